"""Records of a prediction: the results of one model for a sensor, and their parts.

Also the results for a sensor in a mix of resins by one of the pair's mixing curves.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from pneutouch.arrays import Array
from pneutouch.mechanics.events import NO_LINE, WARNED, Event
from pneutouch.mechanics.response import STRAIGHT, Figures
from pneutouch.mechanics.sensor import ResponseCorrection
from pneutouch.results.prediction import ErrorEstimate
from pneutouch.spec.material import MixByCurve
from pneutouch.units import KPA

if TYPE_CHECKING:
    from pneutouch.mechanics.harmonic.object_contact import PressedFace
    from pneutouch.mechanics.harmonic.press import OffAxisCurve


@dataclass(frozen=True, slots=True)
class DeformedShape:
    """The wall at an indentation (mm; 0: inflated, None: unloaded): outlines of the cells (n, m, 2), (r, z) in mm, and
    the greatest stretch in each (n,); ``body``: section (k, 2) of an object in contact, None for a plate."""

    indentation: float | None
    cells: Array
    stretch: Array
    body: Array | None = None


@dataclass(frozen=True, slots=True)
class WallPath:
    """Faces of the wall at the solved indentations (k,), mm: points (k, n, 2) in (r, z) from the base to the pole.

    ``objects`` are the sections (m, 2) of an object other than a plate; empty for a plate.
    """

    indentation: Array
    inner: Array
    outer: Array
    objects: tuple[Array, ...] = ()


LAW_RANGE = "law range"
"""Name of the limit and of the event beyond which the wall is stretched further than the data of its law's fit."""


@dataclass(frozen=True, slots=True)
class LimitPoint:
    """The maximum of the inflation curve: apex heights in mm, driving pressure in MPa."""

    apex_inner: float
    apex_outer: float
    driving_pressure: float
    thickness_stretch: float

    @property
    def membrane_stretch(self) -> float:
        """In-plane stretch of an incompressible wall with this thickness stretch."""
        return float(self.thickness_stretch**-0.5)


@dataclass(frozen=True, slots=True)
class Limits:
    """Driving pressures (MPa) at which each limit is met; None if a limit is not met before the limit point.

    ``law_range``: the wall leaves the stretches over which its law was fitted; None also if these are not known.
    ``vacuum``: the emptied dome buckles, below 0; None also where no driving pressure is below ambient.
    """

    limit_point: float | None
    break_strain: float | None
    gauge: float
    law_range: float | None = None
    vacuum: float | None = None

    @property
    def binding(self) -> str:
        """Name of the limit that is met at the lowest driving pressure."""
        return min(self.named(), key=lambda item: item[1])[0]

    @property
    def lowest(self) -> float:
        """The driving pressure at which the first limit is met, MPa."""
        return min(value for _, value in self.named())

    def named(self) -> list[tuple[str, float]]:
        """Names and driving pressures (MPa) of the limits that are met."""
        pairs = [
            ("limit point", self.limit_point),
            ("break strain", self.break_strain),
            (LAW_RANGE, self.law_range),
            ("gauge range", self.gauge),
        ]
        return [(name, value) for name, value in pairs if value is not None]


class Held(NamedTuple):
    """A state given by its `Filling`: the gas ``injected`` into the vented sensor, mm3 at ambient pressure, and whether
    the free dome is stable at a ``regulated`` pressure and with its gas ``sealed`` in, as by a syringe."""

    injected: float
    regulated: bool
    sealed: bool


LEAST_RANGE = 1e-3
"""Least range, mm, that has figures: our choice; a wide plate lies on the flange of a flat disc from the start."""


@dataclass(frozen=True, slots=True)
class SensorState:
    """The inflated dome at one driving pressure, and its loading curve: arrays of one length (mm, N, MPa).

    ``figures`` hold from first contact to ``range_end`` (mm of indentation); None if they are undetermined. ``face``
    returns the pressed outer wall for drawing; ``held`` is that of a state given by its filling. A field is None or
    empty if the model does not give it.
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
    beyond_axis: "OffAxisCurve | None" = None
    face: "Callable[[], PressedFace] | None" = None
    held: Held | None = None

    def __repr__(self) -> str:
        return f"SensorState({self.driving_pressure / KPA:g} kPa, {len(self.indentation)} points)"

    @property
    def warned(self) -> tuple[Event, ...]:
        """Events to warn of, see `WARNED`."""
        return tuple(event for event in self.events if event.kind in WARNED)

    def judged(self) -> "SensorState":
        """The state, without figures and with an event that gives the reason if its curve falls or is no line."""
        f = self.figures
        ranges = self.range_end >= LEAST_RANGE
        if f is None or (f.sensitivity > 0.0 and f.r_squared >= STRAIGHT and ranges):
            return self
        why = "the pressure does not rise with the force"
        if not ranges:
            why = f"the range ends within {1000 * LEAST_RANGE:g} um of first contact"
        elif f.sensitivity > 0.0:
            why = f"a straight line explains {f.r_squared:.0%} of the pressure's changes"
        event = Event(NO_LINE, self.range_end, False, f"{why}, so no sensitivity, stiffness or force range is given")
        return replace(self, figures=None, events=(*self.events, event))

    def corrected(self, correction: ResponseCorrection) -> "SensorState":
        """The state with force and rise times the correction's factors; events and range end are unchanged."""
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

    def _scaled_face(self, by_force: float) -> "PressedFace":
        assert self.face is not None
        return self.face().scaled(by_force)


@dataclass(frozen=True, slots=True)
class InflationCurve:
    """Free inflation, through and beyond the limit point; arrays of one length, ordered by volume (mm, mm3, MPa)."""

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
    """All results of one model for one sensor; ``dead_volume`` in mm3, ``closure`` None but for the membrane model;
    ``filled``: states given by their filling, in place of a driving pressure."""

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
    filled: tuple[SensorState, ...] = ()

    @property
    def all_states(self) -> tuple[SensorState, ...]:
        """The states at driving pressures, then those given by their filling."""
        return *self.states, *self.filled

    def __repr__(self) -> str:
        return f"SensorPrediction({self.design!r}, model {self.model}, {len(self.states)} states)"


@dataclass(frozen=True)
class CurveOutcome:
    """A sensor predicted with one mixing curve.

    states: at those of the design's driving pressures, from the lowest, at which the sensor has an equilibrium. rated:
    rated pressure, MPa; None if there is no state.
    """

    by_curve: MixByCurve
    states: tuple[SensorState, ...]
    rated: float | None
