"""Effect of the air, trade-off and tuning of one design, for its datasheet, by the atlas, which must cover the
sensor."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from pneutouch.errors import ComputationError
from pneutouch.evaluation.chart_data import ChartPoint, TradeOff, TuningChart
from pneutouch.evaluation.tuning import curve, interval, under_contact
from pneutouch.evaluation.variants import in_resin
from pneutouch.mechanics import Sensor
from pneutouch.mechanics.atlas.table import shipped
from pneutouch.mechanics.atlas_states import outside_atlas
from pneutouch.mechanics.contact_correction import plate_alone
from pneutouch.mechanics.object_mesh import MOST_CELLS, object_cells
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.solid.rigid_base import RigidBase
from pneutouch.mechanics.uncertainty import GasNotes, batch_of, gas_notes
from pneutouch.selection import CandidateResin, SelectionProblem
from pneutouch.selection.contact_front import contact_front
from pneutouch.selection.contact_trial import SolveCandidate, SolvedStates
from pneutouch.selection.front import front
from pneutouch.selection.pool import CandidatePool
from pneutouch.units import KPA

if TYPE_CHECKING:
    from pneutouch.evaluation.evaluate import Evaluation


def air(evaluation: Evaluation) -> GasNotes:
    """Effects of temperature and speed on the sealed air, one entry a state."""
    pressures = [state.driving_pressure for state in evaluation.prediction.states]
    return gas_notes(batch_of(plate_alone(evaluation.sensor), pressures))


def tuning(evaluation: Evaluation, highest: float) -> TuningChart | None:
    """The design's sensitivity from no driving pressure to ``highest`` (MPa); None if the atlas has no curve.

    The sensitivities at its own driving pressures are those of the prediction's model.
    """
    scene, sensor, prediction = evaluation.scene, evaluation.sensor, evaluation.prediction
    drawn = curve(plate_alone(sensor), highest, "this design")
    if drawn is not None and sensor.protocol.other_contact is not None:
        drawn = under_contact(sensor, drawn, prediction.states)
    if drawn is None or drawn.driving_pressure_kPa.size < 2:
        return None
    materials = list(evaluation.resins.values())
    low, high = interval(
        sensor,
        drawn,
        scene.membrane_material,
        materials,
        scene.printer,
        prediction.model,
        scene.calibration,
        prediction.states,
        anywhere=scene.design.contact.anywhere,
    )
    working = {s.driving_pressure / KPA: s.figures.sensitivity_kPa_per_N for s in prediction.states if s.figures}
    return TuningChart(drawn, low, high, working)


def tradeoff(evaluation: Evaluation) -> TradeOff | None:
    """Fronts at the design's highest driving pressure in every resin that its printer runs and the atlas covers.

    Under another central contact than a plate without friction the atlas is corrected by the solid. None if the
    prediction has no figures there, and for contact off the axis.
    """
    sensor, state = evaluation.sensor, evaluation.prediction.states[-1]
    if state.figures is None or sensor.protocol.off_axis is not None:
        return None
    problem = tradeoff_problem(evaluation, state.driving_pressure)
    if sensor.protocol.other_contact is None:
        fronts, errors = front(problem), None
    else:
        drawn = contact_front(problem, resized(sensor, problem))
        fronts, errors = drawn.fronts, (drawn.median_error, drawn.greatest_error)
    saturation, end = state.figures.saturation_force, state.figures.force_range[1]
    force = end if saturation is None else min(end, saturation)
    title = evaluation.scene.membrane_material.title
    return TradeOff(
        tuple(fronts),
        state.driving_pressure / KPA,
        (problem.gauge_limit - state.driving_pressure) / KPA,
        (ChartPoint(title, f"this design, {force:.3g} N", state.figures.sensitivity_kPa_per_N, force),),
        errors=errors,
    )


def resized(sensor: Sensor, problem: SelectionProblem) -> SolveCandidate:
    """The solid's answers of candidates: the sensor with their resins and sizes, in everything else as it is."""

    def solve(resin: CandidateResin, pool: CandidatePool, pressures: list[float]) -> SolvedStates:
        """States of a candidate at driving pressures (MPa), or why there are none."""
        from pneutouch.mechanics.solid_states import solid_states

        radius = float(pool.radius[0])
        sized = in_resin(sensor, resin.material).replace(
            inner_radius=radius,
            wall_thickness=float(pool.wall[0]),
            depth=problem.depth_share * radius,
            flange=None,
            base=None if sensor.dome.base is None else RigidBase(),
        )
        if (object_cells(sized) or 0) > MOST_CELLS:
            return SolvedStates((), "the object is too small for the mesh")
        try:
            return SolvedStates(solid_states(sized, np.array(pressures)))
        except ComputationError as error:
            return SolvedStates((), error.problem)

    return solve


def tradeoff_problem(evaluation: Evaluation, pressure: float) -> SelectionProblem:
    """The selection problem of the design: everything but its resin, radius and wall is settled."""
    sensor, printer, recipe = plate_alone(evaluation.sensor), evaluation.scene.printer, shipped().recipe
    wall = printer.smallest.wall("elastomer")
    return SelectionProblem(
        resins=_resins(evaluation),
        sensitivity_kPa_per_N=None,
        tolerance=1.0,
        driving_pressure=pressure,
        force_range=None,
        stiffness=(None, None),
        max_diameter=None,
        inner_radius=None,
        wall_thickness=None,
        least_wall=wall.least or wall.recommended,
        ambient_pressure=sensor.gas.ambient_pressure,
        dead_volume=lambda radius: np.full_like(radius, sensor.gas.dead_volume),
        plate_radius=np.inf if evaluation.sensor.protocol.body is not None else sensor.protocol.plate_radius,
        gauge_limit=sensor.gas.gauge_limit,
        depth_share=min(sensor.protocol.depth / sensor.dome.inner_radius, recipe.deepest),
        steps=sensor.protocol.steps,
        recipe=recipe,
    )


def _resins(evaluation: Evaluation) -> tuple[CandidateResin, ...]:
    candidates = []
    for name, material in evaluation.resins.items():
        runs = evaluation.scene.printer.mode_for(material) is not None
        if runs and outside_atlas(in_resin(plate_alone(evaluation.sensor), material)) is None:
            paper = material_sensor(material)
            candidates.append(
                CandidateResin(name, material, paper.wall.shear_modulus, paper.wall.break_stretch or np.inf)
            )
    return tuple(candidates)
