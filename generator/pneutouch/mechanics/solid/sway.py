"""Loss of stability of the axisymmetric path under the plate: sway (one wave around the axis) and lobes (several)."""

from dataclasses import dataclass
from functools import lru_cache

from pneutouch.mechanics.solid.continuation import PlateState
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import SolverState
from pneutouch.mechanics.solid.second_variation import HarmonicSolid, unstable_waves

#: Greatest number of waves around the axis that is checked.
MOST_WAVES = 8
#: Plate travel between checked states, in R0; a loss between two of them is searched in the states between.
_TRAVEL = 0.25


@dataclass(frozen=True)
class AxisymmetryLoss:
    """Plate height (R0) below which the axisymmetric path is unstable to n ``waves`` around the axis."""

    waves: int
    height: float


@lru_cache(maxsize=1)
def _variation(solid: SolidModel) -> HarmonicSolid:
    """Second variation of a solid; kept, because all presses of one solid check its stability."""
    return HarmonicSolid(solid)


def round_waves(solid: SolidModel, state: SolverState, most: int = MOST_WAVES) -> tuple[int, ...]:
    """Numbers of waves, 1 to ``most``, to which a state without contact is unstable; empty: it stays round."""
    return unstable_waves(_variation(solid), state, tuple(range(1, most + 1))) if most else ()


def axisymmetry_losses(solid: SolidModel, path: list[PlateState], most: int = MOST_WAVES) -> list[AxisymmetryLoss]:
    """Losses of stability of a path from first contact down: the first to one wave, the first to 2 to ``most`` waves.

    States are checked at every quarter of R0 of plate travel, and the last one. A loss between two of these is
    bracketed by bisection over the states in between, and located by solving for states between neighbours.
    """
    harmonic = _variation(solid)
    losses: list[AxisymmetryLoss] = []
    watched, reached = tuple(range(1, most + 1)), 0
    for k, state in enumerate(path):
        if not watched:
            break
        if k < len(path) - 1 and path[reached].height - state.height < _TRAVEL:
            continue
        lost = unstable_waves(harmonic, state.state, watched)
        if lost:
            # Most presses stay stable: where one does not is searched by a module of its own.
            from pneutouch.mechanics.solid.onset import onset
        for kind in ((1,), tuple(n for n in watched if n > 1)):
            onsets = [AxisymmetryLoss(n, onset(harmonic, path[reached : k + 1], n)) for n in lost if n in kind]
            if onsets:
                losses.append(max(onsets, key=lambda loss: loss.height))
                watched = tuple(n for n in watched if n not in kind)
        reached = k
    return losses
