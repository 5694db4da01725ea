"""Least squares by Gauss-Newton steps, damped where they would go too far (Levenberg and Marquardt), within bounds.

SciPy's least_squares cannot leave out points that are outside the model during the search, and evaluated the model 4 to
12 times as often (8 to 15 calls for 1 to 4, four fits of simulated curves), for sums of squares equal within 1e-6.
"""

from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.bench.calibrate.fitted_atlas import AtlasModel
from pneutouch.bench.calibrate.fitted_solid import SolidExpansion
from pneutouch.bench.calibrate.parameters import CalibrationParameters
from pneutouch.errors import ComputationError

_POOR = 0.25
"""Decrease of the cost over the expected one below which a step counts as too long (Marquardt's rule)."""
_ROUNDS = 60
_DAMPING = 1e-3
_MOST = 1e9
_SETTLED = 1e-4
"""Least decrease of the sum of squares for which the search goes on, a hundredth of a standard deviation. The criterion
is the sum, not the step: along an undetermined direction steps stay long."""
_MOST_LOST = 0.5
"""Greatest share of a run's points that a step may lose: our choice; else runs could vanish unseen."""


@dataclass(frozen=True, slots=True)
class LeastSquaresSolution:
    """Point with the least sum of squares, for k fitted coordinates and N values.

    Attributes:
        at: Coordinates of the fitted parameters.
        residual: Model less measured over the standard deviation, 0 where not used, (N,).
        local: The residual less the contribution of the shared unknowns, (N,).
        jacobian: Derivatives of the residual, (N, k).
        model: Values of the model, (N,).
        use: Points that were used, (N,).
        bound: Parameters on a bound that would go beyond it, (k,).
        rounds: Steps taken."""

    at: Array
    residual: Array
    local: Array
    jacobian: Array
    model: Array
    use: Flags
    bound: Flags
    rounds: int


class LeastSquaresProblem:
    """Residuals and derivatives; ``errors`` (N,) are the independent standard deviations of the values, ``shared``
    (N, q) the contributions of unknowns of unit variance that act on many values together."""

    def __init__(
        self, model: AtlasModel | SolidExpansion, chosen: CalibrationParameters, errors: Array, shared: Array
    ) -> None:
        self.model, self.chosen, self.errors = model, chosen, errors
        self.shared = shared / errors[:, None]
        fitted = list(chosen.fitted)
        self.low, self.high, self.step = chosen.low[fitted], chosen.high[fitted], chosen.step[fitted]
        self.centre, prior_spread = chosen.start[fitted], chosen.prior_spread[fitted]
        self.weight: Array = prior_spread**-2.0 if chosen.priors else np.zeros(len(fitted))

    def look(self, at: Array) -> tuple[Array, Array, Array, Flags]:
        """Residuals (N,), derivatives (N, k) and values (N,) at ``at``, and flags (N,) of values that the model has."""
        # Differences point inwards where the bound is near.
        step = np.where(at + self.step <= self.high, self.step, -self.step)
        values, ok = self.model.values(self.chosen.full(np.vstack([at, at + np.diag(step)])))
        known = np.asarray(ok.all(axis=0))
        scaled = np.where(known, values, 0.0) / self.errors
        residual = scaled[0] - np.where(known, self.model.points.values, 0.0) / self.errors
        return residual, ((scaled[1:] - scaled[0]) / step[:, None]).T, values[0], known

    def lost(self, use: Flags, known: Flags) -> bool:
        """True if a run has lost more than `_MOST_LOST` of its values in ``use``: those not in ``known``."""
        clusters = self.model.points.clusters
        before = np.bincount(clusters[use])
        after = np.bincount(clusters[use & known], minlength=before.size)
        return bool((after < (1 - _MOST_LOST) * before).any())

    def whitened(self, rows: Array, use: Flags) -> Array:
        """Columns (n + q, j) whose scalar products are those of the columns of ``rows`` (N, j), weighted by the inverse
        covariance of the n values in ``use``.

        The first n entries of a column are its residual after the best-fitting shared unknowns b, the last q are b."""
        shared, seen = self.shared[use], rows[use]
        best = np.linalg.solve(np.eye(shared.shape[1]) + shared.T @ shared, shared.T @ seen)
        return np.vstack([seen - shared @ best, best])

    def cost(self, residual: Array, use: Flags, at: Array) -> float:
        """Sum of squares of whitened residuals and of distances from the priors."""
        return float((self.whitened(residual[:, None], use) ** 2).sum() + (self.weight * (at - self.centre) ** 2).sum())


def solve(problem: LeastSquaresProblem, start: Array) -> LeastSquaresSolution:
    """Solution with the least sum of squares, searched from ``start``, (k,).

    Points outside the model are left out during a search; one that is inside at its end is included in the next. Raises
    ComputationError if no point is inside at the start or the search does not end.
    """
    at = np.clip(start, problem.low, problem.high)
    rounds = 0
    for _ in range(3):
        solution = _descend(problem, at)
        rounds += solution.rounds
        at = solution.at
        if solution.use.sum() == problem.model.points.use.sum():
            break
        if (problem.look(at)[3] & problem.model.points.use).sum() == solution.use.sum():
            break
    return replace(solution, rounds=rounds)


def _descend(problem: LeastSquaresProblem, at: Array) -> LeastSquaresSolution:
    residual, jacobian, values, known = problem.look(at)
    use = known & problem.model.points.use
    if not use.any():
        raise ComputationError(
            "calibrate: the model of the design has none of the measured states (beyond its limit point or buckled); "
            "give the design a modulus or wall nearer to the sensor's"
        )
    damping = _DAMPING
    rounds = 0
    while rounds < _ROUNDS:
        rounds += 1
        step, bound, expected = _step(problem, at, residual, jacobian, use, damping)
        # Differences leave an error in the slope that grows with the residuals, and so must what counts as settled.
        settled = _SETTLED * max(1.0, problem.cost(residual, use, at) / use.sum())
        if expected < settled:
            break
        trial = np.clip(at + step, problem.low, problem.high)
        new = problem.look(trial)
        kept = use & new[3]
        gain = problem.cost(residual, kept, at) - problem.cost(new[0], kept, trial)
        if gain >= 0.0 and not problem.lost(use, new[3]):
            # A step that lowers the cost by much less than expected went past the least: the next one is shorter.
            damping *= 0.1 if gain > _POOR * expected else 10.0
            at, use, damping = trial, kept, max(damping, 1e-12)
            residual, jacobian, values = new[0], new[1], new[2]
        else:
            damping *= 10.0
            if damping > _MOST:
                break
    else:
        raise ComputationError(
            f"calibrate: no least sum of squares within {_ROUNDS} steps; fit fewer parameters with `fit`"
        )
    keep = use[:, None]
    local = np.zeros_like(residual)
    local[use] = problem.whitened(residual[:, None], use)[: int(use.sum()), 0]
    return LeastSquaresSolution(
        at, np.where(use, residual, 0.0), local, np.where(keep, jacobian, 0.0), values, use, bound, rounds
    )


def _step(
    problem: LeastSquaresProblem, at: Array, residual: Array, jacobian: Array, use: Flags, damping: float
) -> tuple[Array, Flags, float]:
    """Damped step, (k,), flags of the parameters held on a bound, and the expected decrease of the cost."""
    whole = problem.whitened(np.column_stack([residual, jacobian]), use)
    r, j = whole[:, 0], whole[:, 1:]
    slope = j.T @ r + problem.weight * (at - problem.centre)
    normal = j.T @ j + np.diag(problem.weight)
    size = np.diag(normal).copy()
    size[size <= 0] = 1.0
    bound = ((at <= problem.low) & (slope > 0)) | ((at >= problem.high) & (slope < 0))
    step = np.zeros_like(at)
    free = ~bound
    if free.any():
        root = np.sqrt(size[free])
        # In parameters scaled to unit information the damping is the same for all, and tiny directions stay tame.
        scaled = normal[np.ix_(free, free)] / np.outer(root, root) + damping * np.eye(root.size)
        step[free] = -np.linalg.solve(scaled, slope[free] / root) / root
    return step, bound, float(-(slope @ step))
