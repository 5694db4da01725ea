"""Graded selection: a grade for a target that no constant mix meets, and the constant mixes of its size."""

from dataclasses import dataclass, replace

import numpy as np

from pneutouch.catalogue import Library, ResolvedDesign
from pneutouch.catalogue.library import elastomers
from pneutouch.errors import InputError
from pneutouch.evaluation.charts import in_resin
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.mechanics.atlas.table import shipped
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.prediction import Limits
from pneutouch.mechanics.rating import ratings
from pneutouch.mechanics.sensor import Sensor
from pneutouch.parts import assemble
from pneutouch.selection.candidates import evaluated
from pneutouch.selection.graded import (
    GradeSearch,
    GradeTarget,
    GradeTrial,
    TrialReport,
    UniformMembrane,
    cost,
    grade_search,
    middle_wall,
    nearest_fraction,
    shares,
    trial_of,
)
from pneutouch.selection.mixes import levels
from pneutouch.selection.problem import SelectionProblem
from pneutouch.spec.grade import Grade
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer
from pneutouch.spec.read import Changes
from pneutouch.spec.target import Target
from pneutouch.spec.toml_text import assignments
from pneutouch.units import KPA
from pneutouch.workflows.select.base import ResinPair, base_scene, requested_pair, setting_changes
from pneutouch.workflows.select.checks import judge, other_contact, source_of, without_plate
from pneutouch.workflows.select.select import grade_text, problem_of

_LEVELS = 4
"""Number of fractions scanned at pole and rim: moduli in steps of two for TangoPlus and VeroClear, 16 trials."""
_TRIALS = 48
_WALL_ROUNDS = 2
"""Number of corrections of the wall under a contact that the atlas does not cover; the solid then searches the
grade."""
_SMALLER = "give a smaller given.inner_radius_mm (`inner_radius`)"


@dataclass(frozen=True)
class GradedSelectionRun:
    """A search for a grade with all that is needed to show and write it.

    changes: what the target changes in its base, by ``table.key``. sensor: the base's, with the radius and wall of the
    search. constants: catalogue resins, then the nearest mix. left_out: resins that are no constants, with the reason.
    rejected: why ``check`` rejects a grade that meets the target; None if it passes or no grade meets it."""

    target: Target
    base: ResolvedDesign
    changes: Changes
    sensor: Sensor
    pair: ResinPair
    grade_target: GradeTarget
    search: GradeSearch
    constants: tuple[UniformMembrane, ...]
    left_out: dict[str, str]
    rejected: str | None = None

    @property
    def passes(self) -> bool:
        """True if a grade meets the target and passes ``check``."""
        return self.search.met and self.rejected is None

    @property
    def solves(self) -> int:
        """Number of solid models solved, each inflated once and pressed at every pressure of the target."""
        return len(self.search.trials) + len(self.constants)

    @property
    def nearest(self) -> UniformMembrane:
        """The constant mix nearest to the target."""
        return self.constants[-1]

    @property
    def grade(self) -> Grade:
        """The best grade."""
        return self.pair.grade(self.search.best.pole, self.search.best.rim)

    def meets(self, trial: GradeTrial) -> bool:
        """True if a membrane meets every tolerance and limit."""
        return max(shares(self.grade_target, trial).values()) <= 1.0

    def assignments(self) -> list[str]:
        """Changes that turn the base design into the graded one, as ``table.key=value``."""
        pressures_kPa = sorted({0.0, *(round(p / KPA, 6) for p in self.grade_target.pressures)})
        values = {
            "membrane.material": grade_text(self.grade),
            "membrane.inner_radius_mm": f"{self.sensor.dome.inner_radius:.6g}",
            "membrane.wall_thickness_mm": f"{self.sensor.dome.wall_thickness:.6g}",
            "pneumatics.driving_pressures_kPa": pressures_kPa,
        }
        return [f"{key}={value}" for key, value in values.items()] + assignments(self.changes)

    def rejection(self, library: Library) -> str | None:
        """Reason why ``check`` rejects the best grade; None if it passes."""
        why = judge(source_of(self.base, self.assignments()), library, predicted=True).reason
        return None if why is None else ": ".join(part for part in why if part)


def select_graded(
    target: Target,
    where: str,
    library: Library | None = None,
    progress: TrialReport = lambda trial, done, most: None,
    trials: int | None = None,
) -> GradedSelectionRun:
    """Search a grade for a target that requires one. Raises InputError if it names something unknown.

    ``where`` names the file in messages; ``trials`` bounds the number of grades solved (None: `_TRIALS`). A grade that
    meets the target is judged as ``check`` does."""
    library = library or Library.default()
    scene = base_scene(target, where, library)
    pair = requested_pair(target, where, scene.printer, library)
    assert pair is not None
    grade_target, base = _grade_target(target), sensor_of(assemble(scene))
    problem = problem_of(target, scene, base, (pair.resin(float(levels(pair.law, 3)[1])),))
    sensor = base.replace(wall_thickness=_wall(target, where, grade_target, problem, base))
    _check_footprint(target, where, problem, sensor)
    changes = setting_changes(target, library)

    def solve(pole: float, rim: float) -> GradeTrial:
        return _trial(sensor, pair.material(pair.grade(pole, rim)), scene.printer, grade_target, pole, rim)

    search = grade_search(grade_target, levels(pair.law, _LEVELS), solve, progress, trials or _TRIALS)
    constants, left_out = _catalogue(scene, sensor, grade_target, library)
    nearest = _nearest(grade_target, problem, pair, sensor, scene.printer, search)
    run = GradedSelectionRun(
        target, scene, changes, sensor, pair, grade_target, search, (*constants, nearest), left_out
    )
    return replace(run, rejected=run.rejection(library)) if search.met else run


def _grade_target(target: Target) -> GradeTarget:
    required = target.target
    assert required.sensitivity_kPa_per_N is not None
    both_kPa = required.same_sensitivity_at_kPa
    pressures_kPa = both_kPa if both_kPa is not None else [required.driving_pressure_kPa or 0.0]
    return GradeTarget(
        required.sensitivity_kPa_per_N,
        required.tolerance_percent / 100,
        tuple(p * KPA for p in pressures_kPa),
        None if both_kPa is None else required.same_within_percent / 100,
        required.force_range_N,
        required.widest_range,
    )


def _wall(target: Target, where: str, grade_target: GradeTarget, problem: SelectionProblem, base: Sensor) -> float:
    """Wall, mm: as given; else the one at which the middle mix has the sensitivity; else the base's. Raises InputError
    if too thick or thin."""
    radius, most = base.dome.inner_radius, target.target.max_diameter_mm
    thickest = np.inf if most is None else 0.5 * most - radius
    wall = target.given.wall_thickness_mm
    if wall is None:
        wall = _middle_wall(grade_target, problem, base, thickest) or base.dome.wall_thickness
    if wall > thickest + 1e-9:
        raise InputError(
            f"a dome of inner radius {radius:g} mm and wall {wall:g} mm is {2 * (radius + wall):g} mm wide",
            file=where,
            key="target.max_diameter_mm",
            value=most,
            remedy=_SMALLER,
        )
    least = f"the printer's least wall is {problem.least_wall:g} mm"
    if wall < problem.least_wall and target.given.wall_thickness_mm is not None:
        raise InputError(least, file=where, key="given.wall_thickness_mm", value=wall)
    if wall < problem.least_wall:
        raise InputError(
            f"for inner radius {radius:g} mm the atlas has no wall with the sensitivity, and the base's own wall is "
            f"{wall:g} mm; {least}",
            file=where,
            remedy="give given.wall_thickness_mm (`wall`) or another given.inner_radius_mm (`inner_radius`)",
        )
    return wall


def _middle_wall(grade_target: GradeTarget, problem: SelectionProblem, base: Sensor, thickest: float) -> float | None:
    """Wall by `middle_wall`, mm, or None; under a contact that the atlas does not cover the solid corrects the
    target."""
    radius, target_kPa_per_N = base.dome.inner_radius, grade_target.sensitivity
    problem = without_plate(problem, base)
    wall = middle_wall(grade_target, problem, radius, thickest)
    for _ in range(_WALL_ROUNDS if other_contact(base) is not None else 0):
        if wall is None:
            break
        middle = in_resin(base.replace(wall_thickness=wall), problem.resins[0].material)
        solved = trial_of(middle, grade_target.pressures[:1], lambda limits: limits.lowest)
        place = np.zeros(1), np.array([radius]), np.array([wall]), np.array(grade_target.pressures[:1])
        factor = solved.sensitivity[0] / evaluated(problem, *place).figures.sensitivity
        if not np.isfinite(factor):
            break
        wall = middle_wall(replace(grade_target, sensitivity=target_kPa_per_N / factor), problem, radius, thickest)
    return wall


def _check_footprint(target: Target, where: str, problem: SelectionProblem, sensor: Sensor) -> None:
    """Raise InputError if the whole sensor is wider than the target allows."""
    radius, wall, most = sensor.dome.inner_radius, sensor.dome.wall_thickness, target.target.max_footprint_mm
    assert problem.connector is not None
    footprint = float(problem.connector(np.array([radius]), np.array([wall])).diameter[0])
    if most is not None and footprint > most:
        raise InputError(
            f"the sensor with a dome of inner radius {radius:g} mm and wall {wall:g} mm is {footprint:g} mm wide",
            file=where,
            key="target.max_footprint_mm",
            value=most,
            remedy=f"{_SMALLER} or another connector",
        )


def _trial(
    sensor: Sensor,
    material: Material,
    printer: Printer,
    grade_target: GradeTarget,
    pole: float = np.nan,
    rim: float = np.nan,
) -> GradeTrial:
    """Trial of the sensor in a material, with its rated pressure."""
    built = in_resin(sensor, material)

    def rate(limits: Limits) -> float:
        return ratings([limits], [built], material, printer)[0].pressure

    return trial_of(built, grade_target.pressures, rate, pole, rim)


def _catalogue(
    scene: ResolvedDesign, sensor: Sensor, grade_target: GradeTarget, library: Library
) -> tuple[list[UniformMembrane], dict[str, str]]:
    """All elastomers of the catalogue at this size, softest first, and the reasons, by name, for those left out."""
    resins, out = [], {}
    for name, material in elastomers(library).items():
        if scene.printer.mode_for(material) is None:
            out[name] = f"the {scene.printer.title} cannot run it"
        else:
            resins.append((material_sensor(material).wall.shear_modulus, name, material))
    order = sorted(resins, key=lambda entry: entry[:2])
    return [UniformMembrane(name, None, _trial(sensor, m, scene.printer, grade_target)) for _, name, m in order], out


def _nearest(
    grade_target: GradeTarget,
    problem: SelectionProblem,
    pair: ResinPair,
    sensor: Sensor,
    printer: Printer,
    search: GradeSearch,
) -> UniformMembrane:
    """Constant mix nearest to the target, solved by the solid: found by the atlas, else the nearest of those tried.

    If the solid finds the atlas's mix outside a tolerance, the atlas searches once more, corrected by that solution."""

    def solved(fraction: float) -> UniformMembrane:
        grade = pair.grade(round(fraction, 4))
        trial = _trial(sensor, pair.material(grade), printer, grade_target)
        return UniformMembrane(grade.label, grade.fractions[0], trial)

    size = sensor.dome.inner_radius, sensor.dome.wall_thickness
    by_atlas = nearest_fraction(grade_target, problem, pair.law, size) if _atlas_covers(problem, pair, sensor) else None
    if by_atlas is None:
        even = [trial for trial in search.trials if trial.pole == trial.rim]
        return solved(min(even, key=lambda trial: max(shares(grade_target, trial).values())).pole)
    nearest = solved(by_atlas[0])
    factor = np.array(nearest.trial.sensitivity) / by_atlas[1]
    if max(shares(grade_target, nearest.trial).values()) <= 1.0 or not np.isfinite(factor).all():
        return nearest
    again = nearest_fraction(grade_target, problem, pair.law, size, factor)
    others = [nearest] if again is None else [nearest, solved(again[0])]
    return min(others, key=lambda membrane: cost(grade_target, membrane.trial))


def _atlas_covers(problem: SelectionProblem, pair: ResinPair, sensor: Sensor) -> bool:
    """True if the atlas covers the constant mixes of a pair."""
    middle, recipe = problem.resins[0].material, shipped().recipe
    return (
        other_contact(sensor) is None
        and material_sensor(middle).wall.poisson_ratio == recipe.poisson_ratio
        and sensor.gas.ambient_pressure <= recipe.stiffest * float(pair.law.modulus_at(np.array(0.0)))
    )
