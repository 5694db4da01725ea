"""Axisymmetric hyperelastic finite elements: a dome, its trapped gas and a flat rigid plate.

Units throughout: mm, N, MPa (pressures too).  Entry points: `dome` and `printed_dome` (meshes), `laws.hyperelastic` (materials),
`Solid` (the discrete body), `inflate` (study 1), `indent` (study 2).
"""

from pneutouch.mechanics.solid.errors import NoConvergenceError, SolidError, UnreachableLoadError
from pneutouch.mechanics.solid.events import Event
from pneutouch.mechanics.solid.indent import Indentation, Press, PressState, indent
from pneutouch.mechanics.solid.inflate import FreeState, Inflation, inflate, state_at
from pneutouch.mechanics.solid.mesh import SolidMesh, dome
from pneutouch.mechanics.solid.model import Solid
from pneutouch.mechanics.solid.printed import printed_dome
from pneutouch.mechanics.solid.stress import Peak, Probe, burst

__all__ = [
    "Event",
    "FreeState",
    "Indentation",
    "Inflation",
    "NoConvergenceError",
    "Peak",
    "Press",
    "PressState",
    "Probe",
    "Solid",
    "SolidError",
    "SolidMesh",
    "UnreachableLoadError",
    "burst",
    "dome",
    "indent",
    "inflate",
    "printed_dome",
    "state_at",
]
