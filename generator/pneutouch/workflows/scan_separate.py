"""Domes that distinguish two patterns of a specimen: candidates over radius, wall, resin and driving pressure."""

import re
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.catalogue import DesignSource, Library, ResolvedDesign
from pneutouch.catalogue.library import elastomers
from pneutouch.errors import InputError
from pneutouch.evaluation.contact_object import check_shape
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.atlas.table import least_limit, shipped
from pneutouch.mechanics.models.atlas import resin_outside_atlas
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.rating import LIMIT_ERROR, rated_pressure
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.uncertainty.propagate import limit_spread
from pneutouch.results.scan import FavouringState, SeparatingDome, SeparationRecord, TellablePattern
from pneutouch.rounding import rounded, tenths_below
from pneutouch.spec.material import Material
from pneutouch.spec.options import ScanOptions
from pneutouch.spec.read import Changes
from pneutouch.texture.separate import BarPattern, Separation, noise_amplitude, separate
from pneutouch.units import KPA
from pneutouch.workflows.scan import load_both, matrix_of, noise_of

_RADII, _RATIOS, _PRESSURES = 8, 8, 9
_SMALLEST, _LARGEST = 4.0, 20.0
"""Inner radii looked at, mm."""
_SHOWN, _DIGITS = 8, 4


@dataclass(frozen=True)
class DomeCandidates:
    """Candidates, (n,) each: resin by number in ``names``, mm, and one row a driving pressure."""

    names: tuple[str, ...]
    resin: Array
    radius: Array
    wall: Array
    dome: Array
    batch: SensorBatch


def parse_patterns(text: str) -> tuple[BarPattern, BarPattern]:
    """Two patterns out of ``PITCH1@DEPTH1,PITCH2@DEPTH2`` in mm. Raises InputError."""
    number = r"\s*(\d+(?:\.\d+)?)\s*"
    match = re.fullmatch(f"{number}@{number},{number}@{number}", text)
    if match is None:
        raise InputError("must be PITCH1@DEPTH1,PITCH2@DEPTH2 in mm, such as 3@0,6@2", key="separate", value=text)
    a, b, c, d = (float(part) for part in match.groups())
    if min(a, c) <= 0:
        raise InputError("a pitch must be more than 0 mm", key="separate", value=text)
    if (a, b) == (c, d):
        raise InputError(
            "both patterns are the same", key="separate", value=text, remedy="there is nothing to distinguish"
        )
    return BarPattern(a, b), BarPattern(c, d)


def separating(
    specimen: str,
    design: str | DesignSource,
    text: str,
    options: ScanOptions,
    changes: Changes | None = None,
    library: Library | None = None,
) -> SeparationRecord:
    """The domes that best distinguish two patterns; the specimen gives matrix and speed, the design the rest."""
    library = library or Library.default()
    patterns = parse_patterns(text)
    context, scene, sensor = load_both(specimen, design, changes, library, scanned=False)
    speed = context.specimen.scan.speed_mm_per_s if options.speed_mm_per_s is None else options.speed_mm_per_s
    floor = tuple(noise_amplitude(speed / pattern.pitch, noise_of(options)) for pattern in patterns)
    domes = candidates(scene, sensor, library)
    separation = separate(
        domes.batch, domes.dome, options.preload_N, matrix_of(context), patterns, (floor[0], floor[1])
    )
    return SeparationRecord(
        tuple(
            TellablePattern(p.pitch, p.depth, speed / p.pitch, f / KPA) for p, f in zip(patterns, floor, strict=True)
        ),
        len(domes.batch),
        options.preload_N,
        tuple(_dome(domes, separation, k) for k in range(min(_SHOWN, len(separation.dome)))),
    )


def _dome(domes: DomeCandidates, separation: Separation, k: int) -> SeparatingDome:
    row = int(np.flatnonzero(domes.dome == separation.dome[k])[0])
    pressures_kPa, amplitudes_kPa = separation.pressures[k] / KPA, separation.amplitudes[k] / KPA
    states = tuple(
        FavouringState(float(at), i + 1, tuple(of.tolist()))
        for i, (at, of) in enumerate(zip(pressures_kPa, amplitudes_kPa, strict=True))
    )
    return SeparatingDome(
        rank=k + 1,
        resin=domes.names[int(domes.resin[row])],
        inner_radius_mm=float(round(domes.radius[row], 2)),
        wall_thickness_mm=float(round(domes.wall[row], 2)),
        contrast=rounded(float(separation.contrast[k]), _DIGITS),
        states=rounded(states, _DIGITS),
    )


def candidates(scene: ResolvedDesign, sensor: Sensor, library: Library) -> DomeCandidates:
    """A grid over the resins that the design's printer runs and the atlas covers, wall ratio, radius and pressure.

    Sizes are in hundredths of a millimetre and pressures in tenths of a kPa, as they are shown; no pressure is above
    the rated pressure of its dome.
    """
    check_shape(scene)
    recipe, feature = shipped().recipe, scene.printer.smallest.wall("elastomer")
    least = feature.least or feature.recommended
    resins = {
        name: material
        for name, material in sorted(elastomers(library, scene.printer.is_casting).items())
        if scene.printer.mode_for(material) is not None
        and resin_outside_atlas(material_sensor(material).wall, sensor.gas.ambient_pressure) is None
    }
    if not resins:
        raise InputError(
            f"the {scene.printer.title} runs no resin that the atlas covers", file=scene.where, key="print.profile"
        )
    resin, ratio, radius = _grid(
        np.arange(len(resins), dtype=float),
        np.geomspace(recipe.thinnest, recipe.thickest, _RATIOS),
        np.round(np.geomspace(_SMALLEST, _LARGEST, _RADII), 2),
    )
    # Rounded, the thinnest and the thickest wall stay inside the atlas.
    thinnest, thickest = np.ceil(100 * recipe.thinnest * radius), np.floor(100 * recipe.thickest * radius)
    wall = np.clip(np.round(100 * ratio * radius), thinnest, thickest) / 100
    keep = wall >= least
    resin, radius, wall = resin[keep], radius[keep], wall[keep]
    domes = _batch(resin, radius, wall, [*resins.values()], sensor)
    rated = _rated(domes, resin, [*resins.values()], scene)
    shares = np.linspace(0.0, 1.0, _PRESSURES)
    pressure = np.array([[tenths_below(share * each / KPA) * KPA for share in shares] for each in rated]).ravel()
    row = np.repeat(np.arange(resin.size), _PRESSURES)
    batch = replace(domes.take(row), driving_pressure=pressure)
    return DomeCandidates(tuple(resins), resin[row], radius[row], wall[row], row.astype(float), batch)


def _batch(resin: Array, radius: Array, wall: Array, materials: list[Material], sensor: Sensor) -> SensorBatch:
    """Unpressurised sensors of domes, (n,); everything else is the design's."""
    walls = [material_sensor(material).wall for material in materials]
    number, ones = resin.astype(int), np.ones(radius.size)
    return SensorBatch(
        inner_radius=radius,
        wall_thickness=wall,
        shear_modulus=np.array([wall.shear_modulus for wall in walls])[number],
        ambient_pressure=ones * sensor.gas.ambient_pressure,
        dead_volume=ones * sensor.gas.dead_volume,
        driving_pressure=0.0 * ones,
        depth=radius * min(sensor.protocol.depth / sensor.dome.inner_radius, shipped().recipe.deepest),
        plate_radius=ones * sensor.protocol.plate_radius,
        gauge_limit=ones * sensor.gas.gauge_limit,
        break_stretch=np.array([wall.break_stretch or np.inf for wall in walls])[number],
    )


def _rated(domes: SensorBatch, resin: Array, materials: list[Material], scene: ResolvedDesign) -> Array:
    """Rated pressures of domes, (n,), MPa."""
    limit = domes.shear_modulus * least_limit(domes.wall_ratio, domes.break_stretch)
    spread = np.zeros_like(limit)
    for number, material in enumerate(materials):
        rows = resin == number
        spread[rows] = limit_spread(domes.take(rows), material, scene.printer, LIMIT_ERROR).standard
    return rated_pressure(limit, spread, domes.gauge_limit)


def _grid(*axes: Array) -> list[Array]:
    """Every combination, one array an axis; the last axis runs fastest."""
    return [np.asarray(grid, float).ravel() for grid in np.meshgrid(*axes, indexing="ij")]
