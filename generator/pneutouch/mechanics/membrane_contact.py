"""State II of the paper's membrane theory: the inflated dome pressed by a wide rigid plate.

The paper's equations 10 to 19 are ambiguous as printed, so there are two closures for the contact radius:

``variational``
    One potential, the wall's energy at its total stretch plus the isothermal gas, least over the contact
    radius at a given plate height; the force is its slope by the plate height. Energy and work agree.
``printed``
    Equation 17 as printed: the stretch counts from state I, the force is p_II pi rho^2, and its slope by
    the plate height at fixed contact radius is set to zero. It follows the paper's theory curves in trend
    only (S far above any measured value): for reproducing them, not for design.

The pressed shape of the paper's state II: a flat disc and a free part of constant curvature.

The free part is an arc tangent to the plate at radius rho and height h, through the base circle R0
(eq. 11). Area and volume follow in closed form, with their derivatives by rho and h. Write c = R0 - rho,
a = (c^2 + h^2)/(2h) for the arc's radius and theta for the angle it spans; then

    A = pi [rho^2 + 2 rho a theta + c^2 + h^2]
    V = pi [rho^2 h + rho a^2 theta - rho c (a - h) + a h^2 - h^3/3] .

rho = 0 gives the cap of state I.

The wall's energy in the membrane theory: neo-Hookean, incompressible, equibiaxial (paper, eq. 7).

With thickness stretch lambda and in-plane stretches lambda**-1/2, W = C1 (lambda^2 + 2/lambda - 3), C1 = mu/2.

The trapped gas: isothermal and ideal (Boyle's law), pressures as gauge pressures in MPa, volumes in mm3.

The paper's eq. (15), (p_II + p_m) V_gt = (p_I + p_m) V_g, with a dead volume added on both sides.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.inflation import bisect
from pneutouch.mechanics.sensor import Sensor


@dataclass(frozen=True, slots=True)
class PressedCap:
    """Membrane ``area`` (mm2, middle surface = inner surface in this theory) and cavity ``volume`` (mm3).

    Derivatives are by the contact radius (``_rho``) and the plate height (``_h``).
    """

    area: Array
    volume: Array
    area_rho: Array
    area_h: Array
    volume_rho: Array
    volume_h: Array


def pressed_cap(rho: Array, h: Array, inner_radius: float) -> PressedCap:
    """Evaluate the shape at contact radii ``rho`` (0 to R0) and plate heights ``h``, broadcast together."""
    c = inner_radius - rho
    a = (c**2 + h**2) / (2 * h)
    theta = np.arctan2(c, a - h)
    slope = 2 * rho * h + a**2 * theta - 2 * rho * a * theta * c / h + rho * (2 * a - h) - c * a + rho * c**2 / h
    return PressedCap(
        area=np.pi * (rho**2 + 2 * rho * a * theta + c**2 + h**2),
        volume=np.pi * (rho**2 * h + rho * a**2 * theta - rho * c * (a - h) + a * h**2 - h**3 / 3),
        area_rho=2 * np.pi * (2 * rho + a * theta - rho * theta * c / h - c),
        area_h=2 * np.pi * (rho * theta * (1 - a / h) + rho * c / h + h),
        volume_rho=np.pi * slope,
        volume_h=np.pi * (rho**2 + 2 * rho * a * theta * (1 - a / h) + 2 * rho * c * a / h + a * h),
    )


def energy(shear_modulus: float, thickness_stretch: Array) -> Array:
    """Energy density, MPa, of the undeformed wall."""
    return 0.5 * shear_modulus * (thickness_stretch**2 + 2 / thickness_stretch - 3)


def energy_slope(shear_modulus: float, thickness_stretch: Array) -> Array:
    """Derivative of the energy density by the thickness stretch, MPa."""
    return shear_modulus * (thickness_stretch - thickness_stretch**-2)


@dataclass(frozen=True, slots=True)
class TrappedGas:
    """An amount of gas closed in at ``driving_pressure`` with the cavity at ``cavity_volume``."""

    driving_pressure: Array | float
    cavity_volume: Array | float
    dead_volume: float
    ambient_pressure: float

    @property
    def content(self) -> Array | float:
        """Absolute pressure times volume, N mm; constant as long as nothing leaks."""
        return (self.driving_pressure + self.ambient_pressure) * (self.cavity_volume + self.dead_volume)

    def pressure(self, volume: Array) -> Array:
        """Gauge pressure at a cavity volume."""
        return self.content / (volume + self.dead_volume) - self.ambient_pressure

    def pressure_slope(self, volume: Array) -> Array:
        """Derivative of the pressure by the cavity volume, MPa/mm3."""
        return -self.content / (volume + self.dead_volume) ** 2


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
    model = _BY_NAME[closure](sensor, gas, apex, height)
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


_BY_NAME: dict[str, Callable[..., VariationalClosure | PrintedClosure]] = {
    "variational": VariationalClosure,
    "printed": PrintedClosure,
}
