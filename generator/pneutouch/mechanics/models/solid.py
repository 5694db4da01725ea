"""The model ``solid``: the paper's finite element study (section 2-C and Supplement B) for a sensor.

A wall stretched beyond the range over which its law was fitted is a limit of the inflation and an event of the press.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache, partial
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.arrays import Array, distinct, hermite
from pneutouch.mechanics.events import Event, SolidEvent, range_end
from pneutouch.mechanics.models.accuracy import (
    BODY,
    NOT_CHECKED,
    discretised,
    limit_discretisation,
    sensitivity_discretisation,
    solid_assumptions,
)
from pneutouch.mechanics.models.interface import Answered, ModelAnswer, SensorModel, one_by_one
from pneutouch.mechanics.prediction import (
    LAW_RANGE,
    DeformedShape,
    InflationCurve,
    LimitPoint,
    Limits,
    ModelResult,
    SensorState,
    WallPath,
)
from pneutouch.mechanics.response import figures
from pneutouch.mechanics.sensor import Filling, RigidBase, Sensor
from pneutouch.mechanics.solid.continuation import Guides
from pneutouch.mechanics.solid.indent import IndentationPath, PressSettings, PressState, indent
from pneutouch.mechanics.solid.inflate import FreeState, Inflation, first_touch, inflate, state_at
from pneutouch.mechanics.solid.mesh import SolidMesh, dome, nodes_along, object_cells
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.object_contact import Indenter
from pneutouch.mechanics.solid.stress import StrainProbe, burst, met
from pneutouch.results.prediction import ErrorEstimate
from pneutouch.units import KPA
from pneutouch.wording import data_of

if TYPE_CHECKING:
    from pneutouch.mechanics.harmonic.object_contact import PressedFace
    from pneutouch.mechanics.harmonic.press import OffAxisPath, OffAxisState
    from pneutouch.mechanics.solid.indenter import RigidObject

_SUMMARY = "Discretisation: sensitivity within {relative:.1%}, limit pressure within {limit:.1%} of a refined mesh."
_OBJECT_SUMMARY = (
    "Discretisation: sensitivity within {relative:.0%}, limit pressure within "
    "{limit:.1%} of a refined mesh (docs/background/contact.md)."
)


class SolidElements(SensorModel):
    """Axisymmetric finite elements with trapped gas and contact."""

    name = "solid"
    holds_flange = True

    def covers(self, sensor: Sensor) -> str | None:
        """Reason why the contact is not axisymmetric, which the solid does not cover, or None if it is."""
        return sensor.protocol.off_axis

    def answer(self, sensors: Sequence[Sensor], driving_pressures: Sequence[Array]) -> list[Answered]:
        """Answers of `solid_result`, one sensor at a time: the paths of each guide those of the next."""
        press = partial(_state, {})
        return one_by_one(lambda *one: ModelAnswer(solid_result(*one, pressed_state=press)), sensors, driving_pressures)

    def filled(self, sensor: Sensor, fillings: Sequence[Filling]) -> tuple[SensorState, ...]:
        """States given by their fillings: `filled_states`."""
        from pneutouch.mechanics.models.filling import filled_states

        return filled_states(sensor, solid_probe(sensor), fillings, partial(_state, {}))

    def stated_error(self, sensor: Sensor) -> float:
        """Relative error of the mesh in sensitivity, which is greater for an object other than a plate."""
        return sensitivity_discretisation(sensor)

    def errors(self, sensor: Sensor, driving_pressures: Array) -> ErrorEstimate:
        """Relative errors of the mesh in sensitivity and limit pressure."""
        error, plate = limit_discretisation(sensor), not (sensor.protocol.body or sensor.protocol.soft)
        relative = self.stated_error(sensor)
        summary = (_SUMMARY if plate else _OBJECT_SUMMARY).format(relative=relative, limit=error)
        return discretised(summary, relative, limit_relative=error)

    def assumptions(self, sensor: Sensor) -> tuple[str, ...]:
        """Assumptions of the solid, with the numbers of waves around the axis that are checked."""
        waves = 0 if sensor.protocol.soft else sensor.protocol.waves
        checked = f"sway and lobes are looked for with up to {waves} waves around the axis" if waves else NOT_CHECKED
        return solid_assumptions(sensor, f"{BODY}; {checked}")


MODEL = SolidElements()


def leaves_law(probe: StrainProbe, run: Inflation, largest: float | None) -> tuple[float, float] | None:
    """Pressure (MPa) and outer apex height (mm) at which free inflation exceeds ``largest``, the stretch in tension up
    to which the law was fitted; None if it does not, or if ``largest`` is None."""
    return None if largest is None else met(probe, run, probe.greatest_tension, largest)


def beyond_law(probe: StrainProbe, pressed: IndentationPath, largest: float | None) -> list[Event]:
    """Event, if any, at which a press exceeds ``largest`` as in `leaves_law`; empty also if ``largest`` is None."""
    if largest is None:
        return []
    tension = [probe.greatest_tension(state.positions / probe.solid.length) for state in pressed.path]
    travel = [max(state.indentation, 0.0) for state in pressed.path]
    beyond = [at for at, stretch in zip(travel, tension, strict=True) if stretch > largest]
    if not beyond:
        return []
    text = f"some of the wall is stretched more than the tested strips: its law was fitted up to {largest:g}"
    return [Event(LAW_RANGE, beyond[0], False, text)]


_DRAWN = 3.0
"""Radius over R0 to which an object is drawn."""

_PAST_LIMIT = 1.6
"""Multiple of the limit point's volume to which inflation continues: enough to show the falling branch."""

KINDS: dict[str, tuple[str, bool]] = {kind: (name, ends) for kind, (name, ends) in data_of(__file__).items()}
"""Reported name of each kind of the solver's events, and True if no figure may be fitted beyond it."""


PressedState = Callable[[Sensor, StrainProbe, FreeState, float], SensorState]
"""Presses a free state at its driving pressure (MPa)."""

_Paths = dict[float, Guides]  # Paths of the last two sensors by driving pressure, MPa.


def solid_result(
    sensor: Sensor,
    driving_pressures: Array,
    *,
    cells: int | None = None,
    past_limit: float = _PAST_LIMIT,
    pressed_state: PressedState | None = None,
) -> ModelResult:
    """Inflate through the limit point, then press at every driving pressure (MPa, ascending).

    ``cells`` is the number of cells along the arc; None: by wall ratio (docs/background/accuracy.md) and object.
    ``past_limit`` is the multiple of the limit point's volume to which inflation goes on; 1 is enough for the figures.
    ``pressed_state`` presses one free state; None: the axisymmetric solid does.
    Raises BeyondLimitError beyond the limit point, ComputationError if no equilibrium is found.
    """
    probe, run = _inflated(sensor, cells, past_limit)
    press, lowest = pressed_state or partial(_state, {}), min(driving_pressures, default=0.0)
    emptied = Inflation([], None, "")
    if lowest < 0.0:
        from pneutouch.mechanics.models.filling import emptied_to

        emptied = emptied_to(sensor, probe.solid, lowest)
    at = driving_pressures.tolist()
    states = tuple(press(sensor, probe, state_at(probe.solid, p, emptied if p < 0.0 else run), p) for p in at)
    curve = _inflation(probe.solid, replace(run, states=[*emptied.states[:0:-1], *run.states]))
    limits = replace(_limits(sensor, probe, run), vacuum=None if emptied.limit is None else emptied.limit.pressure)
    return ModelResult(_limit_point(sensor, run), limits, curve, states)


@lru_cache(maxsize=1)
def _inflated(sensor: Sensor, cells: int | None, past_limit: float) -> tuple[StrainProbe, Inflation]:
    """Probe and inflation for `solid_result`; kept for further driving pressures of the same sensor."""
    probe = solid_probe(sensor, cells)
    return probe, inflate(probe.solid, past_limit=past_limit)


def solid_states(sensor: Sensor, driving_pressures: Array) -> tuple[SensorState, ...]:
    """The states of `solid_result` only: inflation goes no further than to the highest driving pressure (MPa).

    The stability around the axis, which changes no figure, is not checked.
    """
    sensor = sensor.replace(waves=0)
    probe = solid_probe(sensor)
    run = inflate(probe.solid, to_pressure=float(np.max(driving_pressures)))
    return tuple(_state({}, sensor, probe, state_at(probe.solid, p, run), p) for p in driving_pressures.tolist())


def solid_probe(sensor: Sensor, cells: int | None = None) -> StrainProbe:
    """Probe of the strains of the sensor's wall, with its finite elements; ``cells`` as in `solid_result`."""
    shape, flange, cells = sensor.dome.shape, sensor.dome.flange, cells or object_cells(sensor)
    if flange is None:
        mesh = dome(shape, arc=cells)
    else:
        from pneutouch.mechanics.solid.flange import printed_dome

        mesh = printed_dome(shape, *flange, arc=cells)
    return StrainProbe(SolidModel(mesh, sensor.wall.hyperelastic, grade=_grade(sensor), base=_base(sensor)))


def _base(sensor: Sensor) -> RigidBase | None:
    """Rigid base for the solid (None without one); the outer wall meets it outside a printed flange, or a wall that
    leans at its rim and can be pressed below the base plane."""
    dome, shape = sensor.dome, sensor.dome.shape
    leans = shape.floor < 0.0
    if dome.base is None or (dome.flange is None and not leans):
        return dome.base
    wide = 0.0 if dome.flange is None else dome.flange[0]
    return replace(dome.base, flange=shape.outer_radius + wide)


def _grade(sensor: Sensor) -> Callable[[Array, Array], Array] | None:
    """Function that gives the relative modulus at positions (r, z), R0; None for a homogeneous wall."""
    if sensor.wall.grade is None:
        return None
    arc, relative = np.array(sensor.wall.grade[0]), np.array(sensor.wall.grade[1])
    return lambda radius, height: np.interp(sensor.dome.shape.arc_share_scaled(radius, height), arc, relative)


def _limit_point(sensor: Sensor, run: Inflation) -> LimitPoint | None:
    if run.limit is None:
        return None
    inner, outer = run.limit.inner_apex, run.limit.outer_apex
    return LimitPoint(inner, outer, run.limit.pressure, (outer - inner) / sensor.dome.wall_thickness)


def _inflation(solid: SolidModel, run: Inflation) -> InflationCurve:
    """Inflation curve on Hermite cubics over the volume, through the solved states with their slopes."""
    volume = run.volume
    grid = distinct(np.concatenate([np.linspace(volume[0], volume[-1], 90), volume]))

    def along(values: list[float], slopes: list[float]) -> Array:
        return hermite(grid, volume, np.array(values), np.array(slopes))

    def apex(node: int) -> list[float]:
        # Positions by volume are nondimensional: R0 over R0 cubed.
        return [float(s.by_volume[node, 1]) / solid.length**2 for s in run.states]

    inner = along([s.inner_apex for s in run.states], apex(solid.mesh.inner_apex))
    outer = along([s.outer_apex for s in run.states], apex(solid.mesh.outer_apex))
    pressure = along([s.pressure for s in run.states], [s.stiffness for s in run.states])
    return InflationCurve(inner, outer, grid, pressure)


def _limits(sensor: Sensor, probe: StrainProbe, run: Inflation) -> Limits:
    """Driving pressures at which the limits are met on the rising branch of the inflation curve."""
    rupture = None if sensor.wall.break_stretch is None else burst(probe, run, sensor.wall.break_stretch - 1)
    broken, left = (_rising(run, place) for place in (rupture, leaves_law(probe, run, sensor.wall.largest_stretch)))
    return Limits(
        limit_point=None if run.limit is None else run.limit.pressure,
        break_strain=broken,
        gauge=sensor.gas.gauge_limit,
        law_range=left,
    )


def _rising(run: Inflation, place: tuple[float, float] | None) -> float | None:
    """Pressure (MPa) of a place (pressure, outer apex height); None for None or a place beyond the limit point."""
    if place is None or (run.limit is not None and place[1] > run.limit.outer_apex):
        return None
    return place[0]


def press_settings(sensor: Sensor) -> PressSettings:
    """Settings of the sensor's test for the solid."""
    test, gas, stretch = sensor.protocol, sensor.gas, sensor.wall.break_stretch
    return PressSettings(
        depth=test.depth,
        steps=test.steps,
        plate_diameter=2 * test.plate_radius,
        plate_rim=test.plate_rim,
        body=test.body,
        soft=test.soft,
        friction=test.friction,
        ambient=gas.ambient_pressure,
        dead_volume=gas.dead_volume,
        gauge_range=gas.gauge_limit,
        break_strain=np.inf if stretch is None else stretch - 1,
        waves=test.waves,
    )


def _state(guides: _Paths, sensor: Sensor, probe: StrainProbe, free: FreeState, pressure: float) -> SensorState:
    """State at a driving pressure (MPa), pressed from ``free``; ``guides`` at it lead the path, which joins them."""
    test, press = sensor.protocol, press_settings(sensor)
    if press.soft is None:
        pressed = indent(probe.solid, free, press, probe, guides.get(pressure, ()))
    else:
        # Most objects are rigid: the modules of soft ones are loaded only here.
        from pneutouch.mechanics.soft.press import soft_press

        pressed = soft_press(probe.solid, free, press, press.soft, probe)
    guides[pressure] = [pressed.solved, *guides.get(pressure, ())[:1]]
    unfitted = beyond_law(probe, pressed, sensor.wall.largest_stretch)
    happened = sorted(
        [*reported_events(pressed.events, domed=sensor.dome.shape.domed), *unfitted],
        key=lambda event: event.indentation,
    )
    end = min(range_end(happened, test.depth), pressed.path[-1].indentation)
    grid = np.linspace(0.0, end, test.steps + 1)
    force, rise = curve_between(pressed.path, grid)
    body = first_touch(probe.solid, free, press.body, press.plate_diameter, press.plate_rim).body
    last = max((s for s in pressed.path if s.indentation <= end * (1 + 1e-9)), key=lambda s: s.indentation)
    section = partial(_section, press.body, body.height, probe.solid.length)
    face = partial(_face, sensor, probe.solid.mesh, body, last.positions, last.indentation)
    if pressed.undersides:
        section = partial(_yielded, pressed, probe.solid.length)
    return SensorState(
        pressure,
        *free_figures(free),
        end,
        figures(grid, force, rise / KPA),
        *pressed_columns(pressed),
        max_von_mises=pressed.column("von_mises"),
        events=tuple(happened),
        shapes=_shapes(probe, free, last, section),
        walls=_walls(probe.solid.mesh, pressed, section),
        face=None if pressed.undersides else face,
    )


def free_figures(free: FreeState) -> tuple[float, float, float]:
    """Heights of the apex inside and outside (mm) and volume (mm3) of the inflated dome, as in `SensorState`."""
    return free.inner_apex, free.outer_apex, free.volume


def pressed_columns(pressed: "IndentationPath | OffAxisPath") -> tuple[Array, Array, Array, Array, Array]:
    """Indentation, force, pressure rise, contact radius and greatest stretch of a press, as in `SensorState`."""
    column = pressed.column
    return column("indentation"), column("force"), column("rise"), column("contact_radius"), column("stretch")


def reported_events(events: list[SolidEvent], *, domed: bool = True) -> list[Event]:
    """The solver's events with their reported names, in the order of indentation; a face that is not ``domed`` is
    touched in a ring from the start or soon, which ends no range."""
    kinds = {"separation": "hollow"} if not domed else {}
    named = [(*KINDS[kinds.get(e.kind, e.kind)], e) for e in events]
    reported = [Event(name, max(e.indentation, 0.0), ends, e.detail) for name, ends, e in named]
    return sorted(reported, key=lambda event: event.indentation)


def curve_between(path: "Sequence[PressState] | Sequence[OffAxisState]", grid: Array) -> tuple[Array, Array]:
    """Force (N) and pressure rise (MPa) at indentations ``grid`` (n,; mm), on Hermite cubics through solved states."""
    x = np.array([s.indentation for s in path])
    keep = np.concatenate([[True], np.diff(x) > 1e-9])
    x, states = x[keep], [path[k] for k in np.flatnonzero(keep).tolist()]
    force, rise = np.array([s.force for s in states]), np.array([s.rise for s in states])
    stiffness = np.array([s.stiffness for s in states])
    rate = np.nan_to_num(np.array([s.slope for s in states])) * stiffness
    if x.size == 1:
        return np.full(grid.shape, force[0]), np.full(grid.shape, rise[0])
    return hermite(grid, x, force, stiffness), hermite(grid, x, rise, rate)


def _face(sensor: Sensor, mesh: SolidMesh, body: Indenter, positions: Array, indentation: float) -> "PressedFace":
    """Pressed outer wall for drawing, at positions (n_nodes, 2), mm, under an object that is given at first contact and
    lowered by an indentation (mm)."""
    # To draw in space, the wall is enough: nothing is solved here.
    from pneutouch.mechanics.harmonic.fields import Harmonics
    from pneutouch.mechanics.harmonic.object_contact import pressed_face
    from pneutouch.mechanics.harmonic.surface import PlacedObject

    solid = SolidModel(mesh, sensor.wall.hyperelastic, grade=_grade(sensor))
    placed = PlacedObject(body.at(body.height - indentation / solid.length))
    return pressed_face(solid, Harmonics(0), positions, placed, indentation)


_Section = Callable[[float | None], Array | None]  # Section of the object, (k, 2; mm), at an indentation.


def _shapes(probe: StrainProbe, free: FreeState, last: PressState, section: _Section) -> tuple[DeformedShape, ...]:
    """Shapes of the wall at rest, inflated, and pressed to the end of the range."""
    length = probe.solid.length
    positions = [(None, probe.solid.rest * length), (0.0, free.positions), (last.indentation, last.positions)]
    return tuple(
        DeformedShape(at, probe.outlines(x), probe.cell_stretch(x / length), section(at)) for at, x in positions
    )


def _walls(mesh: SolidMesh, pressed: IndentationPath, section: _Section) -> WallPath:
    """Both faces of the wall at every solved state."""
    positions = np.stack([state.positions for state in pressed.path])
    sections = (section(state.indentation) for state in pressed.path)
    return WallPath(
        indentation=np.array([state.indentation for state in pressed.path]),
        inner=positions[:, nodes_along(mesh.inner)],
        outer=positions[:, nodes_along(mesh.outer)],
        objects=tuple(section for section in sections if section is not None),
    )


def _yielded(pressed: IndentationPath, length: float, at: float | None) -> Array | None:
    """Section of a soft object at an indentation, from its surface at the nearest state of a press."""
    if at is None:
        return None
    nearest = int(np.abs(pressed.column("indentation") - at).argmin())
    return pressed.undersides[nearest].outline(_DRAWN * length)


def _section(body: "RigidObject | None", start: float, length: float, at: float | None) -> Array | None:
    """Section of a ``body`` at an indentation, from its height at first contact over ``length``; None for a plate."""
    return None if body is None or at is None else body.at(start * length - at).outline(_DRAWN * length)
