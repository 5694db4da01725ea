"""The record that a datasheet is drawn from: everything on the sheet that is computed stands here."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from pneutouch.arrays import Array
    from pneutouch.catalogue import ResolvedDesign
    from pneutouch.evaluation.chart_data import (
        ComparedMembrane,
        ContactChart,
        PressedView,
        ResinCurve,
        TradeOff,
        TuningChart,
    )
    from pneutouch.mechanics.curve_outcome import CurveOutcome
    from pneutouch.mechanics.prediction import SensorPrediction
    from pneutouch.mechanics.rating import Rating
    from pneutouch.mechanics.uncertainty import GasNotes
    from pneutouch.mechanics.uncertainty.record import UncertaintyRecord
    from pneutouch.parts import Assembly
    from pneutouch.printability import Finding
    from pneutouch.printability.estimate import JobEstimate


class RelaxationCurve(NamedTuple):
    """Contact force and pressure rise in percent of their values at 1 s, over time since the press (s), (n,) each."""

    time: Array
    force: Array
    rise: Array


class LoadingLoop(NamedTuple):
    """Contact force (N) and pressure rise (MPa), loading and unloading."""

    force_in: Array
    rise_in: Array
    force_out: Array
    rise_out: Array


class ViscousRow(NamedTuple):
    """One driving pressure in one series of relaxation data.

    Attributes:
        driving_pressure: MPa.
        series: Index of the series.
        losses: Shares of force and of pressure rise lost from 1 to 600 s, and of pressure rise per decade; or None.
        hysteresis: Width of the loop over full scale by speed (mm/s); None without an unloading branch.
        ended: By speed (mm/s), or "held": why a run could not be followed further.
        contact_lost: Plate travel, mm, at which the dome leaves the plate, in the loops where it does.
    """

    driving_pressure: float
    series: int
    losses: tuple[float, float, float] | None
    hysteresis: dict[float, float | None]
    ended: dict[float | str, str]
    contact_lost: tuple[float, ...]


@dataclass(frozen=True)
class ViscousData:
    """Relaxation and hysteresis of a sensor; curves and loops (the quicker ones) at the highest driving pressure.

    Attributes:
        depth: Indentation of the runs, mm.
        ramp_speed: Speed of the press before the hold, mm/s.
        sources: One source a series.
        basis: Assumptions of the model.
        rows: One row a driving pressure and series.
        held: One curve a series; None if the run ended before 1 s.
        loops: One loop a series; None without an unloading branch.
    """

    depth: float
    ramp_speed: float
    sources: tuple[str, ...]
    basis: tuple[str, ...]
    rows: tuple[ViscousRow, ...]
    held: tuple[RelaxationCurve | None, ...]
    loops: tuple[LoadingLoop | None, ...]


class AgeingData(NamedTuple):
    """Ratio of the modulus after a year to the fresh one, and pairs of driving pressure (MPa) and change of
    sensitivity."""

    modulus_ratio: float
    sensitivity_change: tuple[tuple[float, float], ...]


class DetectableForce(NamedTuple):
    """The smallest force at one driving pressure (MPa); None if unknown.

    Attributes:
        driving_pressure: MPa.
        force: Smallest change of a force within the range, N: the threshold over the fitted sensitivity.
        at_first_contact: Smallest force on the untouched dome, N, by a power law through the curve's first points.
        drift_kPa_per_K: Pressure change of the sealed gas by temperature.
        drift_N_per_K: The force that reads the same.
        warming: Change of temperature, K, that reads as ``force`` does.
    """

    driving_pressure: float
    force: float | None
    at_first_contact: float | None
    drift_kPa_per_K: float
    drift_N_per_K: float | None
    warming: float | None


class SheetGauge(NamedTuple):
    """Readings of the gauge (gauge pressures, kPa) and its threshold.

    Attributes:
        title: Its name.
        low_kPa, limit_kPa: Least and greatest pressure read.
        threshold_kPa: Smallest change of pressure detected; None if unknown.
        rate_Hz: Readings a second; None if unknown.
        limited_by: Property of the gauge that sets the threshold.
        criterion: When a change counts as detected.
        forces: The smallest force at each driving pressure.
    """

    title: str
    low_kPa: float
    limit_kPa: float
    threshold_kPa: float | None
    rate_Hz: float | None
    limited_by: str
    criterion: str
    forces: tuple[DetectableForce, ...]


class SpeedState(NamedTuple):
    """Speed of a sensor at a driving pressure (MPa): Hz and s, None without a limit (docs/background/dynamics.md)."""

    driving_pressure: float
    resonance: float | None
    bandwidth: float | None
    bandwidth_limit: str | None
    within: float | None
    within_limit: str | None
    delay: float
    rise_time: float
    overshoot: float


class SpeedData(NamedTuple):
    """Speed of a sensor by driving pressure; ``rate_Hz`` of the gauge is None if it is unknown."""

    states: tuple[SpeedState, ...]
    rate_Hz: float | None
    note: str | None


@dataclass(frozen=True)
class SiliconePour:
    """Masses to weigh for one filling: all parts together and each of them, g; ``note`` names the basis of the mass."""

    volume_mL: float
    mass_g: float
    parts_g: tuple[float, ...]
    note: str


@dataclass(frozen=True)
class SheetData:
    """Everything a datasheet is drawn from.

    Attributes:
        scene: The design with its names resolved.
        assembly: Its bodies.
        prediction: Its figures.
        findings: Findings of the print rules.
        input_hash: Hash of all inputs of the sheet.
        uncertainty: One document a state, as `Evaluation.uncertainty`.
        estimates: Resin, support and time of each print job.
        rating: The rated driving pressure and what it follows from.
        numerical_error: Stated relative error in sensitivity of the model.
        zero_drift_kPa_per_K: Drift of the sealed gas without contact, at the lowest driving pressure.
        gauge: Range of its gauge, and the smallest force at each driving pressure.
        resin_curves: The same sensor in every resin, by title.
        viscous: Relaxation and hysteresis, or why they are not predicted.
        ageing: Change after a year, or why it is unknown.
        constants: Membranes of constant mix to compare a graded one with.
        published_kPa_per_N: Published sensitivities of this sensor by driving pressure, kPa.
        gas: Effect of the air, one entry a state; None outside the atlas.
        tradeoff: The trade-off that the design is part of; None outside the atlas.
        tuning: Its sensitivity over the driving pressure; None outside the atlas.
        contact: Errors of the force read where contact is not central, or why they are not known.
        other_contact: True if something else than a plate without friction presses it.
        object_section: Section (n, 2) in mm, r and z, of the object that presses it, at first contact with the unloaded
            dome; None for a plate.
        pressed: The pressed dome in three dimensions; None by a model without its surface.
        speed: Speed of the sensor's reading; None if that was not computed.
        pour: The silicone to weigh; None if the membrane is not cast.
        curves: The sensor by every mixing curve of its mix, the softest first.
    """

    scene: ResolvedDesign
    assembly: Assembly
    prediction: SensorPrediction
    findings: list[Finding]
    input_hash: str
    uncertainty: tuple[UncertaintyRecord, ...]
    estimates: tuple[JobEstimate, ...]
    rating: Rating
    numerical_error: float
    zero_drift_kPa_per_K: float
    gauge: SheetGauge
    resin_curves: dict[str, ResinCurve]
    viscous: ViscousData | str
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
    speed: SpeedData | None = None
    pour: SiliconePour | None = None
    curves: tuple[CurveOutcome, ...] = ()
