"""Press by the solid: a plate or another rigid object presses an inflated dome with a fixed amount of gas."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.events import (
    BASE_SHARE,
    BREAKS_CURVE,
    CREASE,
    DETAIL,
    OBJECT_DETAIL,
    OBJECT_EDGE,
    OVERHANG,
    PLATE_RIM,
    SEPARATION,
    PathPoint,
    SolidEvent,
    crossing,
)
from pneutouch.mechanics.response import Figures, figures
from pneutouch.mechanics.solid.continuation import Guides, PathFollower, PathJump, PlateState, descend
from pneutouch.mechanics.solid.elements import Gas
from pneutouch.mechanics.solid.inflate import FirstTouch, FreeState, first_touch
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import SolverState, UnreachableLoadError
from pneutouch.mechanics.solid.object_contact import Footprint, Indenter, Plate
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.mechanics.solid.sway import axisymmetry_losses
from pneutouch.units import KPA

if TYPE_CHECKING:
    from pneutouch.mechanics.soft.body import SoftBody
    from pneutouch.mechanics.solid.indenter import RigidObject

#: A pressure below absolute vacuum by less than this, in mu, is due to rounding.
_ROUNDING = 1.0e-9


@dataclass(frozen=True)
class PressSettings:
    """Settings of a press: depth and plate diameter in mm (None: endless), ambient in MPa, dead volume in mm^3.

    steps:       number of equal plate steps at which states are returned.
    gauge_range: gauge pressure (MPa) beyond which the pressure sensor clips.
    break_strain: largest principal strain (stretch - 1) that the material bears.
    waves: greatest number of waves around the axis for which the path's stability is checked (`sway`); 0: no check.
    plate_rim:   radius of curvature of the plate's rim, mm; None: a thirtieth of the plate's radius.
    body: the object in mm that replaces the plate (its height is ignored); None: the plate. friction: Coulomb's
      coefficient between wall and plate or object; inf for a surface that grips. soft: the object gives way; None: it
      is rigid, and ``body`` or the plate.
    """

    depth: float
    steps: int = 14
    plate_diameter: float | None = 30.0
    ambient: float = 0.101325
    dead_volume: float = 0.0
    gauge_range: float = 0.1
    break_strain: float = np.inf
    friction: float = 0.0
    body: RigidObject | None = None
    plate_rim: float | None = None
    waves: int = 0
    soft: SoftBody | None = None

    def __post_init__(self) -> None:
        finite = np.isfinite([self.depth, self.ambient, self.dead_volume]).all()
        if not (finite and self.depth > 0.0 and self.steps >= 1 and self.ambient >= 0.0 and self.dead_volume >= 0.0):
            raise ValueError("depth and steps must be positive, ambient and dead_volume not negative, all finite")
        if np.isnan(self.gauge_range) or np.isnan(self.break_strain):
            raise ValueError("gauge_range and break_strain must be numbers")
        if self.plate_diameter is not None and not self.plate_diameter > 0.0:
            raise ValueError("plate_diameter must be positive, or None for an endless plate")
        if not self.friction >= 0.0:
            raise ValueError(f"friction {self.friction} must not be negative, or inf for a plate that grips")


@dataclass(frozen=True)
class PressState:
    """One equilibrium under the plate or another object; mm, N, MPa.

    indentation, force, pressure (gauge), rise (over the driving pressure), volume (mm^3).
    contact_radius: outer edge of the contact.  contact_inner: inner edge, 0 if the wall touches on the axis.
    contact_pressure: largest, per area at rest.  inside_gap: largest gap to the object inside the contact, positive
    where the wall has left it.  penetration: largest overlap due to the finite contact stiffness.
    stiffness: dF/d(indentation), N/mm.  slope: dp/dF with the gas shut in, MPa/N.
    stretch, von_mises: largest on the faces away from the clamp; fold: see `stress.WallExtremes`.
    inner_apex: height.  overhang: depth to which the wall hangs below its base plane.  base_force, base_pressure (per
    area at rest): load of the outer wall on base and flange, if the solid has one.  positions: (n_nodes, 2).
    """

    indentation: float
    force: float
    pressure: float
    rise: float
    volume: float
    contact_radius: float
    contact_inner: float
    contact_pressure: float
    inside_gap: float
    stiffness: float
    slope: float
    stretch: float
    von_mises: float
    fold: float
    penetration: float
    inner_apex: float
    overhang: float
    base_force: float
    base_pressure: float
    positions: Array


@dataclass(frozen=True)
class IndentationPath:
    """``states`` at the plate steps (the first at first contact) up to the depth, or to the event that ended the path.

    ``path`` has every state, also between the steps, ``solved`` the solver's. ``complete``: the depth was reached.
    ``undersides``: of a soft object, its surface (mm) at every state of ``path``; empty for a rigid one.
    """

    states: list[PressState]
    path: list[PressState]
    events: list[SolidEvent]
    complete: bool
    solved: Sequence[PlateState] = ()
    undersides: Sequence[RigidObject] = ()

    def column(self, name: str) -> Array:
        """The field ``name`` of every state, (n_states,)."""
        return np.array([getattr(s, name) for s in self.states])

    def figures(self) -> Figures[float] | None:
        """Figures of the states before the first event of `BREAKS_CURVE`; None if these give no straight line."""
        ends = [e.indentation for e in self.events if e.kind in BREAKS_CURVE]
        keep = self.column("indentation") < min(ends, default=np.inf)
        indentation, force, rise = (self.column(name)[keep] for name in ("indentation", "force", "rise"))
        return figures(indentation, force, rise / KPA)


def indent(
    solid: SolidModel, free: FreeState, press: PressSettings, probe: StrainProbe | None = None, guides: Guides = ()
) -> IndentationPath:
    """Shut in the gas at a free state and lower the plate; presses of one solid can share a ``probe``, None: a new one.
    ``guides``: as in `PathFollower`, from presses without friction; they save Newton steps.

    `complete` of the result is False if an event ended the path before the depth. Raises NoConvergenceError only if
    there is no equilibrium at first contact, and UnreachableLoadError for a pressure below absolute vacuum.
    """
    touch = first_touch(solid, free, press.body, press.plate_diameter, press.plate_rim)
    follower, length, plate = follower_of(solid, free, press, touch, guides), solid.length, touch.body
    recorder = PressRecorder(solid, free, touch, probe or StrainProbe(solid))
    states = [recorder.state(follower.here)]
    events = recorder.events(states[0], states[0], press)
    jump: PathJump | None = None
    # No step passes the flange, but by what its event takes: a curve between both sides of it would be neither's.
    lowest = plate.height - max(recorder.to_rim, 0.0) / length - 1.0e-9
    for k in range(1, press.steps + 1):
        begun = len(follower.path)
        jump = descend(follower, max(plate.height - press.depth / length * k / press.steps, lowest))
        for plate_state in follower.path[begun:]:
            if not _ended(events, solid):
                states.append(recorder.state(plate_state))
                events += recorder.events(states[-2], states[-1], press)
        if jump is not None or _ended(events, solid):
            break
    events += recorder.losses(follower.path[: len(states)], press.waves)
    return replace(_finish(states, events, jump, recorder, press), solved=follower.path)


def follower_of(
    solid: SolidModel, free: FreeState, press: PressSettings, touch: FirstTouch, guides: Guides = ()
) -> PathFollower:
    """Path follower of a press, at the first contact ``touch``, with the gas shut in; ``guides`` as in `indent`."""
    gas = shut_in(solid, free, press)
    if press.friction:
        # Most presses have no friction: its modules are loaded only here.
        from pneutouch.mechanics.solid.friction_path import FrictionFollower

        return FrictionFollower(solid, gas, touch.body, free.unit.x, press.friction)
    return PathFollower(solid, gas, touch.body, free.unit.x, guides)


def shut_in(solid: SolidModel, free: FreeState, press: PressSettings) -> Gas:
    """Gas of a free state with its amount fixed, nondimensional. Raises UnreachableLoadError below absolute vacuum."""
    length, mu = solid.length, solid.mu
    if free.pressure + press.ambient < -_ROUNDING * mu:
        raise UnreachableLoadError(free.pressure, -press.ambient, "it lies below absolute vacuum")
    return Gas.filled(free.pressure / mu, free.volume / length**3, press.ambient / mu, press.dead_volume / length**3)


_BESIDE = np.linspace(0.0, 3.0, 301)
"""Distances (R0) beside the wall at which an object is held against the flange."""


def travel_to_rim(solid: SolidModel, body: Indenter) -> float:
    """Travel (R0) of an object from its height at which it meets the flange, or a ring on it; inf without a base."""
    if solid.base is None:
        return np.inf
    beside = solid.rest[solid.mesh.outer[0, 0], 0] + _BESIDE
    return float((body.underside(beside)[0] - solid.base.outer.surface(beside)[0]).min())


def _ended(events: list[SolidEvent], solid: SolidModel) -> bool:
    """True if an event ends the press: the object on the flange, or the inner wall on a floor that is not modelled."""
    return any(e.kind == "rim" or (e.kind == "floor" and solid.base is None) for e in events)


def _finish(
    states: list[PressState],
    events: list[SolidEvent],
    jump: PathJump | None,
    recorder: PressRecorder,
    press: PressSettings,
) -> IndentationPath:
    """Path with the states at the plate steps and, if a jump ended it, with the event of this jump."""
    if jump is not None:
        events = [*events, SolidEvent(jump.kind, recorder.indentation(jump.height), jump.why)]
    step = press.depth / press.steps
    at_steps = [s for s in states if abs(s.indentation / step - round(s.indentation / step)) < 1.0e-9]
    return IndentationPath(at_steps, states, events, len(at_steps) == press.steps + 1)


class PressRecorder:
    """Converts the solver's states to mm, N and MPa, and finds the events between consecutive ones."""

    def __init__(self, solid: SolidModel, free: FreeState, touch: FirstTouch, probe: StrainProbe) -> None:
        self._solid, self._free, self._probe = solid, free, probe
        self._plate, self._first = touch
        # A first contact within an edge length of the axis counts as contact on the axis.
        self._annular = touch.radius > solid.contact.longest
        self._edge = PLATE_RIM if isinstance(self._plate, Plate) else OBJECT_EDGE
        self.to_rim = travel_to_rim(solid, self._plate) * solid.length

    def indentation(self, height: float) -> float:
        """Plate travel (mm) since first contact at a nondimensional height."""
        return (self._plate.height - height) * self._solid.length

    def state(self, plate_state: PlateState) -> PressState:
        """A converged state of the solver in mm, N and MPa."""
        solid, x, touch = self._solid, plate_state.state.x, plate_state.state.touch
        assert touch is not None
        foot = solid.contact.footprint(x, touch, self._annular)
        if foot.traction == 0.0:
            foot = Footprint(self._first, 0.0, 0.0, self._first if self._annular else 0.0)
        stiffness = -plate_state.stiffness
        slope = -plate_state.pressure_rate / stiffness if stiffness else np.nan
        state = self.balanced(plate_state.state, foot, plate_state.force, stiffness, slope)
        deep = max(state.penetration, -float(touch.gap.min()) * solid.length)
        return replace(state, indentation=self.indentation(plate_state.height), penetration=deep)

    def balanced(self, state: SolverState, foot: Footprint, force: float, stiffness: float, slope: float) -> PressState:
        """A state under an object that touches it at ``foot``, with its force and the slopes of force and pressure, all
        nondimensional, in mm, N and MPa at the indentation 0."""
        solid, x = self._solid, state.x
        length, mu = solid.length, solid.mu
        base, peak = solid.base_load(x), self._probe.peak(x)
        pressure = state.filling.pressure * mu
        return PressState(
            indentation=0.0,
            force=force * mu * length**2,
            pressure=pressure,
            rise=pressure - self._free.pressure,
            volume=state.volume * length**3,
            contact_radius=foot.radius * length,
            contact_inner=foot.inner * length,
            contact_pressure=foot.traction * mu,
            inside_gap=foot.inside_gap * length,
            stiffness=stiffness * mu * length,
            slope=slope / length**2,
            stretch=peak.stretch,
            von_mises=peak.von_mises,
            fold=peak.fold,
            penetration=base.penetration * length,
            inner_apex=float(x[solid.mesh.inner_apex, 1]) * length,
            overhang=max(0.0, float((solid.bottom - x[:, 1]).max()) * length),
            base_force=base.force * mu * length**2,
            base_pressure=base.traction * mu,
            positions=x * length,
        )

    def events(self, a: PressState, b: PressState, press: PressSettings) -> list[SolidEvent]:
        """Events whose levels are crossed between the consecutive states a and b."""
        wall = self._solid.mesh.wall
        inner, outer = (edge * self._solid.length for edge in self._plate.span)
        levels = {
            "gauge_range": press.gauge_range,
            "break": press.break_strain,
            "crease": CREASE,
            "separation": SEPARATION * wall,
            self._edge: outer,
            "floor": -self._solid.mesh.floor,
            "overhang": OVERHANG * wall,
            "base": BASE_SHARE,
            "rim": self.to_rim,
        }
        before, after = _watched(a, self._edge), _watched(b, self._edge)
        places = {kind: crossing(before[kind], after[kind], level) for kind, level in levels.items()}
        if self._annular and places[self._edge] is None:
            begun, ended = (PathPoint(s.indentation, -s.contact_inner) for s in (a, b))
            places[self._edge] = crossing(begun, ended, -inner)
        detail = DETAIL if self._edge == PLATE_RIM else OBJECT_DETAIL
        return [SolidEvent(kind, where, detail[kind]) for kind, where in places.items() if where is not None]

    def losses(self, path: list[PlateState], waves: int) -> list[SolidEvent]:
        """Events at which the axisymmetric path loses its stability to 1 to ``waves`` waves around the axis."""
        lost = axisymmetry_losses(self._solid, path, waves) if waves else []
        kinds = ["sway" if loss.waves == 1 else "lobes" for loss in lost]
        return [
            SolidEvent(kind, self.indentation(loss.height), DETAIL[kind].format(waves=loss.waves))
            for kind, loss in zip(kinds, lost, strict=True)
        ]


def _watched(s: PressState, edge: str) -> dict[str, PathPoint]:
    """Quantities of one state whose levels define events, by kind of event; ``edge`` is that of the object's edge."""
    rate = s.slope * s.stiffness if np.isfinite(s.slope) else None
    return {
        "gauge_range": PathPoint(s.indentation, s.pressure, rate),
        "break": PathPoint(s.indentation, s.stretch - 1.0),
        "crease": PathPoint(s.indentation, s.fold),
        "separation": PathPoint(s.indentation, s.inside_gap),
        edge: PathPoint(s.indentation, s.contact_radius),
        "floor": PathPoint(s.indentation, -s.inner_apex),
        "overhang": PathPoint(s.indentation, s.overhang),
        "base": PathPoint(s.indentation, s.base_force / max(s.force, 1.0e-300)),
        "rim": PathPoint(s.indentation, s.indentation, 1.0),
    }
