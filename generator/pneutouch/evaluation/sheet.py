"""The record that a datasheet is drawn from, made from an evaluation.

It holds the pressed dome, evaluated from the Fourier sums of a prediction, and membranes to compare a graded one with.
"""

from dataclasses import replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import ComputationError
from pneutouch.evaluation.anywhere import contact_chart
from pneutouch.evaluation.charts import air, resin_curves, tradeoff, tuning
from pneutouch.evaluation.contact_object import at_rest
from pneutouch.evaluation.dynamics import dynamics
from pneutouch.evaluation.evaluate import Evaluation
from pneutouch.evaluation.gauge import gauge_record, zero_drift_kPa_per_K
from pneutouch.evaluation.relaxation import viscous
from pneutouch.evaluation.sheet_data import AgeingData, ComparedMembrane, PressedView, SheetData
from pneutouch.evaluation.table_s1 import published_sensitivities
from pneutouch.evaluation.uncertainty import unknown
from pneutouch.mechanics import Sensor, SensorPrediction
from pneutouch.mechanics.models.choice import stated_error
from pneutouch.mechanics.viscous.describe import ageing_ratio, ageing_unknown
from pneutouch.parts.mould import silicone_batch
from pneutouch.spec.material import Material
from pneutouch.units import KPA

_ANGLES = 64
"""Angles around the axis at which the surface is evaluated."""


def pressed_view(prediction: SensorPrediction) -> PressedView | None:
    """The dome at the first driving pressure, pressed to its range's end; None if the model gives no surface."""
    state = prediction.states[0]
    if state.face is None:
        return None
    face = state.face()
    angles = 2.0 * np.pi * np.arange(_ANGLES) / _ANGLES
    rows = face.rows()
    points = face.positions(rows, angles)
    # On the axis all angles are one point.
    points[-1] = points[-1].mean(axis=0)
    pressure = face.pressure(rows, angles)
    pressure[-1] = pressure[-1].mean()
    sheared = None if state.beyond_axis is None else state.beyond_axis.shear
    moved = face.travel != 0.0 and sheared is not None
    force = sheared.force[-1] if moved and sheared else SheetData.force_at(state, face.indentation)
    return PressedView(
        driving_pressure_kPa=state.driving_pressure / KPA,
        indentation=face.indentation,
        travel=face.travel,
        force=float(force),
        points=points,
        normals=_normals(points),
        pressure_kPa=pressure / KPA,
        lines=face.lines,
    )


def _normals(points: Array) -> Array:
    """Outward unit normals of a surface (n, m, 3), from differences between neighbours."""
    along = np.gradient(points, axis=0)
    around = np.roll(points, -1, axis=1) - np.roll(points, 1, axis=1)
    out = np.cross(around, along)
    # On the axis a row is one point and has no tangent around it.
    out[-1] = out[-2].sum(axis=0)
    return np.asarray(out / np.linalg.norm(out, axis=2, keepdims=True))


_LEAST_SPAN = 22 * KPA
"""Driving pressure, MPa, up to which the sensitivity plot reaches at least: the paper's highest."""


def sheet_data(evaluation: Evaluation, input_hash: str) -> SheetData:
    """Everything that a datasheet shows; gas, trade-off and tuning only inside the atlas."""
    scene, sensor, prediction = evaluation.scene, evaluation.sensor, evaluation.prediction
    material, states = scene.membrane_material, prediction.states
    highest = max(states[-1].driving_pressure, _LEAST_SPAN)
    published = published_sensitivities(sensor, material)
    sheet = SheetData(
        scene=scene,
        assembly=evaluation.assembly,
        prediction=prediction,
        findings=evaluation.findings,
        input_hash=input_hash,
        uncertainty=evaluation.uncertainty,
        filled_uncertainty=evaluation.filled_uncertainty,
        estimates=evaluation.estimates,
        rating=evaluation.rating,
        numerical_error=stated_error(prediction.model, sensor),
        zero_drift_kPa_per_K=zero_drift_kPa_per_K(scene, prediction, states[0]),
        gauge=gauge_record(evaluation),
        resin_curves=resin_curves(sensor, evaluation.alike, highest, prediction.model, prediction.closure, states),
        viscous=viscous(evaluation.viscous_runs),
        viscous_runs=None if isinstance(evaluation.viscous_runs, str) else evaluation.viscous_runs,
        ageing=ageing_data(prediction, material, sensor),
        constants=constant_membranes(sensor, prediction),
        published_kPa_per_N=published,
        contact=contact_chart(prediction, sensor),
        other_contact=sensor.protocol.other_contact is not None,
        object_section=object_section(sensor),
        pressed=pressed_view(prediction),
        speed=dynamics(evaluation.bandwidth),
        pour=None if evaluation.assembly.mould is None else silicone_batch(evaluation.assembly.mould),
        curves=evaluation.curves,
        as_drawn=evaluation.as_drawn,
    )
    if unknown(sensor, prediction.model) is not None or states[-1].driving_pressure < 0.0:
        return sheet
    # The design's own pressures are shown, above the rated one too.
    tuned = tuning(evaluation, max(evaluation.rating.pressure, states[-1].driving_pressure))
    if tuned is not None:
        tuned = replace(tuned, published_kPa_per_N=tuple(published.items()))
    return replace(sheet, gas=air(evaluation), tradeoff=tradeoff(evaluation), tuning=tuned)


def constant_membranes(sensor: Sensor, prediction: SensorPrediction) -> tuple[ComparedMembrane, ...]:
    """Membranes with the least, mean and greatest modulus of a graded wall throughout; empty for other walls."""
    if sensor.wall.grade is None:
        return ()
    pressures = np.array([state.driving_pressure for state in prediction.states])
    relative, membranes = sensor.wall.grade[1], []
    for label, share in (("softest", min(relative)), ("mean", 1.0), ("stiffest", max(relative))):
        modulus = share * sensor.wall.shear_modulus
        constant = sensor.replace(shear_modulus=modulus, grade=None)
        membranes.append(_constant(constant, pressures, f"{label} {modulus:.2f} MPa"))
    return tuple(membrane for membrane in membranes if membrane is not None)


def _constant(sensor: Sensor, pressures: np.ndarray, label: str) -> ComparedMembrane | None:
    """A constant membrane at the lowest of the pressures, as many as can be solved; None if none can."""
    from pneutouch.mechanics.models.solid import solid_states

    for count in range(pressures.size, 0, -1):
        try:
            return ComparedMembrane(label, solid_states(sensor, pressures[:count]))
        except ComputationError:
            continue
    return None


def ageing_data(prediction: SensorPrediction, material: Material, sensor: Sensor) -> AgeingData | str:
    """Modulus after a year and the change of sensitivity at the lowest and highest pressure, or why it is unknown.

    Outside the atlas no change of sensitivity is given.
    """
    why = ageing_unknown(material)
    if why is not None:
        return why
    from pneutouch.mechanics.models.choice import outside
    from pneutouch.mechanics.viscous.describe import ageing_shift

    changes: tuple[tuple[float, float], ...] = ()
    if outside("atlas", sensor) is None:
        ends = [prediction.states[k].driving_pressure for k in (0, -1)]
        shift = ageing_shift(sensor, material, ends)[1]
        if np.isfinite(shift).all():
            changes = tuple(zip(ends, shift.tolist(), strict=True))
    return AgeingData(ageing_ratio(material), changes)


_DRAWN = 1.5
"""Radius to which an object is drawn, over that of the dome."""


def object_section(sensor: Sensor) -> Array | None:
    """Section (n, 2) of the object in the plane of symmetry, x and z in mm, at first contact with the unloaded dome;
    a row of NaN lies between its halves. None for a plate."""
    body = sensor.protocol.body
    if body is None:
        return None
    reach = _DRAWN * sensor.dome.shape.outer_radius
    half = body.at(at_rest(body, sensor)[0]).outline(reach)
    section = np.concatenate([half * [-1.0, 1.0], [[np.nan, np.nan]], half])
    section[:, 0] += sensor.protocol.offset
    return np.asarray(section)
