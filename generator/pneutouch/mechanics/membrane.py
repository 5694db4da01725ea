"""The paper's membrane theory: an inflated cap in closed form (state I), and the dome pressed by a plate (state II).

State I (eq. 4 to 9): with x = h/R0 the thickness stretch is 2/(1 + x^2), and stationary energy gives, for the
neo-Hookean law with C1 = mu/2, p R0/(C1 t0) = 8 x/(1 + x^2) - 64 x/(1 + x^2)^4. Its maximum is the limit point.

State II (eq. 10 to 19) is ambiguous as printed, so there are two closures for the contact radius:

``variational``
    The potential, energy of the wall at its total stretch plus isothermal gas, is minimal over the contact radius
    at a given plate height; the force is minus its slope by the plate height. Energy and work agree.
``printed``
    Equation 17 as printed: the stretch counts from state I, the force is p_II pi rho^2, and the slope of the
    potential by the plate height at fixed contact radius is set to zero. It follows the paper's theory curves only
    in trend (S far above any measured value): for reproducing the curves, not for design.

The free part of the pressed dome is an arc tangent to the plate at radius rho and height h, through the base circle R0
(eq. 11). With c = R0 - rho, a = (c^2 + h^2)/(2h) for the arc's radius and theta for the angle it spans,

    A = pi [rho^2 + 2 rho a theta + c^2 + h^2]
    V = pi [rho^2 h + rho a^2 theta - rho c (a - h) + a h^2 - h^3/3] .

The gas is isothermal and ideal, with the dead volume on both sides of eq. 15: pressures in MPa gauge, volumes in mm3.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array, bisected
from pneutouch.errors import BeyondLimitError, InputError
from pneutouch.mechanics.prediction import LimitPoint, Limits
from pneutouch.mechanics.sensor import Sensor

_HIGHEST = 1e6
"""Largest x searched on the falling branch; p R0/(mu t0) is 4e-6 there."""


def relative_pressure(x: Array) -> Array:
    """Dimensionless pressure p R0/(mu t0) at relative height x = h/R0."""
    square = 1 + x**2
    return 4 * x / square - 32 * x / square**4


def thickness_stretch(x: Array) -> Array:
    """Wall thickness over unloaded wall thickness at x = h/R0 (eq. 5)."""
    return 2 / (1 + x**2)


def membrane_stretch(x: Array) -> Array:
    """In-plane stretch at x = h/R0, the same in all directions (eq. 3)."""
    return thickness_stretch(x) ** -0.5


def _limit_height() -> float:
    """Relative height x of the limit point, where (1 - x^2)(1 + x^2)^3 = 8 (1 - 7 x^2)."""

    def slope(x: Array) -> Array:
        square = x**2
        return 8 * (1 - 7 * square) - (1 - square) * (1 + square) ** 3

    # The slope is negative below the limit point and positive above it on this bracket.
    return float(bisected(slope, np.array(1.2), np.array(3.0)))


LIMIT_HEIGHT = _limit_height()
"""Relative height h/R0 at the limit point: 1.80524, for every stiffness, size and wall."""

LIMIT_PRESSURE = float(relative_pressure(np.array(LIMIT_HEIGHT)))
"""Dimensionless pressure p R0/(mu t0) at the limit point: 1.51991."""


def pressure(x: Array, inner_radius: float, wall: float, shear_modulus: float) -> Array:
    """Driving pressure (MPa) that holds a dome at x = h/R0 (eq. 9); lengths in mm, ``shear_modulus`` in MPa."""
    return shear_modulus * wall / inner_radius * relative_pressure(x)


def relative_height(
    p: Array, inner_radius: float, wall: float, shear_modulus: float, *, falling: bool = False
) -> Array:
    """Relative heights h/R0 at driving pressures ``p`` (MPa, from 0), on the rising or the ``falling`` branch.

    Raises BeyondLimitError beyond the limit point, and InputError for a negative pressure.
    """
    target = np.asarray(p, float) * inner_radius / (shear_modulus * wall)
    if np.any(target > LIMIT_PRESSURE * (1 + 1e-12)):
        scale = shear_modulus * wall / inner_radius
        text = (
            f"no equilibrium of the membrane at p R0/(mu t0) = {float(np.max(target)):.4g}: the limit point is "
            f"{LIMIT_PRESSURE:.4g}; lower the driving pressure"
        )
        raise BeyondLimitError(float(np.max(target)) * scale, LIMIT_PRESSURE * scale, text)
    if np.any(target < 0):
        problem = "the membrane theory does not cover suction"
        raise InputError(problem, key="model", value="membrane", remedy="take `model` solid")
    if falling:
        low, high = np.full(target.shape, math.log(LIMIT_HEIGHT)), np.full(target.shape, math.log(_HIGHEST))
        return np.exp(bisected(lambda s: target - relative_pressure(np.exp(s)), low, high))
    low, high = np.ones(target.shape), np.full(target.shape, LIMIT_HEIGHT)
    return bisected(lambda x: relative_pressure(x) - target, low, high)


def limit_point(sensor: Sensor) -> LimitPoint:
    """The limit point of a sensor by the paper's membrane: its stretch is the same for every resin and size."""
    stretch = float(thickness_stretch(np.array(LIMIT_HEIGHT)))
    apex = LIMIT_HEIGHT * sensor.dome.inner_radius
    scale = sensor.wall.shear_modulus * sensor.dome.wall_thickness / sensor.dome.inner_radius
    return LimitPoint(apex, apex + stretch * sensor.dome.wall_thickness, LIMIT_PRESSURE * scale, stretch)


def limits(sensor: Sensor) -> Limits:
    """Driving pressures at which free inflation reaches each limit of a sensor; the break stretch, measured in uniaxial
    tension, is compared with the in-plane stretch: an assumption, stated with the figures."""
    broken = None
    if sensor.wall.break_stretch is not None:
        height = np.sqrt(2 * sensor.wall.break_stretch**2 - 1)
        if height < LIMIT_HEIGHT:
            dome = sensor.dome
            broken = float(pressure(height, dome.inner_radius, dome.wall_thickness, sensor.wall.shear_modulus))
    return Limits(limit_point(sensor).driving_pressure, broken, sensor.gas.gauge_limit)


_PRESSURE = (0.0, 0.256734, 0.487184, 0.66381, 0.816153, 1.021195, 1.204673, 1.317759, 1.398748, 1.453046, 1.497427)
_HEIGHT = (1.0, 1.03, 1.066291, 1.1, 1.134059, 1.19, 1.255874, 1.31, 1.36073, 1.405, 1.452773)
_LAST_ROWS = ((1.546655, 1.535446), (1.568785, 1.611202), (1.57537, 1.69))

RISING_BRANCH = np.vstack([np.column_stack([_PRESSURE, _HEIGHT]), _LAST_ROWS])
"""Pressure p R0/(mu t0) and height h/R0 of the exact neo-Hookean membrane from zero pressure to the limit point, by
shooting without the assumption of constant curvature; the tests solve it again with an independent program."""


def limit_point_errors() -> tuple[float, float]:
    """Relative errors of the cap against the exact membrane: of the limit pressure, and of the apex height there."""
    pressure, height = RISING_BRANCH[-1]
    return float(LIMIT_PRESSURE / pressure - 1), float(LIMIT_HEIGHT / height - 1)


def height_errors(relative_pressures: Array) -> Array:
    """Relative errors of the cap's apex height at p R0/(mu t0) from 0 to the cap's limit, where it is 22 % too high.

    Heights of `RISING_BRANCH` are linear in the root of the distance to the exact limit pressure, within 0.2 %.
    """
    known, height = RISING_BRANCH.T
    exact = np.interp(-np.sqrt(known[-1] - relative_pressures), -np.sqrt(known[-1] - known), height)
    return np.asarray(relative_height(relative_pressures, 1.0, 1.0, 1.0) / exact - 1)


@dataclass(frozen=True, slots=True)
class PressedCap:
    """Membrane ``area`` (mm2; the middle surface equals the inner surface in this theory) and cavity ``volume`` (mm3).

    Derivatives are by the contact radius (``_rho``) and by the plate height (``_h``).
    """

    area: Array
    volume: Array
    area_rho: Array
    area_h: Array
    volume_rho: Array
    volume_h: Array


def pressed_cap(rho: Array, h: Array, inner_radius: float) -> PressedCap:
    """Area and volume at contact radii ``rho`` (0 to R0) and plate heights ``h``, mm, broadcast together."""
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
    """Strain energy of the wall per undeformed volume, MPa (N mm/mm3)."""
    return 0.5 * shear_modulus * (thickness_stretch**2 + 2 / thickness_stretch - 3)


def energy_slope(shear_modulus: float, thickness_stretch: Array) -> Array:
    """Derivative of the energy density by the thickness stretch, MPa."""
    return shear_modulus * (thickness_stretch - thickness_stretch**-2)


@dataclass(frozen=True, slots=True)
class TrappedGas:
    """A fixed amount of gas, enclosed at ``driving_pressure`` (gauge) and ``cavity_volume``; MPa, mm3."""

    driving_pressure: Array | float
    cavity_volume: Array | float
    dead_volume: float
    ambient_pressure: float

    @property
    def content(self) -> Array | float:
        """Absolute pressure times volume, N mm; constant as long as nothing leaks."""
        return (self.driving_pressure + self.ambient_pressure) * (self.cavity_volume + self.dead_volume)

    def pressure(self, volume: Array) -> Array:
        """Gauge pressure (MPa) at a cavity volume (mm3)."""
        return self.content / (volume + self.dead_volume) - self.ambient_pressure

    def pressure_slope(self, volume: Array) -> Array:
        """Derivative of the pressure by the cavity volume, MPa/mm3."""
        return -self.content / (volume + self.dead_volume) ** 2


@dataclass(frozen=True, slots=True)
class PressedStates:
    """Pressed states (mm, mm3, MPa, N); every array has the broadcast shape of driving pressure and indentation."""

    contact_radius: Array
    volume: Array
    pressure: Array
    force: Array
    thickness_stretch: Array

    def row(self, k: int) -> "PressedStates":
        """The states at the k-th driving pressure, the first index of the arrays."""
        return PressedStates(
            self.contact_radius[k], self.volume[k], self.pressure[k], self.force[k], self.thickness_stretch[k]
        )


def press(sensor: Sensor, gas: TrappedGas, apex: Array, indentation: Array, closure: str) -> PressedStates:
    """States of the dome, inflated to height ``apex`` (mm), at ``indentation`` (mm); ``closure`` is a name."""
    height = apex - indentation
    model = _BY_NAME[closure](sensor, gas, apex, height)
    zero = np.zeros(np.broadcast_shapes(np.shape(gas.driving_pressure), np.shape(height)))
    rho = bisected(model.residual, zero, zero + sensor.dome.inner_radius)
    cap = pressed_cap(rho, height, sensor.dome.inner_radius)
    reference = 2 * np.pi * sensor.dome.inner_radius**2
    return PressedStates(rho, cap.volume, gas.pressure(cap.volume), model.force(rho), reference / cap.area)


@dataclass(frozen=True, slots=True)
class _Closure:
    """Common part of both closures: heights of apex and plate, mm, which broadcast with the gas's driving pressures."""

    sensor: Sensor
    gas: TrappedGas
    apex: Array
    height: Array

    def cap(self, rho: Array) -> PressedCap:
        return pressed_cap(rho, self.height, self.sensor.dome.inner_radius)

    def wall_slope(self, cap: PressedCap, reference_area: Array | float) -> Array:
        """Derivative of the wall's energy by the membrane's area, N/mm."""
        stretch = reference_area / cap.area
        wall_volume = 2 * np.pi * self.sensor.dome.inner_radius**2 * self.sensor.dome.wall_thickness
        return -wall_volume * energy_slope(self.sensor.wall.shear_modulus, stretch) * stretch / cap.area


class VariationalClosure(_Closure):
    """Closure by the minimum of the potential over the contact radius."""

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
    """Closure by equation 17 as printed."""

    def residual(self, rho: Array) -> Array:
        """Slope of eq. 17's potential by the plate height at fixed contact radius, N."""
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
