"""The record that a datasheet is drawn from, with all computed figures of the sheet.

Its charts have records of their own, which hold figures and compute nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.catalogue import ResolvedDesign
from pneutouch.mechanics.prediction import CurveOutcome, SensorPrediction, SensorState
from pneutouch.mechanics.rating import Rating
from pneutouch.mechanics.response import Figures
from pneutouch.mechanics.uncertainty.document import GasNotes
from pneutouch.mechanics.viscous.describe import ViscousRuns
from pneutouch.parts import Assembly
from pneutouch.parts.mould.assembly import SiliconeBatch
from pneutouch.printability import Finding
from pneutouch.results.behaviour import Dynamics, GaugeFigures, Viscous
from pneutouch.results.printing import JobEstimate
from pneutouch.results.uncertainty import UncertaintyRecord
from pneutouch.selection.front import TradeOffFront
from pneutouch.spec.contact import ContactKind


class AgeingData(NamedTuple):
    """Modulus after a year over the fresh one; pairs of driving pressure (MPa) and relative change of sensitivity."""

    modulus_ratio: float
    sensitivity_change: tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class SheetData:
    """Everything a datasheet is drawn from.

    Attributes:
        scene: The design with its names resolved.
        assembly: Bodies of the sensor.
        prediction: Prediction of the sensor.
        findings: Findings of the print rules.
        input_hash: Hash of all inputs of the sheet.
        uncertainty, filled_uncertainty: One record for each state, as `Evaluation.uncertainty`.
        estimates: Resin, support and time of each print job.
        rating: The rated driving pressure and what it follows from.
        numerical_error: Relative numerical error in sensitivity that the model states.
        zero_drift_kPa_per_K: Drift of the sealed gas without contact, at the lowest driving pressure.
        gauge: Range of the gauge, and the smallest force at each driving pressure.
        resin_curves: Sensitivity curves of the same sensor in every resin, by title.
        viscous: Relaxation and hysteresis, or the reason why they are not predicted.
        viscous_runs: Runs from which relaxation and hysteresis are read; None where they are not predicted.
        ageing: Change after a year, or the reason why it is unknown.
        constants: Membranes of constant mix to compare a graded one with.
        published_kPa_per_N: Published sensitivities of this sensor by driving pressure, kPa.
        gas: Effect of the air, one entry a state; None outside the atlas.
        tradeoff: The trade-off that the design is part of; None outside the atlas.
        tuning: Sensitivity of the design over the driving pressure; None outside the atlas.
        contact: Errors of the force read where contact is not central, or the reason why they are unknown.
        other_contact: True if the contact is other than that of a plate without friction.
        object_section: Section (n, 2) in mm, x and z, of the object that presses it, at first contact with the unloaded
            dome; None for a plate.
        pressed: The pressed dome in three dimensions; None by a model without its surface.
        speed: Speed of the sensor's reading; None if that was not computed.
        pour: The silicone to weigh; None if the membrane is not cast.
        curves: The sensor by every mixing curve of its mix, the softest first.
        as_drawn: Prediction with the gas as drawn, if a dead volume of 0 is stated behind a tube; else None.
    """

    scene: ResolvedDesign
    assembly: Assembly
    prediction: SensorPrediction
    findings: list[Finding]
    input_hash: str
    uncertainty: tuple[UncertaintyRecord, ...]
    filled_uncertainty: tuple[UncertaintyRecord, ...]
    estimates: tuple[JobEstimate, ...]
    rating: Rating
    numerical_error: float
    zero_drift_kPa_per_K: float
    gauge: GaugeFigures
    resin_curves: dict[str, SensitivityCurve]
    viscous: Viscous
    ageing: AgeingData | str
    constants: tuple[ComparedMembrane, ...] = ()
    published_kPa_per_N: Mapping[float, float] = field(default_factory=dict)
    gas: GasNotes | None = None
    tradeoff: TradeOff | None = None
    tuning: TuningChart | None = None
    contact: ContactChart | str | None = None
    other_contact: bool = False
    object_section: Array | None = None
    pressed: PressedView | None = None
    speed: Dynamics | None = None
    viscous_runs: ViscousRuns | None = None
    pour: SiliconeBatch | None = None
    curves: tuple[CurveOutcome, ...] = ()
    as_drawn: SensorPrediction | None = None

    @staticmethod
    def force_at(state: SensorState, indentation: float) -> float:
        """Contact force (N) at an indentation, mm: linear between the steps, and on to the end of the range."""
        travel, force = state.indentation.tolist(), state.force.tolist()
        if state.figures is not None and state.range_end > travel[-1]:
            travel, force = [*travel, state.range_end], [*force, state.figures.force_range[1]]
        return float(np.interp(indentation, travel, force))


class SensitivityCurve(NamedTuple):
    """Sensitivity (kPa/N) over driving pressure (kPa), (n,) each, the model that computed it, and its label."""

    driving_pressure_kPa: Array
    sensitivity: Array
    model: str = "atlas"
    label: str = ""


class ComparedMembrane(NamedTuple):
    """A membrane to compare with: its label and its states, driving pressures ascending."""

    label: str
    states: tuple[SensorState, ...]


@dataclass(frozen=True)
class TuningChart:
    """Sensitivity of one design from zero driving pressure to its rated one, or to the highest that it states.

    Attributes:
        chosen: The curve.
        low_kPa_per_N: Lower end of its k = 2 interval, kPa/N, (n,); None if that is not known.
        high_kPa_per_N: Upper end, (n,).
        working_kPa_per_N: Sensitivities at the design's own driving pressures, kPa to kPa/N.
        others: Designs to compare with.
        published_kPa_per_N: Measured sensitivities of this very sensor, kPa to kPa/N.
        caption: Note below the chart on what the curves leave out; empty for no note.
        filled_kPa_per_N: Pressures (kPa) and sensitivities of the states given by their filling, which pass the limit.
    """

    chosen: SensitivityCurve
    low_kPa_per_N: Array | None
    high_kPa_per_N: Array | None
    working_kPa_per_N: dict[float, float]
    others: tuple[SensitivityCurve, ...] = ()
    published_kPa_per_N: tuple[tuple[float, float], ...] = ()
    caption: str = ""
    filled_kPa_per_N: tuple[tuple[float, float], ...] = ()


class ChartPoint(NamedTuple):
    """A design in the trade-off: title of its resin, text beside the point, and figures."""

    resin: str
    label: str
    figures: Figures[float]


@dataclass(frozen=True)
class TradeOff:
    """Trade-off fronts at one driving pressure.

    Attributes:
        fronts: One for each resin; empty ones are left out.
        driving_pressure_kPa: Driving pressure, kPa.
        gauge_kPa: Pressure rise that the pressure sensor has left, kPa.
        window_kPa_per_N: Least and greatest required sensitivity (kPa/N), None if free.
        force: Least required force range, N; None if free.
        spots: Designs to mark, the first one highlighted.
        caption: Note below the chart on what the fronts leave out; empty for no note.
        errors: Median and greatest relative difference of the fronts from the solid, which corrects them; else None.
    """

    fronts: tuple[TradeOffFront, ...]
    driving_pressure_kPa: float
    gauge_kPa: float
    spots: tuple[ChartPoint, ...]
    window_kPa_per_N: tuple[float, float] | None = None
    force: float | None = None
    caption: str = ""
    errors: tuple[float, float] | None = None

    @property
    def known(self) -> tuple[TradeOffFront, ...]:
        """The fronts with a line to draw."""
        return tuple(front for front in self.fronts if front.sensitivity.size > 1)


class ErrorCurves(NamedTuple):
    """Errors of the force read over ``along``, (n,), a size or a place of contact: percent, (n,) for each driving
    pressure, NaN if the reading is not reached."""

    along: Array
    errors_percent: tuple[Array, ...]


class ContactRow(NamedTuple):
    """A contact: object (plate, ball or edge), its radius (None: a plate) and offset in mm, tilt in degrees; errors of
    the force read in percent by driving pressure and reading, None if the reading is not reached."""

    kind: ContactKind
    radius: float | None
    offset: float
    tilt_deg: float
    errors_percent: tuple[tuple[float | None, ...], ...]


@dataclass(frozen=True)
class ContactChart:
    """Curves of the reading under contact off the centre, at one or two driving pressures.

    Attributes:
        driving_pressures_kPa: The lowest and the highest of the design, kPa.
        rises_kPa: Pressure rises of the rows at each driving pressure, kPa; the curves are at the first rise.
        forces: Contact forces of the central plate at these rises, N.
        by_radius: Central balls over their radius, mm; ``edges_by_radius``: edges of bars across the pole.
        by_offset: The ball of ``ball_radius`` over its offset, mm; ``edges_by_offset``: the edge of that radius.
        by_tilt: A leaning plate over its tilt, degrees.
        ball_radius: Radius of that ball, mm.
        rows: Rows of the table, one for each contact.
        standard_uncertainties: Standard uncertainty of the logarithm of the force read while object and place of
            contact are unknown, by driving pressure.
        free_offset: Greatest offset of a plate from the axis that has no effect, mm.
    """

    driving_pressures_kPa: tuple[float, ...]
    rises_kPa: tuple[tuple[float, ...], ...]
    forces: tuple[tuple[float, ...], ...]
    by_radius: ErrorCurves
    by_offset: ErrorCurves
    by_tilt: ErrorCurves
    edges_by_radius: ErrorCurves
    edges_by_offset: ErrorCurves
    ball_radius: float
    rows: tuple[ContactRow, ...]
    standard_uncertainties: tuple[float, ...]
    free_offset: float


@dataclass(frozen=True)
class PressedView:
    """The pressed dome in three dimensions at one driving pressure.

    Attributes:
        driving_pressure_kPa: Driving pressure, kPa.
        indentation: Indentation by the object, mm.
        travel: Distance that it then moved sideways, mm.
        force: Contact force, N.
        points: Outer surface, mm, (n, m, 3): rows from the base to the pole, columns once around.
        normals: Outward unit normals there, (n, m, 3).
        pressure_kPa: Contact pressure there, kPa, (n, m); 0 where nothing touches.
        lines: Lines that outline the object, mm, (k, 3) each.
    """

    driving_pressure_kPa: float
    indentation: float
    travel: float
    force: float
    points: Array
    normals: Array
    pressure_kPa: Array
    lines: tuple[Array, ...]
