"""The trapped gas: isothermal and ideal (Boyle's law), pressures as gauge pressures in MPa, volumes in mm3.

The paper's eq. (15), (p_II + p_m) V_gt = (p_I + p_m) V_g, with a dead volume added on both sides.
"""

from dataclasses import dataclass

from pneutouch.arrays import Array


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
