"""What the mechanics needs to know of a sensor: numbers in mm and MPa, nothing of files or printers."""

from __future__ import annotations

from dataclasses import dataclass

from pneutouch.mechanics.laws import Hyperelastic, hyperelastic, neo_hookean


@dataclass(frozen=True, slots=True)
class Sensor:
    """A dome with its gas and its plate. ``break_stretch`` is the stretch at which the resin may tear.

    ``law`` is a hyperelastic law's name with its constants where the resin has one of its own; without it the
    wall is neo-Hookean with ``shear_modulus``. ``flange`` is the width and thickness of the flange where the solid
    shall be held as it is printed; without it the wall is clamped at the base plane, as in the paper. ``grade`` are arc
    positions from the pole (0) to the rim (1) with the modulus there over ``shear_modulus``, straight between them; without it
    the wall is even.
    """

    inner_radius: float
    wall_thickness: float
    shear_modulus: float
    poisson_ratio: float
    ambient_pressure: float
    dead_volume: float
    plate_radius: float
    depth: float
    steps: int
    break_stretch: float | None
    gauge_limit: float
    law: tuple[str, tuple[float, ...]] | None = None
    flange: tuple[float, float] | None = None
    grade: tuple[tuple[float, ...], tuple[float, ...]] | None = None

    @property
    def material(self) -> Hyperelastic:
        """The wall's hyperelastic law. Raises InputError for constants that make no solid."""
        if self.law is None:
            return neo_hookean(self.shear_modulus, self.poisson_ratio)
        return hyperelastic(*self.law, self.poisson_ratio)
