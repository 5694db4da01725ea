"""The screws that hold a mould closed."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class MouldScrew:
    """A screw by its holes, mm in diameter."""

    name: str
    clearance_diameter: float
    core_diameter: float
    head_diameter: float
    depth: float

    def margin(self, undersize: float) -> float:
        """Plastic in mm from a screw's axis outwards: its head and half a millimetre."""
        return 0.5 * (max(self.head_diameter, self.clearance_diameter) + undersize) + 1.0


SCREW = MouldScrew("M3", clearance_diameter=3.4, core_diameter=2.5, head_diameter=5.5, depth=8.0)
"""Clearance hole: ISO 273, medium series; head: ISO 4762; core: M3 tap drill, also used for thread-forming screws;
depth: own choice, above two diameters."""
