"""The paper's sensor in any resin, and the conversion between Shore A hardness and Young's modulus.

Shore A hardness to modulus: A. N. Gent, Rubber Chem. Technol. 31, 896-906 (1958), in its usual metric form, E = 0.0981
(56 + 7.62336 S) / (0.137505 (254 - 2.54 S)) MPa. Only slopes and ratios of this relation are used: its level is not
trusted for a relaxed modulus (it gives TangoPlus twice the modulus of the paper's Table 1). Above 80 the scale is
compressed and the slope grows without bound towards 100.
"""

import dataclasses
import math

import numpy as np

from pneutouch.mechanics.sensor import Dome, GasCircuit, IndentationProtocol, Sensor, WallMaterial
from pneutouch.shape.hemisphere import Hemisphere, no_hemisphere
from pneutouch.spec.material import Material
from pneutouch.units import GAUGE_LIMIT, STANDARD_ATMOSPHERE

PAPER_RADIUS, PAPER_WALL, PAPER_PLATE, PAPER_DEPTH = 9.25, 1.5, 30.0, 0.75 * 9.25
"""Radius, wall, plate and depth of the paper's sensor in mm: section 2-B and Supplement B."""


_SAME = 1e-6
"""Relative tolerance for a value to equal the paper's: below any difference that can be printed."""


def is_paper_sensor(sensor: Sensor) -> bool:
    """True if dome, gas, plate, central contact and depth are the paper's, so that its Table S1 applies; any resin."""
    dome, gas, protocol = sensor.dome, sensor.gas, sensor.protocol
    pairs = [
        (dome.inner_radius, PAPER_RADIUS),
        (dome.wall_thickness, PAPER_WALL),
        (2 * protocol.plate_radius, PAPER_PLATE),
        (protocol.depth, PAPER_DEPTH),
        (gas.ambient_pressure, STANDARD_ATMOSPHERE),
    ]
    if no_hemisphere(dome.shape) or protocol.body is not None or protocol.off_axis is not None:
        return False
    same = all(math.isclose(value, paper, rel_tol=_SAME) for value, paper in pairs)
    return same and gas.dead_volume <= _SAME * dome.inner_radius**3


def material_sensor(material: Material) -> Sensor:
    """The paper's sensor made of ``material``: no dead volume, 14 steps to three quarters of R0.

    Raises InputError if Poisson ratio or law describe no stable solid.
    """
    assert material.shear_modulus_MPa is not None and material.poisson_ratio is not None
    elongation = material.elongation_at_break_percent
    law = _law(material)
    wall = WallMaterial(
        material.shear_modulus_MPa.nominal,
        material.poisson_ratio.nominal,
        break_stretch=None if elongation is None else 1 + elongation.least / 100,
        law=law,
        grade=_grade(material),
        largest_stretch=None if material.law is None else material.law.largest_stretch,
    )
    # A law fitted here has a modulus fitted over the same range next to it; of another its own is taken.
    modulus = wall.shear_modulus if wall.fitted else wall.hyperelastic.mu
    return Sensor(
        Dome(Hemisphere(PAPER_RADIUS, PAPER_WALL)),
        dataclasses.replace(wall, shear_modulus=modulus),
        GasCircuit(STANDARD_ATMOSPHERE, dead_volume=0.0, gauge_limit=GAUGE_LIMIT),
        IndentationProtocol(0.5 * PAPER_PLATE, depth=PAPER_DEPTH, steps=14),
    )


def _law(material: Material) -> tuple[str, tuple[float, ...]] | None:
    """Name and constants of a material's law; None without one, or if it is neo-Hookean with the stated modulus."""
    law, modulus = material.law, material.shear_modulus_MPa
    if law is None or modulus is None or (law.name == "neo-hookean" and law.constants == [modulus.nominal]):
        return None
    return law.name, tuple(law.constants)


def _grade(material: Material) -> tuple[tuple[float, ...], tuple[float, ...]] | None:
    along, mean = material.along, material.shear_modulus_MPa
    if along is None or mean is None:
        return None
    return tuple(along.arc), tuple(modulus / mean.nominal for modulus in along.shear_modulus_MPa)


_OFFSET, _RISE = 56.0, 7.62336
_UNIT = 0.0981 / (0.137505 * 2.54)
_FULL = 100.0


def young_modulus(shore_a: float) -> float:
    """Young's modulus in MPa of a Shore A hardness below 100."""
    return _UNIT * (_OFFSET + _RISE * shore_a) / (_FULL - shore_a)


def shore_a(modulus: float) -> float:
    """Shore A hardness for a Young's modulus in MPa: the inverse of `young_modulus`."""
    return (_FULL * modulus - _UNIT * _OFFSET) / (modulus + _UNIT * _RISE)


def logarithmic_slope(shore: float) -> float:
    """Slope d(ln E)/dS per unit of Shore A, at the hardness ``shore``."""
    return _RISE / (_OFFSET + _RISE * shore) + 1.0 / (_FULL - shore)


def logarithmic_change(before: float, after: float) -> float:
    """Logarithm ln(E_after/E_before) for a change of the Shore A hardness from ``before`` to ``after``."""
    return float(np.log(young_modulus(after) / young_modulus(before)))
