"""Notes on a calibration: data left out, undetermined parameters, further tests, deviations, held-out pressures."""

from collections.abc import Sequence

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.calibrate.fit import UNSEEN, CalibrationFit, CorrelatedParameters, Identifiability, fit
from pneutouch.bench.calibrate.goodness import ASSUMED_SCATTER, response_gap
from pneutouch.bench.calibrate.intervals import LEAST_RUNS
from pneutouch.bench.calibrate.observations import Observations, clipped, points_of
from pneutouch.bench.calibrate.other_states import SuggestedTest
from pneutouch.bench.calibrate.parameters import DEAD, FRICTION, LOGARITHMIC, USUAL, CalibrationParameters
from pneutouch.errors import InputError
from pneutouch.mechanics.response import lines
from pneutouch.mechanics.sensor import Sensor
from pneutouch.results.calibration import HeldOutRecord, MissRecord
from pneutouch.units import KPA, ML
from pneutouch.wording import counted, enumerated, listed

GAIN = 0.01


def gain_shifts(fit: CalibrationFit) -> tuple[Array, Array]:
    """Shifts of the estimates, two arrays (k,) in coordinates, if the force or the pressure were read 1 % too high; 0
    for a parameter on a bound.

    A pressure read too high includes the driving pressure.
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
    """Step of the estimates, (k,), for a change ``residual`` of the residuals, (N,) in N and MPa."""
    free = np.flatnonzero(~fit.solution.bound)
    change = np.where(fit.solution.use, residual / fit.problem.errors, 0.0)
    whole = fit.problem.whitened(np.column_stack([change, fit.solution.jacobian[:, free]]), fit.solution.use)
    jacobian = whole[:, 1:]
    normal = jacobian.T @ jacobian + np.diag(fit.problem.weight[free])
    scale = np.sqrt(np.maximum(np.diag(normal), 1e-30))
    normal += 1e-12 * np.diag(scale**2)
    shift = np.zeros(fit.solution.at.size)
    # The estimates follow readings that are too high: what is found is minus the correction.
    shift[free] = np.linalg.solve(normal, jacobian.T @ whole[:, 0])
    return shift


def predict_held_out(
    observations: Observations, sensor: Sensor, parameters: CalibrationParameters, driving_pressure_kPa: float
) -> HeldOutRecord:
    """Fit without the runs at a driving pressure (kPa), and predict these by that fit and its correction.

    Raises InputError for a pressure that was not measured, where nothing is left to fit, and where the model reaches
    fewer than two points of a run."""
    known_kPa = observations.driving_pressures_kPa
    if driving_pressure_kPa not in known_kPa:
        measured = ", ".join(f"{p:g}" for p in known_kPa) or "none"
        problem = f"no run at this driving pressure; measured: {measured} kPa"
        raise InputError(problem, key="hold_out_kPa", value=driving_pressure_kPa)
    rest = observations.without(driving_pressure_kPa)
    if not rest.curves and not rest.injections:
        problem, remedy = "all runs are at this driving pressure", "there must be runs at another to fit"
        raise InputError(problem, key="hold_out_kPa", value=driving_pressure_kPa, remedy=remedy)
    fitted = fit(rest, sensor, parameters)
    points = points_of(observations.only(driving_pressure_kPa))
    values, ok = fitted.model_at(points).values(fitted.full[None])
    shape = points.there.shape
    use = ok[0][: points.there.size].reshape(shape) & points.there
    if (use.sum(axis=1) < 2).any():
        problem = (
            "the model fitted to the rest has fewer than two points of a run at this pressure (beyond its limit "
            "point or buckled)"
        )
        raise InputError(problem, key="hold_out_kPa", value=driving_pressure_kPa, remedy="hold out another")
    gap = response_gap(fitted)
    # Every run of a held-out pressure has that pressure; its reading differs by a reset's scatter.
    factors = (1.0, 1.0) if gap is None else gap.correction.at(driving_pressure_kPa * KPA)
    parts = values[0][: use.size], values[0][use.size : 2 * use.size]
    force, rise = (factor * part.reshape(shape) for factor, part in zip(factors, parts, strict=True))
    columns = points.travel, points.force, points.rise, force, rise, use
    rows = [_row(*row) for row in zip(*columns, strict=True)]
    measured_kPa_per_N, predicted_kPa_per_N, *errors = (float(x) for x in np.mean(rows, axis=0)[:4])
    errors += [float(x) for x in np.max(rows, axis=0)[4:]]
    force_rms, pressure_rms, force_greatest, pressure_greatest = errors
    return HeldOutRecord(
        driving_pressure_kPa=driving_pressure_kPa,
        sensitivity_measured_kPa_per_N=measured_kPa_per_N,
        sensitivity_predicted_kPa_per_N=predicted_kPa_per_N,
        sensitivity_error=predicted_kPa_per_N / measured_kPa_per_N - 1.0,
        force_rms_share=force_rms,
        force_greatest_share=force_greatest,
        pressure_rms_share=pressure_rms,
        pressure_greatest_share=pressure_greatest,
        points=int(use.sum()),
        points_left_out=int((points.there & ~use).sum()),
    )


def _row(travel: Array, force: Array, rise: Array, model_force: Array, model_rise: Array, use: Array) -> list[float]:
    """Sensitivity measured and predicted; errors over full scale: rms of force, of rise, greatest of both in turn."""
    x, f, r, mf, mr = (np.concatenate([[0.0], part[use]]) for part in (travel, force, rise, model_force, model_rise))
    measured_kPa_per_N, predicted_kPa_per_N = (float(lines(x, a, b / KPA).sensitivity) for a, b in ((f, r), (mf, mr)))
    df, dr = (mf - f)[1:] / np.abs(f).max(), (mr - r)[1:] / np.abs(r).max()
    rms = [float(np.sqrt(np.mean(part**2))) for part in (df, dr)]
    return [measured_kPa_per_N, predicted_kPa_per_N, *rms, float(np.abs(df).max()), float(np.abs(dr).max())]


CHANNELS = ("force", "pressure rise", "injection's pressure")
WORDS = ("shear modulus", "wall thickness", "dead volume", "contact offset", "friction")
_WORTH = 1.2
"""Least factor by which a listed test shrinks the widest interval: our choice."""
_FAR = 2.0
"""Distance from the design, in prior standard deviations, that is noted: our choice, one in twenty by chance."""
_MANY = 100.0
_MOVED = 0.2
"""Share of an interval's half width below which the effect of a gain error is not listed: our choice."""


def amount(k: int, deviation: float) -> str:
    """Text of a deviation of parameter k in its coordinate: in %, as a factor, in mL, in mm, or as a number."""
    if LOGARITHMIC[k]:
        return (
            f"{100 * np.expm1(deviation):.2g} %" if deviation < np.log(2.0) else f"a factor of {np.exp(deviation):.2g}"
        )
    if k == FRICTION:
        return f"{deviation:.2g}"
    return f"{deviation / ML:.2g} mL" if k == DEAD else f"{deviation:.2g} mm"


def fit_notes(
    fit: CalibrationFit,
    identified: Identifiability,
    further: Sequence[SuggestedTest],
    missed: Sequence[MissRecord],
    held_out: Sequence[HeldOutRecord],
) -> list[str]:
    """Notes on a fit in words, at most one for each kind of remark."""
    estimates = _left_out(fit), _bounds(fit), _far(fit), _counted(fit) + _basis(fit)
    tests = _open(fit, identified), _tests(fit, identified, further)
    kinds = *estimates, *tests, _fitness(fit, missed), [_held(one) for one in held_out]
    return ["; ".join(kind) for kind in kinds if kind]


def _counted(fit: CalibrationFit) -> list[str]:
    """Clauses on the sources of uncertainty that the intervals include beside the scatter, and on those left out."""
    used = np.unique(fit.points.channels[fit.solution.use])
    sizes = ", ".join(f"{(fit.sizes[c]):.1%} of the {CHANNELS[c]}" for c in used)
    parts = [f"the intervals include the model discrepancy ({sizes})"]
    others = enumerated([WORDS[k] for k in fit.parameters.others]) if fit.parameters.others else ""
    if others:
        parts.append(f"and the priors of {others}, not fitted")
    elif not fit.parameters.priors and len(fit.parameters.fitted) < len(USUAL):
        parts.append("without priors only the fitted parameters are uncertain: the others are taken as designed")
    moved = _shared(fit)
    return [*parts, *([f"but no gain error that all runs share: {'; '.join(moved)}"] if moved else [])]


def _points(count: int) -> str:
    return f"{counted(count, 'point')} {'is' if count == 1 else 'are'}"


def _left_out(fit: CalibrationFit) -> list[str]:
    notes = []
    over = [(curve.run.label, int(clipped(curve, fit.observations.rig).sum())) for curve in fit.observations.curves]
    if any(count for _, count in over):
        notes.append(
            f"{_points(sum(count for _, count in over))} left out: at the end of the force sensor's range "
            f"({listed([label for label, count in over if count], 3)})"
        )
    for curve, lost, travel in zip(fit.observations.curves, fit.left_out, fit.points.travel, strict=True):
        if lost.any():
            notes.append(
                f"{curve.run.label}: {_points(int(lost.sum()))} left out from {travel[lost].min():.2f} mm on: the "
                "model's range ends before them (buckling, the plate's edge, the ring around the flange, or a depth "
                "beyond the atlas)"
            )
    other = fit.contact is not None and fit.contact.other_wall
    dome = "neo-Hookean dome of one modulus that stands for this one" if other else "dome"
    for injection, lost in zip(fit.observations.injections, fit.injections_left_out, strict=True):
        if lost.any():
            notes.append(
                f"{injection.label}: {_points(int(lost.sum()))} left out: beyond the limit point of the {dome}"
            )
    return notes


def _bounds(fit: CalibrationFit) -> list[str]:
    return [
        f"{WORDS[k]}: the estimate is on its bound, no interval: the optimum of the data is beyond it"
        for k, bound in zip(fit.parameters.fitted, fit.solution.bound, strict=True)
        if bound
    ]


def _far(fit: CalibrationFit) -> list[str]:
    """Notes on estimates far from the design's value; none for a fit without priors."""
    notes = []
    for place, k in enumerate(fit.parameters.fitted):
        away = abs(fit.solution.at[place] - fit.parameters.start[k]) / fit.parameters.prior_spread[k]
        if away > _FAR and fit.parameters.priors:
            notes.append(
                f"{WORDS[k]}: the estimate is {away:.1f} prior standard deviations from the design's value; where the "
                "design is not what was built, correct it or fit without priors"
            )
    return notes


def _basis(fit: CalibrationFit) -> list[str]:
    notes = []
    if not fit.covariance.clustered:
        runs = fit.covariance.runs
        why = f"{runs} run{'s'[: runs != 1]}, fewer than {LEAST_RUNS}" if runs < LEAST_RUNS else "no pressure twice"
        notes.append(
            f"they rest on the scatter of the points and the instruments alone ({why}): the differences between runs "
            "are not in them; measure more runs"
        )
    gap = response_gap(fit)
    if gap is not None and not gap.freedom:
        notes.append(
            f"no run was repeated: {ASSUMED_SCATTER:.1%} between runs is assumed in the corrected force and "
            "sensitivity, as in the paper's Table S1"
        )
    labels = [curve.run.label for curve in fit.observations.curves]
    labels += [injection.label for injection in fit.observations.injections]
    for run in sorted({int(run) for run in fit.covariance.alone if run >= 0 and fit.covariance.clustered}):
        words = enumerated(
            [WORDS[k] for k, one in zip(fit.parameters.fitted, fit.covariance.alone, strict=True) if one == run]
        )
        notes.append(f"{words} rest on one run ({labels[run]}), taken to scatter as the others do; repeat it")
    return notes


def _open(fit: CalibrationFit, identified: Identifiability) -> list[str]:
    notes = [_apart(group) for group in identified.ambiguities]
    for k in identified.unseen:
        what = "the estimate is the prior" if fit.parameters.priors else "the estimate means nothing"
        notes.append(
            f"{WORDS[k]}: the data do not determine it (more than {UNSEEN:.0%} of its prior standard deviation "
            f"remains); {what}"
        )
    return notes


def _apart(group: CorrelatedParameters) -> str:
    names = enumerated([WORDS[k] for k in group.members])
    power = group.combination or 0.0
    product = f"; the data determine modulus × wall^{power:.2f}" if power > 0 else ""
    wider = float(np.max(group.alone / group.given))
    return (
        f"{names}: strongly correlated parameters (by the data alone {group.correlation:+.3f}, intervals "
        f"{_times(wider)} as wide as with the other{'s'[: len(group.members) > 2]} known){product}"
    )


def _tests(fit: CalibrationFit, identified: Identifiability, further: Sequence[SuggestedTest]) -> list[str]:
    if identified.clear:
        return []
    helpful = [test for test in further if test.gain > _WORTH][:2]
    return [
        f"{'to separate them, measure' if place == 0 else 'or'}: {test.what} (the widest interval would shrink "
        f"{_times(test.gain)})"
        for place, test in enumerate(helpful)
    ]


def _times(gain: float) -> str:
    return f"{gain:.1f} times" if gain < _MANY else f"more than {_MANY:g} times"


def _fitness(fit: CalibrationFit, missed: Sequence[MissRecord]) -> list[str]:
    """Note on the model's deviations that all runs share: the greatest at each driving pressure."""
    parts = []
    for pressure_kPa in sorted({miss.driving_pressure_kPa for miss in missed}):
        miss = max((m for m in missed if m.driving_pressure_kPa == pressure_kPa), key=lambda m: abs(m.share))
        parts.append(
            f"{pressure_kPa:g} kPa: {miss.channel} {abs(miss.share):.1%} of full scale too "
            f"{'high' if miss.share > 0 else 'low'} from {miss.from_mm:.2f} to {miss.to_mm:.2f} mm"
        )
    return [f"the model deviates in all runs alike, {'; '.join(parts)}"] if parts else []


def _shared(fit: CalibrationFit) -> list[str]:
    parts = []
    for what, shift in zip(("force", "pressure"), gain_shifts(fit), strict=True):
        moved = ", ".join(
            f"{WORDS[k]} {'+' if d >= 0 else '-'}{amount(k, abs(d))}"
            for k, d in zip(fit.parameters.fitted, shift, strict=True)
            if abs(d) > _MOVED * fit.half_width[fit.parameters.fitted.index(k)]
        )
        if moved:
            parts.append(f"a {what} reading 1 % too high in all runs moves {moved}")
    return parts


def _held(one: HeldOutRecord) -> str:
    return (
        f"held out {one.driving_pressure_kPa:g} kPa: sensitivity {one.sensitivity_predicted_kPa_per_N:.4g} kPa/N "
        f"predicted, {one.sensitivity_measured_kPa_per_N:.4g} measured ({one.sensitivity_error:+.1%}); force within "
        f"{one.force_greatest_share:.1%} and pressure within {one.pressure_greatest_share:.1%} of full scale"
    )
