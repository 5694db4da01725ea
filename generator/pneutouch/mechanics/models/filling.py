"""States of the solid that are found by another quantity than a pressure above ambient: by the gas that is injected, by
the height of the apex, or by a vacuum; up to where the wall tears or the dome buckles.

One pressure has two states on both sides of the limit point; the injected gas and the height have one each. A pressure
held by a regulator loses its state at the limit point; gas that is shut in loses it where more volume needs less gas.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np

from pneutouch.arrays import hermite
from pneutouch.errors import InputError
from pneutouch.mechanics.prediction import Held, SensorState
from pneutouch.mechanics.sensor import Filling, Sensor
from pneutouch.mechanics.solid.inflate import FreeState, Inflation, at_volume, inflate, rest_state, towards
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import NewtonFailure, NoConvergenceError, UnreachableLoadError
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.mechanics.solid.sway import round_waves
from pneutouch.units import ML

Measure = Callable[[FreeState], tuple[float, float]]
"""A quantity of a free state and its derivative by the cavity's volume (1/mm3)."""

_MOST_SOLVES = 12

_FILLINGS = {"injected": ("injected_volumes_mL", "mL", ML), "apex": ("apex_heights_mm", "mm", 1.0)}
"""Key of [pneumatics], unit and scale of each kind of filling."""


def filled_states(
    sensor: Sensor,
    probe: StrainProbe,
    fillings: Sequence[Filling],
    press: Callable[[Sensor, StrainProbe, FreeState, float], SensorState],
) -> tuple[SensorState, ...]:
    """States given by their fillings; ``press`` presses one from its driving pressure. Errors as in `free_states`."""
    free = free_states(sensor, probe, fillings)
    at = (state.pressure if held.injected else 0.0 for state, held in free)
    return tuple(replace(press(sensor, probe, one, p), held=held) for (one, held), p in zip(free, at, strict=True))


def free_states(sensor: Sensor, probe: StrainProbe, fillings: Sequence[Filling]) -> list[tuple[FreeState, Held]]:
    """States of the free dome given by their fillings, and how they can be held. Raises InputError, on the key of the
    design, for one that tears the wall, or empties the dome until it buckles, with the last one that does not."""
    solid, rest, states = probe.solid, rest_state(probe.solid), []
    for place, (kind, goal) in enumerate(fillings):
        measure = _measure(sensor, solid, kind, rest.volume)
        run = _filled(sensor, probe, measure, goal, up=goal >= measure(rest)[0])
        free = state_where(solid, run, measure, goal)
        if free is None:
            key, unit, scale = _FILLINGS[kind]
            # The height of a dome that is emptied falls, then rises again.
            along = [measure(state)[0] for state in run.states]
            end = min(along) if goal < min(along) else max(along)
            last = (np.floor if end < goal else np.ceil)(1e3 * end / scale) / 1e3
            raise InputError(
                f"beyond the last state: {run.why_no_limit}",
                key=f"pneumatics.{key}[{place}]",
                value=goal / scale,
                remedy=f"give at {'most' if end < goal else 'least'} {last:g} {unit}",
            )
        states.append((free, _held(sensor, solid, free, rest)))
    return states


TORN, BUCKLED = "the wall reaches its break strain", "the dome buckles, or leaves its round form"


def _filled(sensor: Sensor, probe: StrainProbe, measure: Measure, goal: float, *, up: bool) -> Inflation:
    """Inflation (``up``) or emptying until a measure of the free state is ``goal``, or the wall tears or buckles."""
    solid, largest = probe.solid, sensor.wall.break_stretch or np.inf

    def reached(state: FreeState) -> bool:
        return (measure(state)[0] >= goal) == up or not sound(state)

    def sound(state: FreeState) -> bool:
        return probe.greatest_stretch(state.unit.x) < largest if up else _is_round(sensor, solid, state)

    run = inflate(solid, None if up else -np.inf, past_limit=np.inf, enough=reached)
    return while_sound(solid, run, sound, TORN if up else BUCKLED)


def _measure(sensor: Sensor, solid: SolidModel, kind: str, at_rest: float) -> Measure:
    """Measure of free states for a kind of `Filling`; ``at_rest``: volume of the vented cavity, mm3."""
    gas = sensor.gas

    def injected(state: FreeState) -> tuple[float, float]:
        absolute = state.pressure + gas.ambient_pressure
        slope = (state.stiffness * (state.volume + gas.dead_volume) + absolute) / gas.ambient_pressure
        return float(gas.injected(state.pressure, state.volume, at_rest)), slope

    def apex(state: FreeState) -> tuple[float, float]:
        return state.outer_apex, float(state.by_volume[solid.mesh.outer_apex, 1]) / solid.length**2

    return injected if kind == "injected" else apex


def _held(sensor: Sensor, solid: SolidModel, free: FreeState, rest: FreeState) -> Held:
    """Gas of a free state and what holds it; the solver finds a state by its volume only if it is stable at that."""
    gas, is_round = sensor.gas, _is_round(sensor, solid, free)
    of_gas = (free.pressure + gas.ambient_pressure) / (free.volume + gas.dead_volume)
    injected = float(gas.injected(free.pressure, free.volume, rest.volume)) if free.volume != rest.volume else 0.0
    return Held(injected, is_round and free.stable, is_round and free.stiffness > -of_gas)


def emptied_to(sensor: Sensor, solid: SolidModel, pressure: float) -> Inflation:
    """The dome emptied to a pressure (MPa) below ambient, and on to its ``limit``, where it buckles, if the sensor's
    test looks for waves around the axis. Raises UnreachableLoadError where it buckles before."""
    round_at, to = partial(_is_round, sensor, solid), -np.inf if sensor.protocol.waves else pressure
    # Past its buckling the round dome is no longer followed: the solver may find no equilibrium there.
    run = inflate(solid, to_pressure=to, enough=lambda state: not round_at(state))
    run = while_sound(solid, run, round_at, BUCKLED)
    last = run.states[-1]
    if last.pressure > pressure:
        raise UnreachableLoadError(pressure, last.pressure, BUCKLED)
    return replace(run, limit=last) if run.why_no_limit == BUCKLED else run


def buckling(sensor: Sensor, solid: SolidModel) -> float | None:
    """Pressure (MPa) at which the emptied dome buckles; None: it does not above absolute vacuum, or is not tested."""
    run = emptied_to(sensor, solid, 0.0) if sensor.protocol.waves else None
    return None if run is None or run.limit is None else run.limit.pressure


def _is_round(sensor: Sensor, solid: SolidModel, state: FreeState) -> bool:
    """True if a free state is stable to as many waves around the axis as the sensor's test checks."""
    return not round_waves(solid, state.unit, sensor.protocol.waves)


def state_where(solid: SolidModel, run: Inflation, measure: Measure, goal: float) -> FreeState | None:
    """The first state of an inflation at which ``measure`` is ``goal``, to 1e-9 of its change between two states of the
    run; None if it passes none. Raises NoConvergenceError if the solver finds no equilibrium there."""
    for a, b in pairwise(run.states):
        span = measure(b)[0] - measure(a)[0]
        if min(measure(a)[0], measure(b)[0]) <= goal <= max(measure(a)[0], measure(b)[0]):
            break
    else:
        return None
    here: FreeState | NewtonFailure = min(a, b, key=lambda end: abs(measure(end)[0] - goal))
    for k in range(_MOST_SOLVES):
        if isinstance(here, NewtonFailure):
            break
        value, slope = measure(here)
        if abs(value - goal) <= 1e-9 * abs(span):
            return here
        ahead = here.unit.volume + (goal - value) / slope / solid.length**3
        here = at_volume(solid, [here], ahead) if k else towards(solid, a, b, _level_root(a, b, measure, goal))
    raise NoConvergenceError("a filling", "the volume does not settle", "another one near it")


def _level_root(a: FreeState, b: FreeState, measure: Measure, goal: float) -> float:
    """Volume (R0^3) between two states at which the Hermite cubic of a measure through them is ``goal``."""
    width = b.volume - a.volume
    (first, slope), (last, end) = measure(a), measure(b)
    share = np.linspace(0.0, 1.0, 1001)
    curve = hermite(share, np.array([0.0, 1.0]), np.array([first, last]), width * np.array([slope, end]))
    up = np.sign(last - first)
    near = float(np.interp(up * goal, np.maximum.accumulate(up * curve), share))
    return a.unit.volume + near * (b.unit.volume - a.unit.volume)


def while_sound(
    solid: SolidModel, run: Inflation, sound: Callable[[FreeState], bool], why: str, within: float = 1e-4
) -> Inflation:
    """An inflation up to the last state that is ``sound``, to ``within`` of its volume; ``why`` it ends there."""
    for k, (a, b) in enumerate(pairwise(run.states)):
        if sound(b):
            continue
        while abs(b.volume - a.volume) > within * a.volume:
            middle = towards(solid, a, b, 0.5 * (a.unit.volume + b.unit.volume))
            a, b = (middle, b) if sound(middle) else (a, middle)
        return Inflation([*run.states[: k + 1], a], run.limit, why)
    return run
