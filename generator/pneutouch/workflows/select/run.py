"""A target to designs: resolves its names, searches, confirms the best by the solid, writes the chosen one."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.catalogue import DEFAULT, Library, ResolvedDesign, load_scene
from pneutouch.errors import InputError, PneutouchError
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.evaluation.table_s1 import is_near_paper
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.atlas.table import shipped
from pneutouch.mechanics.atlas_states import resin_outside_atlas
from pneutouch.mechanics.models import NUMERICAL
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.uncertainty import ModelErrors, budget, measured_errors
from pneutouch.mechanics.uncertainty.source import FIGURES, SENSITIVITY
from pneutouch.parts import assemble
from pneutouch.selection import Candidate, CandidateResin, SelectionProblem, SelectionResult, choose
from pneutouch.selection.mixes import met_by_fraction
from pneutouch.selection.pool import CandidatePool
from pneutouch.spec.design import DesignFile
from pneutouch.spec.grade import Grade
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer
from pneutouch.spec.read import read_toml, validate
from pneutouch.spec.target import Target
from pneutouch.spec.toml_text import value_text
from pneutouch.units import KPA
from pneutouch.workflows.select.mix import USUAL, ResinPair, mix_resins, pair_of

_CONFIRMED = 3
"""Designs that are confirmed by the solid."""
_DEAD_VOLUMES = 8
"""Radii at which the connector is drawn for its dead volume; between them it is straight."""


@dataclass(frozen=True)
class Confirmation:
    """The result of the solid for a design: sensitivity (kPa/N) and whether it lies within the stated uncertainty."""

    sensitivity_kPa_per_N: float
    within: bool


@dataclass(frozen=True)
class SelectionRun:
    """An answer with everything needed to show, check and write it. left_out: resins and why."""

    target: Target
    base: ResolvedDesign
    sensor: Sensor
    problem: SelectionProblem
    answer: SelectionResult
    left_out: dict[str, str]
    confirmed: tuple[Confirmation, ...]

    def assignments(self, choice: Candidate) -> list[str]:
        """What turns the base design into a choice, as ``table.key=value``."""
        pressure_kPa = float(choice.pool.pressure[0]) / KPA
        pressures = sorted({0.0, round(pressure_kPa, 6)})
        values = [
            f"membrane.material={_written(choice.resin)}",
            f"membrane.inner_radius_mm={float(choice.pool.radius[0]):.6g}",
            f"membrane.wall_thickness_mm={float(choice.pool.wall[0]):.6g}",
            f"pneumatics.driving_pressures_kPa={pressures}",
        ]
        if self.base.design.indentation.depth_mm is not None:
            # A depth in millimetres belongs to the base's own dome: it goes with the radius.
            values.append(f"indentation.depth_mm={self.problem.depth_share * float(choice.pool.radius[0]):.8g}")
        return values + [f"{key}={value}" for key, value in setting_changes(self.target).items()]

    def sensor_of(self, choice: Candidate) -> Sensor:
        """A choice as a sensor, in everything else the base design's."""
        pool, resin = choice.pool, choice.resin
        batch = self.problem.batch(pool.resin, pool.radius, pool.wall, pool.pressure)
        return _like(self.sensor, batch, 0).replace(
            depth=float(batch.depth[0]),
            shear_modulus=resin.shear_modulus,
            law=None,
            poisson_ratio=self.problem.recipe.poisson_ratio,
            break_stretch=None if np.isinf(resin.break_stretch) else resin.break_stretch,
        )


def select(target: Target, where: str, library: Library | None = None) -> SelectionRun:
    """Answer a target. Raises InputError where it names what there is not; ``where`` names the file in messages."""
    library = library or Library.default()
    scene = base_scene(target, where, library)
    sensor = sensor_of(assemble(scene))
    pair = requested_pair(target, where, scene.printer, library)
    if pair is None:
        resins, left_out = _resins(target, where, scene, sensor, library)
    else:
        resins, left_out = mix_resins(pair, sensor.gas.ambient_pressure)
    problem = problem_of(target, scene, sensor, resins)
    answer = choose(
        problem,
        (target.weights.robustness, target.weights.tunability),
        _uncertainty(scene, sensor, library),
        None if pair is None else _refined(pair),
    )
    run = SelectionRun(target, scene, sensor, problem, answer, left_out, ())
    return replace(run, confirmed=tuple(_confirm(run, choice) for choice in answer.designs[:_CONFIRMED]))


def setting_changes(target: Target) -> dict[str, Any]:
    """What a target's setting changes in the base design, by ``table.key``."""
    setting = target.setting
    values = {
        "print.profile": setting.profile,
        "pneumatics.tube_length_mm": setting.tube_length_mm,
        "pneumatics.dead_volume_mL": setting.dead_volume_mL,
    }
    return {key: value for key, value in values.items() if value is not None}


def _written(resin: CandidateResin) -> str:
    """A resin as a design names it: by its name, or as the mix that it is."""
    return resin.name if resin.grade is None else grade_text(resin.grade)


def grade_text(grade: Grade) -> str:
    """A grade as a design file has it."""
    return value_text(grade.model_dump(by_alias=True, exclude_none=True))


def requested_pair(target: Target, where: str, printer: Printer, library: Library) -> ResinPair | None:
    """The pair to mix: the one named, the usual one for a grade; None where resins are to be chosen from."""
    given = target.given
    if given.mix is None and not given.graded:
        return None
    return pair_of(given.mix or USUAL, printer, library, where, named=given.mix is not None)


def _refined(pair: ResinPair) -> Callable[[SelectionProblem, CandidatePool], tuple[SelectionProblem, CandidatePool]]:
    return lambda problem, pool: met_by_fraction(problem, pool, pair.law, pair.resin)


def base_scene(target: Target, where: str, library: Library) -> ResolvedDesign:
    """The scene that gives everything the target does not; its own dome is replaced by the candidates'."""
    given = target.given
    changes = {**setting_changes(target), "membrane.material": _some_resin(target, where, library)}
    sizes = {"inner_radius_mm": given.inner_radius_mm, "wall_thickness_mm": given.wall_thickness_mm}
    changes |= {f"membrane.{key}": size for key, size in sizes.items() if size is not None}
    try:
        return load_scene(target.setting.base or DEFAULT, changes, library)
    except InputError as error:
        raise InputError(f"{error}", file=where) from None


def _some_resin(target: Target, where: str, library: Library) -> str:
    """A resin that the base can be drawn with: the first of those allowed that its printer runs, else the first."""
    setting = target.setting
    profile = setting.profile
    if profile is None:
        base = library.design_file(setting.base) if setting.base else None
        design = validate(DesignFile, read_toml(base), str(base)) if base else DesignFile()
        profile = design.print.profile
    printer: Printer = library.load("printers", profile, file=where, key="setting.profile")
    pair = requested_pair(target, where, printer, library)
    names = [pair.soft] if pair else target.given.materials or sorted(library.paths("materials"))
    loaded = {name: library.load("materials", name, file=where, key="given.materials") for name in names}
    for name in target.given.materials or []:
        if loaded[name].kind != "elastomer":
            raise InputError(
                f"{name} is {loaded[name].kind}", file=where, key="given.materials", remedy="it must be an elastomer"
            )
    runs = [name for name, m in loaded.items() if m.kind == "elastomer" and printer.mode_for(m) is not None]
    if not runs:
        raise InputError(
            f"the {printer.title} runs none of {', '.join(names)}", file=where, remedy="give other materials or profile"
        )
    return runs[0]


def _resins(
    target: Target, where: str, scene: ResolvedDesign, sensor: Sensor, library: Library
) -> tuple[tuple[CandidateResin, ...], dict[str, str]]:
    """Resins the printer runs and the atlas covers, and why the others are left out."""
    known = library.all("materials", Material)
    names = target.given.materials or sorted(name for name, m in known.items() if m.kind == "elastomer")
    resins, out = [], {}
    for name in names:
        material = library.load("materials", name, file=where, key="given.materials")
        wall = material_sensor(material).wall
        if scene.printer.mode_for(material) is None:
            out[name] = f"the {scene.printer.title} cannot run it"
        elif (why := resin_outside_atlas(wall, sensor.gas.ambient_pressure)) is not None:
            out[name] = why
        else:
            resins.append(CandidateResin(name, material, wall.shear_modulus, wall.break_stretch or np.inf))
    return tuple(resins), out


def problem_of(
    target: Target, scene: ResolvedDesign, sensor: Sensor, resins: tuple[CandidateResin, ...]
) -> SelectionProblem:
    """The search in numbers, on a base with its sensor."""
    required, given = target.target, target.given
    feature = scene.printer.smallest.wall("elastomer")
    return SelectionProblem(
        resins=resins,
        sensitivity_kPa_per_N=required.sensitivity_kPa_per_N,
        tolerance=required.tolerance_percent / 100,
        driving_pressure=None if required.driving_pressure_kPa is None else required.driving_pressure_kPa * KPA,
        force_range=required.force_range_N,
        stiffness=(required.stiffness_least_N_per_mm, required.stiffness_most_N_per_mm),
        max_diameter=required.max_diameter_mm,
        inner_radius=given.inner_radius_mm,
        wall_thickness=given.wall_thickness_mm,
        least_wall=feature.least or feature.recommended,
        ambient_pressure=sensor.gas.ambient_pressure,
        dead_volume=_dead_volume(scene, sensor),
        plate_radius=sensor.protocol.plate_radius,
        gauge_limit=sensor.gas.gauge_limit,
        depth_share=min(sensor.protocol.depth / sensor.dome.inner_radius, shipped().recipe.deepest),
        steps=sensor.protocol.steps,
        recipe=shipped().recipe,
    )


def _dead_volume(scene: ResolvedDesign, sensor: Sensor) -> Callable[[Array], Array]:
    """Dead volume (mm3) over the inner radius: drawn at a few radii where the connector's channel follows it."""
    if scene.design.pneumatics.dead_volume_mL is not None:
        return lambda radius: np.full_like(radius, sensor.gas.dead_volume)
    radii = np.geomspace(2.0, 60.0, _DEAD_VOLUMES)
    known = [(radius, volume) for radius in radii if (volume := _drawn(scene, float(radius))) is not None]
    if not known:
        return lambda radius: np.full_like(radius, sensor.gas.dead_volume)
    at, volumes = np.array(known).T
    return lambda radius: np.interp(radius, at, volumes)


def _drawn(scene: ResolvedDesign, radius: float) -> float | None:
    """Dead volume of the scene's connector on another dome, or None where it cannot be drawn."""
    membrane = scene.design.membrane.model_copy(update={"inner_radius_mm": radius, "wall_thickness_mm": 0.15 * radius})
    try:
        return assemble(replace(scene, design=scene.design.model_copy(update={"membrane": membrane}))).dead_volume
    except PneutouchError:
        return None


def _uncertainty(
    scene: ResolvedDesign, sensor: Sensor, library: Library
) -> Callable[[CandidateResin, SensorBatch], Array]:
    materials = library.all("materials", Material)
    known = measured_errors(materials)

    def relative(resin: CandidateResin, batch: SensorBatch) -> Array:
        errors = known.get(resin.name) or ModelErrors(pool=next(iter(known.values())).pool if known else ())
        near = np.array([is_near_paper(_like(sensor, batch, i)) for i in range(len(batch))])
        uncertainty = budget(
            batch,
            resin.material,
            scene.printer,
            near_paper=near,
            errors=errors,
            numerical={FIGURES[SENSITIVITY]: NUMERICAL["atlas"]},
        )
        return np.asarray(uncertainty.expanded[SENSITIVITY])

    return relative


def _like(sensor: Sensor, batch: SensorBatch, i: int) -> Sensor:
    return sensor.replace(
        inner_radius=float(batch.inner_radius[i]),
        wall_thickness=float(batch.wall_thickness[i]),
        dead_volume=float(batch.dead_volume[i]),
        flange=None,
    )


def _confirm(selection: SelectionRun, choice: Candidate) -> Confirmation:
    """The solid's sensitivity, compared with that of the atlas."""
    from pneutouch.mechanics.solid_states import solid_states

    figures = solid_states(selection.sensor_of(choice), choice.pool.pressure)[0].figures
    if figures is None:
        return Confirmation(float("nan"), False)
    stated_kPa_per_N = float(choice.pool.response.lines.sensitivity_kPa_per_N[0])
    return Confirmation(
        figures.sensitivity_kPa_per_N,
        bool(abs(np.log(figures.sensitivity_kPa_per_N / stated_kPa_per_N)) <= choice.expanded),
    )
