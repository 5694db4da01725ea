"""Axisymmetric hyperelastic finite elements: a dome, its trapped gas and a flat rigid plate.

Units throughout: mm, N, MPa (pressures too).  Entry points: `dome` and `printed_dome` (meshes), `laws.hyperelastic` (materials),
`SolidModel` (the discrete body), `inflate` (study 1), `indent` (study 2).
"""

from pneutouch.mechanics.solid.errors import NoConvergenceError, SolidError, UnreachableLoadError
from pneutouch.mechanics.solid.events import SolidEvent
from pneutouch.mechanics.solid.indent import IndentationPath, PressSettings, PressState, indent
from pneutouch.mechanics.solid.inflate import FreeState, Inflation, inflate, state_at
from pneutouch.mechanics.solid.mesh import SolidMesh, dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.printed import printed_dome
from pneutouch.mechanics.solid.stress import StrainProbe, WallExtremes, burst

__all__ = [
    "FreeState",
    "IndentationPath",
    "Inflation",
    "NoConvergenceError",
    "PressSettings",
    "PressState",
    "SolidError",
    "SolidEvent",
    "SolidMesh",
    "SolidModel",
    "StrainProbe",
    "UnreachableLoadError",
    "WallExtremes",
    "burst",
    "dome",
    "indent",
    "inflate",
    "printed_dome",
    "state_at",
]
