"""A design's reader against the full model, and a calibrated sensor's against its own held-out run."""

from __future__ import annotations

import importlib.util
import json
import shutil
import subprocess

import jsonschema
import numpy as np
import pytest

from pneutouch.cli.export_reader import years_of
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.evaluation.reader import ROWS, _driving_pressures, reader_grid
from pneutouch.evaluation.reader_tables import reader_tables
from pneutouch.export.reader.reading import ForceReader, Status
from pneutouch.export.reader.render import MOST_TABLES, table_bytes
from pneutouch.mechanics import predict
from pneutouch.units import KPA
from pneutouch.workflows.export_reader import make_reader, write_reader
from tests.evaluation.calibrated import DEAD, changed, library_of, predicted

c_compiler = pytest.mark.skipif(shutil.which("gcc") is None, reason="no C compiler (gcc) on this machine")

MAIN = """
#include <stdio.h>
#include "paper_dome_reader.h"
int main(void)
{
    float driving, gauge;
    while (scanf("%f %f", &driving, &gauge) == 2) {
        paper_dome_reader reader;
        paper_dome_reading reading;
        paper_dome_status status;
        paper_dome_begin(&reader);
        paper_dome_add(&reader, driving);
        paper_dome_tare(&reader, 20.0f, PAPER_DOME_AMBIENT_KPA);
        status = paper_dome_read(&reader, gauge, 20.0f, PAPER_DOME_AMBIENT_KPA, &reading);
        printf("%d %.9g\\n", (int)status, (double)reading.force_N);
    }
    return 0;
}
"""


@pytest.fixture(scope="module")
def evaluation():
    return evaluate("paper-dome", model="auto")


@pytest.fixture(scope="module")
def result(evaluation):
    return make_reader(evaluation)


@c_compiler
def test_the_header_is_within_half_a_percent_of_the_full_model_at_10_000_random_states(tmp_path, evaluation, result):
    draw, sensor, known = np.random.default_rng(11), evaluation.sensor, result.document
    driving = np.sort(draw.uniform(*known["box"]["driving_pressure_kPa"], 125))
    states = predict("dome", sensor.replace(steps=113), [p * KPA for p in driving], model=known["model"]).states
    rows, forces = [], []
    for state in states:
        depths = draw.uniform(0.0, min(state.range_end, known["box"]["indentation_mm"][1]), 80)
        force, rise = (np.interp(depths, state.indentation, y) for y in (state.force, state.pressure_rise))
        rows += [f"{state.driving_pressure / KPA:.9g} {(state.driving_pressure + dp) / KPA:.9g}" for dp in rise]
        forces += force.tolist()
    assert len(forces) == 10_000
    (tmp_path / "paper_dome_reader.h").write_bytes(result.files["paper_dome_reader.h"])
    (tmp_path / "main.c").write_text(MAIN)
    subprocess.run(["gcc", "-O2", "main.c", "-o", "main"], cwd=tmp_path, check=True)
    done = subprocess.run([tmp_path / "main"], input="\n".join(rows), capture_output=True, text=True, check=True)
    status, read = np.array([line.split() for line in done.stdout.splitlines()], float).T
    full = known["box"]["contact_force_N"][1]
    inside = status <= Status.ABOVE_RATING
    # At the very end of a row between two others the last column may lie a little before the model's.
    assert inside.mean() > 0.99
    assert np.abs(read - forces)[inside].max() <= 0.005 * full
    assert known["difference"]["nominal_N"] <= 0.005 * full
    assert known["difference"]["other_conditions_N"] <= 0.005 * full
    # States in which the reader gives a force: the last ones of a press may lie beyond its box.
    assert 9_900 <= known["difference"]["states"] <= 10_000


def test_the_document_follows_its_schema_and_its_tables_are_small(result):
    schema = json.loads(result.files["reader.schema.json"])
    jsonschema.validate(result.document, schema)
    assert table_bytes(result.document) <= MOST_TABLES
    for name in ("pressure_rise_kPa", "contact_force_N"):
        rows = np.array(result.document["grid"][name])
        assert (rows[:, 0] == 0.0).all() and (np.diff(rows, axis=1) > 0.0).all()


def test_the_uncertainty_is_that_of_the_sensitivity_where_the_curve_is_as_stiff(evaluation, result):
    """The force at a rise is the rise over the sensitivity: their relative uncertainties are of one size."""
    stated = [entry.known["sensitivity_kPa_per_N"].standard_uncertainty_relative for entry in evaluation.uncertainty]
    relative = np.array(result.document["grid"]["force_uncertainty_relative"])
    assert relative.min() > 0.5 * min(stated) and relative.max() < 2.0 * max(stated)


def test_a_disc_reads_as_surely_as_it_is_predicted():
    changes = {"membrane.shape": "disc", "membrane.boss_radius_mm": 2.8, "membrane.boss_height_mm": 2.8}
    disc = evaluate("paper-dome", {**changes, "pneumatics.driving_pressures_kPa": [4.0, 12.0]}, model="solid")
    states, grid = disc.prediction.states, reader_grid(disc)
    year, fresh = (reader_tables(disc, grid, aged).grid for aged in (None, 0.0))
    stated = [entry.known["sensitivity_kPa_per_N"].standard_uncertainty_relative for entry in disc.uncertainty]
    rows = [np.array(one.force_uncertainty_relative)[:, -1] for one in (year, fresh)]
    at = np.interp([state.driving_pressure / KPA for state in states], year.driving_pressure_kPa, rows[0])
    assert at == pytest.approx(stated, rel=0.05) and (rows[1] < rows[0]).all()
    assert year.force_uncertainty_unknown is None


def test_less_ageing_is_less_uncertainty_and_a_year_is_all_that_is_known(evaluation, result):
    grid = reader_grid(evaluation)
    year, half, fresh = (reader_tables(evaluation, grid, aged).grid for aged in (None, 0.5, 0.0))
    assert [one.force_uncertainty_age_days for one in (year, half, fresh)] == [365.0, 182.5, 0.0]
    rows = [np.array(one.force_uncertainty_relative) for one in (year, half, fresh)]
    assert (rows[0] > rows[1]).all() and (rows[1] > rows[2]).all()
    for aged in (-0.1, 1.1, float("nan")):
        with pytest.raises(InputError):
            reader_tables(evaluation, grid, aged)


@pytest.mark.parametrize(("age_days", "counted"), [(200.0, 165.0), (400.0, 0.0)])
def test_after_a_calibration_only_the_rest_of_the_first_year_counts(library, tmp_path, age_days, counted):
    place = library_of(tmp_path, library, changed(source={"age_days": age_days}))
    calibrated = predicted(place, {**DEAD, "pneumatics.driving_pressures_kPa": [0.0]})
    grid = reader_grid(calibrated)
    assert reader_tables(calibrated, grid, 1.0).grid.force_uncertainty_age_days == pytest.approx(counted)
    assert reader_tables(calibrated, grid).grid.force_uncertainty_age_days == 0.0


@pytest.mark.parametrize(
    ("text", "years"), [("90d", 90 / 365), ("8w", 56 / 365), ("6m", 0.5), ("1y", 1.0), ("0d", 0.0)]
)
def test_a_time_with_its_unit_is_a_share_of_a_year(text, years):
    assert years_of(text, "age") == pytest.approx(years)


@pytest.mark.parametrize("text", ["", "y", "1", "2y", "-1d", "1 year", "nany"])
def test_a_time_without_a_unit_or_beyond_a_year_is_refused(text):
    with pytest.raises(InputError):
        years_of(text, "age")


@pytest.mark.parametrize("pressures", [[0.0], [12.0]])
def test_a_design_with_one_driving_pressure_has_a_box_around_it(pressures):
    single = evaluate("paper-dome", {"pneumatics.driving_pressures_kPa": pressures}, model="atlas")
    grid = reader_grid(single)
    assert grid.low <= pressures[0] * KPA < grid.high
    assert grid.driving_pressure[0] < grid.low and grid.driving_pressure[-1] == pytest.approx(grid.high)


def test_the_same_design_gives_the_same_bytes_and_a_module_that_reads(tmp_path, evaluation, result):
    first, second = (
        write_reader(one, tmp_path / place) for one, place in ((result, "a"), (make_reader(evaluation), "b"))
    )
    files = sorted(path.relative_to(first) for path in first.rglob("*") if path.is_file())
    assert [(first / name).read_bytes() for name in files] == [(second / name).read_bytes() for name in files]
    spec = importlib.util.spec_from_file_location("paper_dome_reader", first / "paper_dome_reader.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    reader = module.ForceReader(module.TABLE)
    assert reader.tare([5.0]) == 0
    state = predict("dome", evaluation.sensor, [5.0 * KPA], model="atlas").states[0]
    middle = len(state.force) // 2
    reading = reader.read((state.driving_pressure + state.pressure_rise[middle]) / KPA)
    assert reading.force_N == pytest.approx(state.force[middle], rel=0.005)


def test_an_absolute_gauge_at_its_end_gives_no_force_at_any_ambient_pressure():
    """It reads to 125 kPa with the ambient pressure in it: 20.7 kPa where that is greatest, 3 kPa above the design's."""
    changes = {"pneumatics.gauge": "bosch-bmp390", "pneumatics.driving_pressures_kPa": [0.0, 5.0]}
    known = make_reader(evaluate("paper-dome", changes, model="auto")).document
    reader, ambient_kPa = ForceReader(known), known["box"]["ambient_pressure_kPa"][1]
    assert reader.tare([5.0], 20.0, ambient_kPa) == Status.OK
    assert reader.read(124.9 - ambient_kPa, 20.0, ambient_kPa).status <= Status.ABOVE_RATING
    assert reader.read(125.0 - ambient_kPa, 20.0, ambient_kPa).status == Status.GAUGE_SATURATED


@pytest.mark.parametrize("highest_kPa", [0.0, 1.0, 22.0])
def test_rows_below_zero_continue_three_computed_ones(evaluation, monkeypatch, highest_kPa):
    monkeypatch.setitem(ROWS, evaluation.prediction.model, 5)
    rows, computed, low, high = _driving_pressures(evaluation, 0.0, highest_kPa * KPA)
    assert len(rows) - computed >= 3 and computed >= 1
    assert rows[computed] == pytest.approx(0.0, abs=1e-12) and rows[-1] == pytest.approx(high)
    assert low == 0.0 and high <= 0.97 * min(
        evaluation.prediction.limits.limit_point, evaluation.sensor.gas.gauge_limit
    )
