"""Further tests that would reduce the uncertainty most, predicted at the estimate before any measurement."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.calibrate.fit import CalibrationFit
from pneutouch.bench.calibrate.fitted_atlas import free_pressure, shared_of
from pneutouch.bench.calibrate.observations import ATLAS_FORCE, ATLAS_PRESSURE, READING, ObservationPoints
from pneutouch.bench.calibrate.parameters import DEAD, MODULUS, NAMES, WALL
from pneutouch.bench.indents import REPETITIONS, SHARE
from pneutouch.mechanics.atlas.coverage import other_shape
from pneutouch.mechanics.atlas.table import REST_VOLUME, shipped
from pneutouch.mechanics.membrane import limits
from pneutouch.mechanics.prediction import ModelResult
from pneutouch.mechanics.rating import RATED_SHARE
from pneutouch.mechanics.uncertainty.propagate import COUPON
from pneutouch.units import KPA
from pneutouch.wording import tenths_below

CALIPER = 0.05 / np.sqrt(3.0)
"""Standard deviation of a soft wall's thickness by caliper, mm: uniform within +-0.05 mm, our choice; the caliper
itself is better, but the soft wall yields."""

SYRINGE = 0.01
"""Relative error of an injected volume, the same for all volumes of a syringe: our choice, a gas-tight syringe."""

CAP = 10.0
"""Standard deviation of the air volume under a rigid cap, mm3: our choice, 2 mm of a 2.5 mm bore."""

_STEPS = 12
_RIDGE = 1e-8
_QUANTILE = 1.96


@dataclass(frozen=True, slots=True)
class SuggestedTest:
    """A test and its predicted effect.

    Attributes:
        what: The test in words.
        gain: Factor by which it shrinks the interval of the most uncertain combination.
        half_width: Half widths of the 95 % intervals expected after the test, in the fitted coordinates, (k,); NaN on a
            bound."""

    what: str
    gain: float
    half_width: Array


def further_tests(fit: CalibrationFit, rated: float) -> list[SuggestedTest]:
    """Candidate tests at no more than the rated pressure (MPa), most helpful first; none without free parameters.

    Parameters on a bound are not free: they are left as they are."""
    places = np.flatnonzero(~fit.solution.bound)
    if not places.size:
        return []
    numbers = np.array(fit.parameters.fitted)[places]
    prior_spread = fit.parameters.prior_spread[numbers]
    scale = np.outer(prior_spread, prior_spread)
    now = fit.covariance.information[np.ix_(places, places)] * scale
    now += (1.0 if fit.parameters.priors else _RIDGE) * np.eye(places.size)
    before = np.linalg.inv(now)
    worst = np.linalg.eigh(before)[1][:, -1]
    # The priors of parameters that are not fitted stay: the test concerns those that are.
    stays = (fit.covariance.considered**2).sum(axis=1)[places]
    tests = []
    for what, gained in _candidates(fit, rated):
        after = np.linalg.inv(now + gained[np.ix_(numbers, numbers)] * scale)
        width = np.full(fit.solution.at.size, np.nan)
        width[places] = _QUANTILE * np.sqrt(np.diag(after) * prior_spread**2 + stays)
        tests.append(SuggestedTest(what, float(np.sqrt((worst @ before @ worst) / (worst @ after @ worst))), width))
    return sorted(tests, key=lambda test: -test.gain)


def _candidates(fit: CalibrationFit, rated: float) -> Iterator[tuple[str, Array]]:
    """Tests with their information on all five parameters, (5, 5)."""
    full, size = fit.full, fit.sensor.dome.inner_radius
    # Pressed, the cavity stays within the gauge's range.
    highest = min(0.5 * fit.sensor.gas.gauge_limit, rated, _estimated(fit))
    measured = fit.points.driving
    depth = SHARE * size
    for share in (0.0, 0.5, 1.0):
        pressure_kPa = tenths_below(share * highest / KPA)
        pressure = pressure_kPa * KPA
        near = measured.size > 0 and float(np.abs(measured - pressure).min()) < 0.1 * highest
        deep = near and float(fit.points.travel[np.abs(measured - pressure).argmin()].max()) > 0.9 * depth
        if not deep:
            words = f"{REPETITIONS} indentations to {depth:.2g} mm at {pressure_kPa:.3g} kPa"
            yield words, _indented(fit, full, pressure, depth)
    volume = _volume(fit, full, highest)
    yield (
        f"air injected into the closed sensor up to {tenths_below(highest / KPA):.3g} kPa",
        _injected(fit, full, volume),
    )
    if full[DEAD] > 0:
        spread = np.hypot(full[DEAD] * np.hypot(READING / (0.5 * fit.sensor.gas.gauge_limit), SYRINGE), CAP)
        yield "air injected with a rigid cap in place of the dome (the dead volume alone)", _alone(DEAD, spread)
    yield "a tensile coupon of the same print (the modulus alone)", _alone(MODULUS, COUPON)
    yield "the wall measured with a caliper", _alone(WALL, CALIPER / float(np.exp(full[WALL])))


def _estimated(fit: CalibrationFit) -> float:
    """Pressure (MPa) that the estimated sensor is rated for: `RATED_SHARE` of its least limit."""
    full = fit.full
    built = fit.sensor.replace(shear_modulus=float(np.exp(full[MODULUS])), wall_thickness=float(np.exp(full[WALL])))
    found = _inflated(fit, full).limits if other_shape(fit.sensor) else limits(built)
    return RATED_SHARE * found.lowest


def _inflated(fit: CalibrationFit, full: Array) -> ModelResult:
    """Inflation of the estimated sensor by the solid."""
    from pneutouch.mechanics.models.solid import solid_result

    modulus, wall = np.exp(full[[MODULUS, WALL]]).tolist()
    built = fit.sensor.of_modulus(modulus).replace(wall_thickness=wall, dead_volume=float(full[DEAD]))
    return solid_result(built.replace(waves=0), np.zeros(0))


def _alone(number: int, spread: float) -> Array:
    matrix = np.zeros((len(NAMES), len(NAMES)))
    matrix[number, number] = spread**-2.0
    return matrix


def _evaluated(fit: CalibrationFit, full: Array, points: ObservationPoints) -> tuple[Array, Array]:
    """Values (N,) and derivatives (N, 5) at the estimate; both are 0 outside the model."""
    step = np.where(full + fit.parameters.step <= fit.parameters.high, fit.parameters.step, -fit.parameters.step)
    values, ok = fit.model_at(points).values(np.vstack([full, full + np.diag(step)]))
    known = np.asarray(ok.all(axis=0))
    derivatives = ((values[1:] - values[0]) / step[:, None]).T
    return np.where(known, values[0], 0.0), np.where(known[:, None], derivatives, 0.0)


def _planned(travel: Array, driving: Array, volume: Array) -> ObservationPoints:
    """Points of a planned test at travels (c, m), driving pressures (c,) and injected volumes (i, n)."""
    t, v, runs = np.ones_like(travel), np.ones_like(volume), np.zeros(len(travel))
    return ObservationPoints(
        travel=travel,
        force=t,
        rise=t,
        force_error=t,
        rise_error=t,
        there=t > 0,
        driving=driving,
        volume=volume,
        pressure=v,
        pressure_error=v,
        known=v > 0,
        travel_error=runs,
        group=runs.astype(int),
        onset_error=runs,
    )


def _indented(fit: CalibrationFit, full: Array, pressure: float, depth: float) -> Array:
    """Information, (5, 5), of `REPETITIONS` runs at one pressure (MPa), with the scatter of the measured runs."""
    row = np.linspace(0.0, depth, _STEPS + 1)[None, 1:]
    points = _planned(row, np.array([pressure]), np.zeros((0, 0)))
    values, derivatives = _evaluated(fit, full, points)
    half = row.size
    force = np.hypot(fit.observations.rig.force_resolution_N / np.sqrt(12.0), ATLAS_FORCE * np.abs(values[:half]).max())
    rise = np.hypot(READING, ATLAS_PRESSURE * np.abs(values[half:]).max())
    error = np.repeat([force, rise] * fit.channel_factor[:2], half)
    # Without data on the scatter between runs a run counts as one point: its points all move together.
    together = fit.run_factor if fit.points.there.any() and fit.covariance.clustered else float(half)
    return _information(fit, points, values, derivatives, np.diag(error**2 * together / REPETITIONS))


def _volume(fit: CalibrationFit, full: Array, pressure: float) -> float:
    """Volume to inject from ambient to reach a gauge pressure (MPa), mm3."""
    if other_shape(fit.sensor):
        curve, ambient = _inflated(fit, full).inflation, fit.sensor.gas.ambient_pressure
        rising = slice(0, int(curve.pressure.argmax()) + 1)
        grown = float(np.interp(pressure, curve.pressure[rising], curve.volume[rising]))
        dead = float(full[DEAD])
        return float((pressure + ambient) * (grown + dead) / ambient - curve.volume[0] - dead)
    size, mu = fit.sensor.dome.inner_radius, float(np.exp(full[MODULUS]))
    slices = shipped().slices(np.array([np.exp(full[WALL]) / size]), ())
    nodes = np.linspace(0.0, 1.0, 100)
    pressures, _ = free_pressure(slices, np.zeros(nodes.size, dtype=np.intp), nodes)
    nu = float(np.interp(pressure / mu, pressures, nodes))
    grown = nu * float(slices.reach(np.zeros(1, dtype=np.intp))[0]) * size**3
    volume, ambient = REST_VOLUME * size**3 + full[DEAD], fit.sensor.gas.ambient_pressure
    return float((pressure + ambient) * (volume + grown) / ambient - volume)


def _injected(fit: CalibrationFit, full: Array, volume: float) -> Array:
    """Information, (5, 5), of an injection in steps, with one relative error common to all its volumes (mm3)."""
    row = np.linspace(0.0, volume, _STEPS + 1)[None, 1:]
    points = _planned(np.zeros((0, 0)), np.zeros(0), row)
    values, derivatives = _evaluated(fit, full, points)
    by_volume = np.gradient(values, row[0]) * row[0] * SYRINGE
    error = np.hypot(READING, ATLAS_PRESSURE * np.abs(values).max()) * fit.channel_factor[2]
    noise = np.diag(np.full(row.size, error**2)) + np.outer(by_volume, by_volume)
    return _information(fit, points, values, derivatives, noise)


def _information(
    fit: CalibrationFit, points: ObservationPoints, values: Array, derivatives: Array, noise: Array
) -> Array:
    """Information, (5, 5), of values with error covariance ``noise``, (N, N), and the model discrepancy of the fit."""
    shared = shared_of(points.with_values(values)).sized(fit.sizes)
    return np.asarray(derivatives.T @ np.linalg.solve(noise + shared @ shared.T, derivatives))
