"""Errors that all runs share and that no interval holds, such as a gauge that reads too much."""

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.calibrate.fit import CalibrationFit

GAIN = 0.01


def gain_shifts(fit: CalibrationFit) -> tuple[Array, Array]:
    """Shifts of the estimates, (k,) coordinates each, if the force and if the pressure were read 1 % too high; 0 on a
    bound.

    The gauge reads the driving pressure too.
    """
    p, solution = fit.points, fit.solution
    size = p.there.size
    more = fit.model_at(p._replace(driving=p.driving * (1.0 - GAIN))).values(fit.full[None])[0][0]
    force, pressure = np.zeros(p.values.size), np.where(solution.use, more - solution.model, 0.0)
    # True values are lower than read ones, and so would be the data.
    force[:size] = GAIN * p.values[:size]
    pressure[size:] += GAIN * p.values[size:]
    return _shift(fit, force), _shift(fit, pressure)


def _shift(fit: CalibrationFit, residual: Array) -> Array:
    """Step of the estimates for a change of the residuals in N and MPa."""
    free = np.flatnonzero(~fit.solution.bound)
    change = np.where(fit.solution.use, residual / fit.problem.errors, 0.0)
    whole = fit.problem.whitened(np.column_stack([change, fit.solution.jacobian[:, free]]), fit.solution.use)
    jacobian = whole[:, 1:]
    normal = jacobian.T @ jacobian + np.diag(fit.problem.weight[free])
    scale = np.sqrt(np.maximum(np.diag(normal), 1e-30))
    normal += 1e-12 * np.diag(scale**2)
    shift = np.zeros(fit.solution.at.size)
    # The estimates follow readings that are too high: what is found is minus the correction.
    right = jacobian.T @ whole[:, 0]
    shift[free] = np.linalg.solve(normal, right)
    return np.asarray(shift)
