"""Selection of designs for a target: resolve names, search, check, and confirm the best by the solid."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from pneutouch.catalogue import Library, ResolvedDesign
from pneutouch.catalogue.library import CachedLibrary, elastomers
from pneutouch.catalogue.printers import casting_missing
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import Evaluation
from pneutouch.mechanics.atlas.coverage import resin_outside_atlas
from pneutouch.mechanics.atlas.figures import wider_box
from pneutouch.mechanics.atlas.table import Atlas, shipped
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.rating import LIMIT_ERROR
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.uncertainty.propagate import limit_spread
from pneutouch.mechanics.uncertainty.sources.model_error import measured_errors
from pneutouch.results.selection import GaugeTrial
from pneutouch.selection import Candidate, CandidateResin, SelectionProblem, SelectionResult, choose
from pneutouch.selection.choose import Refine
from pneutouch.selection.contact_search import ContactSelection, choose_by_solid
from pneutouch.selection.mixes import met_by_fraction
from pneutouch.spec.grade import Grade
from pneutouch.spec.material import Material
from pneutouch.spec.read import Changes
from pneutouch.spec.target import Target
from pneutouch.spec.toml_text import assignments, value_text
from pneutouch.units import KPA
from pneutouch.workflows.select.base import (
    base_scene,
    mix_resins,
    prints,
    requested_pair,
    setting_changes,
    with_connector,
)
from pneutouch.workflows.select.checks import (
    CandidateSolver,
    RejectedDesign,
    base_around,
    base_sensor,
    connector_fit,
    dead_volume,
    judge,
    other_contact,
    sensitivity_uncertainties,
    sized_as,
    source_of,
    without_plate,
)

_CONFIRMED = 3
"""Number of designs that the solid confirms."""
_NOTHING = SelectionResult([], None, [], 0)
PLATE_SHARE = 1.6
"""Radius of the plate over R0 if no base gives one: the contact of an inflated dome grows past R0."""


@dataclass(frozen=True)
class Confirmation:
    """Result of the solid for a design: sensitivity (kPa/N), and True if it lies within the stated uncertainty."""

    sensitivity: float
    within: bool


@dataclass(frozen=True)
class SelectionRun:
    """A selection with all that is needed to show, check and write it.

    changes: what the target changes in its base, by ``table.key``. left_out: resins, with the reason. rejected: designs
    that ``check`` rejects, best first. judged: evaluations by rank of designs of the answer that pass ``check``.
    confirmed: the solid's results by rank. gauges: those considered, if the target leaves the gauge open. by_solid: the
    search by the solid, None for a contact that the atlas covers."""

    target: Target
    base: ResolvedDesign
    changes: Changes
    sensor: Sensor
    problem: SelectionProblem
    answer: SelectionResult
    left_out: dict[str, str]
    rejected: tuple[RejectedDesign, ...] = ()
    judged: Mapping[int, Evaluation] = field(default_factory=dict)
    confirmed: tuple[Confirmation, ...] = ()
    by_solid: ContactSelection | None = None
    gauges: tuple[GaugeTrial, ...] = ()

    def assignments(self, choice: Candidate) -> list[str]:
        """Changes that turn the base design into a candidate, as ``table.key=value``."""
        pool = choice.pool
        radius, pressure_kPa = float(pool.radius[0]), float(pool.pressure[0]) / KPA
        pressures = sorted({0.0, round(pressure_kPa, 6)})
        values = [
            f"membrane.material={choice.resin.name if choice.resin.grade is None else grade_text(choice.resin.grade)}",
            f"membrane.inner_radius_mm={radius:.6g}",
            f"membrane.wall_thickness_mm={float(pool.wall[0]):.6g}",
            f"pneumatics.driving_pressures_kPa={pressures}",
        ]
        if self.base.design.indentation.depth_mm is not None:
            # A depth in millimetres belongs to the base's own dome: it goes with the radius.
            values.append(f"indentation.depth_mm={self.problem.depth_share * radius:.8g}")
        plate = 2 * float(self.problem.plate(pool.radius)[0])
        if self.base.design.contact.is_plate and plate > self.base.design.indentation.plate_diameter_mm:
            values.append(f"indentation.plate_diameter_mm={plate:g}")
        return values + assignments(self.changes)

    def footprint(self, choice: Candidate) -> float:
        """Diameter of the whole sensor, mm: membrane, flange and connector, without a port at its side."""
        assert self.problem.connector is not None
        return float(self.problem.connector(choice.pool.radius, choice.pool.wall).diameter[0])

    def sensor_of(self, choice: Candidate) -> Sensor:
        """Sensor of a candidate, with all other properties from the base design."""
        pool, resin = choice.pool, choice.resin
        batch = self.problem.batch(pool.resin, pool.radius, pool.wall, pool.pressure)
        return sized_as(self.sensor, batch, 0).replace(
            depth=float(batch.depth[0]),
            shear_modulus=resin.shear_modulus,
            law=None,
            poisson_ratio=self.problem.recipe.poisson_ratio,
            break_stretch=None if np.isinf(resin.break_stretch) else resin.break_stretch,
            base=base_around(self.base, float(pool.radius[0]), float(pool.wall[0])),
        )


STEPS = ("base", "search", "print rules", "solid")
"""Steps that a selection reports, in order."""


def select(
    target: Target,
    where: str,
    library: Library | None = None,
    *,
    written: int | None = None,
    progress: Callable[[str], None] = lambda step: None,
) -> SelectionRun:
    """Search a target's designs. Raises InputError if it names something unknown; ``where`` names the file in messages.

    The best design and that of rank ``written``, to be saved, pass the whole ``check``, those between them the print
    rules; designs that do not are taken out of the answer."""
    library = CachedLibrary((library or Library.default()).folders)
    run = found(target, where, library, progress=progress)
    progress("print rules")
    run = passing(run, written, library)
    if run.by_solid is not None:
        return run
    progress("solid")
    best = enumerate(run.answer.designs[:_CONFIRMED], start=1)
    return replace(run, confirmed=tuple(_confirm(run, choice, run.judged.get(rank)) for rank, choice in best))


def found(
    target: Target,
    where: str,
    library: Library,
    *,
    thorough: bool = True,
    progress: Callable[[str], None] = lambda step: None,
) -> SelectionRun:
    """Search for designs, by rank; neither the print rules nor the solid check them.

    Without ``thorough`` only the coarse scan is searched: a design between its points may be missed."""
    progress("base")
    scene = base_scene(target, where, library)
    sensor = base_sensor(scene)
    pair = requested_pair(target, where, scene.printer, library)
    if pair is None:
        resins, left_out = resins_of(target, where, scene, sensor, library)
    else:
        resins, left_out = mix_resins(pair, sensor.gas.ambient_pressure)
    problem = problem_of(target, scene, sensor, resins)
    progress("search")
    run = SelectionRun(target, scene, setting_changes(target, library), sensor, problem, _NOTHING, left_out)
    refine = None if pair is None else lambda problem, pool: met_by_fraction(problem, pool, pair.law, pair.resin)
    return _answered(run, refine, library, thorough=thorough)


def _answered(run: SelectionRun, refine: Refine | None, library: Library, *, thorough: bool) -> SelectionRun:
    """The run with its answer, by the atlas, or by the solid if only that covers the base's contact or a resin's
    law."""
    target, problem = run.target, run.problem
    weights = target.weights.robustness, target.weights.tunability
    errors = measured_errors(library.all("materials", Material))
    anywhere = target.weights.contact_anywhere
    uncertainty = partial(sensitivity_uncertainties, run.base, run.sensor, errors, anywhere=anywhere)
    laws = [resin.name for resin in problem.resins if resin.material.law is not None]
    other = other_contact(run.sensor) or (f"the atlas has no law as that of {laws[0]}" if laws else None)
    if other is not None and anywhere:
        raise InputError(
            f"the table of contact anywhere is for designs that a central plate calibrates, and {other}",
            key="weights.contact_anywhere",
            value=True,
            remedy="leave out contact_anywhere, or the contact",
        )
    if other is None:
        return replace(run, answer=choose(problem, weights, uncertainty, refine, thorough=thorough))
    run = replace(run, problem=without_plate(problem, run.sensor))
    solver = CandidateSolver(run.base, run.assignments, library)
    selection = choose_by_solid(run.problem, weights, solver.expanded, solver, refine)
    return replace(run, answer=selection.result, by_solid=selection, left_out=run.left_out | selection.unsettled)


def passing(run: SelectionRun, written: int | None, library: Library) -> SelectionRun:
    """The run without designs that do not pass ``check``, which are tried by rank until ``written`` (or one) pass."""
    passed: list[Candidate] = []
    rejected: list[RejectedDesign] = []
    judged: dict[int, Evaluation] = {}
    waiting = list(run.answer.designs)
    while waiting and len(passed) < (written or 1):
        choice, rank = waiting.pop(0), len(passed) + 1
        source = source_of(run.base, run.assignments(choice))
        reason, evaluation = judge(source, library, predicted=rank in (1, written))
        if reason is not None:
            rejected.append(RejectedDesign(choice, *reason))
            continue
        passed.append(choice)
        if evaluation is not None:
            judged[rank] = evaluation
    answer = replace(run.answer, designs=[*passed, *waiting])
    return replace(run, answer=answer, rejected=tuple(rejected), judged=judged)


def grade_text(grade: Grade) -> str:
    """Text for a grade in a design file."""
    return value_text(grade.model_dump(by_alias=True, exclude_none=True))


def resins_of(
    target: Target, where: str, scene: ResolvedDesign, sensor: Sensor, library: Library
) -> tuple[tuple[CandidateResin, ...], dict[str, str]]:
    """Resins that the printer runs and the atlas covers, and the reasons, by name, for others of its process left
    out."""
    casting = scene.printer.is_casting
    offered = (name for name, one in elastomers(library, casting).items() if one.is_cast == casting)
    names = target.given.materials or sorted(offered)
    resins, out = [], {}
    for name in names:
        material = library.load("materials", name, file=where, key="given.materials")
        # A cast resin's law is the solid's: the search goes by the neo-Hookean fit, corrected by the solid.
        plain = material.model_copy(update={"law": None}) if casting else material
        wall = material_sensor(plain).wall
        if not target.have.holds("materials", name):
            out[name] = "it is not on the shelf"
        elif casting_missing(scene.printer, material):
            out[name] = "its file has no table [casting]"
        elif not prints(scene, material):
            out[name] = f"the {scene.printer.title} cannot run it{with_connector(scene)}"
        elif (why := resin_outside_atlas(wall, sensor.gas.ambient_pressure, _atlas(scene))) is not None:
            out[name] = why
        else:
            resins.append(CandidateResin(name, material, wall.shear_modulus, wall.break_stretch or np.inf))
    return tuple(resins), out


def _atlas(scene: ResolvedDesign) -> Atlas:
    """Atlas to search with; for cast resins its range is extended to soft walls, as the solid corrects the result."""
    return wider_box() if scene.printer.is_casting else shipped()


def problem_of(
    target: Target, scene: ResolvedDesign, sensor: Sensor, resins: tuple[CandidateResin, ...]
) -> SelectionProblem:
    """Selection problem, in numbers, of a target on a base with its sensor."""
    required, given = target.target, target.given
    feature = scene.printer.smallest.wall("elastomer")
    return SelectionProblem(
        resins=resins,
        sensitivity=required.sensitivity_kPa_per_N,
        tolerance=required.tolerance_percent / 100,
        driving_pressure=None if required.driving_pressure_kPa is None else required.driving_pressure_kPa * KPA,
        force_range=required.force_range_N,
        stiffness=(required.stiffness_least_N_per_mm, required.stiffness_most_N_per_mm),
        stiffness_depth=required.stiffness_depth_mm,
        max_diameter=required.max_diameter_mm,
        inner_radius=given.inner_radius_mm,
        wall_thickness=given.wall_thickness_mm,
        least_wall=feature.least or feature.recommended,
        ambient_pressure=sensor.gas.ambient_pressure,
        dead_volume=dead_volume(scene, sensor),
        plate_radius=sensor.protocol.plate_radius,
        gauge_limit=sensor.gas.gauge_limit,
        depth_share=min(sensor.protocol.depth / sensor.dome.inner_radius, shipped().recipe.deepest),
        steps=sensor.protocol.steps,
        atlas=_atlas(scene),
        plate_share=0.0 if "plate_diameter_mm" in scene.design.indentation.model_fields_set else PLATE_SHARE,
        max_footprint=required.max_footprint_mm,
        connector=connector_fit(scene),
        anywhere=target.weights.contact_anywhere,
        limit_spread=lambda resin, batch: limit_spread(batch, resin.material, scene.printer, LIMIT_ERROR).standard,
    )


def _confirm(selection: SelectionRun, choice: Candidate, judged: Evaluation | None) -> Confirmation:
    """Sensitivity by the solid, compared with the atlas's; from the evaluation ``judged`` if there is one."""
    from pneutouch.mechanics.models.solid import solid_states

    if judged is None:
        wall = material_sensor(choice.resin.material).wall
        sensor = selection.sensor_of(choice).replace(law=wall.law, largest_stretch=wall.largest_stretch)
        state = solid_states(sensor, choice.pool.pressure)[0]
    else:
        driven = float(choice.pool.pressure[0])
        state = min(judged.prediction.states, key=lambda state: abs(state.driving_pressure - driven))
    figures = state.figures
    if figures is None:
        return Confirmation(float("nan"), False)
    return Confirmation(
        figures.sensitivity, bool(abs(np.log(figures.sensitivity / choice.pool.figures.sensitivity)) <= choice.expanded)
    )
