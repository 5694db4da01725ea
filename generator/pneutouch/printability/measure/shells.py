"""Closed hollows: shells of a solid that face inwards."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.printability.subject import Point3

_NOTHING = 1e-6
"""Volume in mm3 below which a shell is rounding."""


@dataclass(frozen=True)
class Hollow:
    """A hollow without an opening: ``volume`` in mm3, ``bounds`` (2, 3) in mm, the ``body`` it lies in."""

    body: str
    volume: float
    bounds: Array

    @property
    def where(self) -> Point3:
        """Middle of its box."""
        x, y, z = (float(value) for value in self.bounds.mean(axis=0))
        return x, y, z

    def alike(self, other: Hollow) -> bool:
        """True if both are one and the same."""
        return bool(np.allclose(self.bounds, other.bounds, atol=1e-6))


def voids(manifold: Any, body: str) -> list[Hollow]:
    """Hollows of a manifold3d solid, smallest first."""
    hollows = []
    for shell in manifold.decompose():
        volume = float(shell.volume())
        if volume < -_NOTHING:
            hollows.append(Hollow(body, -volume, np.array(shell.bounding_box()).reshape(2, 3)))
    return sorted(hollows, key=lambda hollow: hollow.volume)
