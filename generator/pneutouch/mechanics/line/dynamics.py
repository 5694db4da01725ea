"""A sensor's reading over frequency: wall, gas in the cavity and line, for small changes about a state.

A change v of the cavity volume and a force (or a travel) x give the pressure p = k (v/C) + b x at the wall; C is the
wall's volume compliance at constant x, b a constant, k(s) the wall's modulus over the relaxed modulus: 1 for a wall
that does not relax. Gas of compliance C_gas and a line of admittance Y take up the volume, v = -p (C_gas + Y/s). So

    p/x = b / (1 + k (C_gas + Y/s)/C).

The gain is this times the line's transfer, over the value at s = 0, where the gas is isothermal: b, which depends on
the model of the press, cancels. The mass of the wall and of the pressing object is not included.

`GasLine` holds the elements of a line from the cavity to the gauge, at one state of the air.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array, Complex
from pneutouch.mechanics.line.elements import ADIABATIC, AirState, Duct, GasVolume, LineEnd, Step, profiles

LineElement = Duct | GasVolume | Step


@dataclass(frozen=True, slots=True)
class GasLine:
    """Ducts and volumes in series from the cavity on, closed at the gauge behind the last one, with their air."""

    elements: tuple[LineElement, ...]
    air: AirState

    @property
    def volume(self) -> float:
        """Gas volume, mm3."""
        return sum(element.volume for element in self.elements)

    @property
    def length(self) -> float:
        """Total length of the ducts, mm."""
        return sum(element.length for element in self.elements if isinstance(element, Duct))

    def seen(self, s: Complex) -> LineEnd:
        """Admittance of the line at the cavity, and pressure at the gauge over that in the cavity, at s (n,; 1/s)."""
        end = LineEnd(np.zeros_like(s), np.ones_like(s))
        ducts = [element for element in self.elements if isinstance(element, Duct)]
        rows = list(profiles(ducts, s, self.air))
        for element in reversed(self.elements):
            if isinstance(element, Duct):
                end = element.before(end, s, self.air, rows.pop())
            else:
                end = element.before(end, s, self.air)
        return end


@dataclass(frozen=True, slots=True)
class SensorDynamics:
    """A state of a sensor, with what responds to small changes about it.

    Attributes:
        cavity: The gas under the dome.
        line: Gas line behind the cavity.
        wall_compliance: Cavity volume change over pressure change, mm3/MPa; infinite where the source sets the
            pressure, 0 where it sets the volume.
        excess, times: Relaxing terms of the wall's modulus over the relaxed one, and their times in s; none if elastic.
        stiffening: Constant term of the wall's modulus over the relaxed modulus; above 1 for the stiffness `at_once`.
        isothermal: True if the gas of the cavity keeps its temperature at any frequency.
        lumped: True if the line is replaced by its isothermal volume.
    """

    cavity: GasVolume
    line: GasLine
    wall_compliance: float
    excess: tuple[float, ...] = ()
    times: tuple[float, ...] = ()
    stiffening: float = 1.0
    isothermal: bool = False
    lumped: bool = False

    @property
    def gas_share(self) -> float:
        """Isothermal compliance of all the gas over that of the wall; inf for a wall of compliance 0."""
        slow = self.stiffening * (self.cavity.volume + self.line.volume) / self.line.air.pressure
        return slow / self.wall_compliance if self.wall_compliance else np.inf

    def gain(self, s: Complex) -> Complex:
        """Pressure at the gauge over that of a slow change, (n,), at nonzero s (n,; 1/s) with a real part >= 0."""
        return self.both(s)[1]

    def both(self, s: Complex) -> tuple[Complex, Complex]:
        """Pressures in the cavity and at the gauge, each over that of a slow change, at s as in `gain`, (n,) each."""
        pressure = self.line.air.pressure
        gas = self.cavity.volume / pressure if self.isothermal else self.cavity.compliance(s, self.line.air)
        behind, transfer = self.line.volume / pressure + np.zeros_like(s), np.ones_like(s)
        if not self.lumped:
            seen = self.line.seen(s)
            behind, transfer = seen.admittance / s, seen.transfer
        slow = (self.cavity.volume + self.line.volume) / pressure
        yielding = self.wall_compliance
        if np.isinf(yielding):
            return np.ones_like(s), transfer
        cavity = (yielding + self.stiffening * slow) / (yielding + self._modulus(s) * (gas + behind))
        return cavity, cavity * transfer

    def _modulus(self, s: Complex) -> Complex:
        """Modulus of the wall over the relaxed modulus at s, (n,)."""
        value = self.stiffening + np.zeros_like(s)
        for excess, time in zip(self.excess, self.times, strict=True):
            value = value + excess * s * time / (1.0 + s * time)
        return value

    def at_once(self) -> "SensorDynamics":
        """The sensor with an elastic wall of the instantaneous stiffness; gain relative to the slow reading with it."""
        stiff = self.stiffening + sum(self.excess)
        return replace(self, excess=(), times=(), stiffening=stiff)

    @property
    def fast_wall(self) -> float:
        """Reading over the slow reading for a change that is fast for the wall's relaxation and slow for the gas."""
        slow, fast = self.gas_share, self.at_once().gas_share
        return 1.0 if np.isinf(slow) else (1.0 + slow) / (1.0 + fast)

    @property
    def fast_gas(self) -> float:
        """Reading with adiabatic gas over the reading with isothermal gas, without the line's inertia and loss."""
        share = self.gas_share
        return ADIABATIC if np.isinf(share) else (1.0 + share) / (1.0 + share / ADIABATIC)


def on_axis(frequency: Array | Sequence[float]) -> Complex:
    """Imaginary frequencies s = 2 pi i f (1/s) for frequencies f in Hz."""
    return np.asarray(2j * np.pi * np.asarray(frequency, dtype=float))
