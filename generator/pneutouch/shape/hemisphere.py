"""The paper's dome: half a sphere inside and outside."""

import math

from pneutouch.shape.dome import INNER_WALL, OUTER_WALL, DomeShape
from pneutouch.shape.meridian import Arc

_QUARTER = 0.5 * math.pi


class Hemisphere(DomeShape):
    """Two half spheres about one centre in the base plane."""

    __slots__ = ()

    key = "hemisphere"
    adjective = "hemispherical"

    @property
    def inner(self) -> tuple[Arc, ...]:
        """The inner half sphere."""
        return (Arc((0.0, 0.0), self.inner_radius, 0.0, _QUARTER, INNER_WALL),)

    @property
    def outer(self) -> tuple[Arc, ...]:
        """The outer half sphere."""
        return (Arc((0.0, 0.0), self.inner_radius + self.wall_thickness, 0.0, _QUARTER, OUTER_WALL),)


def no_hemisphere(shape: DomeShape) -> str | None:
    """Reason why formulas and tables of the hemisphere do not cover a shape; None for the hemisphere itself."""
    return None if type(shape) is Hemisphere else f"the dome is no hemisphere: its shape is {shape.key}"
