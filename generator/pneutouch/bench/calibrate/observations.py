"""Data of a calibration: indentation curves and injections of one sensor, as arrays of one shape."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.bench.indents import EARLY
from pneutouch.bench.record import MeasuredCurve
from pneutouch.errors import InputError
from pneutouch.spec.campaign import Rig
from pneutouch.units import KPA, STANDARD_ATMOSPHERE

ATLAS_FORCE, ATLAS_PRESSURE = 0.0011, 0.0004
"""Error of the atlas over full scale: medians of 500 presses at their worst state (docs/background/atlas.md)."""

READING = 0.05 * KPA
"""Least standard deviation of a pressure point, MPa: our choice, half of the 0.1 kPa that such gauges show; the paper
gives only the resolution of its force sensor."""

_RANGE = 0.99
"""Share of the force sensor's range at which a reading counts as clipped: our choice, as the zero is subtracted."""

_AVERAGED = 100
"""Greatest number of samples over which noise is assumed to average out: our choice, as noise is not white."""


@dataclass(frozen=True, slots=True)
class Injection:
    """Air pushed into the closed sensor from ambient pressure: injected volume (mm3, at ambient pressure) and gauge
    pressure (MPa), (n,) each; ``noise`` is the standard deviation of a pressure point, MPa."""

    label: str
    volume: Array
    pressure: Array
    noise: float = READING


@dataclass(frozen=True, slots=True)
class Observations:
    """Curves and injections of one sensor, the ambient pressure (MPa) they were measured in, and the rig."""

    curves: tuple[MeasuredCurve, ...]
    injections: tuple[Injection, ...] = ()
    ambient: float = STANDARD_ATMOSPHERE
    rig: Rig = field(default_factory=Rig)

    @property
    def driving_pressures_kPa(self) -> tuple[float, ...]:
        """Driving pressures of the curves as the campaign names them, kPa, ascending, each once."""
        return tuple(sorted({curve.run.driving_pressure_kPa for curve in self.curves}))

    def without(self, driving_pressure_kPa: float) -> "Observations":
        """These observations without the curves of a driving pressure, kPa."""
        kept = tuple(curve for curve in self.curves if curve.run.driving_pressure_kPa != driving_pressure_kPa)
        return replace(self, curves=kept)

    def only(self, driving_pressure_kPa: float) -> "Observations":
        """Only the curves at a driving pressure, kPa, without the injections."""
        kept = tuple(curve for curve in self.curves if curve.run.driving_pressure_kPa == driving_pressure_kPa)
        return replace(self, curves=kept, injections=())


class ObservationPoints(NamedTuple):
    """Observations as arrays: c curves of at most m points and i injections of at most n points.

    Shorter rows are filled up with their last point; ``there`` and ``known`` are True for real points.
    Curves, (c, m): travel (mm), force (N), pressure rise (MPa), standard errors of force (N) and rise (MPa), there.
    Driving pressure of each curve, (c,), MPa. Injections, (i, n): volume (mm3), pressure and its standard error (MPa),
    known. travel_error, (c,): standard error of the run's first contact, mm. group, (c,): index of its driving
    pressure. onset_error, (c,): standard error of the first contact that all runs at that pressure share, mm; 0: none.
    """

    travel: Array
    force: Array
    rise: Array
    force_error: Array
    rise_error: Array
    there: Flags
    driving: Array
    volume: Array
    pressure: Array
    pressure_error: Array
    known: Flags
    travel_error: Array
    group: Array
    onset_error: Array

    @property
    def force_slope(self) -> Array:
        """Derivative of the force by travel, N/mm, (c, m)."""
        return _slopes(self.travel, self.force)

    @property
    def rise_slope(self) -> Array:
        """Derivative of the rise by travel, MPa/mm, (c, m)."""
        return _slopes(self.travel, self.rise)

    @property
    def values(self) -> Array:
        """All measured values in one flat array: forces (N), pressure rises (MPa), then injection pressures (MPa)."""
        return np.concatenate([self.force.ravel(), self.rise.ravel(), self.pressure.ravel()])

    @property
    def errors(self) -> Array:
        """Standard deviations of `values`, (N,)."""
        return np.concatenate([self.force_error.ravel(), self.rise_error.ravel(), self.pressure_error.ravel()])

    @property
    def full_scale(self) -> Array:
        """Full scale of each value, (N,): greatest magnitude in its run and channel."""
        parts = self.force, self.rise, self.pressure
        return np.concatenate(
            [np.broadcast_to(np.abs(part).max(axis=1, initial=0.0)[:, None], part.shape).ravel() for part in parts]
        )

    def with_values(self, values: Array) -> "ObservationPoints":
        """These points with other measured values, (N,), in the order of `values`."""
        force, rise, pressure = np.split(values, [self.force.size, 2 * self.force.size])
        return self._replace(
            force=force.reshape(self.force.shape),
            rise=rise.reshape(self.rise.shape),
            pressure=pressure.reshape(self.pressure.shape),
        )

    @property
    def use(self) -> Flags:
        """Flags of real values, not padding, (N,)."""
        return np.concatenate([self.there.ravel(), self.there.ravel(), self.known.ravel()])

    @property
    def clusters(self) -> Array:
        """Number of the curve or injection behind each value, (N,): values that one run's gain and zero move."""
        (c, m), (i, n) = self.travel.shape, self.volume.shape
        curve = np.repeat(np.arange(c), m)
        return np.concatenate([curve, curve, c + np.repeat(np.arange(i), n)])

    @property
    def channels(self) -> Array:
        """Channel of each value, (N,): 0 force, 1 rise, 2 injection."""
        sizes = self.force.size, self.rise.size, self.pressure.size
        return np.repeat(np.arange(3), sizes)


def points_of(observations: Observations) -> ObservationPoints:
    """Arrays of observations. Raises InputError for no or one point in all, a run without a point, or NaN."""
    if not observations.curves and not observations.injections:
        raise InputError(
            "calibrate: no curves and no injections; there must be at least one run of kind steps or injection"
        )
    curves = [_curve(curve, observations.rig) for curve in observations.curves]
    *curve_columns, there = _padded(curves, 5)
    injections = [_injection(injection) for injection in observations.injections]
    *injected, known = _padded(injections, 3)
    # What a gauge reads a little below zero before contact is zero: the dome is not sucked in.
    driving = np.array([max(curve.driving, 0.0) for curve in observations.curves])
    pressures_kPa = observations.driving_pressures_kPa
    group = np.array([pressures_kPa.index(curve.run.driving_pressure_kPa) for curve in observations.curves])
    there, known, errors = there.astype(bool), known.astype(bool), _travel_errors(observations.curves)
    columns = (*curve_columns, there, driving, *injected, known, errors, group, np.zeros(group.size))
    points = ObservationPoints._make(columns)
    if points.there.sum() + points.known.sum() < 2:
        raise InputError("calibrate: one point is not enough; there must be at least two without the origin")
    return points


def _curve(curve: MeasuredCurve, rig: Rig) -> tuple[Array, ...]:
    """Travel, force, rise, and errors of force and rise; without the origin, which defines zero and is not measured."""
    loaded = (curve.indentation > 0) & ~clipped(curve, rig)
    x, force, rise = curve.indentation[loaded], curve.force[loaded], curve.rise[loaded]
    if not x.size:
        raise InputError(f"calibrate: {curve.run.file}: no point beyond first contact; there must be at least one")
    for name, values in (("indentation", x), ("force", force), ("pressure rise", rise)):
        if not np.isfinite(values).all():
            raise InputError(f"calibrate: {curve.run.file}: {name}: not a number among the points; must be finite")
    order = np.unique(x, return_index=True)[1]
    x, force, rise = x[order], force[order], rise[order]
    samples = np.mean([(i.read[1] - i.read[0]) * rig.rate_Hz for i in curve.indents]) if curve.indents else 1.0
    noise = np.nan_to_num(np.array(curve.noise)) / np.sqrt(np.clip(samples, 1.0, _AVERAGED))
    # A resolution is a rectangle as wide as itself (JCGM 100, F.2.2.1).
    reading = rig.force_resolution_N / np.sqrt(12.0)
    force_error = np.sqrt(noise[0] ** 2 + reading**2 + (ATLAS_FORCE * np.abs(force).max()) ** 2)
    rise_error = np.sqrt(noise[1] ** 2 + READING**2 + (ATLAS_PRESSURE * np.abs(rise).max()) ** 2)
    return x, force, rise, np.full(x.size, force_error), np.full(x.size, rise_error)


def clipped(curve: MeasuredCurve, rig: Rig) -> Flags:
    """Flags (n,) of points at the end of the force sensor's range."""
    return np.asarray(np.abs(curve.force) >= _RANGE * rig.force_range_N)


def _travel_errors(curves: Sequence[MeasuredCurve]) -> Array:
    """Standard errors of the first contact of each run, mm, (c,): of the median over its first `EARLY` indentations.

    The spread is pooled over all runs, as the few indentations of one run give a poor estimate; 0 where no run has two.
    """
    groups = [np.array([indent.onset for indent in curve.indents if indent.fitted])[:EARLY] for curve in curves]
    free = sum(max(onsets.size - 1, 0) for onsets in groups)
    squares = sum(float(((onsets - onsets.mean()) ** 2).sum()) for onsets in groups if onsets.size > 1)
    spread = np.sqrt(squares / free) if free else 0.0
    # The variance of a median is pi/2 times that of the mean, for many normal values.
    return np.array([spread * np.sqrt(0.5 * np.pi / max(onsets.size, 1)) for onsets in groups])


def _slopes(travel: Array, values: Array) -> Array:
    """Slopes of values by travel along each row, (c, m), from the origin; zero at repeated travels (padding)."""
    slopes = np.zeros_like(values)
    for row, (x, y) in enumerate(zip(travel, values, strict=True)):
        at = np.concatenate([[0.0], np.unique(x)])
        slope = np.gradient(np.concatenate([[0.0], y[: at.size - 1]]), at)[1:]
        slopes[row, : slope.size] = slope
    return slopes


def _injection(injection: Injection) -> tuple[Array, ...]:
    pushed = injection.volume > 0
    volume, pressure = injection.volume[pushed], injection.pressure[pushed]
    if not volume.size:
        raise InputError(f"calibrate: {injection.label}: no injected volume above zero; there must be at least one")
    if not (np.isfinite(volume).all() and np.isfinite(pressure).all()):
        raise InputError(f"calibrate: {injection.label}: not a number among volumes and pressures; must be finite")
    error = np.hypot(max(injection.noise, READING), ATLAS_PRESSURE * np.abs(pressure).max())
    return volume, pressure, np.full(volume.size, error)


def _padded(rows: list[tuple[Array, ...]], columns: int) -> list[Array]:
    """Columns of rows as (rows, longest) arrays, padded with the last value, and flags of the real entries."""
    longest = max((row[0].size for row in rows), default=0)
    arrays = [
        np.array([np.pad(row[k], (0, longest - row[k].size), mode="edge") for row in rows]).reshape(len(rows), longest)
        for k in range(columns)
    ]
    there = np.array([np.arange(longest) < row[0].size for row in rows]).reshape(len(rows), longest)
    return [*arrays, there]
