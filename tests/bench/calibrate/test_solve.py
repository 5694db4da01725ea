"""The least sum of squares of a problem with large residuals, whose Gauss-Newton steps go past the least."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from pneutouch.bench.calibrate.solve import LeastSquaresProblem, solve


def test_steps_that_go_to_and_fro_across_the_least_become_shorter():
    """Residuals x and 10 + 0.0485 x^2: their steps are 1.97 times too long, and shrink by 3 % only if each is taken."""

    def values(sets):
        x = sets[:, 0]
        return np.stack([x, 10.0 + 0.0485 * x**2], axis=1), np.ones((len(sets), 2), dtype=bool)

    points = SimpleNamespace(values=np.zeros(2), use=np.ones(2, dtype=bool), clusters=np.zeros(2, dtype=int))
    bounds = {"low": np.array([-50.0]), "high": np.array([50.0]), "step": np.array([1e-6])}
    chosen = SimpleNamespace(
        fitted=(0,), start=np.zeros(1), prior_spread=np.ones(1), priors=False, full=np.asarray, **bounds
    )
    model = SimpleNamespace(values=values, points=points)
    problem = LeastSquaresProblem(model, chosen, np.ones(2), np.zeros((2, 0)))
    solution = solve(problem, np.array([1.0]))
    assert solution.at == pytest.approx([0.0], abs=0.02)
    assert solution.rounds < 15
