"""The search in numbers: resins, bounds, the target. mm, N, MPa; sensitivities in kPa/N."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.atlas.recipe import AtlasRecipe
from pneutouch.spec.grade import Grade
from pneutouch.spec.material import Material

_SMALLEST, _LARGEST = 2.0, 60.0
"""Inner radii that are searched where none is given, mm."""


@dataclass(frozen=True)
class CandidateResin:
    """A resin as the atlas needs it; ``grade`` where it is mixed from two."""

    name: str
    material: Material
    shear_modulus: float
    break_stretch: float
    grade: Grade | None = None


@dataclass(frozen=True)
class SelectionProblem:
    """What is required of a sensor and what is settled; None where free. depth_share: plate travel over R0."""

    resins: tuple[CandidateResin, ...]
    sensitivity_kPa_per_N: float | None
    tolerance: float
    driving_pressure: float | None
    force_range: float | None
    stiffness: tuple[float | None, float | None]
    max_diameter: float | None
    inner_radius: float | None
    wall_thickness: float | None
    least_wall: float
    ambient_pressure: float
    dead_volume: Callable[[Array], Array]
    plate_radius: float
    gauge_limit: float
    depth_share: float
    steps: int
    recipe: AtlasRecipe

    def batch(self, resin: Array, radius: Array, wall: Array, pressure: Array) -> SensorBatch:
        """Candidates as sensors; resin (n,) numbers, radius and wall (n,) mm, pressure (n,) MPa."""
        index = resin.astype(np.intp)
        ones = np.ones(radius.size)
        return SensorBatch(
            inner_radius=radius,
            wall_thickness=wall,
            shear_modulus=np.array([r.shear_modulus for r in self.resins])[index],
            ambient_pressure=ones * self.ambient_pressure,
            dead_volume=self.dead_volume(radius),
            driving_pressure=pressure,
            depth=radius * self.depth_share,
            plate_radius=ones * self.plate_radius,
            gauge_limit=ones * self.gauge_limit,
            break_stretch=np.array([r.break_stretch for r in self.resins])[index],
        )

    def radii(self, ratio: Array) -> tuple[Array, Array]:
        """Least and greatest inner radius for wall ratios: by the printer's least wall and by the size limit."""
        if self.inner_radius is not None:
            fixed = np.full_like(ratio, self.inner_radius)
            return fixed, fixed
        low = np.maximum(self.least_wall / ratio, _SMALLEST)
        largest = _LARGEST if self.max_diameter is None else 0.5 * self.max_diameter
        return low, np.minimum(largest / (1.0 + ratio), _LARGEST)
