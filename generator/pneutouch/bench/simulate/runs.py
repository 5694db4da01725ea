"""One run on the simulated rig: a protocol, a curve, and the readings of the instruments."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.protocol import RunProtocol
from pneutouch.bench.simulate.curve import PressCurve
from pneutouch.bench.simulate.rig import RigModel
from pneutouch.bench.simulate.scatter import ScatterModel, WallMemory

WALL, SCATTER = WallMemory(), ScatterModel()

VENT, REFILL, SHUT, VALVE = 0.2, 0.4, 0.6, 0.02
"""Shares of a rest: when the cavity is vented, filled again and shut in, and the time constant of both: our choice.
Shut in, it is within 0.005 % of its driving pressure."""


class RecordSamples(NamedTuple):
    """A record: s, mm, N, MPa, (n,) each."""

    time: Array
    position: Array
    force: Array
    pressure: Array


def within(protocol: RunProtocol, reach: float) -> RunProtocol:
    """The protocol with no depth beyond ``reach``: steps omit the deeper ones, the others stop there."""
    if protocol.kind in ("loop", "relaxation"):
        return replace(protocol, depths=tuple(min(depth, reach) for depth in protocol.depths))
    return replace(protocol, depths=tuple(depth for depth in protocol.depths if depth <= reach * (1 + 1e-9)))


def simulate_run(
    curve: PressCurve,
    protocol: RunProtocol,
    rig: RigModel,
    rate: float,
    rng: np.random.Generator,
    *,
    wall: WallMemory = WALL,
    scatter: ScatterModel = SCATTER,
) -> RecordSamples:
    """Simulate one run at ``rate`` Hz.

    Memory of the wall lasts over the whole run; without contact there is no force. Raises ValueError for a protocol
    that leaves the curve (see `within`)."""
    if not curve.covers(max(protocol.depths)):
        raise ValueError(f"depth {max(protocol.depths):g} mm is beyond the curve, {curve.reach:g} mm")
    knots, travels = protocol.knots()
    time = np.arange(round(float(knots[-1]) * rate) + 1) / rate
    travel = np.interp(time, knots, travels)
    force, rise = _pressed(curve, travel, wall, 1.0 / rate)
    rise *= 1.0 + scatter.gain * rng.standard_normal()
    set_to = curve.driving + scatter.reset * rng.standard_normal(len(protocol.depths) + 1)
    pressure = _shut_in(protocol, time, set_to, rig.drift(curve.driving), rise)
    return _read(rig, rate, rng, RecordSamples(time, _lagging(time, knots, travels, rig.backlash), force, pressure))


def simulate_leak(
    driving: float, seconds: float, rig: RigModel, rate: float, rng: np.random.Generator
) -> RecordSamples:
    """A closed, unpressed sensor left alone at a driving pressure (MPa)."""
    time = np.arange(round(seconds * rate) + 1) / rate
    still = np.zeros_like(time)
    return _read(rig, rate, rng, RecordSamples(time, still, still, driving + rig.drift(driving) * time))


def _pressed(curve: PressCurve, travel: Array, wall: WallMemory, step: float) -> tuple[Array, Array]:
    """Force and rise with the wall's memory at plate travels (n,); below zero the plate is clear."""
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
    """Pressure of the shut-in gas; in a rest with reset it is vented and filled again, and drift begins again."""
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


def _read(rig: RigModel, rate: float, rng: np.random.Generator, true: RecordSamples) -> RecordSamples:
    """Readings of the instruments from the true values."""
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
