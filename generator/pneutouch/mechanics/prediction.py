"""A prediction: the results of a model for a sensor, and their document in boundary units.

A record: a sensor in a mix by one of the mixing curves of its pair.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

from pneutouch.arrays import Array
from pneutouch.mechanics.events import LOBES, SWAY, Event
from pneutouch.mechanics.limits import LimitPoint, Limits
from pneutouch.mechanics.response import Figures
from pneutouch.mechanics.sensor import ResponseCorrection
from pneutouch.results.prediction import ErrorEstimate
from pneutouch.spec.material import MixByCurve
from pneutouch.units import KPA

if TYPE_CHECKING:
    from pneutouch.mechanics.harmonic.object_contact import PressedFace
    from pneutouch.mechanics.off_axis_curve import OffAxisCurve


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

    ``figures`` hold from first contact to ``range_end`` (mm of indentation). ``face`` makes the pressed outer wall,
    to draw.
    """

    driving_pressure: float
    apex_inner: float
    apex_outer: float
    cavity_volume: float
    range_end: float
    figures: Figures[float] | None
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
    face: Callable[[], PressedFace] | None = None

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
            face=None if self.face is None else partial(self._scaled_face, by_force),
        )

    def _scaled_face(self, by_force: float) -> PressedFace:
        assert self.face is not None
        return self.face().scaled(by_force)


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


@dataclass(frozen=True)
class CurveOutcome:
    """The sensor by one mixing curve.

    states: as many of the design's driving pressures as it can be inflated to, from the lowest. rated: rated pressure,
    MPa; None if nothing could be solved.
    """

    by_curve: MixByCurve
    states: tuple[SensorState, ...]
    rated: float | None
