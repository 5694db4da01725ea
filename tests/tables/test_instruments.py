"""Files as ten instruments write them give the same samples, indentations and figures as the plain CSV of the same data."""

from __future__ import annotations

import json
import tomllib

import numpy as np
import pytest

from pneutouch.bench.curve import curve_of
from pneutouch.bench.reading import PLATE, read_blocks, scaled
from pneutouch.bench.source import campaign_lines, identify
from pneutouch.results import record
from pneutouch.spec.campaign import Campaign, ColumnMap, FileFormat, Rig
from pneutouch.tables.read import whole
from pneutouch.units import KPA
from tests.bench.rig import run_of, small
from tests.tables.instruments import INSTRUMENTS, plain

RIG = Rig()
EXPECTED = {
    "labview": [("X_Value", "s"), ("Stage position", "mm"), ("Load cell", "N"), ("Pressure", "Pa")],
    "labview_without_times": [("X_Value", "s"), ("Position", "um"), ("Force", "N"), ("Pressure", "kPa")],
    "instron": [("Time", "s"), ("Compressive extension", "mm"), ("Compressive load", "N"), ("Pressure gauge", "psi")],
    "zwick": [("Prüfzeit", "s"), ("Standardweg", "um"), ("Standardkraft", "N"), ("Innendruck", "mbar")],
    "mts": [("Running Time", "s"), ("Axial Displacement", "mm"), ("Axial Force", "kN"), ("Cavity Pressure", "kPa")],
    "mts_testsuite": [("Time", "s"), ("Crosshead", "in"), ("Load", "lbf"), ("Pressure", "psi")],
    "logger": [("time_ms", "ms"), ("pos_mm", "mm"), ("load_g", "gf"), ("p_mmHg", "mmHg")],
    "savetxt": [("t[s]", "s"), ("z[mm]", "mm"), ("F[N]", "N"), ("p[kPa]", "kPa")],
    "excel": [("Test time", "s"), ("Stroke", "mm"), ("Standard force", "N"), ("Pressure", "bar")],
    "tdms": [("X_Value", "s"), ("Position", "mm"), ("Force", "N"), ("Pressure", "hPa")],
    "parquet": [("Time (s)", "s"), ("Position mm", "mm"), ("Load [N]", "N"), ("P_kPa", "kPa")],
}


@pytest.fixture(scope="module")
def samples():
    """A short run in s, mm, N, kPa as a plain CSV file holds it, rounded to its decimals."""
    short = small(rate=500.0, depths=(1.0, 3.0))
    return tuple(
        np.round(values, count) for values, count in zip((*short[:3], short[3] / KPA), (3, 5, 6, 6), strict=True)
    )


@pytest.fixture(scope="module")
def reference(tmp_path_factory, samples):
    return read_blocks(identify(plain(tmp_path_factory.mktemp("plain"), *samples), ColumnMap(), PLATE), RIG)


@pytest.mark.parametrize("make", INSTRUMENTS, ids=lambda make: make.__name__)
def test_an_instrument_s_file_reads_as_the_plain_one(tmp_path, samples, reference, make):
    source = identify(make(tmp_path, *samples), ColumnMap(), PLATE)
    found = [getattr(source.columns, key) for key in PLATE]
    assert [(column.name, column.unit) for column in found] == EXPECTED[make.__name__]
    assert set(PLATE) <= set(source.guessed)
    blocks = read_blocks(source, RIG)
    for name, digits in (("time", 1e-9), ("position", 1e-5), ("force", 1e-6), ("pressure", 1e-9)):
        assert getattr(blocks, name) == pytest.approx(getattr(reference, name), abs=digits)
    assert blocks.warnings == reference.warnings == ()
    here, there = (curve_of(run_of(), one, RIG) for one in (blocks, reference))
    for name in ("indentation", "force", "rise"):
        assert [f"{value:.4g}" for value in getattr(here, name)] == [f"{value:.4g}" for value in getattr(there, name)]


@pytest.mark.parametrize("make", INSTRUMENTS, ids=lambda make: make.__name__)
def test_what_was_found_can_be_kept(tmp_path, samples, make):
    """The lines that are printed are those of a campaign file, and a file that is read by them leaves nothing to guess."""
    path = make(tmp_path, *samples)
    found = identify(path, ColumnMap(), PLATE)
    head = '[[runs]]\nfile = "a"\nsensor = "A"\nresin = "FLX9950"\n'
    campaign = Campaign.model_validate(tomllib.loads(f"{campaign_lines(found.content)}\n{head}"))
    again = identify(path, campaign.columns, PLATE, campaign.format)
    assert again.guessed == ()
    assert again.columns == found.columns and again.layout.first_row == found.layout.first_row
    assert json.loads(json.dumps(record.plain(found.content))) == tomllib.loads(campaign_lines(found.content))


def test_a_sign_and_a_column_without_header_can_be_stated(tmp_path, samples):
    path = tmp_path / "bare.txt"
    np.savetxt(path, np.stack([-samples[2], samples[3], samples[0], samples[1]]).T, "%.6f", delimiter=";")
    stated = {
        "force": {"name": "#1", "unit": "N", "sign": -1},
        "pressure": {"name": "#2", "unit": "kPa"},
        "time": {"name": "#3", "unit": "s"},
        "position": {"name": "#4", "unit": "mm"},
    }
    source = identify(path, ColumnMap.model_validate(stated), PLATE)
    lines, (time, force) = whole(path, ["#3", "#1"], source.layout)
    assert lines[0] == 1 and time == pytest.approx(samples[0], abs=1e-6)
    assert scaled(path, source.columns, ["force"], lines, force[None])[0] == pytest.approx(samples[2], abs=1e-6)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "cp1252", "latin-1"])
def test_encodings_are_found(tmp_path, samples, reference, encoding):
    path = plain(tmp_path, *samples)
    text = path.read_text().replace("time_s,position_mm", "time_s,Länge [mm]").replace("Länge", "Weg µ ±")
    path.write_bytes(text.encode(encoding))
    source = identify(path, ColumnMap(), PLATE)
    assert source.columns.position.name == "Weg µ ± [mm]"
    assert read_blocks(source, RIG).force == pytest.approx(reference.force, abs=1e-9)
    stated = identify(path, source.columns, PLATE, FileFormat(encoding=source.layout.format.encoding))
    assert stated.guessed == ()
