"""The rigid base under the dome. A file of its own: a sensor names it, and the solver would load SciPy with it."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class RigidBase:
    """The plane z = 0 on which the dome stands, and a ring around it that opens upwards at 45 degrees; in mm.

    opening: radius of the hole in it inside the dome.  flange: outer radius of a flange that is part of the solid and
    on which the outer wall therefore does not meet this base; 0 where the wall itself is clamped at z = 0.
    ring, ring_height: radius of the ring's inner edge at z = 0, and its height; no ring at height 0.
    """

    opening: float = 0.0
    flange: float = 0.0
    ring: float = 0.0
    ring_height: float = 0.0

    def __post_init__(self) -> None:
        sizes = vars(self)
        if not all(np.isfinite(size) and size >= 0.0 for size in sizes.values()):
            stated = ", ".join(f"{name} {size}" for name, size in sizes.items())
            raise ValueError(f"{stated}: the sizes of a base must be finite and not negative")
