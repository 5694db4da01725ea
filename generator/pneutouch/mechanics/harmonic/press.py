"""Press by an object that comes straight down on an inflated dome, off its axis or leaning, and can then move sideways.

Also the greatest stretch on the faces of a wall without rotational symmetry, and the curves of such a press in a
prediction.
"""

from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.mechanics.events import BASE_SHARE, DETAIL, OBJECT_EDGE, OVERHANG, PathPoint, SolidEvent, crossing
from pneutouch.mechanics.harmonic.fields import FieldGroup, FieldOperator, Harmonics
from pneutouch.mechanics.harmonic.friction_path import ShearPath, SurfaceFrictionFollower, held_back, not_sheared, shear
from pneutouch.mechanics.harmonic.model import ContactNewton, Foreseen, HarmonicModel
from pneutouch.mechanics.harmonic.object_contact import HarmonicContact, PressedFace, X, Y, pressed_face
from pneutouch.mechanics.harmonic.surface import ProfiledObject, Surface, first_height
from pneutouch.mechanics.solid.continuation import PathFollower, PathJump, PlateState, descend
from pneutouch.mechanics.solid.elements import F_RR, F_RZ, HOOP, RADIAL
from pneutouch.mechanics.solid.indent import PressSettings, shut_in
from pneutouch.mechanics.solid.inflate import FreeState
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import NewtonFailure, NewtonResult, SolidScene, minimise
from pneutouch.mechanics.solid.stress import StrainProbe


class HarmonicProbe:
    """Stretches at the stations of a `StrainProbe` and at angles from one side of the plane of symmetry to the other,
    or from one plane to the other if there are two."""

    def __init__(self, model: HarmonicModel, probe: StrainProbe) -> None:
        cells = model.mesh.cells
        waves, span = model.harmonics.waves, np.pi / model.harmonics.stride
        angles = np.linspace(0.0, span, 2 * waves + 1) if waves else np.zeros(1)
        self._values, self._turned = model.harmonics.values(angles), model.harmonics.turned(angles)
        self._stations = self._gradients(probe.operator.reshape(len(cells), -1, 5, probe.operator.shape[-1]), cells)
        self._edges = self._gradients(probe.edge_operator[:, None], cells[probe.edge_cells])
        self._far = probe.far

    def _gradients(self, strains: Array, cells: Index) -> FieldOperator:
        shapes = (strains[:, :, row, RADIAL] for row in (F_RR, F_RZ, HOOP))
        rows = (self._values, self._values, self._turned)
        groups = [FieldGroup(shape, row) for shape, row in zip(shapes, rows, strict=True)]
        return FieldOperator(groups, cells, np.ones((int(cells.max()) + 1, self._values.shape[2])))

    def greatest_stretch(self, x: Array) -> float:
        """Greatest principal stretch over both faces, away from the clamp, for coefficients x (n_nodes, columns)."""
        stations = self._stations.fields(x)
        far = stations.reshape(-1, *stations.shape[2:])[self._far].reshape(-1, 3, 3)
        f = np.concatenate([far, self._edges.fields(x).reshape(-1, 3, 3)])
        # The greatest singular value by the greatest eigenvalue of the right Cauchy-Green tensor.
        return float(np.sqrt(np.linalg.eigvalsh(np.matmul(f, np.swapaxes(f, 1, 2)))[:, -1].max()))


_ALONG = 33
"""Number of points of every edge of the outer wall at which an object may touch first."""


_UPPER = 0.5
"""Share of the inner wall's height over the floor above which it is watched for reaching the floor."""


@dataclass(frozen=True)
class OffAxisState:
    """One equilibrium; mm, N, MPa. Fields that are not listed are as in `indent.PressState`.

    force, sideways: of the wall on the object, upwards and along x, the direction of angle 0. moment: of the wall on
    the object about the y axis through the centre of the base plane, N mm: the sum of z times the force along x minus x
    times the force upwards. contact_radius, object_distance: greatest horizontal distance of a touching point from the
    centre of the contact forces, and from the object's axis. inner_height: least height of the upper inner wall.
    positions: coefficients, see `fields.Harmonics`."""

    indentation: float
    force: float
    sideways: float
    moment: float
    pressure: float
    rise: float
    volume: float
    contact_radius: float
    contact_pressure: float
    object_distance: float
    stiffness: float
    slope: float
    stretch: float
    penetration: float
    inner_height: float
    overhang: float
    base_force: float
    positions: Array


@dataclass(frozen=True)
class OffAxisPath:
    """States at the steps of the protocol, all solved states and events, as in `indent.IndentationPath`, with harmonics
    to ``order``; ``shear``: path of the object's sideways motion after the press, None without it."""

    order: int
    states: list[OffAxisState]
    path: list[OffAxisState]
    events: list[SolidEvent]
    complete: bool
    shear: ShearPath | None = None

    def column(self, name: str) -> Array:
        """The field ``name`` of every state, (n_states,)."""
        return np.array([getattr(s, name) for s in self.states])


class OffAxisFollower(PathFollower):
    """A `PathFollower` that predicts the touching points from the last state."""

    def _least(self, scene: SolidScene, x: Array) -> NewtonResult | NewtonFailure:
        # Without harmonics the steps are the solid's, and with them the last digits of its figures.
        if x.shape[1] == 2:
            return super()._least(scene, x)
        return minimise(scene, x, find=ContactNewton(self._foreseen(scene)))

    def _foreseen(self, scene: SolidScene) -> Foreseen | None:
        """Points that will touch and their tractions, predicted with the last state's rates; None without contact."""
        here, contact = self.here, scene.solid.contact
        touch = here.state.touch
        assert touch is not None and scene.plate is not None
        down = scene.plate.height - here.height
        ahead = -contact.stiffness * (touch.gap + contact.opening(touch, down * here.by_height, down))
        touching = touch.traction > 0.0
        if not touching.any():
            return None
        return Foreseen(ahead > 0.0, np.where(touching, np.maximum(ahead, 0.0), 0.0))


class OffAxisPress:
    """Presses of one dome from one free state by one object, with any number of harmonics.

    ``surface`` is the object in R0 at any height; ``press`` is as for the axisymmetric solid, its object is not used.
    ``travel``: sideways displacement of the object after the press, mm; without friction it must be 0 (ValueError).
    ``symmetric``: True if the plane across that of the offset is one of symmetry too: even harmonics suffice."""

    def __init__(
        self,
        solid: SolidModel,
        free: FreeState,
        press: PressSettings,
        surface: Surface,
        probe: StrainProbe,
        travel: float = 0.0,
        symmetric: bool = False,
    ) -> None:
        if travel and not press.friction:
            raise ValueError("without friction an object that moves sideways slides off")
        self._travel, self._stride = travel, 2 if symmetric else 1
        self._solid, self._free, self._press, self._probe = solid, free, press, probe
        self._gas = shut_in(solid, free, press)
        floor, pole = solid.mesh.floor / solid.length, float(solid.rest[solid.mesh.inner_apex, 1])
        self._watched = floor + _UPPER * (pole - floor)
        outline = solid.contact.outline(free.positions / solid.length, _ALONG)
        self.surface = surface.at(first_height(surface, outline))

    def run(self, order: int) -> OffAxisPath:
        """Press with harmonics to ``order``, and move the object sideways after that if ``travel`` is not 0.

        Raises NoConvergenceError if there is no equilibrium at first contact.
        """
        model, press, start = self._model(order), self._press, self.surface.height
        probe = HarmonicProbe(model, self._probe)
        follower = self._follower(model)
        states = [self._state(model, probe, follower.here)]
        events, jump = self._events(states[0], states[0]), None
        for k in range(1, press.steps + 1):
            begun = len(follower.path)
            jump = descend(follower, start - press.depth / model.length * k / press.steps)
            for plate_state in follower.path[begun:]:
                if not self._ended(events):
                    states.append(self._state(model, probe, plate_state))
                    events += self._events(states[-2], states[-1])
            if jump is not None or self._ended(events):
                break
        pressed = self._finish(order, states, events, jump)
        return replace(pressed, shear=self._shear(follower, pressed)) if self._travel else pressed

    def _shear(self, follower: PathFollower, pressed: OffAxisPath) -> ShearPath:
        """Path of the object's sideways motion after a complete press; without states after an incomplete one."""
        assert isinstance(follower, SurfaceFrictionFollower)
        return shear(follower, self._travel, self._free.pressure) if pressed.complete else not_sheared()

    def coarser(self, order: int, states: list[OffAxisState]) -> list[tuple[float, float]] | None:
        """Force (N) and pressure rise (MPa) at ``states``, solved again from them with the fewer harmonics of
        ``order``; None if one has no equilibrium. Only without friction: with it, a state depends on those before it.
        """
        model, out = self._model(order), []
        for state in states:
            plate = self.surface.at(self.surface.height - state.indentation / model.length)
            start = state.positions[:, : model.harmonics.columns] / model.length
            solved = minimise(SolidScene(model, self._gas, plate), start, find=ContactNewton())
            if isinstance(solved, NewtonFailure):
                return None
            touch, filling = solved.state.touch, solved.state.filling
            assert touch is not None
            force = float(np.vdot(model.contact.weight, touch.traction)) * model.mu * model.length**2
            out.append((force, filling.pressure * model.mu - self._free.pressure))
        return out

    def _model(self, order: int) -> HarmonicModel:
        return HarmonicModel(self._solid, order, self._stride)

    def face(self, pressed: OffAxisPath, end: float) -> PressedFace:
        """The outer wall at the end of the sideways motion, without one at the last state up to indentation ``end``."""
        solid, length, sums = self._solid, self._solid.length, Harmonics(pressed.order, self._stride)
        last = max((s for s in pressed.path if s.indentation <= end * (1.0 + 1e-9)), key=lambda s: s.indentation)
        placed = self.surface.at(self.surface.height - last.indentation / length)
        assert isinstance(placed, ProfiledObject)
        if pressed.shear is None or not pressed.shear.states:
            return pressed_face(solid, sums, last.positions, placed, last.indentation)
        slid = pressed.shear.states[-1]
        placed = replace(placed, offset=placed.offset + slid.travel / length)
        return pressed_face(solid, sums, slid.positions, placed, last.indentation, slid.travel)

    def _follower(self, model: HarmonicModel) -> PathFollower:
        """The follower of the press, at first contact."""
        start, friction = model.harmonics.lifted(self._free.unit.x), self._press.friction
        if friction:
            return SurfaceFrictionFollower(model, self._gas, self.surface, start, friction)
        return OffAxisFollower(model, self._gas, self.surface, start)

    def _ended(self, events: list[SolidEvent]) -> bool:
        """True if an event ends the press: the inner wall reaches the base plane where the solid has no base."""
        return self._solid.base is None and any(e.kind == "floor" for e in events)

    def _finish(
        self, order: int, states: list[OffAxisState], events: list[SolidEvent], jump: PathJump | None
    ) -> OffAxisPath:
        if jump is not None:
            where = (self.surface.height - jump.height) * self._solid.length
            events = [*events, SolidEvent(jump.kind, where, jump.why)]
        step = self._press.depth / self._press.steps
        at_steps = [s for s in states if abs(s.indentation / step - round(s.indentation / step)) < 1.0e-9]
        return OffAxisPath(order, at_steps, states, events, len(at_steps) == self._press.steps + 1)

    def _state(self, model: HarmonicModel, probe: HarmonicProbe, plate_state: PlateState) -> OffAxisState:
        x, touch, filling = plate_state.state.x, plate_state.state.touch, plate_state.state.filling
        contact = model.contact
        assert touch is not None and isinstance(contact, HarmonicContact)
        length, mu = model.length, model.mu
        base = model.base_load(x)
        (sideways, _, force), moment = contact.resultant(x, touch, held_back(plate_state))
        touching = touch.traction > 0.0
        place = contact.points(x)[touching]
        middle = contact.middle(x, touch)
        slope = plate_state.pressure_rate / plate_state.stiffness / length**2 if plate_state.stiffness else np.nan
        here = self.surface.at(plate_state.height)
        return OffAxisState(
            indentation=(self.surface.height - plate_state.height) * length,
            force=force * mu * length**2,
            sideways=sideways * mu * length**2,
            moment=moment[1] * mu * length**3,
            pressure=filling.pressure * mu,
            rise=filling.pressure * mu - self._free.pressure,
            volume=plate_state.state.volume * length**3,
            contact_radius=float(np.hypot(place[:, X] - middle, place[:, Y]).max(initial=0.0)) * length,
            contact_pressure=float(touch.traction.max()) * mu,
            object_distance=float(here.distance(place[:, X], place[:, Y]).max(initial=0.0)) * length,
            stiffness=-plate_state.stiffness * mu * length,
            slope=slope,
            stretch=probe.greatest_stretch(x),
            penetration=max(base.penetration, -float(touch.gap.min())) * length,
            inner_height=model.lowest(x, model.mesh.inner, self._watched) * length,
            overhang=max(0.0, self._solid.bottom - model.lowest(x, model.mesh.outer)) * length,
            base_force=base.force * mu * length**2,
            positions=x * length,
        )

    def _events(self, a: OffAxisState, b: OffAxisState) -> list[SolidEvent]:
        """Events whose levels are crossed between the consecutive states a and b."""
        press, wall = self._press, self._solid.mesh.wall
        levels = {
            "gauge_range": press.gauge_range,
            "break": press.break_strain,
            OBJECT_EDGE: self.surface.span[1] * self._solid.length,
            "floor": -self._solid.mesh.floor,
            "overhang": OVERHANG * wall,
            "base": BASE_SHARE,
        }
        before, after = _watched(a), _watched(b)
        places = {kind: crossing(before[kind], after[kind], level) for kind, level in levels.items()}
        return [SolidEvent(kind, where, DETAIL[kind]) for kind, where in places.items() if where is not None]


def _watched(s: OffAxisState) -> dict[str, PathPoint]:
    """Quantities of one state whose levels define events, by kind of event."""
    rate = s.slope * s.stiffness if np.isfinite(s.slope) else None
    return {
        "gauge_range": PathPoint(s.indentation, s.pressure, rate),
        "break": PathPoint(s.indentation, s.stretch - 1.0),
        OBJECT_EDGE: PathPoint(s.indentation, s.object_distance),
        "floor": PathPoint(s.indentation, -s.inner_height),
        "overhang": PathPoint(s.indentation, s.overhang),
        "base": PathPoint(s.indentation, s.base_force / max(s.force, 1.0e-300)),
    }


@dataclass(frozen=True, slots=True)
class ShearCurve:
    """Sideways motion of the object at constant height: `harmonic.friction_path.ShearPath` with its states as arrays of
    one length (mm, N, N mm, MPa); ``travel`` and ``sideways`` are positive towards the offset."""

    travel: Array
    force: Array
    sideways: Array
    moment: Array
    rise: Array
    sliding: Array
    stiffness: float | None
    peak: float | None
    slips_from: float | None
    ended: str | None

    def scaled(self, force: float, rise: float) -> "ShearCurve":
        """The curve with forces, moment and stiffness times ``force``, and pressure rise times ``rise``."""
        return replace(
            self,
            force=force * self.force,
            sideways=force * self.sideways,
            moment=force * self.moment,
            rise=rise * self.rise,
            stiffness=None if self.stiffness is None else force * self.stiffness,
            peak=None if self.peak is None else force * self.peak,
        )


@dataclass(frozen=True, slots=True)
class RangeCurve:
    """A loading curve at equal steps from first contact to the end of its range (arrays of one length, mm, N, MPa), on
    Hermite cubics through the solved states and their slopes."""

    indentation: Array
    force: Array
    rise: Array


@dataclass(frozen=True, slots=True)
class OffAxisCurve:
    """Additions to a loading curve for contact off the axis: sideways force and moment at its points (N, N mm; see
    `OffAxisState`), ``order`` of the harmonics, relative change ``last_change`` of the figures when it
    was last raised. ``to_end`` is the curve to the end of its range; ``shear`` is None without sideways motion."""

    order: int
    last_change: float
    sideways: Array
    moment: Array
    to_end: RangeCurve
    shear: ShearCurve | None = None

    def scaled(self, force: float, rise: float) -> "OffAxisCurve":
        """The curve with forces and moments times ``force``, and pressure rises times ``rise``."""
        sheared = None if self.shear is None else self.shear.scaled(force, rise)
        to_end = replace(self.to_end, force=force * self.to_end.force, rise=rise * self.to_end.rise)
        sideways, moment = force * self.sideways, force * self.moment
        return replace(self, sideways=sideways, moment=moment, to_end=to_end, shear=sheared)
