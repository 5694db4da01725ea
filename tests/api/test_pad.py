"""A pad from Python: the same numbers as the mechanics, in boundary units; and what cannot be read or pressed."""

from __future__ import annotations

import numpy as np
import pytest

import pneutouch as pt
from pneutouch.errors import InputError
from pneutouch.evaluation import evaluate
from pneutouch.mechanics.models.solid import solid_states
from pneutouch.mechanics.touch import cell as cells
from pneutouch.output.new_pad import new_pad
from pneutouch.units import KPA
from pneutouch.workflows.pad import touch as touching
from pneutouch.workflows.pad.load import load_pad as resolved
from tests.pads import coarse_home


@pytest.fixture(scope="module")
def touch(tmp_path_factory):
    """A pad of three cells, tabulated by coarse presses."""
    with coarse_home(tmp_path_factory) as home:
        new_pad("tip", home / "designs", "row:3", 9.0)
        yield pt.load_pad("tip").touch(12)


def test_pressures_forces_and_places_are_those_of_the_mechanics(touch):
    found = touch.ball([0.0, 4.0], 0.5, 8.0, [1.2, 1.5])
    inner = touch._model.under_balls(np.array([[0.0, 0.5], [4.0, 0.5]]), np.array([8.0, 8.0]), np.array([1.2, 1.5]))
    assert np.allclose(found.pressure_rises_kPa * KPA, inner.rise) and np.array_equal(found.forces_N, inner.forces)
    assert np.allclose(found.force_N, found.forces_N.sum(axis=1)) and found.inside.all()
    assert touch.driving_pressure_kPa == pytest.approx(12.0) and touch.ball_radii_mm[0] < 8.0 < touch.ball_radii_mm[1]


def test_a_cell_yields_at_its_foot_as_on_its_flange(touch, tmp_path, monkeypatch):
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path))
    new_pad("tip", tmp_path / "designs", "row:3", 9.0)
    depth, forces = np.array([0.6, 1.0, 1.4]), {}
    for clamp in ("base", "flange"):
        (state,) = solid_states(evaluate("tip-cell", clamp=clamp).sensor, np.array([12 * KPA]))
        forces[clamp] = np.interp(depth, state.indentation, state.force)
    found = touch.plate(0.0, 0.0, depth).forces_N[:, 0]
    assert found == pytest.approx(forces["flange"], rel=0.02) and (found < 0.96 * forces["base"]).all()


def test_a_kept_table_answers_alike_and_a_damaged_one_is_made_again(touch, tmp_path, monkeypatch):
    table = touch._model.table
    again = cells.CellTable.of(table.arrays())
    assert np.array_equal(again.balls.values, table.balls.values) and again.apex == table.apex
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    sensor = evaluate("paper-dome").sensor
    made = []
    monkeypatch.setattr(touching, "cell_table", lambda *given: made.append(given) or table)
    for _ in range(2):
        touching._kept(sensor, 0.012)
    (kept,) = (tmp_path / "pneutouch" / "tables").glob("pad-*.npz")
    assert len(made) == 1
    kept.write_bytes(kept.read_bytes()[:100])
    assert touching._kept(sensor, 0.012) is table
    assert len(made) == 2
    touching._kept(sensor, 0.013)
    assert len(made) == 3


def test_a_plate_is_read_as_the_plate_it_is(touch):
    pressed = touch.plate([0.02, -0.03], 0.0, [1.0, 1.2])
    read = touch.read(pressed.pressure_rises_kPa, noise_kPa=0.002, model_error=1e-4)
    assert np.allclose(read.force_N, pressed.force_N, rtol=0.03)
    assert (np.abs(read.force_N - pressed.force_N) <= 4.0 * read.force_uncertainty_N).all()
    assert set(read.kind) <= {"plate", "either"}


def test_slopes_of_a_plate_and_the_turn_of_a_cylinder_are_read_with_their_uncertainties(touch):
    plate = touch.plate([0.02, -0.03], 0.01, [1.0, 1.2])
    read = touch.read(plate.pressure_rises_kPa, noise_kPa=0.002, model_error=1e-4)
    sure = read.kind == "plate"
    off = read.slope - np.array([[0.02, 0.01], [-0.03, 0.01]])
    assert sure.any() and (np.abs(off) <= 4.0 * read.slope_uncertainty)[sure].all()
    bar = touch.cylinder(1.0, 0.5, 10.0, 8.0, 1.5)
    assert (bar.forces_N > 0.0).all() and np.allclose(touch.cylinder(1.0, 0.5, 190.0, 8.0, 1.5).forces_N, bar.forces_N)
    read = touch.read(bar.pressure_rises_kPa, noise_kPa=0.002, model_error=1e-4)
    known = read.kind == "cylinder"
    assert np.isnan(read.turn_deg[~known]).all() and np.isnan(read.slope[known]).all()
    assert read.force_N[0] == pytest.approx(bar.force_N[0], abs=4.0 * read.force_uncertainty_N[0])


def test_a_cell_left_out_is_not_used(touch):
    pressed = touch.plate(0.0, 0.0, 1.1)
    spoilt = pressed.pressure_rises_kPa * np.array([1.0, 0.0, 1.0])
    read = touch.read(spoilt, noise_kPa=0.002, left_out=[2], model_error=1e-4)
    assert read.force_N[0] == pytest.approx(pressed.force_N[0], abs=5.0 * read.force_uncertainty_N[0])


@pytest.mark.parametrize(
    ("call", "key"),
    [
        (lambda touch: touch.ball(0, 0, 0.5, 1), "radius_mm"),
        (lambda touch: touch.ball([0, 1], [0, 1, 2], 8, 1), "x_mm"),
        (lambda touch: touch.plate(0, float("nan"), 1), "slope_y"),
        (lambda touch: touch.cylinder(0, 0, 0, 500, 1), "radius_mm"),
        (lambda touch: touch.cylinder(0, 0, float("nan"), 8, 1), "turn_deg"),
        (lambda touch: touch.read([1.0, 2.0], 0.002), "pressure_rises_kPa"),
        (lambda touch: touch.read([1.0, 2.0, 0.0], 0.0), "noise_kPa"),
        (lambda touch: touch.read([1.0, 2.0, 0.0], 0.002, left_out=[4]), "left_out"),
    ],
)
def test_what_makes_no_sense_names_the_argument(touch, call, key):
    with pytest.raises(InputError) as caught:
        call(touch)
    assert caught.value.key == key


@pytest.mark.parametrize("change", [{"membrane.shape": "disc"}, {"contact.friction": 0.5}])
def test_a_cell_that_the_table_does_not_cover_is_refused(change, tmp_path, monkeypatch):
    from pneutouch.workflows.pad.touch import pad_model

    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path))
    new_pad("tip", tmp_path / "designs", "row:2", 14.0)
    with pytest.raises(InputError) as caught:
        pad_model(resolved("tip", change), 5.0)
    assert caught.value.key == "pad.cell"


@pytest.mark.parametrize(("held_kPa", "key"), [(500.0, "driving_pressure_kPa"), (12.0, "pad.groups[0]")])
def test_a_pressure_beyond_the_limit_point_names_what_states_it(touch, held_kPa, key, tmp_path, monkeypatch):
    table, made_by = touch._model.table, touching.cell_table
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path))
    monkeypatch.setattr(
        touching, "_kept", lambda sensor, pressure, _: table if pressure < 0.1 else made_by(sensor, pressure)
    )
    new_pad("tip", tmp_path / "designs", "row:2", 9.0)
    with pytest.raises(InputError) as caught:
        touching.pad_model(resolved("tip", {"pad.groups": [{"cells": [2], "driving_pressure_kPa": 500.0}]}), held_kPa)
    assert caught.value.key == key and caught.value.value == 500.0
    assert 10.0 < float(caught.value.remedy.rsplit(" ", 1)[1]) < 200.0
