"""The model of a fit for domes that the atlas does not tabulate: the solid, expanded around the estimate.

The solid is solved at the estimate and at a lower and a higher value of each parameter. The logarithms of force, rise
and injection pressure are taken as quadratic in each parameter, without mixed terms; the fit is repeated with the
expansion at its estimate, where it is exact. Of caps, thimbles and discs, 6 % off in modulus, wall and gas volume
together, the expansion is up to 0.5 % off in force and rise (tests/bench/calibrate/test_fitted_solid.py).
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.interpolate import PchipInterpolator

from pneutouch.arrays import Array, Flags
from pneutouch.bench.calibrate.observations import ObservationPoints
from pneutouch.bench.calibrate.parameters import DEAD, FRICTION, MODULUS, NAMES, OFFSET, OFFSET_BOUND, WALL
from pneutouch.errors import ComputationError
from pneutouch.mechanics.corrected.curves import after_injection
from pneutouch.mechanics.corrected.figures import GRIPS
from pneutouch.mechanics.models.interface import ModelAnswer
from pneutouch.mechanics.prediction import InflationCurve, ModelResult
from pneutouch.mechanics.sensor import Sensor
from pneutouch.units import KPA

_STEPS = 40
_RELATIVE = {MODULUS: 0.08, WALL: 0.04, DEAD: 0.06}
"""Distance of the nodes of ln modulus and ln wall, and of the dead volume over the whole gas volume: our choice."""

_FRICTION_STEP = 0.15
_LEAST = 1e-6
"""Least end of a press, mm: one without a range has no point."""

_REACH = 4.0
"""Distance from the estimate, in steps of the nodes, up to which the expansion is used: our choice."""

_ALIKE = 0.5 * KPA
"""Span of driving pressures (MPa) that are solved at its ends alone; linear in between."""


@dataclass(frozen=True, slots=True)
class SolvedPresses:
    """Presses and inflation of one sensor by the solid at p driving pressures, of m travels.

    Attributes:
        travel: Travels over the end of each press, 0 to 1, (m,).
        ends: Ends of the presses, mm, (p,).
        logs: Logarithms of force (N) and rise (MPa) over the travel (mm), (2, p, m).
        inflation: The free inflation."""

    travel: Array
    ends: Array
    logs: Array
    inflation: InflationCurve

    def at(self, travel: Array, row: int) -> Array:
        """Logarithms (2, n) at travels (n,; mm) in the press ``row``; constant beyond its end."""
        share = np.clip(travel / self.ends[row], self.travel[0], 1.0)
        return np.array([np.interp(share, self.travel, logs[row]) for logs in self.logs])


class SolidExpansion:
    """The solid's expansion around ``centre`` at ``points``, with the interface of `fitted_atlas.AtlasModel`.

    ``varied`` are the parameters (indices in `NAMES`) that may change. Raises ComputationError where the solid cannot
    press the sensor at any of the driving pressures."""

    def __init__(self, centre: Sensor, points: ObservationPoints, varied: tuple[int, ...]) -> None:
        self.sensor, self.points = centre, points
        self.varied = tuple(k for k in (*_RELATIVE, FRICTION) if k in varied)
        nodes = {k: _nodes(centre, k) for k in self.varied}
        deep = float(points.travel.max(initial=0.0)) + OFFSET_BOUND
        grains = _grains(points.driving)
        self._pressures, self._solved = _solved(centre, tuple(grains.tolist()), deep, tuple(nodes.items()))
        if grains.size and not self._pressures:
            listed = ", ".join(f"{pressure / KPA:g}" for pressure in grains)
            raise ComputationError(f"calibrate: the solid cannot press the sensor at {listed} kPa")
        self._nodes = nodes
        self._last: tuple[bytes, Array, Flags] | None = None

    def values(self, sets: Array) -> tuple[Array, Flags]:
        """Values, and True where the model has them, (s, N) each, at parameter sets (s, 5); the last result is kept."""
        key = sets.tobytes()
        if self._last is None or self._last[0] != key:
            found = [self._evaluated(one) for one in sets]
            self._last = key, np.array([values for values, _ in found]), np.array([ok for _, ok in found])
        return self._last[1], self._last[2]

    def _evaluated(self, full: Array) -> tuple[Array, Flags]:
        weights, inside = self._weights(full)
        travel = np.maximum(self.points.travel + full[OFFSET], 0.0)
        force, rise, reached = np.zeros(travel.shape), np.zeros(travel.shape), np.zeros(travel.shape, dtype=bool)
        pressures = np.array(self._pressures)
        for row, driving in enumerate(self.points.driving):
            if driving > pressures[-1] + _ALIKE:
                continue
            at = float(np.interp(driving, pressures, np.arange(pressures.size)))
            low = min(int(at), pressures.size - 1)
            high = min(low + 1, pressures.size - 1)
            ends = np.array([solved.ends for solved in self._solved]).min(axis=0)
            logs = sum(
                share * self._log(travel[row], k, weights)
                for k, share in ((low, 1.0 - at + low), (high, at - low))
                if share > 0.0
            )
            force[row], rise[row] = travel[row] * np.exp(logs)
            reached[row] = travel[row] <= (1.0 - at + low) * ends[low] + (at - low) * ends[high]
        pressure = self._injected(weights)
        known = np.concatenate([reached.ravel(), reached.ravel(), np.ones(pressure.size, dtype=bool)])
        return np.concatenate([force.ravel(), rise.ravel(), pressure]), known & inside

    def _log(self, travel: Array, row: int, weights: Array) -> Array:
        logs = np.array([solved.at(travel, row) for solved in self._solved])
        return np.tensordot(weights, logs, axes=1)

    def _weights(self, full: Array) -> tuple[Array, bool]:
        """Weights of the solved sensors at the coordinates ``full``, (5,), and True within the expansion's reach."""
        weights, inside = np.zeros(len(self._solved)), True
        weights[0] = 1.0
        for place, k in enumerate(self.varied):
            low, middle, high = self._nodes[k]
            x = full[k]
            by = np.array([(x - middle) * (x - high), (x - middle) * (x - low)])
            by /= np.array([(low - middle) * (low - high), (high - middle) * (high - low)])
            weights[1 + 2 * place : 3 + 2 * place] = by
            weights[0] += (x - low) * (x - high) / ((middle - low) * (middle - high)) - 1.0
            inside &= abs(float(x - middle)) <= _REACH * abs(high - middle)
        return weights, inside

    def _injected(self, weights: Array) -> Array:
        """Gauge pressures (MPa) after the injections, (i n,)."""
        volume = self.points.volume.ravel()
        if not volume.size:
            return np.zeros(0)
        sensors = [self.sensor, *_around(self.sensor, tuple(self._nodes.items()))]
        pairs = zip(sensors, self._solved, strict=True)
        some = np.maximum(volume, 1e-3 * float(volume.max()))
        logs = [np.log(after_injection(solved.inflation, one.gas, some)) for one, solved in pairs]
        return np.asarray(np.where(volume > 0.0, np.exp(weights @ np.array(logs)), 0.0))


def _coordinates(sensor: Sensor) -> Array:
    """The five coordinates of a sensor, (5,)."""
    full = np.zeros(len(NAMES))
    full[[MODULUS, WALL]] = np.log([sensor.wall.shear_modulus, sensor.dome.wall_thickness])
    full[[DEAD, FRICTION]] = sensor.gas.dead_volume, min(sensor.protocol.friction, GRIPS)
    return full


def _nodes(sensor: Sensor, k: int) -> tuple[float, float, float]:
    """Three coordinates of parameter k at which the solid is solved; one is the sensor's own."""
    at = float(_coordinates(sensor)[k])
    step = _FRICTION_STEP if k == FRICTION else _RELATIVE[k]
    if k == DEAD:
        step *= sensor.gas.dead_volume + sensor.dome.shape.cavity_volume
    if k in (DEAD, FRICTION) and at < step:
        # At no volume and without friction both other nodes lie above.
        return at + 2 * step, at, at + step
    return at - step, at, at + step


def _around(centre: Sensor, nodes: tuple[tuple[int, tuple[float, float, float]], ...]) -> list[Sensor]:
    """Sensors at the lower and the higher node of each parameter."""
    return [_at(centre, k, value) for k, (low, _, high) in nodes for value in (low, high)]


def _at(sensor: Sensor, k: int, value: float) -> Sensor:
    if k == MODULUS:
        return sensor.of_modulus(float(np.exp(value)))
    if k == WALL:
        return sensor.replace(wall_thickness=float(np.exp(value)))
    if k == DEAD:
        return sensor.replace(dead_volume=value)
    return sensor.replace(friction=np.inf if value >= GRIPS else value)


def _grains(driving: Array) -> Array:
    """Driving pressures (MPa, ascending) at which the solid is solved: the ends of each span of `_ALIKE`."""
    spans: list[list[float]] = []
    for pressure in np.unique(np.round(driving, 6)).tolist():
        if spans and pressure - spans[-1][0] <= _ALIKE:
            spans[-1] = [spans[-1][0], pressure]
        else:
            spans.append([pressure])
    return np.array([pressure for span in spans for pressure in span])


@lru_cache(maxsize=32)
def _solved(
    centre: Sensor,
    pressures: tuple[float, ...],
    deepest: float,
    nodes: tuple[tuple[int, tuple[float, float, float]], ...],
) -> tuple[tuple[float, ...], list[SolvedPresses]]:
    """Driving pressures without the highest ones that fail, and what is solved there: the centre, then `_around` it.

    Cached, because a fit and its checks need the same ones again."""
    from pneutouch.mechanics.models.solid import MODEL

    free = {"waves": 0, "gauge_limit": np.inf, "break_stretch": None}
    sensors = [one.replace(depth=deepest, steps=_STEPS, **free) for one in (centre, *_around(centre, nodes))]
    for count in range(len(pressures), -1, -1):
        answers = MODEL.answer(sensors, [np.array(pressures[:count])] * len(sensors))
        found = [one.result for one in answers if isinstance(one, ModelAnswer)]
        if len(found) == len(sensors):
            return pressures[:count], [_presses(one) for one in found]
    raise ComputationError("calibrate: the solid cannot inflate the sensor")


def _presses(result: ModelResult) -> SolvedPresses:
    # Closer where force and rise begin.
    share = np.linspace(0.0, 1.0, _STEPS + 1)[1:] ** 1.5
    ends = np.array([max(state.range_end, _LEAST) for state in result.states])
    rows = []
    for state, end in zip(result.states, ends.tolist(), strict=True):
        travel, first = np.unique(state.indentation, return_index=True)
        curves = (
            PchipInterpolator(travel, column[first])(share * end) for column in (state.force, state.pressure_rise)
        )
        rows.append([np.log(np.maximum(curve, 1e-12) / (share * end)) for curve in curves])
    logs = np.array(rows).reshape(len(rows), 2, share.size).transpose(1, 0, 2)
    return SolvedPresses(share, ends, logs, result.inflation)
