"""Air without viscosity and conduction worth mention: its lines have the classical resonances."""

from __future__ import annotations

from pneutouch.mechanics.line.elements import AirState


class Lossless(AirState):
    """Layers at the wall are less than a millionth of a millimetre."""

    __slots__ = ()

    @property
    def kinematic_viscosity(self):
        return 4e-13

    @property
    def thermal_diffusivity(self):
        return 4e-13


IDEAL = Lossless(0.101325)
