"""Runs on the simulated rig, and their true values: figures of each specimen and of its population."""

from dataclasses import dataclass, field, replace
from typing import NamedTuple, cast

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.figures import FIRST, SATURATION_KEY, line_figures
from pneutouch.bench.indents import RunProtocol, protocol
from pneutouch.bench.simulate.curve import ModelDeviation, PressCurve, PressCurves
from pneutouch.bench.simulate.rig import (
    MINUTE,
    RigModel,
    ScatterModel,
    SimulatedSpecimens,
    WallMemory,
    ageing_factor,
    stiffened,
)
from pneutouch.errors import InputError
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.atlas.respond import DEPTH, respond
from pneutouch.mechanics.response import Figures, figures, lines
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.viscous.runs import hysteresis
from pneutouch.results.record import SENSITIVITY_KEY
from pneutouch.spec.campaign import RunKind
from pneutouch.units import KPA

WALL, SCATTER = WallMemory(), ScatterModel()

VENT, REFILL, SHUT, VALVE = 0.2, 0.4, 0.6, 0.02
"""Shares of a rest at which the cavity is vented, filled again and shut in, and the time constant of venting and
filling, a share too: our choice. When shut in, the cavity is within 0.005 % of its driving pressure."""


class RecordSamples(NamedTuple):
    """Record of a run: time s, position mm, force N, pressure MPa, (n,) each."""

    time: Array
    position: Array
    force: Array
    pressure: Array


def within(protocol: RunProtocol, reach: float) -> RunProtocol:
    """The protocol without depths beyond ``reach`` (mm): loop and relaxation stop there, others omit deeper steps."""
    if protocol.kind in ("loop", "relaxation"):
        return replace(protocol, depths=tuple(min(depth, reach) for depth in protocol.depths))
    return replace(protocol, depths=tuple(depth for depth in protocol.depths if depth <= reach * (1 + 1e-9)))


def simulate_run(
    curve: PressCurve,
    protocol: RunProtocol,
    rig: RigModel,
    rate: float,
    rng: "np.random.Generator",
    *,
    wall: WallMemory = WALL,
    scatter: ScatterModel = SCATTER,
) -> RecordSamples:
    """Simulate one run at ``rate`` Hz.

    The wall's memory lasts over the whole run; without contact there is no force. Raises ValueError for a protocol that
    leaves the curve (see `within`)."""
    if not curve.covers(max(protocol.depths)):
        raise ValueError(f"depth {max(protocol.depths):g} mm is beyond the curve, {curve.reach:g} mm")
    knots, travels = protocol.knots()
    time = np.arange(round(float(knots[-1]) * rate) + 1) / rate
    force, rise = _pressed(curve, np.interp(time, knots, travels), wall, 1.0 / rate)
    rise *= 1.0 + scatter.gain * rng.standard_normal()
    set_to = curve.driving + scatter.reset * rng.standard_normal(len(protocol.depths) + 1)
    pressure = _shut_in(protocol, time, set_to, rig.drift(curve.driving), rise)
    return _read(rig, rate, rng, RecordSamples(time, _lagging(time, knots, travels, rig.backlash), force, pressure))


def simulate_leak(
    driving: float, seconds: float, rig: RigModel, rate: float, rng: np.random.Generator
) -> RecordSamples:
    """Simulate a leak run of a closed, unpressed sensor: driving pressure in MPa, duration in s, ``rate`` in Hz."""
    time = np.arange(round(seconds * rate) + 1) / rate
    still = np.zeros_like(time)
    return _read(rig, rate, rng, RecordSamples(time, still, still, driving + rig.drift(driving) * time))


def _pressed(curve: PressCurve, travel: Array, wall: WallMemory, step: float) -> tuple[Array, Array]:
    """Force (N) and rise (MPa) with the wall's memory at plate travels (n,), mm; below zero the plate is clear."""
    force, rise = np.zeros_like(travel), np.zeros_like(travel)
    touched = travel > 0.0
    force[touched], rise[touched] = curve.at(np.minimum(travel[touched], curve.reach))
    if wall.times:
        terms = wall.terms(np.stack([force, rise], axis=1), step)
        for f, r, term in zip(wall.force, wall.rise, terms, strict=True):
            force += f * term[:, 0]
            rise += r * term[:, 1]
    return np.where(touched, np.maximum(force, 0.0), 0.0), rise


def _shut_in(protocol: RunProtocol, time: Array, set_to: Array, drift: float, rise: Array) -> Array:
    """Pressure of the shut-in gas, MPa, (n,); a rest with reset vents it and fills it again, and drift begins anew."""
    if not protocol.reset or protocol.rest <= 0:
        return np.asarray(set_to[0] + drift * time + rise)
    starts = protocol.knots()[0][:-1:4]
    vents, shut = starts + VENT * protocol.rest, starts + SHUT * protocol.rest
    fade = VALVE * protocol.rest
    number = np.searchsorted(shut, time, side="right")
    since = time - np.concatenate([[0.0], shut])[number]
    base = np.concatenate([[0.0], rise[np.minimum(np.searchsorted(time, shut), time.size - 1)]])
    opened = np.searchsorted(vents, time, side="right")
    closed = opened == number
    # While the valves are open the regulator holds its set pressure, whatever the wall does.
    vented = time - np.concatenate([[-np.inf], vents])[opened]
    filled = vented - (REFILL - VENT) * protocol.rest
    valve = np.where(filled < 0, np.exp(-np.maximum(vented, 0.0) / fade), -np.expm1(-np.maximum(filled, 0.0) / fade))
    trapped = set_to[number] + drift * since + rise - base[number]
    return np.asarray(np.where(closed, trapped, set_to[np.minimum(opened, set_to.size - 1)] * valve))


def _lagging(time: Array, knots: Array, travels: Array, play: float) -> Array:
    """The stage's reading: in loading the plate's position, in unloading it lags by up to ``play``."""
    if play <= 0:
        return np.asarray(np.interp(time, knots, travels))
    times, reads = [knots[0]], [travels[0] + play]
    for start, end, a, b in zip(knots[:-1], knots[1:], travels[:-1], travels[1:], strict=True):
        read = reads[-1]
        if b != a:
            # Until the play is used up the reading stands still.
            taken = read if b > a else read - play
            if min(a, b) < taken < max(a, b):
                times.append(start + (end - start) * (taken - a) / (b - a))
                reads.append(read)
            read = max(read, b) if b > a else min(read, b + play)
        times.append(end)
        reads.append(read)
    return np.asarray(np.interp(time, times, reads))


def _read(rig: RigModel, rate: float, rng: "np.random.Generator", true: RecordSamples) -> RecordSamples:
    """Readings of the instruments from the true values, without the samples that are missed."""
    time, position, force, pressure = true
    zero = rng.standard_normal(3)
    noise = rng.standard_normal((3, time.size))
    position = position + rig.position_zero * zero[0] + rig.position_noise * noise[0]
    force = force + rig.force_zero * zero[1] + rig.force_drift * time
    pressure = pressure + rig.pressure_zero * zero[2]
    force = rig.passed(force + rig.force_noise * noise[1], rate, force[0])
    pressure = rig.passed(pressure + rig.pressure_noise * noise[2], rate, pressure[0])
    kept = rng.random(time.size) >= rig.missed
    force = np.clip(force, -rig.force_range, rig.force_range)
    return RecordSamples(*(x[kept] for x in (time, position, force, rig.stepped(pressure))))


SPECIMENS = 4000
"""Specimens drawn for the mean and spread of a population: the mean is then known to a sixtieth of the spread."""

STEPS = 28
"""Equal plate steps for a specimen of a population."""

_ENOUGH = 0.5
"""Least share of the specimens that must reach every depth for a population to be made of them."""

_LOOP_RATE = 1000.0
_INSTANTS = 200


@dataclass(frozen=True, slots=True)
class SimulationTruth:
    """All assumptions of the simulator: scatter of specimens and runs, the rig, the memory of the wall, and how
    specimens deviate from the model that presses them.

    ``rest`` is the longest rest in s (None: the protocol's), ``specimens`` how many are drawn for a population.
    """

    scatter: ScatterModel = field(default_factory=ScatterModel)
    rig: RigModel = field(default_factory=RigModel)
    wall: WallMemory = field(default_factory=WallMemory)
    deviation: ModelDeviation = field(default_factory=ModelDeviation)
    rest: float | None = None
    specimens: int = SPECIMENS

    def protocol(self, kind: str, height: float, reach: float) -> RunProtocol:
        """Protocol of a kind for an inner height (mm): rests at most ``rest``, depths at most ``reach`` (mm)."""
        reduced = within(protocol(cast(RunKind, kind), height), reach)
        return reduced if self.rest is None else reduced.quicker(min(self.rest, reduced.rest))


@dataclass(frozen=True, slots=True)
class Population:
    """Sensors of one resin and age at one driving pressure: mean figures by key (None if undetermined), spread over
    specimens, number of specimens, and the basis in words."""

    figures: dict[str, float | None]
    spread: dict[str, float]
    count: int
    basis: str


def loading(curve: PressCurve, steps: RunProtocol, wall: WallMemory) -> tuple[Array, Array, Array]:
    """Indentation, force and rise at the ends of the holds without noise, the origin first; (n + 1,) mm, N, MPa."""
    depths = np.array(steps.depths)
    force, rise = curve.at(depths)
    if wall.times:
        by_force, by_rise = wall.held(steps, curve.indentation)
        force, rise = force + by_force @ curve.force, rise + by_rise @ curve.rise
    return tuple(np.concatenate([[0.0], x]) for x in (depths, force, rise))  # type: ignore[return-value]


def specimen_figures(curve: PressCurve, truth: SimulationTruth, height: float, rate: float) -> dict[str, float | None]:
    """Figures of one specimen at one driving pressure without noise, by key; the saturation force may be None.

    Relaxation includes the rig's drift, as a measurement does; drift excludes the wall's recovery. ``height`` is the
    dome's inside, mm; ``rate`` the sampling rate, Hz."""
    depth, force, rise = loading(curve, truth.protocol("steps", height, curve.reach), truth.wall)
    loading_figures = _by_key(lines(depth, force, rise / KPA))
    deep = loading(curve, truth.protocol("saturation", height, curve.reach), truth.wall)
    deepest = figures(deep[0], deep[1], deep[2] / KPA)
    saturation = np.inf if deepest is None else deepest.saturation_force
    noise = truth.rig.noise(rate)
    return {
        **loading_figures,
        SATURATION_KEY: saturation if np.isfinite(saturation) else None,
        **loop_figures(curve, truth, height),
        **relaxation_figures(curve, truth, height),
        "noise_force_N": noise[0],
        "noise_pressure_kPa": noise[1] / KPA,
        "drift_pressure_kPa_per_min": MINUTE * truth.rig.drift(curve.driving) / KPA,
    }


def loop_figures(curve: PressCurve, truth: SimulationTruth, height: float) -> dict[str, float]:
    """Hysteresis of the noise-free loop, percent, mean over its cycles; the rise is counted from before each cycle."""
    loop = truth.protocol("loop", height, curve.reach)
    quiet = ScatterModel.none()
    record = simulate_run(
        curve, loop, RigModel.perfect(), _LOOP_RATE, np.random.default_rng(0), wall=truth.wall, scatter=quiet
    )
    knots, _ = loop.knots()
    rise, both = record.pressure - curve.driving, []
    touched = record.force > 0
    for k in range(len(loop.depths)):
        a, b, c, d = (knots[4 * k + j] for j in (1, 2, 3, 4))
        up = touched & (record.time >= a) & (record.time <= b)
        down = touched & (record.time >= c) & (record.time <= d)
        here = rise - rise[np.searchsorted(record.time, a - 1e-9)]
        both.append(hysteresis(record.force[up], here[up], record.force[down], here[down]))
    width, area = np.mean(both, axis=0)
    return {"hysteresis_width_percent": 100 * float(width), "hysteresis_area_percent": 100 * float(area)}


def relaxation_figures(curve: PressCurve, truth: SimulationTruth, height: float) -> dict[str, float]:
    """Relaxation of force and pressure, percent of the value at 1 s: loss to the end of the hold, and per decade.

    The drift of the force's zero and of the gas in that time is included, as in the rig's readings. The slope is the
    least-squares line through instants even in log time; a loss counts as positive.
    """
    test = truth.protocol("relaxation", height, curve.reach)
    depth = np.array(test.depths[:1])
    force, rise = (float(x[0]) for x in curve.at(depth))
    step = depth[0] / test.speed / 2000
    ramp = np.stack(curve.at(np.linspace(0.0, depth[0], 2001)), axis=1)
    start = [term[-1] for term in truth.wall.terms(ramp, step)]
    time = np.geomspace(FIRST, test.hold, _INSTANTS)
    values = {}
    rig, wall = truth.rig, truth.wall
    for k, (name, level, shares, drift) in enumerate(
        (("force", force, wall.force, rig.force_drift), ("pressure", rise, wall.rise, rig.drift(curve.driving)))
    ):
        value = level + drift * time
        for share, term, tau in zip(shares, start, truth.wall.times, strict=True):
            value += share * term[k] * np.exp(-time / tau)
        slope = np.polyfit(np.log10(time), value, 1)[0]
        values[f"relaxation_{name}_percent"] = float(100 * (value[0] - value[-1]) / value[0])
        values[f"relaxation_{name}_percent_per_decade"] = float(-100 * slope / value[0])
    return values


_LEAST_STEPS = 2
"""Least number of steps with which a line can be fitted, the first contact being another point."""


def population(pressed: PressCurves, k: int, truth: SimulationTruth, rate: float, seed: tuple[int, ...]) -> Population:
    """Population around a nominal sensor, pressed at its k-th driving pressure.

    Specimens come from the atlas in one batch. Mean and spread of each figure are then scaled by the nominal sensor's
    own figure over the atlas's, so that they belong to the model behind the records. Where the atlas does not cover the
    sensor or too few specimens, the figures are the nominal sensor's and the only spread is that between runs."""
    sensor, curve = pressed.sensor, pressed.curves[k]
    if len(truth.protocol("steps", sensor.dome.shape.height, curve.reach).depths) < _LEAST_STEPS:
        why = "" if curve.ends is None else f" ({curve.ends[0]})"
        raise InputError(
            f"driving pressure {curve.driving / KPA:g} kPa: the range ends at {curve.reach:.2f} mm{why}, before "
            f"{_LEAST_STEPS} steps of the test",
            remedy="take other driving pressures, or another object",
        )
    nominal = specimen_figures(curve, truth, sensor.dome.shape.height, rate)
    steps = truth.protocol("steps", sensor.dome.shape.height, curve.reach)
    drawn = _drawn(sensor, curve.driving, steps, truth, seed)
    if drawn is None:
        return Population(
            _with_runs(nominal, truth, None), {}, 0, "the nominal sensor: the atlas does not cover this population"
        )
    here, kept = drawn
    base = _by_key(Figures(*(column[:1] for column in here)))
    mean, spread = dict(nominal), {}
    for key in base:
        values = line_figures(here)[key][1:]
        simulated, tabulated = nominal[key], base[key]
        scale = simulated / tabulated if simulated is not None and tabulated else 1.0
        mean[key], spread[key] = float(scale * values.mean()), float(scale * values.std(ddof=1))
    basis = (
        f"{kept} of {truth.specimens} specimens through the atlas, scaled to the {pressed.model}'s nominal sensor; "
        "saturation, hysteresis and relaxation are the nominal sensor's"
    )
    return Population(_with_runs(mean, truth, spread[SENSITIVITY_KEY]), spread, kept, basis)


def _drawn(
    sensor: Sensor, driving: float, steps: RunProtocol, truth: SimulationTruth, seed: tuple[int, ...]
) -> tuple[Figures[Array], int] | None:
    """Figures of the nominal sensor (first) and of the specimens that reach every depth, and how many; else None."""
    from pneutouch.mechanics.models.choice import outside

    depth = max(steps.depths)
    nominal = sensor.replace(depth=depth, gauge_limit=np.inf)
    if outside("atlas", nominal) is not None:
        return None
    count = truth.specimens
    some = SimulatedSpecimens.draw(truth.scatter, count, np.random.default_rng([*seed, count]))
    batch = batch_of(nominal, np.full(count + 1, driving))
    wall = np.maximum(batch.wall_thickness[1:] + some.wall, 0.05 * sensor.dome.wall_thickness)
    batch = replace(
        batch,
        shear_modulus=batch.shear_modulus * np.concatenate([[1.0], some.modulus]),
        wall_thickness=np.concatenate([batch.wall_thickness[:1], wall]),
        dead_volume=batch.dead_volume + np.concatenate([[0.0], some.dead_volume]),
    )
    response = respond(batch, STEPS)
    whole = np.flatnonzero((response.ends == DEPTH) & np.isfinite(response.range_end))
    if not whole.size or whole[0] != 0 or whole.size - 1 < _ENOUGH * count:
        return None
    nodes = np.linspace(0.0, depth, STEPS + 1)
    force, rise = _held(response.force[whole], response.rise[whole], nodes, steps, truth.wall)
    depths = np.broadcast_to(np.concatenate([[0.0], steps.depths]), force.shape)
    return lines(depths, force, rise / KPA), whole.size - 1


def _held(force: Array, rise: Array, nodes: Array, steps: RunProtocol, wall: WallMemory) -> tuple[Array, Array]:
    """Force and rise of curves (n, nodes) at the ends of the holds, the origin first, (n, depths + 1) each."""
    from scipy.interpolate import PchipInterpolator

    rows = []
    for values, memory in zip((force, rise), wall.held(steps, nodes), strict=True):
        here = PchipInterpolator(nodes, values, axis=1)(np.array(steps.depths)) + values @ memory.T
        rows.append(np.concatenate([np.zeros((len(values), 1)), here], axis=1))
    return rows[0], rows[1]


def _by_key(arrays: Figures[Array]) -> dict[str, float | None]:
    """First figures of a loading curve by key, but for the saturation, which is the deepest curve's."""
    return {key: float(np.ravel(values)[0]) for key, values in line_figures(arrays).items() if key != SATURATION_KEY}


def _with_runs(mean: dict[str, float | None], truth: SimulationTruth, parts: float | None) -> dict[str, float | None]:
    """Mean figures, plus the sensitivity's spread between runs of one specimen and, as ``parts``, between specimens."""
    slope = mean[SENSITIVITY_KEY]
    return {
        **mean,
        "repeatability_kPa_per_N": None if slope is None else truth.scatter.gain * slope,
        "part_to_part_kPa_per_N": parts,
    }


def aged(sensor: Sensor, truth: SimulationTruth, days: float) -> Sensor:
    """The sensor with the modulus that it has after ``days``."""
    return stiffened(sensor, ageing_factor(truth.scatter, days))
