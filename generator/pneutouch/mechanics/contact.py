"""State II of the paper's membrane theory: the inflated dome pressed by a wide rigid plate.

The paper's equations 10 to 19 are ambiguous as printed, so there are two closures for the contact radius:

``variational``
    One potential, the wall's energy at its total stretch plus the isothermal gas, least over the contact
    radius at a given plate height; the force is its slope by the plate height. Energy and work agree.
``printed``
    Equation 17 as printed: the stretch counts from state I, the force is p_II pi rho^2, and its slope by
    the plate height at fixed contact radius is set to zero. It follows the paper's theory curves in trend
    only (S far above any measured value): for reproducing them, not for design.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.cap import PressedCap, pressed_cap
from pneutouch.mechanics.gas import TrappedGas
from pneutouch.mechanics.membrane_energy import energy_slope
from pneutouch.mechanics.roots import bisect
from pneutouch.mechanics.sensor import Sensor


@dataclass(frozen=True, slots=True)
class PressedStates:
    """Pressed states; every array has the broadcast shape of driving pressure and indentation."""

    contact_radius: Array
    volume: Array
    pressure: Array
    force: Array
    thickness_stretch: Array

    def row(self, k: int) -> PressedStates:
        """The curve of the k-th driving pressure."""
        return PressedStates(
            self.contact_radius[k], self.volume[k], self.pressure[k], self.force[k], self.thickness_stretch[k]
        )


def press(sensor: Sensor, gas: TrappedGas, apex: Array, indentation: Array, closure: str) -> PressedStates:
    """Press the dome, inflated to apex height ``apex`` (mm), by ``indentation`` (mm) with a closure's name."""
    height = apex - indentation
    model = CLOSURES[closure](sensor, gas, apex, height)
    zero = np.zeros(np.broadcast_shapes(np.shape(gas.driving_pressure), np.shape(height)))
    rho = bisect(model.residual, zero, zero + sensor.dome.inner_radius)
    cap = pressed_cap(rho, height, sensor.dome.inner_radius)
    reference = 2 * np.pi * sensor.dome.inner_radius**2
    return PressedStates(rho, cap.volume, gas.pressure(cap.volume), model.force(rho), reference / cap.area)


@dataclass(frozen=True, slots=True)
class _Closure:
    """Common part of both closures; heights broadcast against the gas's driving pressures."""

    sensor: Sensor
    gas: TrappedGas
    apex: Array
    height: Array

    @property
    def wall_volume(self) -> float:
        return 2 * np.pi * self.sensor.dome.inner_radius**2 * self.sensor.dome.wall_thickness

    def cap(self, rho: Array) -> PressedCap:
        return pressed_cap(rho, self.height, self.sensor.dome.inner_radius)

    def wall_slope(self, cap: PressedCap, reference_area: Array | float) -> Array:
        """Derivative of the wall's energy by the membrane's area, N/mm."""
        stretch = reference_area / cap.area
        return -self.wall_volume * energy_slope(self.sensor.wall.shear_modulus, stretch) * stretch / cap.area


class VariationalClosure(_Closure):
    """Least potential over the contact radius."""

    def residual(self, rho: Array) -> Array:
        """Slope of the potential by the contact radius, N."""
        cap = self.cap(rho)
        tension = self.wall_slope(cap, 2 * np.pi * self.sensor.dome.inner_radius**2)
        return tension * cap.area_rho - self.gas.pressure(cap.volume) * cap.volume_rho

    def force(self, rho: Array) -> Array:
        """Minus the slope of the potential by the plate height, N."""
        cap = self.cap(rho)
        tension = self.wall_slope(cap, 2 * np.pi * self.sensor.dome.inner_radius**2)
        return self.gas.pressure(cap.volume) * cap.volume_h - tension * cap.area_h


class PrintedClosure(_Closure):
    """Equation 17 as printed."""

    def residual(self, rho: Array) -> Array:
        """Slope of E'_p by the plate height at fixed contact radius, N."""
        cap = self.cap(rho)
        inflated = np.pi * (self.sensor.dome.inner_radius**2 + self.apex**2)
        patch = np.pi * rho**2
        work = self.gas.pressure_slope(cap.volume) * cap.volume_h * (self.apex - self.height)
        return self.wall_slope(cap, inflated) * cap.area_h - patch * (work - self.gas.pressure(cap.volume))

    def force(self, rho: Array) -> Array:
        """Equation 16: p_II pi rho^2, N."""
        return self.gas.pressure(self.cap(rho).volume) * np.pi * rho**2


CLOSURES: dict[str, Callable[..., VariationalClosure | PrintedClosure]] = {
    "variational": VariationalClosure,
    "printed": PrintedClosure,
}
