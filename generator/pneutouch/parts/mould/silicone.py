"""Mass of silicone in a batch, and its division into the parts that are mixed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from pneutouch.parts.mould.assembly import MouldAssembly
from pneutouch.parts.mould.pieces import channels
from pneutouch.units import ML, grams

FILM = 0.5
"""Thickness in mm of the silicone that is left to run over into a window of the base: own choice."""

LOSS_SHARE = 0.15
LEAST_LOSS_ML = 2.0
"""Loss on cup, stirrer and syringe: this share, and at least so much; our choice, measure yours."""


@dataclass(frozen=True)
class SiliconeBatch:
    """The silicone of one filling of the mould. Volumes in mL at the mould's size, masses in g.

    ``parts_by_mass`` are the mixing parts of the material, empty if unknown.
    """

    cavities: int
    cavity_mL: float
    channels_mL: float
    overflow_mL: float
    density_g_per_cm3: float
    parts_by_mass: tuple[float, ...]

    @cached_property
    def filled_mL(self) -> float:
        """Volume that the mould takes: cavities, channels and overflow."""
        return self.cavities * (self.cavity_mL + self.channels_mL + self.overflow_mL)

    @property
    def loss_mL(self) -> float:
        """Volume that is lost: `LOSS_SHARE` of the filling, at least `LEAST_LOSS_ML`."""
        return max(LOSS_SHARE * self.filled_mL, LEAST_LOSS_ML)

    @property
    def volume_mL(self) -> float:
        """To be mixed."""
        return self.filled_mL + self.loss_mL

    @property
    def mass_g(self) -> float:
        """To be weighed, all parts together."""
        return grams(self.volume_mL * ML, self.density_g_per_cm3)

    @property
    def parts_g(self) -> tuple[float, ...]:
        """To be weighed of each part, in the order of ``parts_by_mass``."""
        whole = sum(self.parts_by_mass)
        return tuple(self.mass_g * part / whole for part in self.parts_by_mass)

    def document(self) -> dict[str, Any]:
        """The entry of the manifest."""
        return {
            "cavities": self.cavities,
            "cavity_mL": round(self.cavity_mL, 4),
            "channels_mL": round(self.channels_mL, 4),
            "overflow_mL": round(self.overflow_mL, 4),
            "loss_mL": round(self.loss_mL, 4),
            "volume_mL": round(self.volume_mL, 4),
            "mass_g": round(self.mass_g, 3),
            "parts_g": [round(part, 3) for part in self.parts_g],
        }


def silicone_batch(mould: MouldAssembly) -> SiliconeBatch:
    """The batch that fills a mould once."""
    size, material = mould.size, mould.scene.membrane_material
    return SiliconeBatch(
        cavities=size.shape.cavities,
        cavity_mL=size.cavity_volume / ML,
        channels_mL=sum(channel.volume() for channel in channels(size)) / ML,
        overflow_mL=math.pi * size.window**2 * FILM / ML,
        density_g_per_cm3=material.density_g_per_cm3.nominal,
        parts_by_mass=() if material.casting is None else tuple(material.casting.parts_by_mass),
    )
