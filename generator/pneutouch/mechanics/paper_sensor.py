"""The paper's sensor in any resin: the one with measurements, and the wall that a material file gives."""

import dataclasses
import math

from pneutouch.mechanics.sensor import Dome, GasCircuit, IndentationProtocol, Sensor, WallMaterial
from pneutouch.spec.material import Material
from pneutouch.units import GAUGE_LIMIT, STANDARD_ATMOSPHERE

PAPER_RADIUS, PAPER_WALL, PAPER_PLATE, PAPER_DEPTH = 9.25, 1.5, 30.0, 0.75 * 9.25
"""The paper's sensor in mm: section 2-B and Supplement B."""


_SAME = 1e-6
"""Relative tolerance within which a length, a pressure or a volume is the paper's: below any that can be printed."""


def is_paper_sensor(sensor: Sensor) -> bool:
    """True if dome, gas, plate and depth are the paper's, in any resin and clamp, so that its Table S1 applies."""
    dome, gas, protocol = sensor.dome, sensor.gas, sensor.protocol
    pairs = [
        (dome.inner_radius, PAPER_RADIUS),
        (dome.wall_thickness, PAPER_WALL),
        (2 * protocol.plate_radius, PAPER_PLATE),
        (protocol.depth, PAPER_DEPTH),
        (gas.ambient_pressure, STANDARD_ATMOSPHERE),
    ]
    if protocol.body is not None or protocol.off_axis is not None:
        return False
    same = all(math.isclose(value, paper, rel_tol=_SAME) for value, paper in pairs)
    return same and gas.dead_volume <= _SAME * dome.inner_radius**3


def material_sensor(material: Material) -> Sensor:
    """The paper's sensor in a material: no dead volume, 14 steps to three quarters of R0.

    Raises InputError for a Poisson ratio or a law that makes no solid.
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
    fitted = wall.largest_stretch is not None and law is not None
    modulus = wall.shear_modulus if fitted else wall.hyperelastic.mu
    return Sensor(
        Dome(PAPER_RADIUS, PAPER_WALL),
        dataclasses.replace(wall, shear_modulus=modulus),
        GasCircuit(STANDARD_ATMOSPHERE, dead_volume=0.0, gauge_limit=GAUGE_LIMIT),
        IndentationProtocol(0.5 * PAPER_PLATE, depth=PAPER_DEPTH, steps=14),
    )


def _law(material: Material) -> tuple[str, tuple[float, ...]] | None:
    """The law of a material; None for the neo-Hookean one of its shear modulus, which the atlas covers."""
    law, modulus = material.law, material.shear_modulus_MPa
    if law is None or modulus is None or (law.name == "neo-hookean" and law.constants == [modulus.nominal]):
        return None
    return law.name, tuple(law.constants)


def _grade(material: Material) -> tuple[tuple[float, ...], tuple[float, ...]] | None:
    along, mean = material.along, material.shear_modulus_MPa
    if along is None or mean is None:
        return None
    return tuple(along.arc), tuple(modulus / mean.nominal for modulus in along.shear_modulus_MPa)
