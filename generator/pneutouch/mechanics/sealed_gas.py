"""The gas of an inflated, untouched sensor: its amount, and the effects of a leak and of temperature.

The gas is ideal and at one temperature, and the cavity yields: its volume follows the pressure along the free inflation
of the dome. Lengths mm, pressures MPa.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from pneutouch.arrays import Array


@dataclass(frozen=True, slots=True)
class SealedGas:
    """The gas of one sensor at n driving pressures.

    Attributes:
        pressure: Driving pressure, gauge, MPa (n,), rising.
        volume: Cavity volume of the free dome at each pressure, mm3 (n,).
        dead_volume: Volume behind the cavity, mm3.
        ambient: Ambient pressure, absolute, MPa.
        rest_volume: Cavity volume of the vented dome, mm3.
    """

    pressure: Array
    volume: Array
    dead_volume: float
    ambient: float
    rest_volume: float

    @property
    def capacity(self) -> Array:
        """Increase d(p V)/dp of the gas amount with pressure, mm3 (n,); p absolute, V cavity and dead volume together.

        It is V + p dV/dp, and V for a rigid cavity. dV/dp is the second-order difference.
        """
        give = np.gradient(self.volume, self.pressure, edge_order=2 if self.pressure.size > 2 else 1)
        return np.asarray(self.volume + self.dead_volume + (self.pressure + self.ambient) * give)

    @property
    def injected(self) -> Array:
        """Gas to inject into the vented sensor, as a volume at ambient pressure, mm3 (n,). Isothermal (Boyle)."""
        absolute = self.pressure + self.ambient
        return absolute * (self.volume + self.dead_volume) / self.ambient - self.rest_volume - self.dead_volume

    def by_temperature(self, temperature: float) -> Array:
        """Derivative of the sealed gas's pressure by temperature at ``temperature`` (K), MPa/K (n,).

        From p V/T constant and d(p V) = `capacity` dp: dp/dT = p V/(T capacity), which is p/T in a rigid cavity.
        """
        held = (self.pressure + self.ambient) * (self.volume + self.dead_volume)
        return np.asarray(held / temperature / self.capacity)

    def loss(self, conductance: float) -> Array:
        """Rate at which a leak lowers the pressure, MPa/s (n,).

        ``conductance`` in mm3/s: p V falls at conductance times `leak_pressure`.
        """
        return np.asarray(conductance * leak_pressure(self.pressure, self.ambient) / self.capacity)

    def holding_time(self, conductance: float, start: float, end: float) -> float:
        """Time (s) in which a leak lowers the pressure from ``start`` to ``end`` (MPa); infinite without a leak or for
        an ``end`` of 0 or less.

        The integral of capacity/(conductance `leak_pressure`), with the capacity linear between the states."""
        if conductance <= 0.0 or end <= 0.0:
            return float("inf")
        grid = np.geomspace(end, start, _PANELS + 1)
        capacity = np.interp(grid, self.pressure, self.capacity) * grid / leak_pressure(grid, self.ambient)
        # In ln p the integrand is smooth, so that the trapezium rule integrates it well.
        return float(np.trapezoid(capacity, np.log(grid)) / conductance)


_PANELS = 256


def leak_pressure(pressure: Any, ambient: float) -> Any:
    """Pressure that drives a leak, MPa: (p_abs^2 - p_ambient^2) / (2 p_ambient), near ambient the gauge pressure.

    Laminar flow of a gas through a fine gap, whose density rises with its pressure. For sealed printed chambers that
    fell from 100 to 20 kPa the time by this law is 0 and 5 % too long, by the gauge pressure 14 and 10 % too short.
    """
    return pressure * (1.0 + 0.5 * pressure / ambient)


def conductance_of_cap(rate: float, pressure: float, volume: float, ambient: float) -> float:
    """Conductance (mm3/s) of a leak from a rigid ``volume`` (mm3) in which the pressure falls at ``rate`` (MPa/s) at a
    mean gauge ``pressure`` (MPa)."""
    return float(rate * volume / leak_pressure(pressure, ambient))
