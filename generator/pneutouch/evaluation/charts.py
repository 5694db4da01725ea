"""Curves and trade-off of one design for its datasheet: effects of the air, of the resin and of the driving pressure.

They come from the atlas where it covers the sensor, corrected by the solid under another contact.
"""

from collections.abc import Sequence

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import ComputationError
from pneutouch.evaluation.evaluate import Evaluation
from pneutouch.evaluation.sheet_data import ChartPoint, SensitivityCurve, TradeOff, TuningChart
from pneutouch.evaluation.uncertainty import spread
from pneutouch.mechanics import Sensor, SensorState, predict
from pneutouch.mechanics.atlas.coverage import under_plate
from pneutouch.mechanics.atlas.figures import CONTACT_FIGURES, SENSITIVITY
from pneutouch.mechanics.atlas.press import SensorBatch, batch_of
from pneutouch.mechanics.atlas.respond import EDGE, OUTSIDE, respond
from pneutouch.mechanics.atlas.table import shipped
from pneutouch.mechanics.corrected.figures import CorrectedAtlas, pressed_logs
from pneutouch.mechanics.membrane import limit_point
from pneutouch.mechanics.models.choice import outside
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.rating import RATED_SHARE
from pneutouch.mechanics.sensor import ResponseCorrection, RigidBase
from pneutouch.mechanics.solid.mesh import MOST_CELLS, object_cells
from pneutouch.mechanics.uncertainty.document import GasNotes, gas_notes
from pneutouch.selection import CandidateResin, SelectionProblem
from pneutouch.selection.candidates import CandidatePool
from pneutouch.selection.contact_search import SolveCandidate, SolvedStates
from pneutouch.selection.front import contact_front, front
from pneutouch.spec.calibration import SensorCalibration
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer
from pneutouch.units import KPA

POINTS = 41
"""Number of driving pressures of the curve of the design itself."""

_BUDGETS = 7
"""Number of driving pressures at which the interval is computed; its width is linear between them."""


def curve(sensor: Sensor, highest: float, label: str) -> SensitivityCurve | None:
    """Sensitivity by the atlas from zero driving pressure to ``highest`` (MPa), or to `RATED_SHARE` of the limit point
    if that comes first, with the factors of a calibration.

    Pressures at which the atlas has no answer are left out; None if fewer than two are left, or outside the atlas.
    """
    found = _by_atlas({label: sensor}, highest, POINTS, RATED_SHARE, (OUTSIDE,)).get(label)
    if found is None:
        return None
    factor = np.array([sensor.correction.sensitivity_factor(p * KPA) for p in found.driving_pressure_kPa.tolist()])
    return found._replace(sensitivity=factor * found.sensitivity, label=label)


def under_contact(
    sensor: Sensor, plate: SensitivityCurve, states: Sequence[SensorState], least: int = 3
) -> SensitivityCurve:
    """Convert a sensor's curve under a plate without friction to the sensor's own contact.

    ``states`` are solved states of the solid; more are solved, up to ``least`` in all. Between them the logarithm of
    the ratio of the curves is linear. Pressures at which the ratio is unknown are left out.
    """
    pressures = tuple((plate.driving_pressure_kPa * KPA).tolist())
    ratio = CorrectedAtlas(sensor, pressures, states, least).ratio[SENSITIVITY]
    kept = np.isfinite(ratio)
    values = np.exp(ratio[kept]) * plate.sensitivity[kept]
    return SensitivityCurve(plate.driving_pressure_kPa[kept], values, "atlas corrected by the solid", plate.label)


def interval(
    sensor: Sensor,
    drawn: SensitivityCurve,
    material: Material,
    materials: Sequence[Material],
    printer: Printer,
    model: str,
    calibration: SensorCalibration | None = None,
    states: Sequence[SensorState] = (),
    *,
    anywhere: bool = False,
) -> tuple[Array, Array]:
    """Lower and upper end of a curve's k = 2 interval, kPa/N, (n,) each.

    ``materials`` are all known resins; ``model`` gives the numerical error; ``states`` are states of the solid that are
    solved already, for a contact other than a plate without friction; ``anywhere`` counts an unknown place of contact.
    """
    at = np.linspace(drawn.driving_pressure_kPa[0], drawn.driving_pressure_kPa[-1], _BUDGETS)
    estimate = spread(
        sensor, (at * KPA).tolist(), material, materials, printer, model, calibration, states, anywhere=anywhere
    ).combined()
    widths = estimate.budget.expanded[SENSITIVITY]
    good = np.isfinite(widths)
    width = np.interp(drawn.driving_pressure_kPa, at[good], widths[good])
    return drawn.sensitivity * np.exp(-width), drawn.sensitivity * np.exp(width)


_POINTS = {"membrane": 12, "atlas": 25, "solid": 4}
"""Number of driving pressures of a resin's curve, by model: the solid needs a tenth of a second for each."""

_MARGIN = 0.95
"""Share of a resin's own limit pressure at which its curve stops."""

_AT_DEPTH = 1e-3
"""Difference of logarithms below which the end of a range counts as the depth."""

_LIMIT_SHARE = {"membrane": 1.0, "solid": 0.8}
"""Safe share of the membrane's limit pressure, by model: thick compressible walls reach their own limit earlier."""


def in_resin(sensor: Sensor, material: Material) -> Sensor:
    """The sensor in another resin, with that resin's law and break strain, without a calibration's correction."""
    return sensor.replace(wall=material_sensor(material).wall, correction=ResponseCorrection())


def resin_curves(
    sensor: Sensor,
    materials: dict[str, Material],
    highest: float,
    model: str,
    closure: str | None,
    states: Sequence[SensorState] = (),
) -> dict[str, SensitivityCurve]:
    """Sensitivity over driving pressure, from 0 to ``highest`` (MPa), by resin title.

    Each curve stops short of its own resin's limit point. For the model membrane all curves are the membrane's; else
    they are the atlas's where it covers the sensor, and the solid's where not. Under friction or another object the
    atlas is corrected by a few states of the solid; ``states`` of the sensor are already solved. Contact off the axis
    has no curves.
    """
    if sensor.protocol.off_axis is not None:
        return {}
    variants = {m.title: in_resin(sensor, m) for m in materials.values() if m.kind == "elastomer"}
    looked_up = {}
    if model != "membrane":
        plates = {title: under_plate(variant) for title, variant in variants.items()}
        looked_up = _by_atlas(plates, highest, _POINTS["atlas"], _MARGIN, (OUTSIDE, EDGE))
    model = "membrane" if model == "membrane" else "solid"
    curves = {}
    for title, variant in variants.items():
        curve = looked_up.get(title)
        if curve is not None and variant.protocol.other_contact is not None:
            curve = _under_contact(variant, curve, states if variant == sensor else ())
        curve = curve or _by_model(variant, highest, model, closure)
        if curve is not None:
            curves[title] = curve
    return curves


def _by_atlas(
    variants: dict[str, Sensor], highest: float, points: int, share: float, left_out: tuple[int, ...]
) -> dict[str, SensitivityCurve]:
    """Curves by title of the sensors that the atlas covers, all in one call, from zero driving pressure to ``highest``
    (MPa) or ``share`` of their limit points. Titles with fewer than two points are left out.

    Pressures without an answer, and those at which the range ends in one of the ways ``left_out``, are missing.
    """
    inside = {title: variant for title, variant in variants.items() if outside("atlas", variant) is None}
    if not inside:
        return {}
    walls = np.array([variant.dome.wall_thickness / variant.dome.inner_radius for variant in inside.values()])
    limits = shipped().slices(walls, ()).limit_pressure * np.array([v.wall.shear_modulus for v in inside.values()])
    grids = [np.linspace(0.0, min(highest, share * float(limit)), points) for limit in limits]
    batch = SensorBatch.join([batch_of(v, grid) for v, grid in zip(inside.values(), grids, strict=True)])
    response = respond(batch, next(iter(inside.values())).protocol.steps)
    values = response.lines.sensitivity
    known = (np.isfinite(values) & ~np.isin(response.ends, left_out)).reshape(-1, points)
    rows = zip(inside, grids, values.reshape(-1, points), known, strict=True)
    return {
        title: SensitivityCurve(grid[kept] / KPA, row[kept], "atlas")
        for title, grid, row, kept in rows
        if kept.sum() > 1
    }


def _under_contact(variant: Sensor, plate: SensitivityCurve, states: Sequence[SensorState]) -> SensitivityCurve | None:
    """A resin's curve under its own contact, from few states of the solid; None if both ends cannot be solved.

    If the ranges at both ends go to the depth, the curve is the atlas's ``plate`` times the ratio of the solid to it,
    linear in its logarithm between the ends, or between the ``states`` if there are any. Where an event ends a range,
    the plate's range ends elsewhere: then a parabola goes through the solid's logarithms at both ends and the middle.
    """
    at = plate.driving_pressure_kPa * KPA
    lowest, highest = float(at[0]), float(at[-1])
    ends = CorrectedAtlas(variant, (lowest, highest), states).logs
    if states or np.abs(ends[CONTACT_FIGURES[-1]] - np.log(variant.protocol.depth)).max() < _AT_DEPTH:
        curve = under_contact(variant, plate, states, least=2)
        return curve if curve.driving_pressure_kPa.size > 1 else None
    middle = 0.5 * (lowest + highest)
    three = np.append(ends[SENSITIVITY], pressed_logs(variant.replace(waves=0), (middle,))[SENSITIVITY])
    if not np.isfinite(three).all():
        return None
    parabola = np.polyfit([lowest, highest, middle], three, 2)
    return SensitivityCurve(at / KPA, np.exp(np.polyval(parabola, at)), "solid")


def _by_model(variant: Sensor, highest: float, model: str, closure: str | None) -> SensitivityCurve | None:
    """One resin's curve computed with ``model`` itself; None if this geometry cannot be solved in the resin."""
    top = min(highest, _MARGIN * _LIMIT_SHARE[model] * limit_point(variant).driving_pressure)
    pressures = np.linspace(0.0, top, _POINTS[model])
    try:
        states = predict("", variant, pressures.tolist(), model=model, closure=closure or "variational").states
    except ComputationError:
        return None
    values = [(p / KPA, s.figures.sensitivity) for p, s in zip(pressures, states, strict=True) if s.figures]
    if not values:
        return None
    x, y = zip(*values, strict=True)
    return SensitivityCurve(np.array(x), np.array(y), model)


def air(evaluation: Evaluation) -> GasNotes:
    """Effects of temperature and speed on the sealed air, at each driving pressure of the prediction."""
    pressures = [state.driving_pressure for state in evaluation.prediction.states]
    return gas_notes(batch_of(under_plate(evaluation.sensor), pressures))


def tuning(evaluation: Evaluation, highest: float) -> TuningChart | None:
    """The design's sensitivity from zero driving pressure to ``highest`` (MPa); None if the atlas has no curve.

    At the design's own driving pressures the sensitivities are by the prediction's model.
    """
    scene, sensor, prediction = evaluation.scene, evaluation.sensor, evaluation.prediction
    drawn = curve(under_plate(sensor), highest, "this design")
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
    by_gas = sorted(prediction.filled, key=lambda state: state.held.injected if state.held else 0.0)
    working, filled = (
        tuple((s.driving_pressure / KPA, s.figures.sensitivity) for s in states if s.figures)
        for states in (prediction.states, by_gas)
    )
    return TuningChart(drawn, low, high, dict(working), filled_kPa_per_N=filled)


def tradeoff(evaluation: Evaluation) -> TradeOff | None:
    """Fronts at the design's highest driving pressure in every resin that its printer runs and the atlas covers.

    Under another central contact than a plate without friction the atlas is corrected by the solid. None if the
    prediction has no figures at that pressure, and for contact off the axis.
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
    title = evaluation.scene.membrane_material.title
    return TradeOff(
        tuple(fronts),
        state.driving_pressure / KPA,
        (problem.gauge_limit - state.driving_pressure) / KPA,
        (ChartPoint(title, f"this design, {state.figures.reach:.3g} N", state.figures),),
        errors=errors,
    )


def resized(sensor: Sensor, problem: SelectionProblem) -> SolveCandidate:
    """Solver of candidates by the solid: the sensor with a candidate's resin and sizes, otherwise unchanged."""

    def solve(resin: CandidateResin, pool: CandidatePool, pressures: list[float]) -> SolvedStates:
        """States of a candidate at driving pressures (MPa), or why there are none."""
        from pneutouch.mechanics.models.solid import solid_states

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
    """The selection problem of the design at a driving pressure (MPa): only resin, radius and wall are free."""
    sensor, printer, recipe = under_plate(evaluation.sensor), evaluation.scene.printer, shipped().recipe
    wall = printer.smallest.wall("elastomer")
    return SelectionProblem(
        resins=_resins(evaluation),
        sensitivity=None,
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
        atlas=shipped(),
    )


def _resins(evaluation: Evaluation) -> tuple[CandidateResin, ...]:
    return tuple(
        CandidateResin.of(name, material)
        for name, material in evaluation.alike.items()
        if outside("atlas", in_resin(under_plate(evaluation.sensor), material)) is None
    )
