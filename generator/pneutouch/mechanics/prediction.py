"""A prediction: the results of a model for a sensor, and their document in boundary units.

A record: a sensor in a mix by one of the mixing curves of its pair.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NotRequired, TypedDict

from pneutouch.arrays import Array
from pneutouch.mechanics.events import LOBES, SWAY, Event, EventRecord
from pneutouch.mechanics.limits import LimitPoint, Limits
from pneutouch.mechanics.off_axis_curve import OffAxisCurve, OffAxisRecord
from pneutouch.mechanics.pressed_face import PressedFace
from pneutouch.mechanics.response import Figures, tangent_stiffness
from pneutouch.mechanics.sensor import ResponseCorrection
from pneutouch.rounding import rounded
from pneutouch.spec.material import MixByCurve
from pneutouch.units import KPA, ML

_DIGITS = 12
"""Significant digits written: rounding of the last bits differs between processors."""

_NOTHING = 1e-12
"""Forces and pressure rises below this (N, kPa) are rounding."""


class ErrorEstimate(TypedDict, total=False):
    """Stated errors of a prediction: relative ones as fractions, and a summary in sentences."""

    model_choice: str
    limit_pressure_relative: float
    limit_apex_height_relative: float
    apex_height_relative: float
    sensitivity_discretisation_relative: float
    sensitivity_tabulation_relative: float
    sensitivity_relative: float | None
    sensitivity_relative_0kPa_22kPa: list[float | None]
    sensitivity_basis: str
    summary: list[str]


class StressRecord(TypedDict, total=False):
    """The greatest von Mises stress along a loading curve, where the model computes it."""

    max_von_mises_MPa: list[float]


class CurveRecord(StressRecord):
    """A loading curve, lists of one length."""

    indentation_mm: list[float]
    contact_force_N: list[float]
    pressure_rise_kPa: list[float]
    contact_radius_mm: list[float]
    max_stretch: list[float]
    tangent_stiffness_N_per_mm: list[float]


class StateRecord(TypedDict):
    """A state as ``predict`` prints it; figures are None if no line can be fitted."""

    driving_pressure_kPa: float
    apex_height_inner_mm: float
    apex_height_outer_mm: float
    cavity_volume_mL: float
    range_end_mm: float
    sensitivity_kPa_per_N: float | None
    sensitivity_through_origin_kPa_per_N: float | None
    r_squared: float | None
    nonlinearity_percent: float | None
    stiffness_N_per_mm: float | None
    force_range_N: list[float] | None
    saturation_force_N: float | None
    curve: CurveRecord
    events: list[EventRecord]
    off_axis: NotRequired[OffAxisRecord]


class LimitsRecord(TypedDict):
    """The limits of the driving pressure, and which binds."""

    limit_point_kPa: float | None
    break_strain_kPa: float | None
    law_range_kPa: NotRequired[float]
    gauge_range_kPa: float
    binding: str


class SensorRecord(TypedDict):
    """Predictions for the sensor as a whole, apart from its states."""

    design: str
    model: str
    closure: str | None
    error_estimate: ErrorEstimate
    limit_point: dict[str, float] | None
    limits: LimitsRecord
    dead_volume_mL: float
    inflation: dict[str, list[float]]
    assumptions: list[str]


class ModelRecord(SensorRecord):
    """A prediction by the model alone."""

    states: list[StateRecord]


@dataclass(frozen=True, slots=True)
class DeformedShape:
    """The deformed wall at an indentation (mm; None before contact): cells (n, m, 2) in (r, z), mm, and the
    greatest principal stretch in each cell (n,); ``body`` is the section of an object that is no plate, (k, 2)."""

    indentation: float | None
    cells: Array
    stretch: Array
    body: Array | None = None


@dataclass(frozen=True, slots=True)
class WallPath:
    """The faces of the wall at the solved indentations (k,), mm: points (k, n, 2) in (r, z) from the base to the pole.

    ``objects`` are the sections of an object that is no plate, (m, 2) each; empty for a plate.
    """

    indentation: Array
    inner: Array
    outer: Array
    objects: tuple[Array, ...] = ()


@dataclass(frozen=True, slots=True)
class SensorState:
    """One driving pressure: the inflated dome and its loading curve (arrays of one length, mm, N, MPa).

    ``figures`` hold from first contact to ``range_end`` (mm of indentation).
    """

    driving_pressure: float
    apex_inner: float
    apex_outer: float
    cavity_volume: float
    range_end: float
    figures: Figures | None
    indentation: Array
    force: Array
    pressure_rise: Array
    contact_radius: Array
    max_stretch: Array
    events: tuple[Event, ...]
    max_von_mises: Array | None = None
    shapes: tuple[DeformedShape, ...] = ()
    walls: WallPath | None = None
    beyond_axis: OffAxisCurve | None = None
    face: PressedFace | None = None

    def __repr__(self) -> str:
        return f"SensorState({self.driving_pressure / KPA:g} kPa, {len(self.indentation)} points)"

    @property
    def off_axis(self) -> tuple[Event, ...]:
        """Events in which the axisymmetric path loses its stability; states beyond them are still computed on that
        path."""
        return tuple(event for event in self.events if event.kind in (SWAY, LOBES))

    def corrected(self, correction: ResponseCorrection) -> SensorState:
        """The state with factors on force and pressure rise; its events and the end of its range stay."""
        by_force, by_rise = correction.at(self.driving_pressure)
        if by_force == by_rise == 1.0:
            return self
        return replace(
            self,
            force=by_force * self.force,
            pressure_rise=by_rise * self.pressure_rise,
            figures=None if self.figures is None else self.figures.scaled(by_force, by_rise),
            beyond_axis=None if self.beyond_axis is None else self.beyond_axis.scaled(by_force, by_rise),
            face=None if self.face is None else self.face.scaled(by_force),
        )

    def document(self) -> StateRecord:
        """The state as ``predict`` prints it, without its uncertainty."""
        f = self.figures
        stress: StressRecord = {}
        if self.max_von_mises is not None:
            stress["max_von_mises_MPa"] = self.max_von_mises.tolist()
        record: StateRecord = {
            "driving_pressure_kPa": self.driving_pressure / KPA,
            "apex_height_inner_mm": self.apex_inner,
            "apex_height_outer_mm": self.apex_outer,
            "cavity_volume_mL": self.cavity_volume / ML,
            "range_end_mm": self.range_end,
            "sensitivity_kPa_per_N": f.sensitivity_kPa_per_N if f else None,
            "sensitivity_through_origin_kPa_per_N": f.sensitivity_through_origin_kPa_per_N if f else None,
            "r_squared": f.r_squared if f else None,
            "nonlinearity_percent": 100 * f.nonlinearity if f else None,
            "stiffness_N_per_mm": f.stiffness if f else None,
            "force_range_N": list(f.force_range) if f else None,
            "saturation_force_N": f.saturation_force if f else None,
            "curve": {
                "indentation_mm": self.indentation.tolist(),
                "contact_force_N": self.force.tolist(),
                "pressure_rise_kPa": (self.pressure_rise / KPA).tolist(),
                "contact_radius_mm": self.contact_radius.tolist(),
                "max_stretch": self.max_stretch.tolist(),
                **stress,
                "tangent_stiffness_N_per_mm": tangent_stiffness(self.indentation, self.force).tolist(),
            },
            "events": [event.document() for event in self.events],
        }
        if self.beyond_axis is not None:
            record["off_axis"] = self.beyond_axis.document()
        return record


@dataclass(frozen=True, slots=True)
class InflationCurve:
    """Free inflation through the limit point and past it; arrays of one length in order of volume (mm, mm3, MPa)."""

    apex_inner: Array
    apex_outer: Array
    volume: Array
    pressure: Array


@dataclass(frozen=True, slots=True)
class ModelResult:
    """Results of a model: the limit point (None if the pressure has no maximum), the limits and the states."""

    limit_point: LimitPoint | None
    limits: Limits
    inflation: InflationCurve
    states: tuple[SensorState, ...]


@dataclass(frozen=True, slots=True)
class SensorPrediction:
    """All results of one model for one sensor."""

    design: str
    model: str
    closure: str | None
    error_estimate: ErrorEstimate
    limit_point: LimitPoint | None
    limits: Limits
    dead_volume: float
    inflation: InflationCurve
    states: tuple[SensorState, ...]
    assumptions: tuple[str, ...]

    def __repr__(self) -> str:
        return f"SensorPrediction({self.design!r}, model {self.model}, {len(self.states)} states)"

    def document(self) -> ModelRecord:
        """The prediction as ``predict`` prints it, without rating and uncertainty."""
        point = self.limit_point
        content: ModelRecord = {
            "design": self.design,
            "model": self.model,
            "closure": self.closure,
            "error_estimate": self.error_estimate,
            "limit_point": None if point is None else point.document(),
            "limits": self._limits_record(),
            "dead_volume_mL": self.dead_volume / ML,
            "inflation": {
                "apex_height_inner_mm": self.inflation.apex_inner.tolist(),
                "apex_height_outer_mm": self.inflation.apex_outer.tolist(),
                "cavity_volume_mL": (self.inflation.volume / ML).tolist(),
                "driving_pressure_kPa": (self.inflation.pressure / KPA).tolist(),
            },
            "states": [state.document() for state in self.states],
            "assumptions": list(self.assumptions),
        }
        return rounded(content, _DIGITS, _NOTHING)

    def _limits_record(self) -> LimitsRecord:
        caps = self.limits
        content: LimitsRecord = {
            "limit_point_kPa": None if caps.limit_point is None else caps.limit_point / KPA,
            "break_strain_kPa": None if caps.break_strain is None else caps.break_strain / KPA,
            "gauge_range_kPa": caps.gauge / KPA,
            "binding": caps.binding,
        }
        return content if caps.law_range is None else {**content, "law_range_kPa": caps.law_range / KPA}


@dataclass(frozen=True)
class CurveOutcome:
    """The sensor by one mixing curve.

    states: as many of the design's driving pressures as it can be inflated to, from the lowest. rated: rated pressure,
    MPa; None if nothing could be solved.
    """

    by_curve: MixByCurve
    states: tuple[SensorState, ...]
    rated: float | None

    def document(self) -> dict[str, Any]:
        """The outcome as data."""
        by_curve = self.by_curve
        return {
            "curve": by_curve.curve,
            "place": by_curve.place,
            "shear_modulus_MPa": by_curve.shear_modulus_MPa.nominal,
            "beyond_last_point": by_curve.beyond,
            "rated_pressure_kPa": None if self.rated is None else self.rated / KPA,
            "states": [self._state(state) for state in self.states],
        }

    @staticmethod
    def _state(state: SensorState) -> dict[str, Any]:
        figures = state.figures
        return {
            "driving_pressure_kPa": state.driving_pressure / KPA,
            "sensitivity_kPa_per_N": None if figures is None else figures.sensitivity_kPa_per_N,
            "force_range_end_N": None if figures is None else figures.force_range[1],
        }
