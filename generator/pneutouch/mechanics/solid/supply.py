"""Supplies that fill the cavity, as a potential of its volume: p = -potential', stiffness c = potential'' (a rank-one
term).

All three are nondimensional: volumes in R0^3, pressures in mu.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log1p
from typing import NamedTuple, Protocol


class FillingState(NamedTuple):
    """Potential, gauge pressure and -dp/dV at one volume."""

    energy: float
    pressure: float
    rate: float


class Supply(Protocol):
    """Anything with a potential of the cavity volume."""

    def at(self, volume: float) -> FillingState | None:
        """Potential, pressure and rate, or None if the volume is impossible."""
        ...


@dataclass(frozen=True)
class Regulator:
    """A constant gauge pressure."""

    pressure: float

    def at(self, volume: float) -> FillingState:
        """Potential -p V."""
        return FillingState(-self.pressure * volume, self.pressure, 0.0)


@dataclass(frozen=True)
class Liquid:
    """A nearly incompressible filling of rest volume `target`: volume control as an energy.

    The pressure is what it takes, `stiffness` only sets how far V may fall short of the target; every (p, V) it
    yields is an exact point of the pressure-volume curve.
    """

    target: float
    stiffness: float

    def at(self, volume: float) -> FillingState:
        """Potential stiffness/2 (V - target)^2."""
        deficit = self.target - volume
        return FillingState(0.5 * self.stiffness * deficit * deficit, self.stiffness * deficit, self.stiffness)


@dataclass(frozen=True)
class Gas:
    """Trapped isothermal gas: absolute pressure times (V + dead) stays `content`; shut in at the volume `start`."""

    content: float
    ambient: float
    dead: float
    start: float

    @classmethod
    def filled(cls, pressure: float, volume: float, ambient: float, dead: float) -> Gas:
        """The gas shut in at a gauge pressure and cavity volume."""
        return cls((pressure + ambient) * (volume + dead), ambient, dead, volume)

    def at(self, volume: float) -> FillingState | None:
        """Potential -[C ln((V + dead)/(start + dead)) - ambient (V - start)].

        Counted from the shut-in state: with a large dead volume the rounding of the full potential would hide the work.
        """
        total = volume + self.dead
        if total <= 0.0:
            return None
        swell = volume - self.start
        absolute = self.content / total
        energy = self.ambient * swell - self.content * log1p(swell / (self.start + self.dead))
        return FillingState(energy, absolute - self.ambient, absolute / total)
