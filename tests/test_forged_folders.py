"""Output folders whose files were changed by others, hashes and all: each is refused with the file that is not as written."""

from __future__ import annotations

import json

import pytest

from pneutouch.errors import InputError
from pneutouch.formats import format_of
from tests.refusals import refused


def test_figures_nested_too_deep_are_refused(tmp_path):
    from pneutouch.workflows.driving.pressures import _of_campaign

    path = tmp_path / "figures.json"
    path.write_text("[" * 100_000)
    with pytest.raises(InputError, match="not as characterize writes it"):
        _of_campaign(path, "paper-dome")


def forged(folder, **files):
    """A folder of ours whose manifest agrees with what its files were changed to."""
    from pneutouch.output.files import digest

    contents = {name.replace("_", ".", 1): text.encode() for name, text in files.items()}
    for name, content in contents.items():
        (folder / name).write_bytes(content)
    listed = {name: {"sha256": digest(content)} for name, content in contents.items()}
    (folder / "manifest.json").write_text(
        json.dumps({"format": format_of("manifest"), "files": listed, "versions": []})
    )
    return folder


STATED = '{"format": "pneutouch/prediction/1", %s}'


@pytest.mark.parametrize("text", ["[" * 100_000, "[]", "1", "{", STATED % '"model": "solid"', STATED % '"states": [1]'])
def test_a_forged_prediction_of_a_build_is_refused(text, tmp_path):
    from pneutouch.workflows.compare import of_build

    with pytest.raises(InputError, match="is not as this version writes it"):
        of_build(forged(tmp_path, prediction_json=text))


GROUP = '{"format": "pneutouch/figures/1", "design": "a", "simulated": 0, "runs": [%s], "groups": [{"resin": "a", "age": "b", "figures": %s, "files": ["x"]}]}'


@pytest.mark.parametrize(
    ("figures", "points"),
    [
        ("[" * 100_000, ""),
        (GROUP % ("", "[]"), ""),
        (GROUP % ("1", "{}"), ""),
        (GROUP % ("", "{}"), "file\n\0"),
        (GROUP % ("", "{}"), "x" * 200_000),
    ],
)
def test_forged_figures_of_a_campaign_are_refused(figures, points, tmp_path):
    from pneutouch.workflows.compare_measured import measured_columns

    with pytest.raises(InputError, match=r"figures.json is not as this version writes it"):
        measured_columns(forged(tmp_path, figures_json=figures, points_csv=points))


@pytest.mark.parametrize(("value", "pressure"), [("NaN", "12"), ("Infinity", "12"), ("0.1", "inf"), ('"nan"', "12")])
def test_a_leak_that_is_no_number_is_refused_and_not_read_as_none(value, pressure, tmp_path):
    from pneutouch.workflows.driving.pressures import _of_campaign

    path = tmp_path / "figures.json"
    entry = '{"unit": "kPa/min", "value": %s, "figure": "leak, %s kPa"}'
    path.write_text('{"format": "pneutouch/figures/1", "design": "a", "injections": [%s]}' % (entry % ("0.1", "12")))
    assert _of_campaign(path, "a").rate_kPa_per_min == pytest.approx(0.1)
    path.write_text(
        '{"format": "pneutouch/figures/1", "design": "a", "injections": [%s]}' % (entry % (value, pressure))
    )
    with refused("injections"):
        _of_campaign(path, "a")


@pytest.mark.parametrize(
    "figure",
    [
        {"value": "2", "low": 1, "high": 3},
        {"value": None, "low": 1, "high": 3},
        {"value": 2, "low": [1], "high": 3},
        {"value": float("nan"), "low": 1, "high": 3},
        {"value": 2, "low": 1, "high": -1},
        {"value": True, "low": None, "high": None},
    ],
)
def test_figures_of_another_kind_are_refused_where_they_are_read(figure, tmp_path):
    from pneutouch.workflows.compare_measured import measured_columns
    from tests.fuzzing.seeds import MEASUREMENT, POINTS

    def columns(entry):
        group = MEASUREMENT["groups"][0] | {"figures": {"sensitivity_kPa_per_N": entry}}
        content = json.dumps(MEASUREMENT | {"groups": [group]})
        return measured_columns(forged(tmp_path, figures_json=content, points_csv=POINTS.decode()))

    assert columns({"value": 2, "low": None, "high": None})
    with pytest.raises(InputError, match=r"figures.json is not as this version writes it"):
        columns(figure)
