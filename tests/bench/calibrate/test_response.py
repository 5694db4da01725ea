"""What the runs show of the model's error: its uncertainty with runs repeated, and with each run alone."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.bench.calibrate.fit import fit, identify
from pneutouch.bench.calibrate.fitted_atlas import FLOOR
from pneutouch.bench.calibrate.goodness import ASSUMED_SCATTER, response_gap, scatter_errors
from pneutouch.bench.calibrate.notes import fit_notes
from pneutouch.bench.calibrate.observations import Observations
from pneutouch.bench.calibrate.parameters import USUAL
from pneutouch.spec.material import Material
from tests.bench.calibrate.sensors import DESIGNED, chosen, exact, other


def test_the_assumed_scatter_is_that_of_the_papers_runs(library):
    """Root mean square over the resins of Table S1."""
    measured = [m.measured for m in library.all("materials", Material).values() if m.measured]
    shares = [m.repeatability_kPa_per_N.nominal / m.sensitivity_0kPa_kPa_per_N.nominal for m in measured]
    assert len(shares) == 7
    assert float(np.sqrt(np.mean(np.square(shares)))) == pytest.approx(ASSUMED_SCATTER, abs=5e-4)


def test_runs_that_were_not_repeated_are_not_taken_to_agree(library):
    """Runs without any noise, one a pressure: their scatter is not known, so it is not none."""
    seen = Observations(exact(other(shear_modulus=0.2), (0.0, 12.0)))
    fitted = fit(seen, DESIGNED, chosen(library, *USUAL))
    gap = response_gap(fitted)
    assert gap.freedom == 0.0
    assert gap.force_errors == pytest.approx(np.hypot(ASSUMED_SCATTER, FLOOR[0]))
    assert gap.sensitivity_errors == pytest.approx(np.sqrt(ASSUMED_SCATTER**2 + FLOOR[0] ** 2 + FLOOR[1] ** 2))
    assert any("no run was repeated" in note for note in fit_notes(fitted, identify(fitted), (), (), ()))


def test_the_error_of_a_mean_is_that_of_samples_and_has_the_freedom_of_its_scatter():
    """Three groups of two runs, drawn 4000 times: mean square of the scatter, and its spread by the freedom."""
    rng, scatter = np.random.default_rng(5), np.array([0.05, 0.03])
    drawn = [scatter_errors([*(scatter * rng.standard_normal((3, 2, 2)))]) for _ in range(4000)]
    least = np.array([FLOOR[0], np.hypot(FLOOR[0], FLOOR[1])])
    squares = np.array([errors[0] ** 2 for errors, _ in drawn]) - least**2
    assert squares.mean(axis=0) == pytest.approx(scatter**2 / 2, rel=0.05)
    # A mean square of f degrees of freedom has the relative variance 2/f: here f = 3.
    assert squares.var(axis=0) / squares.mean(axis=0) ** 2 == pytest.approx([2 / 3, 2 / 3], rel=0.1)
    assert all(freedom >= 3.0 for _, freedom in drawn)
    assert min(freedom for _, freedom in drawn) == pytest.approx(3.0, abs=0.5)


def test_runs_that_agree_leave_the_least_share_of_both_readings():
    errors, freedom = scatter_errors([np.zeros((2, 2)), np.full((1, 2), 0.1)])
    assert errors == pytest.approx(np.tile([FLOOR[0], np.hypot(FLOOR[0], FLOOR[1])], (2, 1)))
    assert freedom > 1e5
