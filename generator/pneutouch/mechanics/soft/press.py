"""Press by a soft object: at every step wall and object are in balance (`coupled`), up to the strain of the object for
which linear elasticity is taken."""

from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import InputError
from pneutouch.mechanics.events import DETAIL, SolidEvent
from pneutouch.mechanics.soft.body import RingCompliance, SoftBody
from pneutouch.mechanics.soft.coupled import SoftScene, SoftState, balance
from pneutouch.mechanics.solid.continuation import LONGEST
from pneutouch.mechanics.solid.indent import IndentationPath, PressRecorder, PressSettings, shut_in
from pneutouch.mechanics.solid.indenter import RigidObject, UndersidePiece
from pneutouch.mechanics.solid.inflate import FreeState, first_touch
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import NoConvergenceError
from pneutouch.mechanics.solid.object_contact import Footprint
from pneutouch.mechanics.solid.stress import StrainProbe

STRAINED = 0.5
"""Greatest deflection of the object's surface over the radius of the contact (of a layer also over its thickness) for
which linear elasticity is taken: up to it force and rise are as docs/background/contact.md states against CalculiX
with a neo-Hookean object."""

_SHORTEST = 1e-3
"""Shortest step, R0, before the path counts as lost."""

_DRAWN, _CORNERS = 4.0, 80
"""Greatest radius, over the dome's, to which a deformed surface is drawn, and its corners."""


@dataclass(frozen=True)
class SoftPoint:
    """A balance in mm, N and MPa: force, rise; mean deflection of the object's surface under the force (``lift``, mm),
    and that over the greatest that linear elasticity is taken for (``strain``)."""

    force: float
    rise: float
    lift: float
    strain: float


class SoftPress:
    """Presses of one free dome by one soft object, from first contact on."""

    def __init__(self, solid: SolidModel, free: FreeState, press: PressSettings, body: SoftBody) -> None:
        self.solid, self.free, self.body = solid, free, body
        self.touch = first_touch(solid, free, press.body, press.plate_diameter, press.plate_rim)
        self.scene = SoftScene(solid, shut_in(solid, free, press), body, self.touch.body)
        self._last: SoftState | None = None

    def to(self, travel: float) -> SoftState | None:
        """Balance at a travel (mm) beyond the last one; None if the path is lost before."""
        goal, step = travel / self.solid.length, LONGEST
        points = np.zeros(self.scene.points.weight.shape)
        while True:
            here = self._last
            at = 0.0 if here is None else here.travel
            ahead = min(step, goal - at)
            start = self.free.unit.x if here is None else here.state.x + ahead * here.by_travel
            found = balance(self.scene, at + ahead, start, points if here is None else here.forces)
            if found is None and here is not None:
                found = balance(self.scene, at + ahead, here.state.x, here.forces)
            if found is None:
                step = 0.5 * ahead
                if step < _SHORTEST:
                    return None
                continue
            self._last = found
            if found.travel >= goal * (1.0 - 1e-12):
                return found

    def point(self, found: SoftState) -> SoftPoint:
        """A balance in mm, N and MPa."""
        solid, body = self.solid, self.body
        forces = self._forces(found)
        lift = float(forces @ self._rings(found).matrix @ forces / forces.sum())
        radius = float(found.radii[found.forces > 0.0].max()) * solid.length
        across = radius if body.thickness is None else min(radius, body.thickness)
        rise = found.state.filling.pressure * solid.mu - self.free.pressure
        return SoftPoint(float(forces.sum()), rise, lift, lift / across / STRAINED)

    def _forces(self, found: SoftState) -> Array:
        return np.asarray(found.forces[found.forces > 0.0] * self.solid.mu * self.solid.length**2)

    def _rings(self, found: SoftState, reach: float = 0.0) -> RingCompliance:
        """Rings of the touching points, for places within a reach (R0), at least the contact."""
        touching = (found.forces > 0.0).ravel()
        return self.scene.rings(found.radii, touching, max(reach, float(found.radii[found.forces > 0.0].max())))

    def footprint(self, found: SoftState) -> Footprint:
        """Edge of the contact, half way to the next point, largest pressure, and largest gap farther inside than an
        edge of a cell; nondimensional."""
        solid, points = self.solid, self.scene.points
        touching = found.forces > 0.0
        last = float(found.radii[touching].max())
        beyond = found.radii[found.radii > last]
        edge = 0.5 * (last + float(beyond.min())) if beyond.size else last
        r, z = points.positions(found.state.x)
        inside = (r < last - solid.contact.longest) & ~touching
        rings = self._rings(found).surface(self._forces(found), r[inside] * solid.length) / solid.length
        gaps = self.scene.under(found.travel, r[inside])[0] + rings - z[inside]
        pressure = float((found.forces / points.weight).max())
        return Footprint(edge, float(gaps.max(initial=0.0)), pressure)

    def surface(self, found: SoftState | None) -> RigidObject:
        """Surface of the object, mm, deformed by a balance, None: at rest, as the body of lines that it is drawn as."""
        wide = min(_DRAWN, self.touch.body.span[1])
        r = np.linspace(0.0, wide * self.solid.length, _CORNERS)
        travel = 0.0 if found is None else found.travel
        z = self.scene.under(travel, r / self.solid.length)[0] * self.solid.length
        if found is not None:
            z = z + self._rings(found, _DRAWN / 10.0).surface(self._forces(found), r)
        slope = np.append(np.diff(z) / np.diff(r), 0.0)
        pieces = tuple(UndersidePiece(*row) for row in np.stack([r, r, z, slope], axis=1).tolist())
        return RigidObject("soft object", pieces, (0.0, float(r[-1])), smallest=self.solid.length)


def soft_press(
    solid: SolidModel, free: FreeState, press: PressSettings, body: SoftBody, probe: StrainProbe
) -> IndentationPath:
    """Press a free dome by a soft object to the depth, or to where the object is strained beyond linear elasticity.

    Raises InputError for an object that is strained so far in the first step, NoConvergenceError if none balances it.
    """
    path = SoftPress(solid, free, press, body)
    recorder = PressRecorder(solid, free, path.touch, probe)
    states = [recorder.balanced(free.unit, Footprint(0.0, 0.0, 0.0), 0.0, 0.0, np.nan)]
    undersides, events, before = [path.surface(None)], recorder.events(states[0], states[0], press), 0.0
    for depth in press.depth / press.steps * np.arange(1, press.steps + 1):
        found = path.to(float(depth))
        if found is None and len(states) == 1:
            raise NoConvergenceError(f"{depth:g} mm of a {body.label}", "no balance of wall and object", "more steps")
        if found is None:
            events.append(SolidEvent("lost", states[-1].indentation, DETAIL["lost"]))
            break
        strain = path.point(found).strain
        if strain > 1.0 and len(states) == 1:
            raise InputError(
                f"the {body.label} is strained beyond linear elasticity in the first step, {depth:g} mm",
                key="contact.object_modulus_MPa",
                value=body.modulus,
                remedy="take a stiffer or a thicker object, or more steps (indentation.steps)",
            )
        force, slope = float(found.forces.sum()), found.pressure_rate / found.stiffness
        state = recorder.balanced(found.state, path.footprint(found), force, found.stiffness, slope)
        states.append(replace(state, indentation=float(depth)))
        undersides.append(path.surface(found))
        events += recorder.events(states[-2], states[-1], press)
        if strain > 1.0:
            reached = (1.0 - before) / (strain - before)
            at = states[-2].indentation + reached * (float(depth) - states[-2].indentation)
            events.append(SolidEvent("strained", at, DETAIL["strained"]))
            break
        before = strain
    return IndentationPath(states, states, events, len(states) == press.steps + 1, undersides=undersides)
