"""Columns that are one, with noise or without, are told from the columns of a true press."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from pneutouch.bench.simulate.curve import press_curves
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.units import KPA
from tests.bench.reads import read as plates
from tests.bench.reads import refuse
from tests.bench.recordings import DEEP, READ, ZERO, Recording, presses
from tests.workflows.characterize.test_recordings import NAMES, figures, read


@pytest.mark.parametrize(
    ("first", "second", "factor", "step"),
    [
        ("force", "pressure", 1.0, None),
        ("force", "pressure", 2.2, None),
        ("position", "force", 1.0, None),
        ("time", "position", 1.0, None),
        ("pressure", "force", 0.4, 0.1),
        ("pressure", "force", 0.4, 1.0),
    ],
)
def test_columns_that_are_one_are_refused(first, second, factor, step, tmp_path):
    rows = {"time": 0, "position": 1, "force": 2, "pressure": 3}

    def copied(samples):
        copy = factor * samples[rows[first]]
        samples[rows[second]] = copy if step is None else np.round(copy / step) * step
        return samples

    path = tmp_path / "run.csv"
    path.write_text(Recording(spoil=copied).text())
    named = [NAMES[key] for key in rows if key in (first, second)]
    refuse(path, f"columns {named[0]} and {named[1]} hold the same values")


COPIED = "straight line but for noise"


@pytest.mark.parametrize("name", ["triangular", "single press", "sine", "steps", "stairs with return", "hold"])
@pytest.mark.parametrize(("row", "of"), [(2, 3), (3, 2)])
@pytest.mark.parametrize("share", [0.002, 0.005, 0.01])
def test_a_column_that_is_another_and_noise_is_asked_about(name, row, of, share, tmp_path):
    def copied(samples):
        noise = np.random.default_rng(1).normal(0, share * np.ptp(samples[of]), samples.shape[1])
        samples[row] = 2.2 * (samples[of] + noise)
        return samples

    path = tmp_path / "run.csv"
    path.write_text(replace(READ[name], spoil=copied).text())
    assert any(COPIED in warning.why for warning in plates(path).warnings)


@pytest.mark.parametrize("resin", ["TangoPlus", "FLX9940", "FLX9950", "FLX9960", "FLX9995"])
@pytest.mark.parametrize("noise", [0.0, 0.02, 0.15])
def test_a_press_of_any_resin_to_any_depth_is_no_copy(resin, noise, tmp_path):
    """Between the bends of light and of deep presses a dome is nearly linear, at 4.5 to 6 mm."""
    changes = {"membrane.material": resin, "membrane.wall_thickness_mm": 1.6}
    (press,) = press_curves(evaluate("paper-dome", changes, model="atlas").sensor, [0.0], 6.9, model="atlas").curves
    for depth in (0.3, 1.0, 3.0, 4.5, 6.0, 6.9):

        def pressed(samples, depth=depth):
            force, rise = press.at(np.clip(samples[1] - ZERO, 0.0, None) * depth / DEEP)
            rng = np.random.default_rng(round(10 * depth))
            samples[2] = force + rng.normal(0, noise, force.size)
            samples[3] = rise / KPA + rng.normal(0, 0.03, force.size)
            return samples

        path = tmp_path / "run.csv"
        path.write_text(Recording(presses(1), spoil=pressed).text())
        assert not any(COPIED in warning.why for warning in plates(path).warnings), depth


def test_a_plate_that_goes_in_evenly_and_not_back_is_no_copy_of_the_time(tmp_path):
    inward = Recording([(7.5, 6.5)])
    assert figures(read(tmp_path, inward))["sensitivity_kPa_per_N"].value > 2
