"""Files that are cut, damaged or made to harm: each gives a table or one error in plain words, never anything else."""

from __future__ import annotations

import os
import sys
import zipfile

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from pneutouch.bench.reading import PLATE, read_blocks
from pneutouch.bench.source import identify
from pneutouch.errors import InputError
from pneutouch.spec.campaign import ColumnMap, FileFormat, Rig
from tests.bench.rig import small
from tests.tables.instruments import INSTRUMENTS, excel, instron, labview, mts, tdms

BY_NAME = {make.__name__: make for make in INSTRUMENTS}


@pytest.fixture(scope="module")
def samples():
    short = small(rate=25.0, depths=(1.0, 3.0))
    return (*short[:3], short[3] * 1e3)


@pytest.fixture(scope="module")
def written(tmp_path_factory, samples):
    """The bytes of each instrument's file, by its name, and the suffix."""
    folder = tmp_path_factory.mktemp("whole")
    paths = {name: make(folder, *samples) for name, make in BY_NAME.items()}
    return {name: (path.read_bytes(), path.suffix) for name, path in paths.items()}


def read(path, **written_as):
    return read_blocks(identify(path, ColumnMap(), PLATE, FileFormat(**written_as)), Rig())


def refuse(path, *texts, **written_as):
    with pytest.raises(InputError) as caught:
        read(path, **written_as)
    message = str(caught.value)
    assert message.startswith(f"{path}: ") and "Traceback" not in message
    for text in texts:
        assert text in message


def mutated(data, cuts, bytes_, joins):
    """Bytes with some replaced, some cut out and some repeated."""
    out = bytearray(data)
    for at, byte in bytes_:
        out[at % len(out)] = byte
    for at, length in cuts:
        at %= len(out)
        del out[at : at + length]
        out = out or bytearray(b"x")
    for at, length in joins:
        at %= len(out)
        out[at:at] = out[at : at + length]
    return bytes(out)


SPANS = st.lists(st.tuples(st.integers(0, 10**6), st.integers(1, 400)), max_size=3)
BYTES = st.lists(st.tuples(st.integers(0, 10**6), st.integers(0, 255)), max_size=8)


def check_mutations(name, written, folder, examples):
    data, suffix = written[name]
    path = folder / f"mutated{suffix}"

    @settings(
        max_examples=examples, deadline=None, suppress_health_check=list(HealthCheck), database=None, derandomize=True
    )
    @given(cuts=SPANS, bytes_=BYTES, joins=SPANS, front=st.booleans())
    def check(cuts, bytes_, joins, front):
        # Most of what a file states of itself stands in its first bytes.
        near = (lambda spans: [(at % 400, what) for at, what in spans]) if front else (lambda spans: spans)
        path.write_bytes(mutated(data, near(cuts), near(bytes_), near(joins)))
        try:
            blocks = read(path)
        except InputError as error:
            assert str(path) in str(error)
        else:
            assert np.isfinite(blocks.force).all() and blocks.time.size > 1

    check()


@pytest.mark.parametrize("name", ["labview", "zwick", "mts_testsuite", "excel", "tdms", "parquet"])
def test_a_spoilt_file_gives_a_table_or_an_error(tmp_path, written, name):
    check_mutations(name, written, tmp_path, 12)


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(BY_NAME))
def test_many_spoilt_files_give_a_table_or_an_error(tmp_path, written, name):
    check_mutations(name, written, tmp_path, 400)


@settings(max_examples=60, deadline=None, derandomize=True, database=None)
@given(data=st.binary(min_size=1, max_size=400), suffix=st.sampled_from([".csv", ".xlsx", ".tdms", ".parquet", ".lvm"]))
def test_rubbish_is_refused(tmp_path_factory, data, suffix):
    path = tmp_path_factory.getbasetemp() / f"rubbish{suffix}"
    path.write_bytes(data)
    refuse(path)


def test_the_extras_are_named(tmp_path, monkeypatch, samples):
    for module, make, words in (("openpyxl", excel, "pneutouch[xlsx]"), ("nptdms", tdms, "pneutouch[tdms]")):
        path = make(tmp_path, *samples)
        with monkeypatch.context() as without:
            without.setitem(sys.modules, module, None)
            refuse(path, f'pip install "{words}"')


def test_a_workbook_that_unpacks_to_much_is_refused(tmp_path, monkeypatch, samples):
    path = excel(tmp_path, *samples)
    with zipfile.ZipFile(path, "a", zipfile.ZIP_DEFLATED) as book:
        book.writestr("xl/media/image1.png", bytes(110_000_000))
    assert path.stat().st_size < 1e6
    refuse(path, "MB unpacked", "save the sheet as CSV")


def test_a_workbook_with_an_absurd_size_or_row_is_refused(tmp_path, samples):
    source = excel(tmp_path, *samples)
    for old, new, words in (
        (b'<row r="300">', b'<row r="999999999">', "more than"),
        (b'r="A5"', b'r="ZZZZZ5"', "no whole Excel file"),
        (b"<sheetData>", b'<!DOCTYPE a [<!ENTITY x "y">]><sheetData>', "no whole Excel file"),
    ):
        path = tmp_path / "absurd.xlsx"
        with zipfile.ZipFile(source) as before, zipfile.ZipFile(path, "w") as after:
            for name in before.namelist():
                data = before.read(name)
                after.writestr(name, data.replace(old, new, 1) if "sheet2" in name else data)
        refuse(path, words)


def test_a_formula_is_not_evaluated(tmp_path, samples):
    from openpyxl import load_workbook

    path = excel(tmp_path, *samples)
    book = load_workbook(path)
    book["Specimen 1"]["C9"] = "=1+1"
    book.save(path)
    refuse(path, "row 9: column Standard force: empty", "of a formula its value is read")


def test_several_tables_are_asked_for(tmp_path, samples):
    from openpyxl import load_workbook

    path = excel(tmp_path, *samples)
    book = load_workbook(path)
    book.copy_worksheet(book["Specimen 1"]).title = "Specimen 2"
    book.save(path)
    refuse(path, "tables of numbers in 2 sheets: Specimen 1, Specimen 2", '[format]\nsheet = "Specimen 1"')
    assert read(path, sheet="Specimen 2").force == pytest.approx(samples[2], abs=1e-6)
    refuse(path, 'no sheet "Other"', sheet="Other")


def test_a_second_recording_in_a_file_is_refused(tmp_path, samples):
    for make in (mts, labview, instron):
        path = make(tmp_path, *samples)
        path.write_bytes(path.read_bytes() * 2)
        row = path.read_bytes()[: path.stat().st_size // 2].count(b"\n") + 1
        refuse(path, f"row {row}")


def test_a_labview_file_with_several_clocks_is_refused(tmp_path, samples):
    path = labview(tmp_path, *samples)
    path.write_text(path.read_text().replace("X_Columns\tOne", "X_Columns\tMulti"))
    refuse(path, "each channel has times of its own (X_Columns Multi)")
    path.write_text("\n".join(path.read_text().replace("Multi\t", "One\t").splitlines()[:12]) + "\n")
    refuse(path, "without its two lines ***End_of_Header***")


def test_channels_of_unlike_length_are_refused(tmp_path, samples):
    from nptdms import ChannelObject, TdmsWriter

    path = tmp_path / "a.tdms"
    names = [
        ("Time (s)", samples[0]),
        ("Position mm", samples[1]),
        ("Load [N]", samples[2]),
        ("P_kPa", samples[3][:-5]),
    ]
    with TdmsWriter(path) as writer:
        writer.write_segment([ChannelObject("Run", name, values) for name, values in names])
    refuse(path, "channels of unlike length")
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2])
    refuse(path)


def test_a_line_of_a_thousand_million_columns_is_refused(tmp_path):
    path = tmp_path / "wide.csv"
    with path.open("wb") as file:
        file.write(b"time_s,")
        file.truncate(10**9)
    refuse(path, "zero byte")
    path.write_bytes(b"a," * 10**6)
    refuse(path, "bytes without a line end")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_devices_and_pipes_are_refused(tmp_path):
    pipe = tmp_path / "pipe.csv"
    os.mkfifo(pipe)
    refuse(pipe, "a device or a pipe")


def test_a_preamble_does_not_move_row_numbers(tmp_path, samples):
    path = instron(tmp_path, *samples)
    lines = path.read_text().splitlines(keepends=True)
    lines[19] = lines[19].replace('","', '","?', 1)
    path.write_text("".join(lines))
    refuse(path, "row 20: column Compressive extension: '?")
