"""Walks from equilibrium to equilibrium of one dome: at held volumes, or with trapped gas."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import ComputationError
from pneutouch.mechanics.atlas.recipe import AtlasRecipe, axes
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid.continuation import PathFollower, descend
from pneutouch.mechanics.solid.elements import Gas, Liquid, Regulator, Supply
from pneutouch.mechanics.solid.inflate import FreeState, Inflation, at_volume, inflate, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import NewtonFailure, SolidScene, SolverState, minimise, stability
from pneutouch.mechanics.solid.object_contact import Plate
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.shape.hemisphere import Hemisphere

_HOLDS = (1.0e3, 1.0e2, 1.0e4)
"""Stiffnesses in mu/R0^3 that hold the volume, tried in turn; the state keeps the volume it really has."""
_HALVINGS = 3
_LOST = 4.0e-3
_LOST_AT_CONTACT = 0.5
"""Work unaccounted for in one step, as a share of it, beyond which the step has changed branch; the first step, from a
point of contact, is only known coarsely."""
_SUCTION = 2.0e-3
"""States are kept down to this share of the limit pressure below zero, no further: sucked off the plate the wall
answers with another, softer stiffness, and the kink there would spoil the smooth side."""


def survey_volumes(recipe: AtlasRecipe) -> Array:
    """Surveyed nu, ascending, with nu = 0 among them; (volumes,)."""
    below = round(recipe.volumes * 0.42)
    up = np.linspace(0.0, recipe.highest_volume, recipe.volumes - below)
    down = np.linspace(recipe.lowest_volume, 0.0, below, endpoint=False)
    return np.concatenate([down, up])


def survey_depths(recipe: AtlasRecipe) -> Array:
    """Surveyed w, (depths,)."""
    return axes(recipe).depth.even(recipe.depths)


@dataclass(frozen=True)
class Equilibrium:
    """A state held at its volume under the plate, with its tangents; nondimensional (R0, mu).

    by_height, by_volume: derivatives of the positions, the other coordinate fixed. curvature: second derivatives of the
    energy by volume and height, (2, 2).
    """

    state: SolverState
    height: float
    force: float
    by_height: Array
    by_volume: Array
    curvature: Array
    stable: bool

    @property
    def gradient(self) -> Array:
        """Pressure and minus the force: the energy's derivatives by volume and height."""
        return np.array([self.state.filling.pressure, -self.force])

    @property
    def stiffness(self) -> float:
        """Derivative of the pressure by volume under a fixed plate."""
        return float(self.curvature[0, 0])

    @property
    def energy(self) -> float:
        """Energy of wall and contact alone."""
        return self.state.energy - self.state.filling.energy


class SampledPress(NamedTuple):
    """States of one press with trapped gas, and whether it ended before the greatest depth."""

    path: list[Equilibrium]
    ended: bool


class AtlasSampler:
    """Steps from equilibrium to equilibrium of one dome with R0 = mu = 1."""

    def __init__(self, wall_ratio: float, recipe: AtlasRecipe) -> None:
        self.recipe = recipe
        self.solid = SolidModel(
            dome(Hemisphere(1.0, wall_ratio)), neo_hookean(1.0, recipe.poisson_ratio), base=RigidBase()
        )
        self.probe = StrainProbe(self.solid)
        self.run = run = inflate(self.solid, past_limit=1.2)
        if run.limit is None:
            raise ComputationError(f"t0/R0 = {wall_ratio:g}: no limit point: {run.why_no_limit}")
        self.rest, self.limit = run.states[0], run.limit
        self.free = [self._free(run, nu) for nu in survey_volumes(recipe) if nu >= 0.0]
        apex = self.solid.mesh.outer_apex
        self.first_slope = float(self.rest.by_volume[apex, 1])

    def _free(self, run: Inflation, nu: float) -> FreeState:
        volume = self.rest.volume + nu * (self.limit.volume - self.rest.volume)
        below = [s for s in run.states if s.volume <= volume * (1 + 1e-12)]
        if nu == 0.0:
            return below[0]
        solution = at_volume(self.solid, below[-1:], volume)
        if isinstance(solution, NewtonFailure):
            raise ComputationError(f"t0/R0 = {self.solid.wall:g}, nu = {nu:g}: {solution.why}")
        return solution

    def volume(self, nu: float) -> float:
        """Cavity volume at a share of that at the limit point."""
        return self.rest.volume + nu * (self.limit.volume - self.rest.volume)

    def touching(self, free: FreeState) -> Equilibrium:
        """A free state with the plate at its apex."""
        solution = self._solve(free.unit.x, free.volume, free.outer_apex, free.pressure)
        if solution is None:
            raise ComputationError(f"t0/R0 = {self.solid.wall:g}: no equilibrium at first contact")
        return solution

    def _solve(self, guess: Array, volume: float, height: float, pressure: float) -> Equilibrium | None:
        plate = Plate(height, np.inf, self.solid.contact.longest)
        for hold in _HOLDS:
            scene = SolidScene(self.solid, Liquid(volume + pressure / hold, hold), plate)
            solution = minimise(scene, guess)
            if not isinstance(solution, NewtonFailure):
                return self._equilibrium(scene, solution.state, height)
        return None

    def _equilibrium(self, scene: SolidScene, state: SolverState, height: float) -> Equilibrium:
        solid, touch, contact = self.solid, state.touch, self.solid.contact
        assert touch is not None
        active = np.where(touch.traction > 0.0, -contact.stiffness, 0.0)
        answer = stability(scene, state, solid.faces.push(contact.force(active, touch.slope)))
        stiffness = 1.0 / float(state.by_volume @ answer.soft)
        by_volume, drift = solid.expand(answer.soft) * stiffness, float(state.by_volume @ answer.step)
        # The hold lets the volume drift as the plate moves; here the derivatives are at a fixed volume.
        by_height = solid.expand(answer.step) - drift * by_volume
        mixed = -(state.filling.rate + stiffness) * drift
        r, z = contact.positions(by_height)
        push = -float(np.vdot(contact.weight * active, 1.0 + touch.slope * r - z))
        return Equilibrium(
            state,
            height,
            float(np.vdot(contact.weight, touch.traction)),
            by_height,
            by_volume,
            np.array([[stiffness, mixed], [mixed, push]]),
            answer.stable,
        )

    def step(self, a: Equilibrium, volume: float, height: float, halvings: int = _HALVINGS) -> Equilibrium | None:
        """The equilibrium at another volume and height on the same branch, or None where the branch ends."""
        more, lift = volume - a.state.volume, height - a.height
        guess = a.state.x + a.by_height * lift + a.by_volume * more
        b = self._solve(guess, volume, height, a.state.filling.pressure + a.stiffness * more)
        if b is not None and b.stable and _lost(a, b) < (_LOST if a.force > 0.0 else _LOST_AT_CONTACT):
            return b
        if halvings == 0:
            return None
        middle = self.step(a, a.state.volume + 0.5 * more, a.height + 0.5 * lift, halvings - 1)
        return None if middle is None else self.step(middle, volume, height, halvings - 1)

    def pressed(self, pressure: float, ambient: float) -> SampledPress:
        """The states of one press with trapped gas (vented for no ambient pressure) down to where it ends."""
        free = state_at(self.solid, pressure, self.run)
        supply: Supply = Regulator(pressure)
        if ambient > 0.0:
            supply = Gas.filled(pressure, free.volume, ambient, 0.0)
        plate = Plate(free.outer_apex, np.inf, self.solid.contact.longest)
        follower = PathFollower(self.solid, supply, plate, free.unit.x)
        for depth in survey_depths(self.recipe)[1:]:
            ended = descend(follower, plate.height - depth) is not None
            if ended:
                break
        return SampledPress(
            [self._equilibrium(spot.scene, spot.state, spot.height) for spot in follower.path[1:]], ended
        )

    def reachable(self, solution: Equilibrium) -> bool:
        """Whether a trapped gas can hold the state, started at rest or above, the plate no lower than the box allows.

        The stiffest gas starts as full as that depth lets it, with no dead volume and the greatest ambient pressure:
        p + pa = (p1 + pa) V1/V, dp/dV = -(p + pa)/V.
        """
        volume, pressure, recipe = solution.state.volume, solution.state.filling.pressure, self.recipe
        apex, volumes = [f.outer_apex for f in self.free], [f.volume for f in self.free]
        start = max(volume, float(np.interp(solution.height + recipe.beyond, apex, volumes)))
        first = float(np.interp(start, volumes, [f.pressure for f in self.free]))
        most = (first + recipe.stiffest_gas) * start / volume - recipe.stiffest_gas
        rate = (pressure + recipe.stiffest_gas) / volume
        if volume < self.rest.volume:
            # Squeezed to so low a pressure, the gas cannot have been that stiff: it must have started at rest or above.
            rate = min(rate, max(pressure, 0.0) / (self.rest.volume - volume) * self.rest.volume / volume)
        lowest = -_SUCTION * self.limit.pressure
        return lowest <= pressure <= most + 1e-9 and solution.stiffness + rate > 0.0


def _lost(a: Equilibrium, b: Equilibrium) -> float:
    """Energy that the work of pressure and force does not account for, as a share of that work."""
    move = np.array([b.state.volume - a.state.volume, b.height - a.height])
    work = 0.5 * move @ (a.gradient + b.gradient) - move @ (b.curvature - a.curvature) @ move / 12.0
    scale = 0.5 * np.abs(move) @ (np.abs(a.gradient) + np.abs(b.gradient)) + 1e-5
    return float(abs(b.energy - a.energy - work) / scale)
