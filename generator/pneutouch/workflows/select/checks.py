"""Parts of a selection around the search: its candidates' connectors, solutions by the solid, and uncertainty.

Connector: the space for its parts around a dome, the diameter of the whole sensor, and the dead volume.

Also the design file that a candidate becomes, and what ``check`` says of it.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.catalogue import DesignSource, Library, ResolvedDesign, load_scene
from pneutouch.catalogue.library import compared
from pneutouch.errors import ComputationError, InputError, PneutouchError
from pneutouch.evaluation.charts import interval
from pneutouch.evaluation.contact_object import check_object, rigid_base
from pneutouch.evaluation.evaluate import Evaluation, PredictionOptions, evaluate_scene, sensor_of
from pneutouch.evaluation.sheet_data import SensitivityCurve
from pneutouch.evaluation.subject import subject_of
from pneutouch.evaluation.table_s1 import is_near_paper
from pneutouch.evaluation.uncertainty import spread, unknown
from pneutouch.mechanics.atlas.figures import FIGURES, SENSITIVITY
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.models.accuracy import NUMERICAL
from pneutouch.mechanics.prediction import SensorState
from pneutouch.mechanics.sensor import RigidBase, Sensor
from pneutouch.mechanics.uncertainty.propagate import Budget, propagate_groups
from pneutouch.mechanics.uncertainty.source import PLACE, UncertaintySource
from pneutouch.mechanics.uncertainty.sources import sources
from pneutouch.mechanics.uncertainty.sources.model_error import ModelErrors
from pneutouch.output.new import write_design
from pneutouch.parts import Assembly, assemble
from pneutouch.parts.cast_ring import least_bridge
from pneutouch.parts.layout import Layout, lay_out_dome
from pneutouch.parts.port import port_shape
from pneutouch.parts.space import greatest_radii, least_radii
from pneutouch.printability import check
from pneutouch.selection import Candidate, CandidateResin, SelectionProblem
from pneutouch.selection.candidates import CandidatePool
from pneutouch.selection.contact_search import ContactSelection, SolvedStates
from pneutouch.selection.problem import ConnectorFit
from pneutouch.spec.design import DesignFile
from pneutouch.spec.material import Material
from pneutouch.spec.read import Changes, override, parse_changes, validate
from pneutouch.spec.toml_text import design_template
from pneutouch.wording import counted

_RADII = np.geomspace(2.0, 60.0, 8)
"""Radii in mm at which the connector is drawn for its dead volume, which is interpolated linearly between them."""

_WALL_SHARE = 0.15
"""Wall over radius of the domes drawn at these radii: the dead volume does not depend on the wall."""


def connector_fit(scene: ResolvedDesign) -> Callable[[Array, Array], ConnectorFit]:
    """Function that gives the fit of a scene's connector around domes of inner radius (n,) and wall (n,), mm."""
    port = port_shape(scene.port, scene.tube, scene.hole_undersize)

    def fit(radius: Array, wall: Array) -> ConnectorFit:
        layouts = [
            lay_out_dome(scene, port, replace(scene.design.membrane.dome, inner_radius=r, wall_thickness=t))
            for r, t in zip(radius.tolist(), wall.tolist(), strict=True)
        ]
        margins = [space_margin(scene, layout) for layout in layouts]
        return ConnectorFit(np.array(margins), np.array([2.0 * layout.plate_radius for layout in layouts]))

    return fit


def space_margin(scene: ResolvedDesign, layout: Layout) -> float:
    """Least relative margin of the radii that `check_space` compares; negative if it refuses the layout."""
    small = [has / least - 1.0 for has, least in least_radii(scene, layout).values() if least > 0]
    large = [most / has - 1.0 for has, most in greatest_radii(scene, layout).values()]
    web: list[float] = []
    if layout.ring is not None:
        web = [width / least_bridge(scene) - 1.0 for width in (layout.ring.bridge, layout.ring.rim)]
    return min([*small, *large, *web], default=math.inf)


def base_sensor(scene: ResolvedDesign) -> Sensor:
    """Sensor of a base; with a dome of another size if the connector has no space for the base's own dome.

    Raises InputError if no size has space.
    """
    try:
        return sensor_of(assemble(scene))
    except InputError:
        other = next((assembly for _, assembly in _sizes(scene) if assembly is not None), None)
        if other is None:
            raise
        return sensor_of(other)


def dead_volume(scene: ResolvedDesign, sensor: Sensor) -> Callable[[Array], Array]:
    """Function from inner radii (n,), mm, to dead volumes, mm3: as stated, or interpolated between drawn connectors."""
    if scene.design.pneumatics.dead_volume_mL is not None:
        return lambda radius: np.full_like(radius, sensor.gas.dead_volume)
    drawn = [(radius, assembly.dead_volume) for radius, assembly in _sizes(scene) if assembly is not None]
    if not drawn:
        return lambda radius: np.full_like(radius, sensor.gas.dead_volume)
    at, volumes = np.array(drawn).T
    return lambda radius: np.interp(radius, at, volumes)


def base_around(scene: ResolvedDesign, radius: float, wall: float) -> RigidBase | None:
    """Base that the wall of a dome (inner radius and wall in mm) can lie down on: the connector as drawn around it.

    None if the wall passes through; a plane where the connector cannot be drawn.
    """
    drawn = _resized(scene, radius, wall)
    return RigidBase() if drawn is None else rigid_base(drawn)


def _sizes(scene: ResolvedDesign) -> Iterator[tuple[float, Assembly | None]]:
    """Radii (mm), the smallest first, with the scene drawn around a dome of each; None if it cannot be drawn."""
    for radius in _RADII.tolist():
        yield radius, _resized(scene, radius, _WALL_SHARE * radius)


def _resized(scene: ResolvedDesign, radius: float, wall: float) -> Assembly | None:
    """The scene drawn around another dome (mm); None if it cannot be drawn."""
    sizes = {"inner_radius_mm": radius, "wall_thickness_mm": wall}
    membrane = scene.design.membrane.model_copy(update=sizes)
    try:
        return assemble(replace(scene, design=scene.design.model_copy(update={"membrane": membrane})))
    except PneutouchError:
        return None


@dataclass(frozen=True)
class RejectedDesign:
    """A design that ``check`` rejects: ``rule`` is the broken one, None if it cannot be drawn or predicted."""

    choice: Candidate
    rule: str | None
    reason: str


class Judgement(NamedTuple):
    """Result of ``check`` on a design.

    reason: the first broken rule (None if the design cannot be drawn or predicted) and why; None if the design passes.
    evaluation: the design as the solid predicts it; None if only the print rules were applied.
    """

    reason: tuple[str | None, str] | None
    evaluation: Evaluation | None = None


def judge(source: DesignSource, library: Library, *, predicted: bool) -> Judgement:
    """Judge a design as ``check`` does, with the solid if ``predicted``; else only by the print rules on its bodies.

    The stability around the axis, which changes neither a finding nor a figure, is not checked.
    """
    evaluation = None
    try:
        scene = load_scene(source, {"indentation.checked_waves": 0}, library)
        if predicted:
            evaluation = evaluate_scene(scene, dict, PredictionOptions())
        findings = check(subject_of(assemble(scene))) if evaluation is None else evaluation.findings_alone
    except PneutouchError as error:
        return Judgement((None, "; ".join(part for part in (error.problem, error.remedy) if part)))
    broken = next(((f.rule, f"{f.body}: {f.message}; {f.fix}") for f in findings if f.severity == "error"), None)
    return Judgement(broken, evaluation)


def source_of(base: ResolvedDesign, assignments: list[str], name: str = "selected") -> DesignSource:
    """Design that results from a base by assignments, before it is written."""
    return DesignSource(name, assigned(base.design, assignments, name), base.where)


def write_assigned(
    design: DesignFile, assignments: list[str], name: str, folder: Path, *, overwrite: bool = False
) -> Path:
    """Write a base with assignments as ``folder/name.toml``; an existing file is replaced only with ``overwrite``."""
    chosen = validate(DesignFile, assigned(design, assignments, name), name)
    note = "Every key may be left out; it then takes its default."
    return write_design(
        name, folder, design_template(name, chosen.model_dump(by_alias=True), note), overwrite=overwrite
    )


def assigned(design: DesignFile, assignments: list[str], name: str) -> dict[str, Any]:
    """Tables of a design with ``table.key=value`` assignments applied and ``name`` as its title."""
    base = design.model_dump(by_alias=True)
    content = override(base, parse_changes(assignments), DesignFile)
    content["document"] = {**base["document"], "title": name}
    content["pneumatics"]["driving_pressures_kPa"] = [float(p) for p in content["pneumatics"]["driving_pressures_kPa"]]
    return content


AssignmentsOf = Callable[[Candidate], list[str]]
"""Function that gives the changes, as ``table.key=value``, that turn the base into a candidate."""


def other_contact(sensor: Sensor) -> str | None:
    """Reason why the atlas alone is not enough for the search: the pressing object, or the missing base; else None."""
    if sensor.protocol.other_contact is not None:
        return sensor.protocol.other_contact
    return "the wall passes through its base plane" if sensor.dome.base is None else None


def contact_text(scene: ResolvedDesign) -> str:
    """Text for the object that presses the sensor of a base, and how."""
    contact = scene.design.contact
    rim = "" if contact.plate_rim_mm is None else f" with a rim of {contact.plate_rim_mm:g} mm radius"
    base = "" if contact.base else ", the wall passing through its base"
    return f"{contact.label}{rim}, {contact.hold}{base}"


def without_plate(problem: SelectionProblem, sensor: Sensor) -> SelectionProblem:
    """The problem without the limit of a plate's edge, if an object that is no plate presses; else as it is."""
    return problem if sensor.protocol.body is None else replace(problem, plate_radius=np.inf, plate_share=0.0)


def contact_notes(selection: ContactSelection, scene: ResolvedDesign) -> list[str]:
    """Lines on an answer by the solid: its contact, and how it was searched."""
    settled = f"{counted(selection.rounds, 'round')}, {counted(selection.solves, 'candidate')} solved"
    return [
        f"contact: {contact_text(scene)}",
        f"every figure is the solid's with this contact ({settled}), U as `predict` has it",
    ]


class CandidateSolver:
    """Solves candidates as `predict` does their designs: the base with assignments, drawn and pressed by the solid.

    ``assignments`` gives the changes that turn the base into a candidate.
    """

    def __init__(self, base: ResolvedDesign, assignments: AssignmentsOf, library: Library) -> None:
        self._base, self._assignments, self._library = base, assignments, library

    def __call__(self, resin: CandidateResin, pool: CandidatePool, pressures: list[float]) -> SolvedStates:
        """States at ascending driving pressures, MPa; or the reason why there are none."""
        from pneutouch.mechanics.models.solid import solid_states

        try:
            scene, sensor = self.drawn(resin, pool)
            check_object(scene, sensor)
            return SolvedStates(solid_states(sensor, np.array(pressures)))
        except (InputError, ComputationError) as error:
            return SolvedStates((), "; ".join(part for part in (error.problem, error.remedy) if part))

    def drawn(self, resin: CandidateResin, pool: CandidatePool) -> tuple[ResolvedDesign, Sensor]:
        """Design of a candidate, and its sensor. Raises InputError if it cannot be drawn."""
        choice = Candidate(resin, pool, {}, np.nan, (np.nan, np.nan), np.nan, np.nan)
        unchecked: Changes = {"indentation.checked_waves": 0}
        scene = load_scene(source_of(self._base, self._assignments(choice)), unchecked, self._library)
        return scene, sensor_of(assemble(scene))

    def expanded(self, resin: CandidateResin, pool: CandidatePool, state: SensorState) -> float:
        """Relative expanded uncertainty of the sensitivity under the contact, for a candidate's solved state: as in the
        budget of `predict` at its driving pressure. NaN if not known."""
        scene, sensor = self.drawn(resin, pool)
        sensor = sensor.even
        if unknown(sensor, "solid") is not None:
            return np.nan
        material, printer = scene.membrane_material, scene.printer
        at = [state.driving_pressure]
        estimate = spread(sensor, at, material, self._materials, printer, "solid", states=[state]).combined()
        return float(estimate.budget.expanded[SENSITIVITY, 0])

    def interval(
        self, resin: CandidateResin, pool: CandidatePool, drawn: SensitivityCurve, states: Sequence[SensorState]
    ) -> tuple[Array, Array] | None:
        """Ends of the k = 2 interval of a candidate's tuning curve, (n,) each, through its states; None if not
        known."""
        scene, sensor = self.drawn(resin, pool)
        sensor = sensor.even
        if unknown(sensor, "solid") is not None:
            return None
        material, printer = scene.membrane_material, scene.printer
        return interval(sensor, drawn, material, self._materials, printer, "solid", states=states)

    @cached_property
    def _materials(self) -> list[Material]:
        return list(compared(self._library, self._base.printer).values())


def sensitivity_uncertainties(
    scene: ResolvedDesign,
    sensor: Sensor,
    known: Mapping[str, ModelErrors],
    groups: Sequence[tuple[CandidateResin, SensorBatch]],
    *,
    anywhere: bool = False,
) -> list[Array]:
    """Relative expanded uncertainties of the sensitivity for the designs of each group, (n,) each.

    ``known`` are measured model errors by resin. ``anywhere`` counts an unknown place of contact; NaN for designs that
    its table does not cover.
    """
    pool = next(iter(known.values())).pool if known else ()

    def sources_of(resin: CandidateResin, batch: SensorBatch) -> list[UncertaintySource]:
        """Sources of uncertainty for designs of one resin."""
        return sources(
            batch,
            resin.material,
            scene.printer,
            near_paper=np.array([is_near_paper(sized_as(sensor, batch, i)) for i in range(len(batch))]),
            errors=known.get(resin.name) or ModelErrors(pool=pool),
            numerical={FIGURES[SENSITIVITY]: NUMERICAL["atlas"]},
            anywhere=anywhere,
        )

    budgets = propagate_groups([(batch, sources_of(resin, batch)) for resin, batch in groups])
    return [np.where(_counted(budget, anywhere=anywhere), budget.expanded[SENSITIVITY], np.nan) for budget in budgets]


def _counted(budget: Budget, *, anywhere: bool) -> Flags:
    """Flags (n,) of designs for which every source that the target counts is known."""
    placed = [source.counts[SENSITIVITY] for source in budget.sources if source.name == PLACE]
    whole = np.ones(budget.expanded.shape[1], dtype=bool)
    return np.asarray(whole if not anywhere else placed[0] if placed else ~whole)


def sized_as(sensor: Sensor, batch: SensorBatch, i: int) -> Sensor:
    """The sensor with sizes, dead volume and plate of candidate ``i`` of a batch, without a flange."""
    return sensor.replace(
        inner_radius=float(batch.inner_radius[i]),
        wall_thickness=float(batch.wall_thickness[i]),
        dead_volume=float(batch.dead_volume[i]),
        plate_radius=float(batch.plate_radius[i]),
        flange=None,
    )
