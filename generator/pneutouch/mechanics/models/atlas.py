"""The model ``atlas``: results of the solid, interpolated for a sensor."""

from collections.abc import Sequence
from itertools import groupby
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.errors import BeyondLimitError
from pneutouch.mechanics.atlas.coverage import meets_ring, outside_atlas
from pneutouch.mechanics.atlas.press import AtlasPress, PressTrack, SensorBatch, batch_of
from pneutouch.mechanics.atlas.recipe import FIELDS
from pneutouch.mechanics.atlas.respond import (
    BREAK,
    BUCKLING,
    DEPTH,
    EDGE,
    ENDS,
    GAUGE,
    NEAR,
    OUTSIDE,
    AtlasResponse,
    AtlasRun,
    run,
)
from pneutouch.mechanics.atlas.table import AtlasSlices, shipped
from pneutouch.mechanics.events import CREASE, DETAIL, Event, PathPoint, crossing
from pneutouch.mechanics.models.accuracy import BODY, NOT_CHECKED, NUMERICAL, TABULATION, discretised, solid_assumptions
from pneutouch.mechanics.models.interface import Answered, Limitation, ModelAnswer, SensorModel
from pneutouch.mechanics.prediction import InflationCurve, LimitPoint, Limits, ModelResult, SensorState
from pneutouch.mechanics.response import Figures
from pneutouch.mechanics.sensor import Sensor
from pneutouch.results.prediction import ErrorEstimate

_BUCKLES = "the wall buckles inward under the plate, or its gas no longer holds it"
_TABULATION_SUMMARY = (
    f"Tabulation: sensitivity within {TABULATION:.1%} of the solid, that is within {NUMERICAL['atlas']:.1%} "
    "of a refined mesh."
)
_TOGETHER = 500
"""Number of sensors in one pass: with more, a pass takes more memory and no less time."""

_DETAIL = {EDGE: DETAIL["plate_rim"], GAUGE: DETAIL["gauge_range"], BREAK: DETAIL["break"], BUCKLING: _BUCKLES}

_MEETS_RING = Limitation(
    "in a deep press the wall meets the ring that clamps its flange, which the atlas leaves out: its sensitivity is up "
    "to 10% too high without driving pressure",
    False,
)

VACUUM = Limitation("its tables have no states below ambient pressure", True)

SHALLOW, _LEAST_DEPTH = 0.2, 0.1
"""Range in R0 below which the table may exceed `TABULATION`, and least depth of a press; sensitivities of 300 random
domes are up to 0.36 % off over 0.2 R0, 1.2 % over 0.1, 25 % over 0.01 (tests/mechanics/atlas/test_short_ranges.py)."""

_RESOLVED = 0.02
"""Travel in R0 up to which the table's error, up to 0.02 N and 0.02 kPa in the paper's resins, may exceed the force
and rise (tests/mechanics/atlas/test_short_ranges.py)."""

_TOO_SHALLOW = Limitation(
    f"the range ends within {SHALLOW:g} R0 of first contact, where the table is up to 25% off", False, beyond_error=True
)

_LIMITATIONS = {
    OUTSIDE: Limitation("the press leaves the states that the atlas covers", True),
    EDGE: Limitation("the contact reaches the plate's edge", True),
    BUCKLING: Limitation("the wall buckles in the press, which the solid places more exactly", False),
    BREAK: Limitation("the break strain is reached in the press, which the solid places more exactly", False),
}


class AtlasTables(SensorModel):
    """The shipped atlas as a model."""

    name = "atlas"

    def covers(self, sensor: Sensor) -> str | None:
        """Reason why a sensor lies outside the box of the atlas or is pressed too little for its tables; else None."""
        shallow = sensor.protocol.depth < _LEAST_DEPTH * sensor.dome.inner_radius
        return f"the depth is less than {_LEAST_DEPTH:g} of the inner radius" if shallow else outside_atlas(sensor)

    def answer(self, sensors: Sequence[Sensor], driving_pressures: Sequence[Array]) -> list[Answered]:
        """Answers from the tables; sensors with the same number of steps are computed together."""
        answers: list[Answered | None] = [None] * len(sensors)
        order = sorted(range(len(sensors)), key=lambda i: sensors[i].protocol.steps)
        for _, same in groupby(order, key=lambda i: sensors[i].protocol.steps):
            rows = list(same)
            for start in range(0, len(rows), _TOGETHER):
                some = rows[start : start + _TOGETHER]
                found = _looked_up([sensors[i] for i in some], [driving_pressures[i] for i in some])
                for i, answer in zip(some, found, strict=True):
                    answers[i] = answer
        return [answer for answer in answers if answer is not None]

    def errors(self, sensor: Sensor, driving_pressures: Array) -> ErrorEstimate:
        """Errors of the solid's mesh, and the error of the table."""
        return discretised(_TABULATION_SUMMARY, sensitivity_tabulation_relative=TABULATION)

    def assumptions(self, sensor: Sensor) -> tuple[str, ...]:
        """Assumptions of the solid."""
        return solid_assumptions(sensor, f"{BODY}; {NOT_CHECKED}")


MODEL = AtlasTables()


def _looked_up(sensors: list[Sensor], driving_pressures: list[Array]) -> list[Answered]:
    """Answers for sensors with the same number of steps, in one pass. Those for a vacuum have a fatal limitation."""
    blown = [np.maximum(pressures, 0.0) for pressures in driving_pressures]
    batch = SensorBatch.join([batch_of(*pair) for pair in zip(sensors, blown, strict=True)])
    passed = run(batch, sensors[0].protocol.steps, shipped(), FIELDS)
    fields = dict(zip(FIELDS, passed.press.several(FIELDS, passed.whole), strict=True))
    ends = np.cumsum([len(pressures) for pressures in driving_pressures])
    firsts = ends - [len(pressures) for pressures in driving_pressures]
    free = FreeCurves.of(passed.press.slices, passed.press.k[firsts])
    limits = passed.press.limit[firsts].tolist()
    rows = zip(sensors, map(range, firsts, ends), zip(*free, strict=True), limits, strict=True)
    found = [_ringed(s, read_answer(s, passed, fields, some, FreeCurves(*free), p)) for s, some, free, p in rows]
    return [
        one._replace(limitation=VACUUM) if isinstance(one, ModelAnswer) and (pressures < 0.0).any() else one
        for one, pressures in zip(found, driving_pressures, strict=True)
    ]


def _ringed(sensor: Sensor, answer: Answered) -> Answered:
    """An answer with its limitation if, without another, the wall meets the ring that the atlas leaves out."""
    meets = isinstance(answer, ModelAnswer) and answer.limitation is None and meets_ring(sensor)
    return answer._replace(limitation=_MEETS_RING) if isinstance(answer, ModelAnswer) and meets else answer


def read_answer(
    sensor: Sensor, passed: AtlasRun, fields: dict[str, Array], rows: range, free: "FreeCurves", limit: float
) -> Answered:
    """Answer for one sensor, whose driving pressures are the ``rows`` of a pass, its free inflation and the pressure
    (mu) of its limit point."""
    response, press, limit = passed.response, passed.press, limit * sensor.wall.shear_modulus
    for pressure in press.batch.driving_pressure[rows].tolist():
        if pressure >= limit:
            return BeyondLimitError(pressure, limit, "it lies beyond the limit point")
    states = tuple(_state(sensor, press, passed.whole, fields, response, i) for i in rows)
    ends = response.ends[rows].tolist()
    limitation = next((reason for end, reason in _LIMITATIONS.items() if end in ends), None)
    if limitation is None and response.near_buckling[rows].any():
        why = f"the wall would buckle within {NEAR:g} R0 more of travel, where the table is less accurate"
        limitation = Limitation(why, False)
    if limitation is None and (response.range_end[rows] < SHALLOW * sensor.dome.inner_radius).any():
        limitation = _TOO_SHALLOW
    curve, point, rupture = _inflation(sensor, free, limit)
    limits = Limits(limit, rupture, sensor.gas.gauge_limit)
    return ModelAnswer(ModelResult(point, limits, curve, states), limitation)


def _state(
    sensor: Sensor, press: AtlasPress, whole: PressTrack, fields: dict[str, Array], response: AtlasResponse, i: int
) -> SensorState:
    """State at one driving pressure; ``fields`` are the fields along ``whole``, (n, m) each."""
    length, mu = sensor.dome.inner_radius, sensor.wall.shear_modulus
    ok = whole.ok[i]
    known = slice(0, ok.size if ok.all() else max(int(np.argmin(ok)), 1))
    field = {name: values[i, known] for name, values in fields.items()}
    depth = (press.apex[i] - whole.height[i, known]) * length
    has_range = response.range_end[i] > 0.0
    range_end = float(response.range_end[i]) if has_range else 0.0
    line = Figures(*(float(column[i]) for column in response.lines))
    pressed = np.stack([whole.point.force[i, known], whole.point.pressure[i, known] - press.pressure[i]])
    force, rise = _begun(depth / length, pressed) * mu
    return SensorState(
        driving_pressure=float(press.batch.driving_pressure[i]),
        apex_inner=float(field["inner_apex"][0]) * length,
        apex_outer=float(press.apex[i]) * length,
        cavity_volume=float(press.volume(press.free)[i]) * length**3,
        range_end=range_end,
        figures=line if has_range and line.force_high > line.force_low else None,
        indentation=depth,
        force=force * length**2,
        pressure_rise=rise,
        contact_radius=np.maximum(field["contact_radius"], 0.0) * length,
        max_stretch=field["stretch"],
        events=tuple(_events(depth, field, int(response.ends[i]), range_end)),
        max_von_mises=field["von_mises"] * mu,
    )


def _begun(travel: Array, values: Array) -> Array:
    """Force and rise (2, m) at travels in R0; up to `_RESOLVED` the power from the origin through the states beyond."""
    first, later = np.searchsorted(travel, (_RESOLVED, 2 * _RESOLVED))
    if first == travel.size:
        return values
    ends = slice(first, later + 1, max(later - first, 1))
    known, at = np.maximum(values[:, ends], 1e-300), travel[ends]
    power = np.log(known[:, -1:] / known[:, :1]) / np.log(at[-1] / at[0]) if at.size > 1 else 1.0
    begun = known[:, :1] * (travel[:first] / at[0]) ** np.clip(power, 1.0, 2.0)
    return np.concatenate([begun, values[:, first:]], axis=1)


def _events(depth: Array, field: dict[str, Array], end: int, range_end: float) -> list[Event]:
    """Event that ends the range, by its number ``end`` in `ENDS`, and one of creasing, if any, in order of travel."""
    happened = [] if end == DEPTH else [Event(ENDS[end], range_end, True, _DETAIL.get(end, ENDS[end]))]
    creased = np.flatnonzero(field["fold"] >= CREASE)
    if creased.size:
        before, after = (
            PathPoint(float(depth[j]), float(field["fold"][j])) for j in (max(creased[0] - 1, 0), creased[0])
        )
        happened.append(Event("creasing", crossing(before, after, CREASE) or 0.0, False, DETAIL["crease"]))
    return sorted(happened, key=lambda event: event.indentation)


_INFLATED = 90
"""Volumes from rest to the limit point at which a curve of free inflation is read from the tables; six lie beyond."""


class FreeCurves(NamedTuple):
    """Free inflation at m wall ratios, nondimensional, (m, n) each: cavity, both apices' heights, greatest stretch."""

    volume: Array
    inner: Array
    apex: Array
    stretch: Array
    pressure: Array

    @classmethod
    def of(cls, slices: AtlasSlices, walls: Index) -> "FreeCurves":
        """The curves at some of the wall ratios of ``slices``."""
        beyond = np.linspace(1.0, shipped().recipe.highest_volume, 7)[1:]
        steps = np.concatenate([np.linspace(0.0, 1.0, _INFLATED + 1), beyond])
        k, nu = np.repeat(walls, steps.size), np.tile(steps, walls.size)
        apex = slices.free_apex(k, nu)[:, 0]
        inner, stretch = slices.several(("inner_apex", "stretch"), k, nu, apex)
        columns = slices.rest_volume[k] + nu * slices.reach(k), inner, apex, stretch, slices.point(k, nu, apex).pressure
        return cls(*(column.reshape(walls.size, -1) for column in columns))


def _inflation(sensor: Sensor, free: FreeCurves, limit: float) -> tuple[InflationCurve, LimitPoint, float | None]:
    """Curve of free inflation to slightly beyond its ``limit`` (MPa), the limit point, the pressure at break strain."""
    length, mu = sensor.dome.inner_radius, sensor.wall.shear_modulus
    inner, apex, pressure, top = free.inner, free.apex, free.pressure * mu, _INFLATED
    thinning = float(apex[top] - inner[top]) * length / sensor.dome.wall_thickness
    point = LimitPoint(float(inner[top]) * length, float(apex[top]) * length, limit, thinning)
    rupture = None
    if sensor.wall.break_stretch is not None:
        over = np.flatnonzero(free.stretch[: top + 1] >= sensor.wall.break_stretch)
        if over.size:
            j = max(int(over[0]), 1)
            rupture = float(np.interp(sensor.wall.break_stretch, free.stretch[j - 1 : j + 1], pressure[j - 1 : j + 1]))
    return InflationCurve(inner * length, apex * length, free.volume * length**3, pressure), point, rupture
