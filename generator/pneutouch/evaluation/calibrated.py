"""Effect of a calibration on a design's sensor: parameters, correction and error.

Check that parameters of a design's sensor can be fitted to measured runs.
"""

import math

from pneutouch.catalogue import ResolvedDesign
from pneutouch.errors import InputError
from pneutouch.mechanics.atlas.coverage import outside_fit
from pneutouch.mechanics.corrected.figures import GRIPS
from pneutouch.mechanics.sensor import ResponseCorrection, Sensor
from pneutouch.results.prediction import SensitivityError
from pneutouch.spec.calibration import CalibratedResponse, SensorCalibration
from pneutouch.spec.design import CALIBRATION
from pneutouch.units import KPA, ML

_PLATE = "flat plate, frictionless"

BEYOND = 1.05
"""Depths up to this factor times the greatest measured one count as measured: our choice."""


def calibrated_sensor(sensor: Sensor, calibration: SensorCalibration) -> Sensor:
    """The sensor with the parameters of its calibration.

    Gas volumes add up: a change of the design's dead volume since the calibration, such as by a longer tube, is added
    to the fitted dead volume.
    """
    response = calibration.response
    friction = friction_of(calibration)
    if friction is not None:
        sensor = sensor.replace(friction=friction)
    added = sensor.gas.dead_volume - calibration.design.dead_volume_mL * ML
    return sensor.of_modulus(calibration.value("shear_modulus_MPa")).replace(
        wall_thickness=calibration.value("wall_thickness_mm"),
        dead_volume=max(calibration.value("dead_volume_mL") * ML + added, 0.0),
        correction=ResponseCorrection() if response is None else correction_of(calibration, response),
    )


def friction_of(calibration: SensorCalibration) -> float | None:
    """The coefficient of friction that was fitted, inf for a contact that grips; None if it was not."""
    fitted = [parameter.value for parameter in calibration.parameters if parameter.key == "friction"]
    return None if not fitted else float("inf") if fitted[0] >= GRIPS else fitted[0]


def friction_spread(calibration: SensorCalibration) -> float | None:
    """Standard uncertainty of the coefficient of friction that was fitted; None if it was not."""
    if "friction" not in calibration.covered:
        return None
    place = calibration.covered.index("friction")
    return math.sqrt(calibration.covariance[place][place])


def correction_of(calibration: SensorCalibration, response: CalibratedResponse) -> ResponseCorrection:
    """Factors by which a calibration corrects force and pressure rise, by driving pressure."""
    pressures = tuple(pressure_kPa * KPA for pressure_kPa in calibration.source.driving_pressures_kPa)
    return ResponseCorrection(pressures, tuple(response.force_factors), tuple(response.pressure_factors))


def check_options(scene: ResolvedDesign, model: str, clamp: str) -> None:
    """Raise InputError for a model or a clamp that the parameters of a calibration were not fitted with."""
    name, remedy = scene.design.calibration, "leave the calibration out with the name none"
    if model == "membrane":
        why = "its parameters and its correction are of the models atlas and solid, not of membrane"
        raise InputError(why, file=scene.where, key=CALIBRATION, value=name, remedy=f"take another model, or {remedy}")
    if clamp != "base":
        why = f"it was fitted with the rim clamped at the base plane, not at the {clamp}"
        raise InputError(why, file=scene.where, key=CALIBRATION, value=name, remedy=f"take clamp base, or {remedy}")


def assumption(scene: ResolvedDesign) -> str:
    """Sentence that states which sensor a prediction with the scene's calibration stands for."""
    calibration = scene.calibration
    assert calibration is not None
    source, response = calibration.source, calibration.response
    made = "simulated " if source.simulated else ""
    corrected, campaign = "", source.campaign or "unnamed"
    coefficient = friction_of(calibration)
    friction = "" if coefficient is None else f", friction {coefficient:.3g}"
    if response is not None:
        force, rise = (_span(factors) for factors in (response.force_factors, response.pressure_factors))
        corrected = f"; force times {force}, pressure rise times {rise}"
    return (
        f"calibration {scene.design.calibration}: sensor {source.sensor}, {made}campaign {campaign}, modulus "
        f"{calibration.value('shear_modulus_MPa'):.4g} MPa, wall {calibration.value('wall_thickness_mm'):.4g} "
        f"mm{friction}{corrected}; the figures are of this specimen, not of another print"
    )


def unmeasured(scene: ResolvedDesign, depth: float) -> list[str]:
    """Parts of a prediction to ``depth`` (mm) that its calibration did not measure, one sentence each."""
    calibration, notes = scene.calibration, []
    assert calibration is not None
    source, plate_mm = calibration.source, scene.design.indentation.plate_diameter_mm
    contact = scene.design.contact
    measured, here = source.contact or _PLATE, _PLATE if contact.is_atlas_plate else contact.words
    if friction_of(calibration) is not None:
        measured, here = measured.rpartition(",")[0], here.rpartition(",")[0]
    if measured != here:
        notes.append(
            f"calibration {scene.design.calibration}: measured with a {measured}; this prediction is of a {here}"
        )
    if source.depth_mm is not None and depth > BEYOND * source.depth_mm:
        notes.append(
            f"calibration {scene.design.calibration}: measured to a travel of {source.depth_mm:.3g} mm; this "
            f"prediction goes to {depth:.3g} mm, where its correction and its error are not tested"
        )
    if source.plate_diameter_mm is not None and not math.isclose(plate_mm, source.plate_diameter_mm, rel_tol=1e-6):
        notes.append(
            f"calibration {scene.design.calibration}: measured with a plate of {source.plate_diameter_mm:g} mm; this "
            f"prediction is of one of {plate_mm:g} mm"
        )
    return notes


def _span(factors: list[float]) -> str:
    low, high = f"{min(factors):.3f}", f"{max(factors):.3f}"
    return low if low == high else f"{low} to {high}"


def calibrated_error(calibration: SensorCalibration) -> SensitivityError | None:
    """Error of the sensitivity, for ``error_estimate``, from the residuals; None if no curve was measured."""
    response = calibration.response
    if response is None:
        return None
    pressures_kPa = calibration.source.driving_pressures_kPa
    held = len(response.held_out_sensitivity_errors)
    basis = (
        f"this model calibrated on sensor {calibration.source.sensor}, against its runs at "
        f"{', '.join(f'{p:g}' for p in pressures_kPa)} kPa" + (f", {held} of them also held out" if held else "")
    )
    held_errors = [abs(error) for error in response.held_out_sensitivity_errors]
    greatest = max([*response.sensitivity_errors_relative, *held_errors])
    return SensitivityError(greatest, basis, f"Sensitivity: up to {greatest:.1%}; {basis}.")


def check_fitted(scene: ResolvedDesign, sensor: Sensor) -> None:
    """Raise InputError if no fit covers the sensor: not the atlas even at a small depth, nor for another shape than the
    hemisphere the solid."""
    why = outside_fit(sensor)
    if why is None:
        return
    contact = scene.design.contact
    key = next(iter(contact.off_axis), None if contact.base else "base")
    raise InputError(
        f"no fit covers this sensor: {why}",
        file=scene.where,
        key=None if key is None else f"contact.{key}",
        value=None if key is None else getattr(contact, key),
        remedy="`compare` sets design and measurement side by side without a fit",
    )
