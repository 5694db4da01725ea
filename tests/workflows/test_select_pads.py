"""Pads for a wanted resolution: what is tried, what is best, and that its cells are those of the table."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.errors import InputError
from pneutouch.evaluation import evaluate
from pneutouch.mechanics.touch import cell as cells
from pneutouch.units import KPA
from pneutouch.workflows.pad import select_pads as pads
from pneutouch.workflows.pad.select_pads import PITCH, PadTarget, select_pads, similar_cell
from tests.mechanics.touch.test_touch import CELL
from tests.running import in_process


@pytest.fixture(scope="module")
def trials():
    return select_pads(PadTarget((30.0, 20.0), 0.1, 1.0, 8.0, 12))


def test_grids_cover_the_area_each_finer_than_the_one_before(trials):
    for one in trials:
        rows, columns = map(int, one.layout.removeprefix("grid:").split("x"))
        assert rows * columns == one.cells <= 12
        assert columns * one.pitch >= 30.0 - 1e-9 and rows * one.pitch >= 20.0 - 1e-9
    assert (np.diff([one.pitch for one in trials]) < 0.0).all()


def test_finer_pads_find_the_place_better(trials):
    places = [one.place_error for one in trials]
    assert places[-1] < 0.5 * places[0]
    assert all(one.read > 0.9 for one in trials)
    assert max(one.force_error for one in trials) < 0.2


def test_a_pad_that_is_too_high_does_not_meet(trials):
    target = PadTarget((30.0, 20.0), 1.0, 100.0, 8.0, 12, height=5.0)
    meets = [one.meets(target) for one in trials]
    assert meets == [sum(one.sizes) <= 5.0 for one in trials] and set(meets) == {True, False}


def test_a_noisier_gauge_reads_no_better(trials, monkeypatch):
    monkeypatch.setattr(pads, "_noise", lambda name: 0.1 * KPA)
    noisy = select_pads(PadTarget((30.0, 20.0), 0.1, 1.0, 8.0, 6))
    quiet = [one for one in trials if one.cells <= 6]
    assert np.median([one.force_error for one in noisy]) > np.median([one.force_error for one in quiet])


@pytest.mark.parametrize("target", [((3.0, 3.0), 8.0), ((400.0, 300.0), 8.0), ((30.0, 20.0), 0.5)])
def test_an_area_or_a_ball_that_no_grid_fits_is_refused(target):
    with pytest.raises(InputError) as caught:
        select_pads(PadTarget(target[0], 0.1, 1.0, target[1], 8))
    assert caught.value.key == "pad"


def test_the_next_command_draws_the_pad_that_was_chosen(tmp_path, monkeypatch):
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path))
    found = in_process(["select", "--pad", "30x20", "--place-error", "3", "--gauges", "4", "--charts", "c"], tmp_path)
    assert found.returncode == 0 and (tmp_path / "c/pad-trade-off.svg").is_file()
    words = found.stderr.partition("next: pneutouch ")[2].replace("NAME", "mine").replace("'", "").split()
    assert in_process(words, tmp_path).returncode == 0
    assert in_process(["check", "mine"], tmp_path).returncode == 0
    assert in_process(["select", "--pad", "30x20", "--place-error", "0.01", "--gauges", "4"], tmp_path).returncode == 1
    low = in_process(["select", "--pad", "30x20", "--place-error", "9", "--gauges", "6", "--max-height", "3"], tmp_path)
    assert low.returncode == 1
    for wrong in (
        ["--pad", "30"],
        ["--gauges", "3"],
        ["--pad", "30x20", "--ball", "-1"],
        ["--pad", "9x9", "--pick", "2"],
    ):
        assert in_process(["select", *wrong], tmp_path).returncode == 2


@pytest.mark.slow
@pytest.mark.parametrize("size", [1.0, 1.6])
def test_the_shipped_cell_scales_as_cells_do(size):
    """Presses of a cell ``size`` times as large, with as much more gas behind it."""
    changes = {
        "membrane.inner_radius_mm": 2.78 * size,
        "membrane.wall_thickness_mm": 1.0 * size,
        "pneumatics.dead_volume_mL": 1.5 * size**3,
    }
    made = cells.cell_table(evaluate("paper-dome", {**CELL, **changes}, clamp="flange").sensor, 12.0 * KPA)
    table = similar_cell().scaled(size)
    assert table.apex == pytest.approx(made.apex, rel=2e-3) and table.cavity == pytest.approx(made.cavity, rel=2e-3)
    depth = np.linspace(0.3, 0.8, 4) * min(made.depth, table.depth)
    press = np.full(4, 6.0 * size), np.full(4, 0.8 * size)
    ours, theirs = (
        table.under_round("balls", *press, table.apex - depth),
        made.under_round("balls", *press, made.apex - depth),
    )
    assert np.allclose(ours.force, theirs.force, rtol=0.02) and np.allclose(ours.rise, theirs.rise, rtol=0.02)


def test_the_shipped_cell_is_of_the_pitch_of_new_pads():
    assert 2.0 * similar_cell().outer == pytest.approx(0.84 * PITCH, rel=2e-3)
