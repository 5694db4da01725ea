"""The parameters that can be fitted: coordinates, bounds and priors."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.errors import InputError, nearest
from pneutouch.mechanics.atlas.coverage import is_corrected, other_shape
from pneutouch.mechanics.atlas.figures import neighbourhood
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.atlas.table import shipped
from pneutouch.mechanics.corrected.curves import NODES
from pneutouch.mechanics.corrected.figures import GRIPS
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.uncertainty.contact_model import SPREAD
from pneutouch.mechanics.uncertainty.sources.model_error import build_sources
from pneutouch.mechanics.uncertainty.sources.modulus import modulus_sources
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer
from pneutouch.units import ML

NAMES = ("modulus", "wall", "dead-volume", "offset", "friction")
"""The parameters, in the order of every array over parameters."""
MODULUS, WALL, DEAD, OFFSET, FRICTION = range(5)

USUAL = NAMES[:FRICTION]
"""Parameters that are fitted by default."""

KEYS = ("shear_modulus_MPa", "wall_thickness_mm", "dead_volume_mL", "contact_offset_mm", "friction")
"""Names of the parameters in files, with unit."""

UNITS = ("MPa", "mm", "mL", "mm", "1")
LOGARITHMIC = np.array([True, True, False, False, False])
"""Flags of the parameters that are fitted as logarithms: positive, and uncertain by a factor."""
_OUTSIDE = np.array([1.0, 1.0, ML, 1.0, 1.0])

OFFSET_BOUND = 0.5
"""Greatest contact offset, mm: our choice, one step of the paper's protocol; more is a missed contact."""

OFFSET_PRIOR = 0.05
"""Prior standard deviation of the contact offset, mm: our choice, the part of the first touch below the noise."""

FRICTION_PRIOR = GRIPS / np.sqrt(12.0)
"""Prior standard deviation of the friction coefficient if it is fitted: our choice, that of a uniform distribution from
0 to `GRIPS`."""

_STIFFEST = 100.0
"""Greatest shear modulus fitted, MPa: our choice, far above any elastomer."""
_WALLS = 0.5, 2.0
"""Least and greatest wall over that of the design, for domes that are no hemisphere: our choice."""
_LARGEST = 1e6
"""Greatest dead volume fitted, mm3: the bound of the design file, 1000 mL."""


@dataclass(frozen=True, slots=True)
class CalibrationParameters:
    """Coordinates of the five parameters: ln MPa, ln mm, mm3, mm, coefficient; (5,) arrays.

    Attributes:
        fitted: Indices in `NAMES` of the fitted parameters, ascending.
        start: Design values, also the centres of the priors; parameters that are not fitted keep them.
        low, high: Bounds.
        prior_spread: Standard deviations of the priors around ``start``.
        even: Priors that are uniform; the others are normal.
        step: Finite difference steps.
        origin: Origin of each prior.
        priors: True if the priors are used in the fit.
        frictions: Friction coefficients at which the solid is solved; none where the atlas covers the sensor as it is.
    """

    fitted: tuple[int, ...]
    start: Array
    low: Array
    high: Array
    prior_spread: Array
    even: Flags
    step: Array
    origin: tuple[str, ...]
    priors: bool
    frictions: tuple[float, ...] = ()

    @property
    def others(self) -> tuple[int, ...]:
        """Indices of the parameters that are not fitted but have a prior; none where priors are not used."""
        known = [k not in self.fitted and self.prior_spread[k] > 0.0 for k in range(len(NAMES))]
        return tuple(k for k in range(len(NAMES)) if known[k]) if self.priors else ()

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the fitted parameters."""
        return tuple(NAMES[k] for k in self.fitted)

    def full(self, fitted: Array) -> Array:
        """All five coordinates, (..., 5), from the fitted ones, (..., k)."""
        full = np.broadcast_to(self.start, (*fitted.shape[:-1], len(NAMES))).copy()
        full[..., list(self.fitted)] = fitted
        return full


def outside_value(k: int, coordinate: float) -> float:
    """Value of parameter k in the unit of files (`UNITS`), from its coordinate."""
    return float((np.exp(coordinate) if LOGARITHMIC[k] else coordinate) / _OUTSIDE[k])


def parse_names(names: Iterable[str]) -> tuple[int, ...]:
    """Indices in `NAMES` of parameters, ascending. Raises InputError for an unknown or repeated name, or for none."""
    words = [name.strip() for name in names]
    for word in words:
        if word not in NAMES:
            raise InputError(f"no such parameter.{nearest(word, NAMES)}", key="fit", value=word)
        if words.count(word) > 1:
            problem = f"{word} is there twice"
            raise InputError(problem, key="fit", value=",".join(words), remedy="must be there once")
    if not words:
        raise InputError("empty", key="fit", remedy=f"must name at least one of {', '.join(NAMES)}")
    return tuple(sorted(NAMES.index(word) for word in words))


def parameters(
    sensor: Sensor, material: Material, printer: Printer, names: Sequence[str] = USUAL, *, priors: bool = True
) -> CalibrationParameters:
    """Parameters of a sensor as designed, with ``names`` fitted. Raises InputError for unknown names."""
    recipe, size, numbers = shipped().recipe, sensor.dome.inner_radius, parse_names(names)
    friction = min(sensor.protocol.friction, GRIPS)
    softest = neighbourhood().recipe.stiffest if is_corrected(sensor) else recipe.stiffest
    thinnest, thickest = recipe.thinnest * size, recipe.thickest * size
    if other_shape(sensor):
        thinnest, thickest = (sensor.dome.wall_thickness * factor for factor in _WALLS)
    low = [np.log(sensor.gas.ambient_pressure / softest), np.log(thinnest), 0.0, -OFFSET_BOUND, 0.0]
    high = [np.log(_STIFFEST), np.log(thickest), _LARGEST, OFFSET_BOUND, GRIPS]
    start = [
        np.log(sensor.wall.shear_modulus),
        np.log(sensor.dome.wall_thickness),
        sensor.gas.dead_volume,
        0.0,
        friction,
    ]
    prior_spread, even, origin = _priors(sensor, material, printer, fitted=FRICTION in numbers)
    step = np.array([1e-3, 1e-3, 1e-3 * (sensor.dome.shape.cavity_volume + sensor.gas.dead_volume), 1e-3 * size, 1e-2])
    bounds = np.array(start), np.array(low), np.array(high)
    nodes = _frictions(sensor, fitted=FRICTION in numbers)
    return CalibrationParameters(numbers, *bounds, prior_spread, even, step, origin, priors, nodes)


def _frictions(sensor: Sensor, *, fitted: bool) -> tuple[float, ...]:
    """Friction coefficients at which the solid is solved; none where the atlas needs no correction."""
    if fitted:
        return NODES
    if sensor.protocol.other_contact is None:
        return (0.0,) if is_corrected(sensor) else ()
    stated = min(sensor.protocol.friction, GRIPS)
    return tuple(sorted({stated / SPREAD, stated, min(stated * SPREAD, GRIPS)}))


def _friction_prior(sensor: Sensor, *, fitted: bool) -> tuple[float, str]:
    """Prior standard deviation of the friction coefficient, and its origin; 0 where not fitted and stated as 0."""
    stated = min(sensor.protocol.friction, GRIPS)
    if fitted:
        return float(FRICTION_PRIOR), f"normal, {FRICTION_PRIOR:.2g}: our choice, that of anything from 0 to {GRIPS:g}"
    if not stated:
        return 0.0, "none: a plate without friction"
    u = float(np.log(SPREAD) / np.sqrt(3.0))
    return u * stated, f"friction: assumed, even in its logarithm within a factor of {SPREAD:g}"


def _priors(
    sensor: Sensor, material: Material, printer: Printer, *, fitted: bool
) -> tuple[Array, Flags, tuple[str, ...]]:
    """Prior standard deviations, flags of uniform priors, and origins; ``fitted`` is True if the friction is fitted."""
    built = build_sources(batch_of(sensor, [0.0]), printer)
    groups = (
        modulus_sources(material, np.zeros(1, dtype=bool)),
        [source for source in built if source.acts_on == "wall_thickness"],
        [source for source in built if source.acts_on == "dead_volume"],
    )
    spread = (float(np.sqrt(sum(float(source.standard[0]) ** 2 for source in group))) for group in groups)
    origin = ("; ".join(f"{source.name}: {source.origin}" for source in group) for group in groups)
    priors = list(zip(spread, origin, strict=True))
    offset = (OFFSET_PRIOR, f"normal, {OFFSET_PRIOR:g} mm: our choice, the part of the touch that the noise hides")
    spreads, origins = zip(*priors, offset, _friction_prior(sensor, fitted=fitted), strict=True)
    even = [len(group) == 1 and group[0].distribution.endswith("rectangular") for group in groups]
    return np.array(spreads), np.array([*even, False, False]), tuple(origins)
