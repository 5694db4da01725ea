"""Checks of a result that do not take the solver's word: balance, stability, and whether an event is true."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.events import SolidEvent
from pneutouch.mechanics.solid.elements import Gas, Regulator
from pneutouch.mechanics.solid.indent import IndentationPath, PressSettings, PressState, indent
from pneutouch.mechanics.solid.inflate import FreeState
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import NewtonFailure, SolidScene, SolverState, evaluate, full_tangent, minimise
from pneutouch.mechanics.solid.object_contact import RIM, Plate

#: Events that end a path because the branch ends there.
ENDS_BRANCH = ("snap", "clamp_fold")


@dataclass(frozen=True)
class Study:
    """A dome, its inflated state, how it is pressed and what came of it."""

    solid: SolidModel
    free: FreeState
    press: PressSettings
    found: IndentationPath

    @classmethod
    def of(cls, solid: SolidModel, free: FreeState, press: PressSettings) -> Study:
        return cls(solid, free, press, indent(solid, free, press))

    def scene(self, indentation: float) -> SolidScene:
        """Gas and plate at a travel (mm), set up from the definitions: Boyle's law, a plate with a rounded rim."""
        length, mu = self.solid.length, self.solid.mu
        gas = Gas.filled(
            self.free.pressure / mu,
            self.free.volume / length**3,
            self.press.ambient / mu,
            self.press.dead_volume / length**3,
        )
        top = self.free.positions[self.solid.mesh.outer, 1].max()
        radius = np.inf if self.press.plate_diameter is None else 0.5 * self.press.plate_diameter / length
        rim = max(RIM * radius if np.isfinite(radius) else 0.0, self.solid.contact.longest)
        return SolidScene(
            self.solid, gas, Plate((top - indentation) / length, max(radius - 0.5 * rim, 0.5 * radius), rim)
        )

    def evaluated(self, state: PressState) -> SolverState:
        found = evaluate(self.scene(state.indentation), state.positions / self.solid.length)
        assert found is not None
        return found

    def unbalance(self) -> float:
        """Largest unbalanced force of all states, as a share of what may remain."""
        return max(unbalance(self.solid, self.evaluated(s)) for s in self.found.path)

    def gas_error(self) -> float:
        """Largest relative deviation from Boyle's law, with the volume of the reported positions."""
        free, dead, ambient = self.free, self.press.dead_volume, self.press.ambient
        content = (free.pressure + ambient) * (free.volume + dead)
        volume = [self.solid.cavity.volume(s.positions) for s in self.found.path]
        held = (self.found_pressure() + ambient) * (np.array(volume) + dead)
        return float(np.abs(held - content).max() / max(content, 1e-300))

    def found_pressure(self) -> Array:
        return np.array([s.pressure for s in self.found.path])

    def softest(self, state: PressState) -> float:
        """Least eigenvalue of the whole tangent at a state, by a dense solver: positive where the state is stable."""
        at = self.evaluated(state)
        band = full_tangent(self.scene(state.indentation), at)
        k = at.filling.rate * np.outer(at.by_volume, at.by_volume)
        for offset, row in enumerate(band):
            i = np.arange(band.shape[1] - offset)
            k[i + offset, i] += row[: i.size]
        return float(np.linalg.eigvalsh(k, UPLO="L")[0])


def unbalance(solid: SolidModel, state: SolverState) -> float:
    """Norm of the residual over what convergence allows: 1e-9 of gas and plate forces, and rounding.

    The solver allows ten times the rounding noise; an eleventh is for positions that went through millimetres and back.
    """
    load = abs(state.filling.pressure) * float(np.linalg.norm(state.by_volume))
    noise = solid.noise
    if state.touch is not None:
        load += float(np.linalg.norm(solid.faces.push(solid.contact.force(state.touch.traction, state.touch.slope))))
        noise += solid.contact.noise
    return float(np.linalg.norm(state.residual)) / (1e-9 * (load + 1e-3 * solid.wall) + 11.0 * noise)


def free_unbalance(solid: SolidModel, free: FreeState) -> float:
    """`unbalance` of an inflated state under its own pressure held by a regulator."""
    state = evaluate(SolidScene(solid, Regulator(free.pressure / solid.mu), None), free.positions / solid.length)
    assert state is not None
    return unbalance(solid, state)


def pressed_to(study: Study, indentation: float) -> PressState:
    """Last state of a new study that goes to another depth in one step."""
    depth = min(indentation, study.found.path[-1].indentation)
    return indent(study.solid, study.free, replace(study.press, depth=depth, steps=1)).path[-1]


def gauge_error(study: Study, event: SolidEvent) -> float:
    """Relative distance of the pressure from the end of the gauge's range where the event puts it; 0 if it began so."""
    if event.indentation == 0.0:
        return min(0.0, study.free.pressure / study.press.gauge_range - 1.0)
    return pressed_to(study, event.indentation).pressure / study.press.gauge_range - 1.0


def breaks_there(study: Study, event: SolidEvent) -> bool:
    """Whether the break strain is met within half a solver step (0.03 R0) of where the event puts it, not before."""
    half, level = 0.03 * study.solid.length, 1.0 + study.press.break_strain
    met = pressed_to(study, event.indentation + half).stretch >= level
    if event.indentation <= half:
        return met
    return met and pressed_to(study, event.indentation - half).stretch < level


def other_branch(study: Study) -> float | None:
    """Energy (a share of the stored energy) that a second equilibrium lies below the last state, at the same height.

    The plate is taken a little further, the wall is let fall, and the plate is brought back: on a branch that goes on
    the wall returns to the state it left, past a fold it does not. None: it returned every time.
    """
    last, length = study.found.path[-1], study.solid.length
    here, x = study.evaluated(last), last.positions / length
    for further in (0.0035, 0.005, 0.0075, 0.01, 0.015, 0.02, 0.03, 0.04, 0.06):
        for ways_back in (1, 8):
            back = x
            for share in (*np.linspace(1.0, 0.0, ways_back, endpoint=False), 0.0):
                found = minimise(study.scene(last.indentation + share * further * length), back)
                if isinstance(found, NewtonFailure):
                    break
                back = found.state.x
            else:
                if np.abs(back - x).max() > 1e-3:
                    return (here.energy - found.state.energy) / here.local.energy
    return None
