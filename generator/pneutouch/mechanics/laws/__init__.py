"""Strain energy laws of an incompressible membrane: one file each, and one line here."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from pneutouch.mechanics.laws import neo_hookean
from pneutouch.meridian.segments import Array

Density = Callable[[float, Array], Array]


@dataclass(frozen=True, slots=True)
class Law:
    """Energy density and its slope by the thickness stretch in equibiaxial tension, both in MPa.

    Called with the shear modulus (MPa) and the thickness stretch.
    """

    energy: Density
    energy_slope: Density


LAWS: dict[str, Law] = {
    "neo-hookean": Law(neo_hookean.energy, neo_hookean.energy_slope),
}
