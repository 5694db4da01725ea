"""Protocols for the characterization of a sensor, the paper's (section 3, Supplements C and D), as movements of the
plate."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.spec.campaign import RunKind

STEP, SHARE = 0.5, 0.75
"""Step in mm, and the depth as a share of R0 (paper, section 3-B)."""

HOLD, REST, SHORT_REST, RELAXATION = 4.0, 30.0, 2.0, 600.0
"""Seconds: hold and rest of the sensitivity test (3-B), rest of the saturation test (3-C), relaxation (Suppl. D)."""

REPETITIONS = 3
"""Runs at each driving pressure (paper, section 3-B)."""

SPEED = 5.0
"""Speed of the plate, mm/s: our choice, the paper gives none; its actuator (Actuonix L16-63) reaches 20 mm/s."""

CLEARANCE = 1.0
"""Distance between plate and dome before and after each indentation, mm: our choice."""

DEEPEST = 0.90
"""Depth of the saturation run as a share of R0: our choice, "until it saturates" in the paper; the seat is near."""

CYCLES = 3
"""Cycles of the loading and unloading loop: our choice."""


@dataclass(frozen=True, slots=True)
class RunProtocol:
    """Movements of the plate in one run. Lengths mm, times s, speed mm/s.

    Attributes:
        kind: The kind of run.
        depths: Plate travels after first contact at which the plate stays, in order; of a loop its deepest point.
        hold: Time that it stays at each; 0 in a loop.
        rest: Time that it waits without contact before each indentation.
        reset: True if the cavity is vented and set to its driving pressure again in every rest.
        speed: Of the plate.
    """

    kind: RunKind
    depths: tuple[float, ...]
    hold: float
    rest: float
    reset: bool
    speed: float = SPEED

    @property
    def duration(self) -> float:
        """Seconds from beginning to end."""
        moves = 2 * (sum(self.depths) + len(self.depths) * CLEARANCE) / self.speed
        return moves + len(self.depths) * (self.hold + self.rest)

    def quicker(self, rest: float, hold: float | None = None) -> RunProtocol:
        """The protocol with a shorter rest and, if given, a shorter hold."""
        return replace(self, rest=rest, hold=self.hold if hold is None else hold)

    def knots(self) -> tuple[Array, Array]:
        """Times (n,) s and plate travels (n,) mm between which the plate moves evenly; below zero it is clear."""
        times, travels = [0.0], [-CLEARANCE]
        for depth in self.depths:
            for seconds, travel in (
                (self.rest, -CLEARANCE),
                ((depth + CLEARANCE) / self.speed, depth),
                (self.hold, depth),
                ((depth + CLEARANCE) / self.speed, -CLEARANCE),
            ):
                times.append(times[-1] + seconds)
                travels.append(travel)
        return np.array(times), np.array(travels)


def stairs(depth: float, step: float = STEP) -> tuple[float, ...]:
    """Depths in steps to a depth, which is the last whether or not the steps meet it."""
    count = int(np.ceil(depth / step - 1e-6))
    return tuple(float(min(step * (k + 1), depth)) for k in range(count))


def protocol(kind: RunKind, height: float) -> RunProtocol:
    """The paper's protocol of a kind of run with a plate, for a dome of a ``height`` inside, mm."""
    shallow, deep = SHARE * height, DEEPEST * height
    if kind == "steps":
        return RunProtocol(kind, stairs(shallow), HOLD, REST, True)
    if kind == "saturation":
        return RunProtocol(kind, stairs(deep), HOLD, SHORT_REST, False)
    if kind == "loop":
        return RunProtocol(kind, (shallow,) * CYCLES, 0.0, SHORT_REST, False)
    if kind == "relaxation":
        return RunProtocol(kind, (shallow,), RELAXATION, REST, True)
    raise ValueError(f"{kind} has no plate")
