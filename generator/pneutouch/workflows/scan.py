"""Scan of a specimen by a sensor at each driving pressure, and the domes that best distinguish two patterns."""

import re
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.catalogue import DesignSource, Library, ResolvedDesign, load_scene
from pneutouch.catalogue.library import elastomers
from pneutouch.errors import InputError
from pneutouch.evaluation.contact_object import check_shape
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.evaluation.gauge import reading_of
from pneutouch.mechanics.atlas.coverage import resin_outside_atlas
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.atlas.table import shipped
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.rating import LIMIT_ERROR, rated_pressure
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.uncertainty.propagate import limit_spread
from pneutouch.parts import assemble
from pneutouch.parts.specimen.bars import places
from pneutouch.results.scan import FavouringState, SeparatingDome, SeparationRecord, TellablePattern
from pneutouch.selection.problem import least_limit
from pneutouch.spec.material import Material
from pneutouch.spec.options import ScanOptions
from pneutouch.spec.read import Changes
from pneutouch.spec.specimen import Bars
from pneutouch.texture.detect import Detection, detect, least_duration
from pneutouch.texture.separate import BarPattern, Separation, noise_amplitude, separate
from pneutouch.texture.signal import Signal, read_signal
from pneutouch.texture.sliding import NOISE, PreloadContact, Recorder, ScanPath, TextureScan, scan, touch
from pneutouch.texture.substrate import BarRow, MatrixLayer, Substrate
from pneutouch.units import KPA
from pneutouch.wording import rounded, tenths_below
from pneutouch.workflows.specimen import ResolvedSpecimen, draw, load_specimen

KEPT = 20.0
"""Frequency up to which CSV files keep signals, Hz, or twice the highest pattern's; they have five times that rate."""


@dataclass(frozen=True)
class AnalysedSignal:
    """A signal, simulated or measured, with its detections; touch, substrate and scan are None for a measured one."""

    label: str
    signal: Signal
    detections: tuple[Detection, ...]
    touch: PreloadContact | None = None
    substrate: Substrate | None = None
    scan: TextureScan | None = None


@dataclass(frozen=True)
class ScanRun:
    """A scan with its inputs and signals; ``frequencies`` of the patterns in Hz, by name; ``noise`` in MPa rms."""

    specimen: ResolvedSpecimen
    design: ResolvedDesign
    sensor: Sensor
    matrix: MatrixLayer
    bars: tuple[BarRow, ...]
    options: ScanOptions
    noise: float
    path: ScanPath
    frequencies: dict[str, float]
    seen: tuple[AnalysedSignal, ...]

    @property
    def name(self) -> str:
        """Name of the output folder."""
        return f"{self.specimen.name}-{self.design.name}-scan"

    @property
    def kept(self) -> float:
        """Highest frequency that the written signals keep, Hz."""
        return max(KEPT, 2 * max(self.frequencies.values(), default=0.0))


def run_scan(
    specimen: str,
    design: str | DesignSource,
    options: ScanOptions = ScanOptions(),  # noqa: B008 - immutable
    changes: Changes | None = None,
    library: Library | None = None,
) -> ScanRun:
    """Scan a specimen with a sensor, both given by name or path; ``changes`` override fields of the design.

    Raises InputError for what cannot be scanned; see `texture.sliding` and `texture.detect`.
    """
    library = library or Library.default()
    context, scene, sensor = _load_both(specimen, design, changes, library)
    if options.speed_mm_per_s is not None:
        context = replace(context, specimen=_at_speed(context, options.speed_mm_per_s))
    reading = reading_of(scene)
    noise = _noise_of(options, reading.noise if scene.gauge is not None else None)
    recorder = Recorder(noise=noise, step=reading.step or 0.0, limit=reading.limit, seed=options.seed)
    speed = context.specimen.scan.speed_mm_per_s
    bars, matrix = bars_of(context), _matrix_of(context)
    states = [touch(sensor, at_kPa * KPA, options.preload_N) for at_kPa in options.driving_pressures_kPa]
    margin = max((state.contact_radius for state in states), default=0.0)
    length = context.specimen.block.length_mm
    scan_path = ScanPath(margin, length - margin, speed, options.control)
    frequencies = {row.name: speed / row.pitch for row in bars}
    _check_length(context, scan_path, frequencies)
    simulated = [
        _simulated(state, Substrate(matrix, bars, length, state.contact_radius), scan_path, recorder, frequencies)
        for state in states
    ]
    read = [(path, read_signal(path)) for path in options.data]
    measured = [AnalysedSignal(path.name, each, _detected(each, frequencies, str(path))) for path, each in read]
    return ScanRun(
        context, scene, sensor, matrix, bars, options, noise, scan_path, frequencies, (*simulated, *measured)
    )


def _load_both(
    specimen: str, design: str | DesignSource, changes: Changes | None, library: Library, scanned: bool = True
) -> tuple[ResolvedSpecimen, ResolvedDesign, Sensor]:
    """Specimen, design and sensor; ``scanned``: check bars and drawing. Raises InputError, also for two specimens."""
    context = load_specimen(specimen, None, library)
    if isinstance(design, str) and library.specimen_file(design) is not None:
        raise InputError(
            "is a specimen", key="design", value=design, remedy="give the name or path of a sensor's design"
        )
    _matrix_of(context)
    if scanned:
        bars_of(context)
        draw(context)
    scene = load_scene(design, changes, library)
    # The specimen is flat: what presses the sensor elsewhere does not count here.
    return (
        context,
        scene,
        sensor_of(assemble(scene)).replace(body=None, plate_rim=None, friction=0.0, offset=0.0, tilt=0.0, shear=0.0),
    )


def bars_of(context: ResolvedSpecimen) -> tuple[BarRow, ...]:
    """Rows of bars of the specimen. Raises InputError for a layer of another kind, or two rows of one name."""
    rows = []
    for number, layer in enumerate(context.specimen.layer):
        if not isinstance(layer, Bars):
            raise InputError(
                "the scan model covers bars alone",
                file=context.where,
                key=f"layer[{number}].kind",
                value=layer.kind,
                remedy="with `data`, measured signals of any specimen can be read against a specimen of bars with the "
                "same pitches",
            )
        left = places(layer, context.context)
        edges = np.stack([left, left + layer.width_mm], axis=1)
        pitch = layer.pitch(context.specimen.scan.speed_mm_per_s)
        name = layer.name or f"layer {number + 1}"
        rows.append(BarRow(name, pitch, layer.width_mm, layer.height_mm, layer.depth_mm, edges))
    names = [row.name for row in rows]
    if len(set(names)) < len(names):
        raise InputError("layer: two patterns have one name", file=context.where, remedy="give each its own")
    return tuple(rows)


def _matrix_of(context: ResolvedSpecimen) -> MatrixLayer:
    """Matrix of the specimen's block. Raises InputError for a matrix without a shear modulus."""
    modulus, poisson = context.matrix.shear_modulus_MPa, context.matrix.poisson_ratio
    if modulus is None or poisson is None:
        raise InputError(
            "has no shear modulus",
            file=context.where,
            key="block.matrix",
            value=context.specimen.block.matrix,
            remedy="the scan model takes a soft matrix with stiff bars",
        )
    return MatrixLayer(context.specimen.block.height_mm, modulus.nominal, poisson.nominal)


def _at_speed(context: ResolvedSpecimen, speed: float) -> Any:
    """The specimen scanned at another speed; the bars stay where the file's speed put them."""
    given = context.specimen.scan.speed_mm_per_s
    layers = [
        layer.model_copy(update={"pitch_mm": layer.pitch(given), "target_frequency_Hz": None})
        if isinstance(layer, Bars)
        else layer
        for layer in context.specimen.layer
    ]
    update = {"scan": context.specimen.scan.model_copy(update={"speed_mm_per_s": speed}), "layer": layers}
    return context.specimen.model_copy(update=update)


def _noise_of(options: ScanOptions, gauge: float | None = None) -> float:
    """Noise of a sample, MPa rms: as stated, else the ``gauge``'s, else `NOISE`."""
    if options.noise_kPa is not None:
        return options.noise_kPa * KPA
    return NOISE if gauge is None else gauge


def _check_length(context: ResolvedSpecimen, scan_path: ScanPath, frequencies: dict[str, float]) -> None:
    """Raise InputError, with the block length needed, for a path too short to resolve a pattern's frequency."""
    lasts = (scan_path.end - scan_path.start) / scan_path.speed
    for name, frequency in frequencies.items():
        needed = least_duration(frequency)
        if lasts < needed:
            raise InputError(
                f"{name}: {frequency:.4g} Hz at {scan_path.speed:g} mm/s: the path of "
                f"{max(scan_path.end - scan_path.start, 0):.4g} mm between the block's ends lasts "
                f"{max(lasts, 0):.4g} s and must last {needed:.4g} s",
                file=context.where,
                remedy=f"block.length_mm must be at least {needed * scan_path.speed + 2 * scan_path.start:.4g}",
            )


def _detected(signal: Signal, frequencies: dict[str, float], where: str) -> tuple[Detection, ...]:
    """One detection for each pattern, shared by patterns of one frequency; none for a constant signal."""
    sought = sorted(set(frequencies.values()))
    if np.ptp(signal.pressure) == 0:
        return ()
    by = dict(zip(sought, detect(signal, sought, where=where), strict=True))
    return tuple(by[frequency] for frequency in frequencies.values())


def _simulated(
    state: PreloadContact, substrate: Substrate, scan_path: ScanPath, recorder: Recorder, frequencies: dict[str, float]
) -> AnalysedSignal:
    simulated = scan(state, substrate, scan_path, recorder)
    label = f"{state.driving_pressure / KPA:g} kPa"
    return AnalysedSignal(
        label, simulated.signal, _detected(simulated.signal, frequencies, label), state, substrate, simulated
    )


_RADII, _RATIOS, _PRESSURES = 8, 8, 9
_SMALLEST, _LARGEST = 4.0, 20.0
"""Smallest and largest inner radius considered, mm."""
_SHOWN, _DIGITS = 8, 4


@dataclass(frozen=True)
class DomeCandidates:
    """Candidate domes, (n,) each, a row a driving pressure: index in ``names``, sizes (mm), number of the dome."""

    names: tuple[str, ...]
    resin: Array
    radius: Array
    wall: Array
    dome: Array
    batch: SensorBatch


def parse_patterns(text: str) -> tuple[BarPattern, BarPattern]:
    """Two patterns from a text ``PITCH1@DEPTH1,PITCH2@DEPTH2`` in mm. Raises InputError for another text."""
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
    """Domes that best distinguish two patterns (``text``); the specimen gives matrix and speed, the design all else."""
    library = library or Library.default()
    patterns = parse_patterns(text)
    context, scene, sensor = _load_both(specimen, design, changes, library, scanned=False)
    speed = context.specimen.scan.speed_mm_per_s if options.speed_mm_per_s is None else options.speed_mm_per_s
    floor = tuple(noise_amplitude(speed / pattern.pitch, _noise_of(options)) for pattern in patterns)
    domes = candidates(scene, sensor, library)
    separation = separate(
        domes.batch, domes.dome, options.preload_N, _matrix_of(context), patterns, (floor[0], floor[1])
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
    """Candidates on a grid of wall ratio, radius and pressure, for resins that the printer runs and the atlas covers.

    Sizes are in hundredths of a millimetre and pressures in tenths of a kPa, as they are shown; no pressure is above
    its dome's rated one. Raises InputError without such a resin.
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
    axes = (
        np.arange(len(resins), dtype=float),
        np.geomspace(recipe.thinnest, recipe.thickest, _RATIOS),
        np.round(np.geomspace(_SMALLEST, _LARGEST, _RADII), 2),
    )
    resin, ratio, radius = (grid.ravel() for grid in np.meshgrid(*axes, indexing="ij"))
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
    """Sensors with these domes, (n,), at a driving pressure of 0; all else is the design's."""
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
