"""The steps of a planned run: the work of rig and hand, and its duration."""

from typing import TypedDict

from pneutouch.bench.protocol import CLEARANCE, RunProtocol
from pneutouch.bench.simulate.encode import LEAK_SECONDS
from pneutouch.spec.campaign import Rig

FILL, PUSH, SETTLE = 30.0, 2.0, 20.0
"""Seconds to fill before a leak run, to push one volume, and to let it settle and cool: our choice."""

_REST = (("wait", 0.2), ("vent", 0.2), ("set_pressure", 0.2), ("wait", 0.4))
"""A rest with reset, in shares of it: our choice; the last share lets the pressure settle."""


class StepRecord(TypedDict):
    """One step: the action, the value that it sets in ``unit`` (None if it sets none), and its seconds."""

    action: str
    value: float | None
    unit: str
    seconds: float


def _step(action: str, value: float | None, unit: str, seconds: float) -> StepRecord:
    return {"action": action, "value": value, "unit": unit, "seconds": seconds}


def steps_of(test: RunProtocol, pressure_kPa: float, rig: Rig) -> list[StepRecord]:
    """Steps of rig and hand in one run with a plate; travels count from first contact, below zero the plate is
    clear."""
    steps = [_step("record", rig.rate_Hz, "Hz", 0.0)]
    for k, depth in enumerate(test.depths):
        if test.reset:
            values = {"wait": (None, ""), "vent": (0.0, "kPa"), "set_pressure": (pressure_kPa, "kPa")}
            steps += [_step(action, *values[action], share * test.rest) for action, share in _REST]
        else:
            steps.append(
                _step("set_pressure", pressure_kPa, "kPa", test.rest) if k == 0 else _step("wait", None, "", test.rest)
            )
        seconds = (depth + CLEARANCE) / test.speed
        steps.append(_step("move", depth, "mm", seconds))
        if test.hold > 0:
            steps.append(_step("hold", depth, "mm", test.hold))
        steps.append(_step("move", -CLEARANCE, "mm", seconds))
    return steps


def leak_steps(pressure_kPa: float, rig: Rig) -> list[StepRecord]:
    """Steps of one leak run: the line is filled, closed and left alone."""
    return [
        _step("set_pressure", pressure_kPa, "kPa", FILL),
        _step("record", rig.rate_Hz, "Hz", 0.0),
        _step("wait", None, "", LEAK_SECONDS),
    ]


def injection_steps(volume_mL: float) -> list[StepRecord]:
    """Steps of one injection run: ``volume_mL`` in five equal parts, each read after it has settled."""
    steps = [_step("vent", 0.0, "kPa", SETTLE)]
    for share in (0.2, 0.4, 0.6, 0.8, 1.0):
        steps += [
            _step("inject", round(share * volume_mL, 9), "mL", PUSH),
            _step("wait", None, "", SETTLE),
            _step("record", None, "", 0.0),
        ]
    return steps
