"""Selection under a contact that the atlas does not cover: each candidate's own design, answered by the solid."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from pneutouch.arrays import Array
from pneutouch.catalogue import Library, ResolvedDesign, load_scene
from pneutouch.errors import ComputationError, InputError
from pneutouch.evaluation.chart_data import TuningCurve
from pneutouch.evaluation.contact_object import check_object
from pneutouch.evaluation.elastomers import elastomers
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.evaluation.graded_uncertainty import even_wall
from pneutouch.evaluation.tuning import interval
from pneutouch.evaluation.uncertainty import known, unknown
from pneutouch.mechanics.prediction import SensorState
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.uncertainty.source import SENSITIVITY
from pneutouch.parts import assemble
from pneutouch.selection import Candidate, CandidateResin, SelectionProblem
from pneutouch.selection.contact_search import ContactSelection
from pneutouch.selection.contact_trial import SolvedStates
from pneutouch.selection.pool import CandidatePool
from pneutouch.spec.material import Material
from pneutouch.spec.read import Changes
from pneutouch.workflows.select.passing import source_of

AssignmentsOf = Callable[[Candidate], list[str]]
"""Changes that turn the base into a candidate, as ``table.key=value``."""


def other_contact(sensor: Sensor) -> str | None:
    """Reason why the search with the atlas alone is not enough: the pressing object, or the missing base; None if it
    is."""
    if sensor.protocol.other_contact is not None:
        return sensor.protocol.other_contact
    return "the wall passes through its base plane" if sensor.dome.base is None else None


def contact_text(scene: ResolvedDesign) -> str:
    """Object that presses the sensor of a base, in words."""
    contact = scene.design.contact
    rim = "" if contact.plate_rim_mm is None else f" with a rim of {contact.plate_rim_mm:g} mm radius"
    base = "" if contact.base else ", the wall passing through its base"
    return f"{contact.label}{rim}, {contact.hold}{base}"


def without_plate(problem: SelectionProblem, sensor: Sensor) -> SelectionProblem:
    """The problem without a plate's edge, where an object that is no plate presses."""
    return problem if sensor.protocol.body is None else replace(problem, plate_radius=np.inf, plate_share=0.0)


def contact_notes(selection: ContactSelection, scene: ResolvedDesign) -> list[str]:
    """Notes on an answer by the solid, line by line."""
    settled = f"{selection.rounds} rounds, {selection.solves} candidates solved"
    return [
        f"contact: {contact_text(scene)}",
        f"every figure is the solid's with this contact ({settled}), U as `predict` has it",
    ]


class CandidateSolver:
    """Candidates as `predict` answers their designs: base and assignments drawn, pressed by the solid.

    ``assignments`` gives what turns the base into a candidate.
    """

    def __init__(self, base: ResolvedDesign, assignments: AssignmentsOf, library: Library) -> None:
        self._base, self._assignments, self._library = base, assignments, library

    def __call__(self, resin: CandidateResin, pool: CandidatePool, pressures: list[float]) -> SolvedStates:
        """States at driving pressures, MPa, rising; or why there are none."""
        from pneutouch.mechanics.solid_states import solid_states

        try:
            scene, sensor = self.drawn(resin, pool)
            check_object(scene, sensor)
            return SolvedStates(solid_states(sensor, np.array(pressures)))
        except (InputError, ComputationError) as error:
            return SolvedStates((), "; ".join(part for part in (error.problem, error.remedy) if part))

    def drawn(self, resin: CandidateResin, pool: CandidatePool) -> tuple[ResolvedDesign, Sensor]:
        """The design of a candidate and its sensor. Raises InputError if it cannot be drawn."""
        choice = Candidate(resin, pool, {}, np.nan, (np.nan, np.nan), np.nan, np.nan)
        unchecked: Changes = {"indentation.checked_waves": 0}
        scene = load_scene(source_of(self._base, self._assignments(choice)), unchecked, self._library)
        return scene, sensor_of(assemble(scene))

    def expanded(self, resin: CandidateResin, pool: CandidatePool, state: SensorState) -> float:
        """Relative expanded uncertainty of the sensitivity under the contact, from the candidate's solved state: the
        budget of `predict` at that driving pressure. NaN if unknown."""
        scene, sensor = self.drawn(resin, pool)
        sensor = even_wall(sensor)
        if unknown(sensor, "solid") is not None:
            return np.nan
        material, printer = scene.membrane_material, scene.printer
        at = [state.driving_pressure]
        estimate = known(sensor, at, material, self._materials, printer, "solid", states=[state])
        return float(estimate.budget.expanded[SENSITIVITY, 0])

    def interval(
        self, resin: CandidateResin, pool: CandidatePool, drawn: TuningCurve, states: Sequence[SensorState]
    ) -> tuple[Array, Array] | None:
        """Both ends of the k = 2 interval of a candidate's tuning curve through its states; None if not known."""
        scene, sensor = self.drawn(resin, pool)
        sensor = even_wall(sensor)
        if unknown(sensor, "solid") is not None:
            return None
        material, printer = scene.membrane_material, scene.printer
        return interval(sensor, drawn, material, self._materials, printer, "solid", states=states)

    @cached_property
    def _materials(self) -> list[Material]:
        return list(elastomers(self._library, self._base.printer.is_casting).values())
