"""Properties of dry air over pressure and temperature, in mm, N, MPa and s: masses are in tonnes."""

from __future__ import annotations

import math
from dataclasses import dataclass

from pneutouch.errors import InputError

ADIABATIC = 1.4
"""Heat capacity ratio of air, a diatomic gas with rigid molecules: 7/5."""

REFERENCE_TEMPERATURE = 293.15
"""K. An assumption: 20 C, within the 18 to 26 C of the paper's tests (Supplement C)."""

_GAS_CONSTANT = 8.31432 / 0.0289644
"""J/(kg K): R* and mean molar mass, U.S. Standard Atmosphere, 1976 (NOAA-S/T 76-1562), table 2 and section 1.3."""

_SUTHERLAND = 1.458e-6, 110.4
"""kg/(s m K^0.5) and K: the same source, equation 51."""

_CONDUCTIVITY = 2.64638e-3, 245.4, 12.0
"""W/(m K^1.5), K and K: the same source, equation 53."""

_PASCAL = 1e-6
"""MPa in one Pa, and MPa s in one Pa s."""

_KG_PER_M3 = 1e-12
"""t/mm3 in one kg/m3."""

_TEMPERATURES = (200.0, 400.0)
"""K: between these the formulas of the source are used."""


@dataclass(frozen=True, slots=True)
class AirState:
    """Air at an absolute ``pressure`` (MPa) and a ``temperature`` (K). Raises InputError outside of 200 to 400 K."""

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
        """Ideal gas, t/mm3."""
        return self.pressure / _PASCAL / (_GAS_CONSTANT * self.temperature) * _KG_PER_M3

    @property
    def viscosity(self) -> float:
        """Dynamic viscosity, MPa s."""
        beta, sutherland = _SUTHERLAND
        return beta * math.pow(self.temperature, 1.5) / (self.temperature + sutherland) * _PASCAL

    @property
    def prandtl(self) -> float:
        """Viscosity times heat capacity over conductivity."""
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
        """Conductivity over heat capacity of a volume, mm2/s."""
        return self.kinematic_viscosity / self.prandtl

    @property
    def sound_speed(self) -> float:
        """Speed of sound in free air, mm/s."""
        return math.sqrt(ADIABATIC * self.pressure / self.density)
