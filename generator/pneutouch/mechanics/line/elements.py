"""Elements of a gas line at a complex frequency s (1/s): ducts with viscous and thermal losses, and volumes.

A duct is a rigid round tube with laminar flow and walls of constant temperature, small against the wavelength: Zwikker
and Kosten, Sound Absorbing Materials (1949), chapter II; Bergh and Tijdeman, NLR-TR F.238 (1965), equations 1 to 13,
which has the same Bessel functions. With x = a sqrt(s/nu), a the radius and nu the kinematic viscosity,

    series impedance      Z = s rho/A * I0(x)/I2(x)
    shunt admittance      Y = s A/(gamma p) * (gamma - (gamma - 1) I2(y)/I0(y)),  y = x sqrt(Pr)

per length. Narrow tubes have the Poiseuille resistance and isothermal gas; wide tubes are lossless and adiabatic. On
the imaginary axis |x| is the shear wave number, and |y| its thermal counterpart.

Also properties of dry air over pressure and temperature, in mm, N, MPa and s (masses in tonnes), and the Bessel ratio
I2(x)/I0(x) without `scipy.special`, which takes as long to load as NumPy.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from pneutouch.arrays import Complex
from pneutouch.errors import InputError

ADIABATIC = 1.4
"""Ratio gamma of the heat capacities of air, a diatomic gas with rigid molecules: 7/5."""

REFERENCE_TEMPERATURE = 293.15
"""Reference temperature, K. An assumption: 20 C, within the 18 to 26 C of the paper's tests (Supplement C)."""

_GAS_CONSTANT = 8.31432 / 0.0289644
"""Gas constant of air, J/(kg K): U.S. Standard Atmosphere, 1976 (NOAA-S/T 76-1562), table 2 and section 1.3."""

_SUTHERLAND = 1.458e-6, 110.4
"""Constants of the viscosity, kg/(s m K^0.5) and K: the same source, equation 51."""

_CONDUCTIVITY = 2.64638e-3, 245.4, 12.0
"""Constants of the thermal conductivity, W/(m K^1.5), K and K: the same source, equation 53."""

_PASCAL = 1e-6
"""One pascal in MPa, and one pascal second in MPa s."""

_KG_PER_M3 = 1e-12
"""One kilogram per cubic metre in t/mm3."""

_TEMPERATURES = (200.0, 400.0)
"""Temperature range in K in which the formulas of the source are used."""


@dataclass(frozen=True, slots=True)
class AirState:
    """Air at absolute ``pressure`` (MPa) and ``temperature`` (K). Raises InputError unless above 0 and 200 to 400."""

    pressure: float
    temperature: float = REFERENCE_TEMPERATURE

    def __post_init__(self) -> None:
        if not (math.isfinite(self.pressure) and self.pressure > 0.0):
            raise InputError("must be an absolute pressure above 0 MPa", key="pressure", value=self.pressure)
        low, high = _TEMPERATURES
        if not low <= self.temperature <= high:
            raise InputError(f"must be from {low:g} to {high:g} K", key="temperature", value=self.temperature)

    @property
    def density(self) -> float:
        """Density of the ideal gas, t/mm3."""
        return self.pressure / _PASCAL / (_GAS_CONSTANT * self.temperature) * _KG_PER_M3

    @property
    def viscosity(self) -> float:
        """Dynamic viscosity, MPa s."""
        beta, sutherland = _SUTHERLAND
        return beta * math.pow(self.temperature, 1.5) / (self.temperature + sutherland) * _PASCAL

    @property
    def prandtl(self) -> float:
        """Prandtl number: viscosity times heat capacity over conductivity."""
        factor, first, second = _CONDUCTIVITY
        temperature = self.temperature
        conductivity = (
            factor * math.pow(temperature, 1.5) / (temperature + first * math.pow(10.0, -second / temperature))
        )
        capacity = ADIABATIC / (ADIABATIC - 1.0) * _GAS_CONSTANT
        return self.viscosity / _PASCAL * capacity / conductivity

    @property
    def kinematic_viscosity(self) -> float:
        """Viscosity over density, mm2/s."""
        return self.viscosity / self.density

    @property
    def thermal_diffusivity(self) -> float:
        """Conductivity over heat capacity per volume, mm2/s."""
        return self.kinematic_viscosity / self.prandtl

    @property
    def sound_speed(self) -> float:
        """Speed of sound in free air, mm/s."""
        return math.sqrt(ADIABATIC * self.pressure / self.density)


_FAR = 18.0
"""Argument above which the asymptotic series is used, else the continued fraction; both have 10 digits there."""

_DEPTH = 48
"""Number of steps of the continued fraction."""

_TERMS = 16
"""Number of terms of the asymptotic series."""


def second_over_zeroth(x: Complex) -> Complex:
    """Ratio I2(x)/I0(x) for x of any shape, with a positive real part at least as large as the imaginary part.

    Continued fraction I_k/I_(k-1) = 1/(2 k/x + I_(k+1)/I_k): Abramowitz and Stegun (1964), 9.6.26; asymptotic series:
    9.7.1. No cancellation for small x, where the ratio is x^2/8.
    """
    x = np.asarray(x, dtype=complex)
    far = np.abs(x) > _FAR
    ratio = np.empty_like(x)
    ratio[far], ratio[~far] = _series(2, x[far]) / _series(0, x[far]), _fraction(x[~far])
    return ratio


def _fraction(x: Complex) -> Complex:
    with np.errstate(divide="ignore", invalid="ignore"):
        twice = 2.0 / x
        ratio = np.zeros_like(x)
        for k in range(_DEPTH, 1, -1):
            ratio = 1.0 / (k * twice + ratio)
        value = ratio / (twice + ratio)
    return np.asarray(np.where(x == 0.0, 0.0, value))


def _series(order: int, x: Complex) -> Complex:
    """Asymptotic series of I_order(x), divided by exp(x)/sqrt(2 pi x)."""
    term = np.ones_like(x)
    total = np.ones_like(x)
    for k in range(1, _TERMS):
        term = -term * (4.0 * order**2 - (2.0 * k - 1.0) ** 2) / (8.0 * k * x)
        total = total + term
    return total


_SMALL = 0.05
"""Argument below which `_isothermal_share` uses a series to the sixth power, more exact there than the closed form."""


class LineEnd(NamedTuple):
    """A line from a place to its end: admittance (mm3/(MPa s)), pressure at the end over that at the place, (n,)."""

    admittance: Complex
    transfer: Complex


@dataclass(frozen=True, slots=True)
class Duct:
    """A round tube; length and radius in mm."""

    length: float
    radius: float

    @property
    def volume(self) -> float:
        """Volume inside, mm3."""
        return math.pi * self.radius**2 * self.length

    def impedance(self, s: Complex, air: AirState) -> Complex:
        """Series impedance per length at s (n,), MPa s/mm4; Poiseuille's 8 viscosity/(pi a^4) for small s."""
        return self._impedance(s, air, profiles([self], s, air)[0, 0])

    def admittance(self, s: Complex, air: AirState) -> Complex:
        """Shunt admittance per length at s (n,), mm2/(MPa s)."""
        return self._admittance(s, air, profiles([self], s, air)[0, 1])

    def before(self, end: LineEnd, s: Complex, air: AirState, profile: Complex) -> LineEnd:
        """The line end as seen through this duct; ``profile`` is the duct's row of `profiles`."""
        series, shunt = self._impedance(s, air, profile[0]), self._admittance(s, air, profile[1])
        angle, wave = np.sqrt(series * shunt) * self.length, np.sqrt(series / shunt)
        # Written with decaying exponentials, so that a long line does not overflow.
        once = np.exp(-angle)
        twice, load = once**2, wave * end.admittance
        pressure = (1.0 + load) + (1.0 - load) * twice
        flow = (1.0 + load) - (1.0 - load) * twice
        return LineEnd(flow / pressure / wave, end.transfer * 2.0 * once / pressure)

    def _impedance(self, s: Complex, air: AirState, momentum: Complex) -> Complex:
        return np.asarray(s * air.density / (math.pi * self.radius**2) / momentum)

    def _admittance(self, s: Complex, air: AirState, heat: Complex) -> Complex:
        stiffness = ADIABATIC * air.pressure
        return np.asarray(s * math.pi * self.radius**2 / stiffness * (ADIABATIC - (ADIABATIC - 1.0) * heat))


def profiles(ducts: Sequence[Duct], s: Complex, air: AirState) -> Complex:
    """Bessel ratios I2/I0 for momentum and heat, (k, 2, n), in k ducts at s (n,); one call for all, for speed."""
    across = np.array([duct.radius for duct in ducts])[:, None, None]
    diffusivity = np.array([air.kinematic_viscosity, air.thermal_diffusivity])[:, None]
    return second_over_zeroth(across * np.sqrt(np.asarray(s, dtype=complex) / diffusivity))


@dataclass(frozen=True, slots=True)
class GasVolume:
    """A space of ``volume`` V (mm3) at one pressure that exchanges heat with walls of the area ``surface`` S (mm2).

    The heat exchange is that of a ball of radius 3 V/S: exact for a ball, and for any shape while the thermal boundary
    layer is thin. Without a surface (None) the space is a ball of this volume.
    """

    volume: float
    surface: float | None = None

    @property
    def ball_radius(self) -> float:
        """Radius of the ball with the equivalent heat exchange, mm."""
        if self.surface is None:
            return float(np.cbrt(3.0 * self.volume / (4.0 * math.pi)))
        return 3.0 * self.volume / self.surface

    def compliance(self, s: Complex, air: AirState) -> Complex:
        """Volume change over pressure change at s (n,), mm3/MPa: V/p for slow and V/(gamma p) for fast changes."""
        across = np.asarray(self.ball_radius * np.sqrt(s / air.thermal_diffusivity), dtype=np.complex128)
        share = _isothermal_share(across)
        return np.asarray(self.volume / (ADIABATIC * air.pressure) * (1.0 + (ADIABATIC - 1.0) * share))

    def before(self, end: LineEnd, s: Complex, air: AirState) -> LineEnd:
        """The line end as seen with this volume connected in front of it."""
        return LineEnd(end.admittance + s * self.compliance(s, air), end.transfer)


@dataclass(frozen=True, slots=True)
class Step:
    """Inertia of the air that converges between ducts of two radii, mm; infinite: a space. Karal, J. Acoust. Soc. Am.
    25, 327 (1953): the narrower is longer by 8/(3 pi) radii times a function of their ratio x, the sum of his modes,
    from which 1 - 1.27 x + 0.27 x^4 differs by 0.006 at the most (`tests/mechanics/line`)."""

    one: float
    other: float
    volume: ClassVar[float] = 0.0

    @property
    def length(self) -> float:
        """Added length of the narrower duct, mm."""
        ratio = min(self.one, self.other) / max(self.one, self.other)
        return 8.0 / (3.0 * math.pi) * min(self.one, self.other) * (1.0 - 1.27 * ratio + 0.27 * ratio**4)

    def before(self, end: LineEnd, s: Complex, air: AirState) -> LineEnd:
        """The line end as seen through this step."""
        mass = air.density * self.length / (math.pi * min(self.one, self.other) ** 2)
        drop = 1.0 + s * mass * end.admittance
        return LineEnd(end.admittance / drop, end.transfer / drop)


def _isothermal_share(x: Complex) -> Complex:
    """Share 3 (x coth x - 1)/x^2 of the gas in a ball that keeps the wall's temperature, x as in `compliance`."""
    near = np.abs(x) < _SMALL
    safe = np.where(near, 1.0, x)
    decay = np.exp(-2.0 * safe)
    far = 3.0 * (safe * (1.0 + decay) / (1.0 - decay) - 1.0) / safe**2
    squared = np.where(near, x, 0.0) ** 2
    series = 1.0 - squared / 15.0 + 2.0 * squared**2 / 315.0 - squared**3 / 1575.0
    return np.asarray(np.where(near, series, far))
