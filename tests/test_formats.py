"""Formats of files: stated by every file that the program writes; a file without its format, or of a later one, is refused."""

from __future__ import annotations

import json
import re
from hashlib import sha256

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pneutouch.errors import InputError
from pneutouch.export.reader.reading import FORMAT, ForceReader
from pneutouch.export.reader.render import SCHEMA
from pneutouch.formats import FORMATS, check_format, format_of, problem_of, versioned
from pneutouch.output.files import check_writable, with_manifest
from pneutouch.spec.campaign import Campaign
from pneutouch.spec.read import read_toml, validate
from pneutouch.workflows.compare import of_build
from pneutouch.workflows.compare_measured import manifest_of, measured_columns
from pneutouch.workflows.driving.pressures import read_leak
from pneutouch.workflows.sweep.dataset import stored_dataset, stored_fingerprint
from tests.conftest import ROOT
from tests.refusals import refused

NAMES = st.sampled_from(sorted(FORMATS))


def later(name):
    return f"pneutouch/{name}/{FORMATS[name].version + 1}"


@settings(max_examples=20)
@given(NAMES)
def test_what_is_written_is_read(name):
    check_format(name, versioned(name, {"a": 1}), "there.json")


@pytest.mark.parametrize("content", [{}, {"format": 1}, {"format": None}])
def test_a_document_without_its_format_is_refused_with_file_and_key(content):
    with pytest.raises(InputError) as refused:
        check_format("plan", content, "there.json")
    assert (refused.value.file, refused.value.key) == ("there.json", "format")


@settings(max_examples=20)
@given(NAMES, st.integers(1, 10**5))
def test_a_later_version_is_refused_with_file_key_value_and_remedy(name, more):
    version = FORMATS[name].version + more
    stated = f"pneutouch/{name}/{version}"
    with pytest.raises(InputError) as refused:
        check_format(name, {"format": stated}, "there.json")
    assert str(refused.value) == (
        f"there.json: format = {json.dumps(stated)}: of a later version; "
        f'this pneutouch reads "{format_of(name)}": take a newer one, or write it again'
    )


@settings(max_examples=20)
@given(
    NAMES,
    st.one_of(
        st.none(), st.text(), st.integers(), st.booleans(), st.floats(), st.lists(st.integers()), NAMES.map(format_of)
    ),
)
def test_what_is_no_format_of_this_file_is_refused(name, stated):
    assert (problem_of(name, stated) is None) == (stated == format_of(name))


def test_every_format_is_written_somewhere_and_by_its_name_alone():
    files = [path for path in (ROOT / "generator/pneutouch").rglob("*.py") if path.name != "formats.py"]
    written = set(re.findall(r"(?:format_of|versioned)\(\s*\"([\w-]+)\"", "".join(path.read_text() for path in files)))
    assert written == FORMATS.keys() - {"exported-design"}
    script = (ROOT / "generator/pneutouch/studio/static/files.js").read_text()
    assert re.findall(r"pneutouch/[\w-]+/\d+", script) == [format_of("exported-design")]


def test_the_module_of_a_reader_states_its_format_without_the_package():
    assert format_of("reader") == FORMAT
    assert json.loads(SCHEMA.read_text())["properties"]["format"]["const"] == FORMAT
    with pytest.raises(ValueError, match="this module reads format pneutouch/reader/1"):
        ForceReader({"format": later("reader")})


def test_a_build_states_the_formats_of_its_files(built):
    folder = built("paper-dome")
    for name in ("manifest", "prediction"):
        assert json.loads((folder / f"{name}.json").read_text())["format"] == format_of(name)


def folder_of(where, **files):
    """An output folder with a manifest, of JSON documents by name."""
    content = {f"{name}.json": json.dumps(document).encode() for name, document in files.items()}
    where.mkdir()
    for name, data in with_manifest({**content, "points.csv": b"file\n"}, "dome", {}).items():
        (where / name).write_bytes(data)
    return where


@pytest.mark.parametrize(
    ("name", "read"),
    [
        ("figures", measured_columns),
        ("figures", lambda folder: read_leak(folder, "paper-dome")),
        ("prediction", of_build),
    ],
)
def test_a_folder_with_a_later_document_is_refused(name, read, tmp_path):
    folder = folder_of(tmp_path / "results", **{name: {"format": later(name)}})
    with pytest.raises(InputError, match=rf'{name}\.json: format = "{later(name)}": of a later version; '):
        read(folder)


@pytest.mark.parametrize("read", [manifest_of, check_writable])
def test_a_folder_with_a_later_manifest_is_neither_read_nor_replaced(read, tmp_path):
    folder = folder_of(tmp_path / "results")
    before = (folder / "manifest.json").read_text()
    read(folder)
    after = before.replace(format_of("manifest"), later("manifest"))
    (folder / "manifest.json").write_text(after)
    with refused("format", "pneutouch/manifest/2"):
        read(folder)
    assert sha256((folder / "manifest.json").read_bytes()).digest() == sha256(after.encode()).digest()
    (folder / "manifest.json").write_text(before.replace(f'  "format": "{format_of("manifest")}",\n', ""))
    with refused("format"):
        read(folder)


@pytest.mark.parametrize("read", [stored_dataset, stored_fingerprint])
def test_a_dataset_of_a_later_version_is_refused(read, tmp_path):
    import xarray

    path = tmp_path / "walls.nc"
    xarray.Dataset(attrs={"format": later("dataset"), "input_hash": "0"}).to_netcdf(path, engine="scipy")
    with refused("format", "pneutouch/dataset/2"):
        read(path)


def test_a_campaign_of_a_later_version_is_refused_and_one_without_is_read(tmp_path):
    path = tmp_path / "campaign.toml"
    run = '[[runs]]\nfile = "a.csv"\nsensor = "1"\nresin = "TangoPlus"\n'
    for head in ("", f'campaign_format = "{format_of("campaign")}"\n'):
        path.write_text(head + run)
        assert validate(Campaign, read_toml(path), str(path)).runs[0].file == "a.csv"
    path.write_text(f'campaign_format = "{later("campaign")}"\n{run}')
    with pytest.raises(
        InputError, match=r"campaign\.toml: campaign_format = .*: of a later version; this pneutouch reads"
    ):
        validate(Campaign, read_toml(path), str(path))
