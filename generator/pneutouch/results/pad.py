"""Record of a built pad."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class PadState:
    """Figures of one cell at one driving pressure, alone under the plate of its design."""

    driving_pressure_kPa: float
    """Driving pressure."""
    sensitivity_kPa_per_N: float | None
    """Sensitivity; null: no straight line explains the curve."""
    force_range_end_N: float | None
    """Contact force at the end of the range; null: no straight line explains the curve."""

    @property
    def text(self) -> str:
        """Sensitivity and the end of its range."""
        figures = self.sensitivity_kPa_per_N, self.force_range_end_N
        return "no line" if None in figures else "{:.3g}, to {:.3g} N".format(*figures)


@dataclass(frozen=True, slots=True)
class PadCell:
    """One cell, with the port of its number."""

    number: int
    """Number, from 1."""
    place_mm: tuple[float, float]
    """Axis of the dome (x, y), seen from the domes."""
    port_mm: tuple[float, float]
    """Axis of the port (x, y), in the same coordinates."""
    channel_mm: float
    """Length of the channel from the cavity to the passage of the port."""
    dead_volume_mL: float
    """Gas behind the cavity: channel, port, tube and gauge, or as the cell's design states it."""
    states: tuple[PadState, ...]
    """Figures at each driving pressure."""


@dataclass(frozen=True, slots=True)
class PadRecord:
    """A pad of cells on one membrane over one manifold."""

    name: str
    """Name of the pad."""
    cell: str
    """Design of its cells."""
    layout: str
    """Pattern of the cells, as the pad file states it."""
    pitch_mm: float
    """Least distance of two cells."""
    width_mm: tuple[float, float]
    """Extent of the whole along x and y."""
    thickness_mm: float
    """Thickness of the manifold under the membrane, without ports."""
    channel_diameter_mm: float
    """Diameter of the channels."""
    port_pitch_mm: float
    """Least distance of two ports."""
    pressed_diameter_mm: float
    """Greatest diameter of a dome pressed to the end of its range."""
    cells: tuple[PadCell, ...]
    """Cells by number."""
    assumptions: tuple[str, ...]
    """Assumptions of the prediction of a cell, in words."""


@dataclass(frozen=True, slots=True)
class MeasuredCell:
    """A cell of a measured pad."""

    number: int
    """Number, from 1."""
    place_mm: tuple[float, float]
    """Axis of the dome (x, y), seen from the domes."""
    rise_factor: float
    """Pressure rise over the predicted one."""
    rise_factor_uncertainty: float
    """Its standard uncertainty."""


@dataclass(frozen=True, slots=True)
class PadFigures:
    """Readings of a pad beside its prediction."""

    pad: str
    """Name of the pad."""
    simulated: bool
    """True for readings that nobody measured."""
    driving_pressure_kPa: float
    """Driving pressure of every cell."""
    ball_radius_mm: float
    """Radius of the ball."""
    readings: int
    """Number of readings in contact that are used."""
    by_hand: int
    """Number of those whose place is not known."""
    force_factor: float
    """Force over the predicted one."""
    force_factor_uncertainty: float
    """Its standard uncertainty."""
    stage_zero_mm: tuple[float, float, float] | None
    """Place of the stage's zero on the pad: x, y, and depth below the domes' tops; null: all readings are by hand."""
    rise_error: float
    """Error left in the rises, root mean square, over the greatest of a reading."""
    force_error: float
    """Error left in the forces, root mean square, over that of the forces."""
    cells: tuple[MeasuredCell, ...]
    """Cells by number."""
