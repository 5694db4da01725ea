"""Sources of uncertainty of a calibrated sensor: its fitted parameters as one source, and the remaining error of the
corrected model."""

import math
from dataclasses import replace

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.mechanics.atlas.figures import FIGURES, SENSITIVITY
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.uncertainty.source import (
    CORRECTION,
    FIGURE,
    FRICTION,
    JOINT,
    Distribution,
    UncertaintySource,
    counting,
)
from pneutouch.mechanics.uncertainty.sources.model_error import GAUGE, MODEL_CORRELATION
from pneutouch.spec.calibration import CalibratedResponse, SensorCalibration
from pneutouch.units import KPA, ML

FORCE_GAUGE = 0.01
"""Greatest relative error of the rig's force sensor: an assumption; the paper gives only its resolution."""

NAME = "calibrated parameters"

_INPUT_OF = {
    "shear_modulus_MPa": ("shear_modulus", 1.0),
    "wall_thickness_mm": ("wall_thickness", 1.0),
    "dead_volume_mL": ("dead_volume", ML),
}
"""Name of the input, and factor to its unit, by the key of a fitted parameter; not for the contact offset."""

_FORCES = (FIGURES.index("stiffness_N_per_mm"), FIGURES.index("force_at_range_end_N"))

LEFT = math.sqrt(2.0 * (1.0 - MODEL_CORRELATION))
"""Standard deviation of the difference of two errors of the model over that of one error: the share of the model's
error that remains far from the driving pressures of a correction, from the paper's Table S1 at 0 and 22 kPa."""

_BEYOND = 1.05
"""Factor by which a driving pressure may lie outside the measured ones and still count as measured: a choice."""


def replaced(calibration: SensorCalibration) -> frozenset[str]:
    """Inputs whose uncertainty comes from the calibration, in place of the sources of design and resin on them."""
    return frozenset(_INPUT_OF[key][0] for key in calibration.covered if key in _INPUT_OF)


def calibrated_sources(batch: SensorBatch, calibration: SensorCalibration) -> list[UncertaintySource]:
    """Sources that a calibration states, for n rows: the calibrated sensor at n driving pressures."""
    parameters = [_parameters(batch, calibration)] if replaced(calibration) else []
    response = calibration.response
    return parameters + ([] if response is None else _response(batch, calibration, response))


def kept_of_design(
    batch: SensorBatch, calibration: SensorCalibration, design: list[UncertaintySource]
) -> list[UncertaintySource]:
    """Sources of design and resin that remain after calibration, for the calibrated sensor at n driving pressures.

    Inner radius and friction are not replaced, but those of the specimen acted in the measured runs too: if curves were
    measured, the correction includes their effect on sensitivity and force within the curves' driving pressures.
    """
    known = replaced(calibration)
    kept = [source for source in design if source.acts_on not in known]
    if calibration.response is None:
        return kept
    counts = counting(len(batch))
    counts[[SENSITIVITY, *_FORCES]] = _outside(batch, calibration)
    held = ("inner radius", FRICTION, CORRECTION)
    return [replace(one, counts=one.counts & counts) if one.name in held else one for one in kept]


def kept_of_model(
    batch: SensorBatch, calibration: SensorCalibration, model: list[UncertaintySource]
) -> list[UncertaintySource]:
    """Sources of the model's error that remain after calibration, for the sensor at n driving pressures: unchanged
    without measured curves; with curves, `LEFT` of the error beyond their driving pressures, and none within them."""
    if calibration.response is None:
        return model
    beyond = _outside(batch, calibration)
    how = f"; {LEFT:.2f} of it, beyond the driving pressures of the calibration"
    return [
        replace(one, standard=LEFT * one.standard, counts=one.counts & beyond, origin=one.origin + how) for one in model
    ]


def _parameters(batch: SensorBatch, calibration: SensorCalibration) -> UncertaintySource:
    """Fitted parameters as one joint source, with a root of the covariance from its eigenvectors."""
    keys = [key for key in calibration.covered if key in _INPUT_OF]
    places = [calibration.covered.index(key) for key in keys]
    factors = np.array([_INPUT_OF[key][1] for key in keys])
    covariance = np.array(calibration.covariance)[np.ix_(places, places)] * np.outer(factors, factors)
    # Scaled, because the eigenvalue of a volume in mm3 would drown those of the logarithms.
    scale = np.sqrt(np.maximum(np.diag(covariance), 1e-30))
    values, vectors = np.linalg.eigh(covariance / np.outer(scale, scale))
    root = scale[:, None] * vectors * np.sqrt(np.maximum(values, 0.0))
    loads = {_INPUT_OF[key][0]: tuple(float(x) for x in row) for key, row in zip(keys, root, strict=True)}
    source, size = calibration.source, len(batch)
    origin = (
        f"covariance of the fit to sensor {source.sensor}, {source.curves} curves and {source.injections} injections; "
        "it holds for this specimen, not for another print"
    )
    counts = counting(size)
    if calibration.response is not None:
        # Where curves were measured the correction compensates changes of the parameters: they are correlated.
        counts[[SENSITIVITY, *_FORCES]] = _outside(batch, calibration)
        origin += "; sensitivity and force within the driving pressures measured do not follow from it"
    return UncertaintySource(NAME, JOINT, np.zeros(size), "normal", counts, origin, True, loads=loads)


def _outside(batch: SensorBatch, calibration: SensorCalibration) -> Flags:
    """Mask (n,) of the driving pressures that lie beyond those of the calibration's curves."""
    pressures_kPa, at_kPa = calibration.source.driving_pressures_kPa, batch.driving_pressure / KPA
    return np.asarray((at_kPa < min(pressures_kPa) / _BEYOND) | (at_kPa > max(pressures_kPa) * _BEYOND))


def _response(
    batch: SensorBatch, calibration: SensorCalibration, response: CalibratedResponse
) -> list[UncertaintySource]:
    size, pressures_kPa = len(batch), calibration.source.driving_pressures_kPa
    span = f"{min(pressures_kPa):g} to {max(pressures_kPa):g} kPa"
    held, seen = response.held_out_sensitivity_errors, response.errors_freedom > 0
    scatter = "scatter of the runs" if seen else "scatter assumed, because no runs were repeated,"
    origin = (
        f"{scatter} at {len(pressures_kPa)} driving pressures; between them how far the correction changes"
        f"{f', at least the errors of the {len(held)} held out' if held else ''}; beyond {span} the correction itself"
    )
    force = np.log(response.force_factors)
    sensitivity = np.log(response.pressure_factors) - force
    at = batch.driving_pressure / KPA
    outside = float(np.sqrt(np.mean(np.log1p(held) ** 2))) if held else 0.0
    beyond = _outside(batch, calibration)
    error = _error(at, pressures_kPa, response.sensitivity_errors_relative, sensitivity, outside, beyond)
    force_error = _error(at, pressures_kPa, response.force_errors_relative, force, 0.0, beyond)

    freedom = response.errors_freedom if seen else np.inf

    def source(
        name: str, standard: Array, figures: tuple[int, ...], origin: str, shape: Distribution, freedom: float = np.inf
    ) -> UncertaintySource:
        known = shape == "lognormal" and seen
        return UncertaintySource(name, FIGURE, standard, shape, counting(size, only=figures), origin, known, freedom)

    return [
        source("model as calibrated", error, (SENSITIVITY,), origin, "lognormal", freedom),
        source("model as calibrated", force_error, _FORCES, origin, "lognormal", freedom),
        source(
            "pressure gauge of the rig",
            np.full(size, GAUGE / math.sqrt(3.0)),
            (SENSITIVITY,),
            f"assumed: +-{GAUGE:.0%} of the reading, as of the driving pressure; the calibration can be no better",
            "rectangular",
        ),
        source(
            "force sensor of the rig",
            np.full(size, FORCE_GAUGE / math.sqrt(3.0)),
            (SENSITIVITY, *_FORCES),
            f"assumed: +-{FORCE_GAUGE:.0%} of the reading; the calibration can be no better",
            "rectangular",
        ),
    ]


def _error(
    at_kPa: Array, known_kPa: list[float], errors: list[float], logs: Array, outside: float, beyond: Flags
) -> Array:
    """Standard uncertainty of a correction, (n,), at driving pressures ``at_kPa``.

    ``errors`` and ``logs`` belong to the pressures ``known_kPa``. Between two of them the uncertainty is that of a
    random walk known at both ends: in the middle half of the change between them, but at least ``outside``.
    """
    places_kPa = np.array(known_kPa)
    measured = np.interp(at_kPa, places_kPa, errors)
    if places_kPa.size > 1:
        k = np.clip(np.searchsorted(places_kPa, at_kPa, side="right") - 1, 0, places_kPa.size - 2)
        t = np.clip((at_kPa - places_kPa[k]) / np.diff(places_kPa)[k], 0.0, 1.0)
        change = np.maximum(0.5 * np.abs(np.diff(logs))[k], outside)
        between = 2.0 * np.sqrt(t * (1.0 - t)) * change
    else:
        between = np.zeros(at_kPa.size)
    end = np.abs(np.interp(at_kPa, places_kPa, logs))
    return np.asarray(np.hypot(measured, np.where(beyond, np.maximum(end, outside), between)))
