"""Every bound on what is read, just within it and just beyond; a refusal states the size and the bound."""

from __future__ import annotations

import itertools
import json

import numpy as np
import pytest

import pneutouch as pt
from pneutouch.errors import InputError, shown
from pneutouch.spec.design import DesignFile
from pneutouch.spec.files import MOST_BYTES, read_bytes
from pneutouch.spec.read import read_toml, validate
from pneutouch.spec.tasks import read_tasks
from tests.refusals import refused


@pytest.mark.parametrize(("most", "words"), [(MOST_BYTES, "1 MB"), (64 * 1024, "64 KiB"), (2**21, "2 MiB")])
def test_a_file_of_the_greatest_size_is_read_and_one_byte_more_is_not(most, words, tmp_path):
    path = tmp_path / "a.toml"
    path.write_bytes(b"#" * most)
    assert len(read_bytes(path, most)) == most
    path.write_bytes(b"#" * (most + 1))
    with pytest.raises(InputError, match=f"larger than {words}: {most + 1} bytes; no TOML file is"):
        read_bytes(path, most)


@pytest.mark.parametrize("part", ["a", '"a b"', "'a.b'", "a ", "a\t"])
@pytest.mark.parametrize("written", ["{} = 1", "[{}]", "[[{}]]", "x = {{ {} = 1 }}"])
def test_keys_have_at_most_32_parts(part, written, tmp_path):
    path = tmp_path / "a.toml"
    path.write_text(written.format(".".join([part] * 32)))
    assert read_toml(path)
    path.write_text(written.format(".".join([part] * 33)))
    with pytest.raises(InputError, match="a key of more than 32 parts"):
        read_toml(path)


def test_a_key_as_long_as_a_file_is_refused_without_counting_its_parts_in_pairs(tmp_path):
    path = tmp_path / "a.toml"
    path.write_text(".".join(["a"] * 499_000) + " = 1")
    # tomllib alone takes an hour.
    with pytest.raises(InputError, match="more than 32 parts"):
        read_toml(path)


@pytest.mark.parametrize("text", ["a" * 990_000, '"' * 990_000, "1.5, " * 190_000, ". " * 490_000, "a " * 490_000])
def test_no_text_makes_the_look_for_long_keys_long(text):
    from pneutouch.spec.read import _LONG_KEY

    assert _LONG_KEY.search(text) is None


def test_a_file_of_many_problems_reports_twenty_and_how_many_more():
    with pytest.raises(InputError) as caught:
        validate(DesignFile, {f"k{number}": 1 for number in range(50_000)}, "a.toml")
    lines = str(caught.value).split("\n")
    assert len(lines) == 21 and lines[-1] == "a.toml: and 49980 more problems"
    with pytest.raises(InputError) as caught:
        validate(DesignFile, {f"k{number}": 1 for number in range(20)}, "a.toml")
    assert len(str(caught.value).split("\n")) == 20


def test_a_table_of_tasks_has_at_most_fifty(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("force_range_N\n" + "15\n" * 50)
    assert len(read_tasks(path)) == 50
    path.write_text("force_range_N\n" + "15\n" * 51)
    with pytest.raises(InputError, match="51 tasks; at most 50"):
        read_tasks(path)


def test_a_value_nested_without_end_is_shown_cut():
    value: object = 1
    for _ in range(5000):
        value = [value]
    assert shown(value) == "[" * 21 + "..." + "]" * 21
    table: object = 1
    for _ in range(5000):
        table = {"a": table}
    assert len(shown(table)) < 300


def test_a_keyword_without_end_is_refused():
    endless: list[object] = []
    endless.append(endless)
    for value in (endless, {"a": endless}, itertools.count(), range(10**12)):
        with pytest.raises(InputError) as caught:
            pt.Design(driving_pressures_kPa=value)
        assert caught.value.key.partition("[")[0] == "driving_pressures_kPa"


@pytest.mark.parametrize("deep", [[None], [[[{"a": None}, None]]], {"a": [None]}])
def test_runs_of_the_page_that_no_campaign_file_can_hold_are_refused(deep, tmp_path):
    from pneutouch.studio.measured import write_runs

    with refused("runs"):
        write_runs(tmp_path, [{"file": "a.csv", "sensor": deep}])
    assert not list(tmp_path.iterdir())


HEAD = "time_s,position_mm,force_N,pressure_kPa\n"


@pytest.mark.parametrize(
    ("times", "words"),
    [
        ((0, 1e-320, 2e-320), "rises by 1e-320 s from row to row"),
        ((0, 0.9e-6, 1.8e-6), "rises by 9e-07 s"),
        ((0, 1, 2, 1e99), "are missing, at 1 Hz: more than half"),
    ],
)
def test_times_that_no_instrument_has_are_refused_without_a_warning(times, words, tmp_path):
    from pneutouch.bench.reading import PLATE, read_blocks
    from pneutouch.bench.source import identify
    from pneutouch.spec.campaign import ColumnMap, Rig

    path = tmp_path / "a.csv"
    path.write_text(HEAD + "".join(f"{time},{k},{k * k},{k}\n" for k, time in enumerate(times)))
    with pytest.raises(InputError, match=words):
        read_blocks(identify(path, ColumnMap(), PLATE), Rig())
    path.write_text(HEAD + "".join(f"{k * 2e-6},{k},{k * k},{k}\n" for k in range(4)))
    assert read_blocks(identify(path, ColumnMap(), PLATE), Rig()).rate == pytest.approx(5e5)


@pytest.mark.parametrize("step", ["inf", "nan", "1e308", "-1e308"])
@pytest.mark.parametrize("key", ["X0", "Delta_X"])
def test_a_clock_that_no_instrument_has_is_refused_without_a_warning(key, step, tmp_path):
    from pneutouch.bench.reading import PLATE, read_blocks
    from pneutouch.bench.source import identify
    from pneutouch.spec.campaign import ColumnMap, Rig
    from tests.bench.rig import small
    from tests.tables.instruments import labview_without_times

    time, position, force, pressure = small(rate=4.0, depths=(1.0,))
    path = labview_without_times(tmp_path, time, position, force, pressure * 1e3)
    assert read_blocks(identify(path, ColumnMap(), PLATE), Rig()).rate == pytest.approx(4)
    lines = path.read_text().split("\n")
    path.write_text("\n".join(f"{key},{step},{step},{step}," if line.startswith(f"{key},") else line for line in lines))
    with pytest.raises(InputError, match=r"no instrument reads that|time (stands still|runs backwards)"):
        read_blocks(identify(path, ColumnMap(), PLATE), Rig())


def test_a_slice_that_states_more_pixels_than_a_tray_has_is_refused():
    import struct
    import zlib

    from pneutouch.export.voxels.png import MOST_PIXELS, decode, encode, table

    content = encode(np.zeros((2, 3), np.uint8), table([(0, 0, 0, 0)]), (600, 300))
    assert decode(content, "a.png").pixels.shape == (2, 3)
    for columns, rows, words in (
        (MOST_PIXELS, 1, "bytes of pixels"),
        (MOST_PIXELS + 1, 1, "at most"),
        (2**32 - 1, 2**32 - 1, "at most"),
    ):
        head = b"IHDR" + struct.pack(">II", columns, rows) + content[24:29]
        with pytest.raises(InputError, match=words):
            decode(content[:12] + head + struct.pack(">I", zlib.crc32(head)) + content[33:], "a.png")


@pytest.mark.parametrize(("columns", "rows"), [(0, 2**32 - 1), (0, 1), (1, 0), (0, 0)])
def test_a_slice_without_pixels_is_refused_before_its_rows_are_unpacked(columns, rows):
    import struct
    import zlib

    from pneutouch.export.voxels.png import _chunk, decode

    head = _chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 6, 0, 0, 0))
    # Rows without pixels take a byte each: these would be four gigabytes.
    packed = _chunk(b"IDAT", zlib.compress(b"\0" * rows if rows < 10 else b""))
    with pytest.raises(InputError, match=f"states {columns} x {rows} pixels; there must be one at least"):
        decode(b"\x89PNG\r\n\x1a\n" + head + packed + _chunk(b"IEND", b""), "a.png")


@pytest.mark.parametrize("key", ["dpi", "pixels", "pixel_um"])
@pytest.mark.parametrize("value", [[1], [1, 2, 3], ["1", 2], [None, None]])
def test_a_stack_whose_pairs_are_none_is_refused(key, value, tmp_path):
    from pneutouch.export.voxels.stack import read_stack
    from tests.fuzzing.seeds import seeds

    content = json.loads(seeds("stack")[0])
    (tmp_path / "stack.json").write_text(json.dumps(content | {key: value}))
    with pytest.raises(InputError, match=f"{key} is not two numbers"):
        read_stack(tmp_path)


def test_a_dataset_of_more_than_a_tebibyte_is_not_read(tmp_path):
    from pneutouch.workflows.sweep.dataset import stored_dataset, stored_fingerprint

    path = tmp_path / "a.nc"
    with path.open("wb") as file:
        file.truncate(2**40 + 1)
    for read in (stored_dataset, stored_fingerprint):
        with pytest.raises(InputError, match=f"larger than 1048576 MiB: {2**40 + 1} bytes; no dataset is"):
            read(path)


def test_a_journal_without_lines_is_not_read_as_a_whole(tmp_path):
    """Lines of a gibibyte are no entries: what is read of one at once is bounded, and the file is left to its sweep."""
    from pneutouch.workflows.sweep.journal import MOST_LINE, Journal

    path, found = tmp_path / "journal", []
    with path.open("wb") as file:
        file.truncate(3 * MOST_LINE)
    Journal(path, "a" * 64).read(lambda records, place: found.extend(records))
    assert found == [] and path.read_bytes() == b""


def test_a_table_in_memory_as_a_whole_has_a_greatest_count_of_numbers(tmp_path, monkeypatch):
    from pneutouch.tables import read

    path = tmp_path / "a.csv"
    path.write_text("a,b\n" + "1,2\n" * 100)
    monkeypatch.setattr(read, "MOST_NUMBERS", 200)
    assert read.whole(path, ["a", "b"])[1].shape == (2, 100)
    monkeypatch.setattr(read, "MOST_NUMBERS", 199)
    with pytest.raises(InputError, match="more than 199 numbers"):
        read.whole(path, ["a", "b"])


def test_parquet_states_its_rows_and_sizes_before_any_is_read(tmp_path, monkeypatch):
    pa = pytest.importorskip("pyarrow")
    import pyarrow.parquet as pq

    from pneutouch.tables import binary_tables, read

    path = tmp_path / "a.parquet"
    pq.write_table(pa.table({"a": np.zeros(1000), "b": np.random.default_rng(1).random(1000)}), path)
    group = pq.ParquetFile(path).metadata.row_group(0)
    size = group.total_byte_size
    for limit, value, beyond in (("MOST_ROWS", 1000, 999), ("MOST_UNPACKED", size, size - 1)):
        with monkeypatch.context() as here:
            here.setattr(binary_tables, limit, value)
            assert read.whole(path, ["b"])[1].shape == (1, 1000)
            here.setattr(binary_tables, limit, beyond)
            with pytest.raises(
                InputError, match="1000 rows; at most 999" if limit == "MOST_ROWS" else "in one group of rows"
            ):
                read.whole(path, ["b"])
