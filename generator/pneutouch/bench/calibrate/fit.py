"""Fit of a sensor's parameters to its measurements, with intervals, and the parameters the data do not determine."""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.bench.calibrate.fitted_atlas import (
    FLOOR,
    OTHER_SHAPES,
    AtlasModel,
    FittedContact,
    SharedUnknowns,
    model_of,
    shared_of,
    sizes_of,
)
from pneutouch.bench.calibrate.fitted_solid import SolidExpansion
from pneutouch.bench.calibrate.intervals import Covariance, covariance, factor, half_widths, information
from pneutouch.bench.calibrate.observations import ObservationPoints, Observations, points_of
from pneutouch.bench.calibrate.parameters import LOGARITHMIC, MODULUS, NAMES, OFFSET_PRIOR, CalibrationParameters
from pneutouch.bench.calibrate.solve import LeastSquaresProblem, LeastSquaresSolution, solve
from pneutouch.errors import InputError
from pneutouch.mechanics.atlas.coverage import other_shape
from pneutouch.mechanics.atlas.table import shipped
from pneutouch.mechanics.sensor import Sensor

_START_SHARE = 0.9
"""Greatest driving pressure over limit pressure at which the search may begin: our choice."""

_ROUNDS = 2
"""Repetitions of the fit with errors and discrepancy taken from the residuals: our choice, a third changes nothing."""

_CENTRED = 3
"""Greatest number of refits with the solid's correction of the atlas recomputed at the estimate: our choice."""

_NEAR = 0.02
"""Distance of contacts (`FittedContact.distance`) below which the correction is kept; it changes forces by < 0.005."""

_SMOOTH = 0.1
"""Model discrepancy, share of the reading, assumed while the scatter of points is estimated: our choice, generous."""


@dataclass(frozen=True, slots=True)
class CalibrationFit:
    """Result of a fit; coordinates as in `CalibrationParameters`.

    Attributes:
        observations, points, parameters, sensor: Inputs of the fit; the sensor as designed, at the ambient pressure of
            the runs.
        problem, solution: Least-squares problem, weighted with the scatter of the runs, and its solution.
        covariance: Uncertainty of the solution.
        half_width: Half-widths of the 95 % intervals, (k,); NaN for a parameter on a bound or without data and prior.
        chi_squared, freedom: Chi-squared of the residuals, whose covariance includes reading, atlas, first contact and
            model discrepancy, and its degrees of freedom.
        channel_factor: Ratios of the points' standard deviations to the stated ones: force, rise, injection; (3,).
        sizes: Model discrepancy, common to all runs, share of the reading: force, rise, injection; (3,).
        run_factor: Ratio of the variance between runs to that of independent points.
        contact: Input of the solid's correction of the atlas; None where the atlas covers the sensor without it."""

    observations: Observations
    points: ObservationPoints
    parameters: CalibrationParameters
    sensor: Sensor
    problem: LeastSquaresProblem
    solution: LeastSquaresSolution
    covariance: Covariance
    half_width: Array
    chi_squared: float
    freedom: int
    channel_factor: Array
    sizes: Array
    run_factor: float
    contact: FittedContact | None = None

    @property
    def full(self) -> Array:
        """All five coordinates, (5,)."""
        return self.parameters.full(self.solution.at)

    def model_at(self, points: ObservationPoints) -> AtlasModel | SolidExpansion:
        """The fitted model, evaluated at ``points`` in place of the points of the fit."""
        return model_of(self.sensor, points, self.contact)

    @property
    def left_out(self) -> Flags:
        """Flags of the curve points that the model does not reach, (c, m); see also `injections_left_out`."""
        size = self.points.there.size
        return self.points.there & ~self.solution.use[:size].reshape(self.points.there.shape)

    @property
    def injections_left_out(self) -> Flags:
        """Flags of the injected volumes that the model does not reach, (i, n)."""
        size = self.points.there.size
        return self.points.known & ~self.solution.use[2 * size :].reshape(self.points.known.shape)


def fit(
    observations: Observations, sensor: Sensor, parameters: CalibrationParameters, floor: Array = FLOOR
) -> CalibrationFit:
    """Fit ``parameters`` of ``sensor`` to observations.

    The first fit uses the stated errors of reading and atlas, later ones the errors that the residuals show, by
    channel, and the scatter between runs; so the priors get the weight that the data leave them. The model discrepancy
    is estimated from the residuals and is at least ``floor``, (3,) shares of the reading (`sizes_of`). Where the solid
    corrects the atlas (`FittedContact`), the fit is repeated with the correction at the estimate. Raises InputError for
    too few points or a sensor that the atlas does not cover, ComputationError where no fit is found."""
    sensor = sensor.replace(ambient_pressure=observations.ambient)
    points, count = points_of(observations), len(parameters.fitted)
    if other_shape(sensor):
        stated = np.array([curve.onset_error for curve in observations.curves])
        points = points._replace(onset_error=np.where(np.isfinite(stated), stated, OFFSET_PRIOR))
        floor = OTHER_SHAPES * floor
    if not parameters.priors and int(points.use.sum()) <= count:
        raise InputError(
            f"calibrate: {int(points.use.sum())} values for {count} parameters without priors; there must be more "
            "values, or fewer parameters with `fit`"
        )
    at = _start(sensor, points, parameters)
    contact = FittedContact.of(sensor, parameters, parameters.full(at))
    # The ratio is centred by rough fits first: where it is off, the residuals show its error and not the runs'.
    for _ in range(_CENTRED):
        at = _roughly(model_of(sensor, points, contact), parameters, at, floor).at
        if not _moved(contact, nearer := FittedContact.of(sensor, parameters, parameters.full(at))):
            break
        contact = nearer
    fitted = _fit(observations, points, sensor, parameters, floor, contact, at)
    for _ in range(_CENTRED):
        if not _moved(contact, nearer := FittedContact.of(sensor, parameters, fitted.full)):
            break
        contact = nearer
        fitted = _fit(observations, points, sensor, parameters, floor, contact, fitted.solution.at)
    return fitted


def _moved(contact: FittedContact | None, nearer: FittedContact | None) -> bool:
    """True if the solid's correction at the estimate, ``nearer``, must replace the present one, ``contact``."""
    return contact is not None and nearer is not None and contact.distance(nearer) >= _NEAR


def _roughly(
    model: AtlasModel | SolidExpansion, parameters: CalibrationParameters, at: Array, floor: Array
) -> LeastSquaresSolution:
    """A first fit with errors that are shares of full scale, and without shared unknowns."""
    points = model.points
    errors = np.hypot(points.errors, points.full_scale * floor[points.channels])
    return solve(LeastSquaresProblem(model, parameters, errors, np.zeros((errors.size, 0))), at)


def _fit(
    observations: Observations,
    points: ObservationPoints,
    sensor: Sensor,
    parameters: CalibrationParameters,
    floor: Array,
    contact: FittedContact | None,
    start: Array,
) -> CalibrationFit:
    """`fit` with the solid's correction for ``contact`` (None: no correction), from the coordinates ``start``, (k,)."""
    model = model_of(sensor, points, contact)
    solution = _roughly(model, parameters, start, floor)
    for _ in range(_ROUNDS):
        # A share of the readings would pull the fit below them (Peelle's puzzle); one of the fitted values does not.
        shared = shared_of(points.with_values(np.where(solution.use, solution.model, points.values)))
        channels = _channel_factors(
            LeastSquaresProblem(model, parameters, points.errors, shared.sized(np.full(3, _SMOOTH))), solution
        )
        errors = points.errors * channels[points.channels]
        sizes = _sizes(LeastSquaresProblem(model, parameters, errors, shared.columns), solution, shared, floor)
        seen = LeastSquaresProblem(model, parameters, errors, shared.sized(sizes))
        solution = solve(seen, solution.at)
    runs = factor(seen, solution)
    last = LeastSquaresProblem(model, parameters, errors * np.sqrt(runs), shared.sized(sizes))
    solution = solve(last, solution.at)
    spread = covariance(last, solution, runs, _others(last, solution) * parameters.prior_spread)
    read = LeastSquaresProblem(model, parameters, points.errors, shared.sized(sizes))
    stated = read.whitened((solution.residual * last.errors / points.errors)[:, None], solution.use)
    squares, freedom = float((stated**2).sum()), max(int(solution.use.sum()) - len(parameters.fitted), 0)
    fitting = observations, points, parameters, sensor, last, solution, spread, half_widths(spread)
    return CalibrationFit(*fitting, squares, freedom, channels, sizes, run_factor=runs, contact=contact)


def _others(problem: LeastSquaresProblem, solution: LeastSquaresSolution) -> Array:
    """Derivatives of the values over their errors, (N, 5), by parameters with a prior that are not fitted; else 0."""
    slopes = np.zeros((solution.residual.size, len(NAMES)))
    others = list(problem.chosen.others)
    if others:
        full, step = problem.chosen.full(solution.at), problem.chosen.step
        step = np.where(full + step <= problem.chosen.high, step, -step)
        values, ok = problem.model.values(np.vstack([full, full + np.diag(step)[others]]))
        use = solution.use & ok.all(axis=0)
        change = (values[1:] - values[0]) / step[others, None] / problem.errors
        slopes[:, others] = np.where(use, change, 0.0).T
    return slopes


def _sizes(problem: LeastSquaresProblem, solution: LeastSquaresSolution, shared: SharedUnknowns, floor: Array) -> Array:
    """Sizes of the model discrepancy, (3,), from the residuals that no parameter, fitted or with a prior, explains."""
    others, use = list(problem.chosen.others), solution.use
    residual, jacobian, _, _ = problem.look(solution.at)
    whole = np.hstack([jacobian, _others(problem, solution)[:, others]])
    prior_weight = np.concatenate([problem.weight, problem.chosen.prior_spread[others] ** -2.0])
    # At the solution the priors pull the fitted ones: their rows are part of the data.
    pull = np.concatenate([np.sqrt(problem.weight) * (solution.at - problem.centre), np.zeros(len(others))])
    return sizes_of(
        SharedUnknowns(problem.shared[use], shared.kind), whole[use], residual[use], prior_weight, pull, floor
    )


def _start(sensor: Sensor, points: ObservationPoints, parameters: CalibrationParameters) -> Array:
    """Start values, (k,): the design's; the modulus raised if the dome would burst at a pressure that was measured."""
    start = parameters.start[list(parameters.fitted)].copy()
    if MODULUS in parameters.fitted and points.driving.size:
        least = points.driving.max() / _START_SHARE / _limit(sensor)
        where = parameters.fitted.index(MODULUS)
        start[where] = max(start[where], np.log(max(least, 1e-9)))
    return start


def _limit(sensor: Sensor) -> float:
    """Pressure of the limit point over the shear modulus; inf for a dome that has none."""
    if other_shape(sensor):
        from pneutouch.mechanics.models.solid import solid_result

        found = solid_result(sensor.replace(waves=0), np.zeros(0)).limits.limit_point
        return np.inf if found is None else found / sensor.wall.shear_modulus
    slices = shipped().slices(np.array([sensor.dome.wall_thickness / sensor.dome.inner_radius]), ())
    return float(slices.limit_pressure[0])


def _channel_factors(problem: LeastSquaresProblem, solution: LeastSquaresSolution) -> Array:
    """Root mean square of each channel's residuals without what shared unknowns explain, (3,), at least 1."""
    factors, use = np.ones(3), solution.use
    residual, shared = problem.look(solution.at)[0], problem.shared[use]
    explained = shared.T @ shared
    best = np.linalg.solve(np.eye(len(explained)) + explained, np.column_stack([explained, shared.T @ residual[use]]))
    rest, total = residual[use] - shared @ best[:, -1], int(use.sum())
    spare = max(total - float(np.trace(best[:, :-1])), 0.1 * total) / total
    for channel in range(3):
        rows = problem.model.points.channels[use] == channel
        if rows.any():
            factors[channel] = max(1.0, float(np.sqrt(np.mean(rest[rows] ** 2) / spare)))
    return factors


CORRELATED = 0.95
"""Correlation above which two parameters count as strongly correlated: our choice; the standard deviation of each is
then 3 times that with the other known."""

UNSEEN = 0.7
"""Posterior over prior standard deviation above which a parameter counts as not determined by the data: our choice; the
data then weigh no more than the prior."""

_LEAST = 1e-12
_NEEDED = 0.5
"""Standard deviation by the data alone, over that of the prior, above which more than two parameters count as strongly
correlated: our choice."""
_MEMBER = 0.3
_NAMED = 0.25
"""Least weight of a parameter in a correlated group, and of one in a named combination."""


@dataclass(frozen=True, slots=True)
class CorrelatedParameters:
    """Strongly correlated parameters, m of them.

    Attributes:
        members: Their indices in `NAMES`.
        correlation: Greatest correlation among them, in the data alone, with its sign.
        alone: Standard deviations, (m,), by the data's scatter alone, if the model were true: relative for modulus and
            wall, mm3 for the dead volume, mm for the offset.
        given: The same if the other members were known, (m,).
        combination: Exponent a of the best-determined product modulus x wall^a if these two are the members; None for
            other members or where the wall hardly contributes."""

    members: tuple[int, ...]
    correlation: float
    alone: Array
    given: Array
    combination: float | None


@dataclass(frozen=True, slots=True)
class Identifiability:
    """Parameters that the data do not determine."""

    unseen: tuple[int, ...]
    ambiguities: tuple[CorrelatedParameters, ...]

    @property
    def clear(self) -> bool:
        """True if the data determine every parameter."""
        return not self.unseen and not self.ambiguities


def identify(fit: CalibrationFit) -> Identifiability:
    """Parameters that the data of a fit leave open, from the small eigenvalues of their information in unit scale."""
    fitted = np.array(fit.parameters.fitted)
    seen = np.abs(fit.solution.jacobian).max(axis=0) > 0
    places = np.flatnonzero(seen)
    numbers, known = fitted[places], fit.covariance.information[np.ix_(places, places)]
    # Correlations follow from the model's curves alone; standard deviations from all that is uncertain.
    curves = information(fit.solution.jacobian[:, places])
    groups = _groups(curves, known, numbers, fit.parameters.prior_spread[numbers]) if places.size > 1 else []
    grouped = {k for group in groups for k in group.members}
    unseen = [
        int(k)
        for place, k in enumerate(fitted)
        if k not in grouped and not fit.solution.bound[place] and _left(fit, place, bool(seen[place])) > UNSEEN
    ]
    return Identifiability(tuple(unseen), tuple(groups))


def _left(fit: CalibrationFit, place: int, seen: bool) -> float:
    """Standard deviation of a parameter by prior and data, over that of the prior alone."""
    if not seen:
        return 1.0
    prior_spread = fit.parameters.prior_spread[list(fit.parameters.fitted)]
    whole = fit.covariance.information * np.outer(prior_spread, prior_spread) + np.eye(prior_spread.size)
    return float(np.sqrt(np.linalg.inv(whole)[place, place]))


def _groups(curves: Array, known: Array, numbers: Array, prior_spread: Array) -> list[CorrelatedParameters]:
    """Correlated parameters: those along eigenvectors of the curves' information (n, n) with small eigenvalues.

    ``known``, (n, n), is the information that accounts for errors shared by many values; ``numbers``, (n,), are indices
    in `NAMES`."""
    scale = np.sqrt(np.diag(curves))
    values, vectors = np.linalg.eigh(curves / np.outer(scale, scale))
    covariance = (vectors / np.maximum(values, _LEAST)) @ vectors.T / np.outer(scale, scale)
    spread = np.sqrt(np.diag(covariance))
    correlation = covariance / np.outer(spread, spread) - np.eye(numbers.size)
    sets = [np.flatnonzero(np.abs(v) > _MEMBER) for v in vectors[:, values < 1.0 - CORRELATED].T]
    # Three or four parameters are always correlated; it matters where a prior is still needed.
    alone = _spreads(known)
    sets = [places for places in sets if (alone / prior_spread)[places].max() > _NEEDED]
    sets += [np.array(pair) for pair in np.argwhere(np.triu(np.abs(correlation) > CORRELATED))]
    groups: list[CorrelatedParameters] = []
    for places in sorted(sets, key=len, reverse=True):
        members = {int(numbers[p]) for p in places}
        if len(members) < 2 or any(members <= set(group.members) for group in groups):
            continue
        inner = correlation[np.ix_(places, places)]
        strongest = float(inner.ravel()[np.abs(inner).argmax()])
        numbered = tuple(int(numbers[p]) for p in places)
        product = _product(covariance[np.ix_(places, places)], numbers[places])
        groups.append(CorrelatedParameters(numbered, strongest, spread[places], 1.0 / scale[places], product))
    return groups


def _spreads(known: Array) -> Array:
    """Standard deviations (n,) from an information matrix (n, n)."""
    scale = np.sqrt(np.diag(known))
    values, vectors = np.linalg.eigh(known / np.outer(scale, scale))
    return np.asarray(np.sqrt(((vectors**2) / np.maximum(values, _LEAST)).sum(axis=1)) / scale)


def _product(covariance: Array, numbers: Array) -> float | None:
    """Exponent a of the best-determined product modulus x wall^a, of a pair of these; else None."""
    if numbers.size != 2 or not LOGARITHMIC[numbers].all():
        return None
    # Along the ridge d ln mu = -a d ln t0; the ridge is the direction of the greatest variance.
    ridge = np.linalg.eigh(covariance)[1][:, -1]
    return float(-ridge[0] / ridge[1]) if abs(ridge[1]) > _NAMED else None
