"""The uncertainty of a calibrated sensor: its fitted parameters together, and what the corrected model leaves."""

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.uncertainty.source import (
    FIGURE,
    FIGURES,
    JOINT,
    SENSITIVITY,
    Distribution,
    UncertaintySource,
    counting,
)
from pneutouch.mechanics.uncertainty.sources.build import GAUGE
from pneutouch.spec.calibration import CalibratedResponse, SensorCalibration
from pneutouch.units import KPA, ML

FORCE_GAUGE = 0.01
"""Greatest relative error of the rig's force sensor: an assumption; the paper states its resolution alone."""

NAME = "calibrated parameters"

_INPUT_OF = {
    "shear_modulus_MPa": ("shear_modulus", 1.0),
    "wall_thickness_mm": ("wall_thickness", 1.0),
    "dead_volume_mL": ("dead_volume", ML),
}
"""Input and factor from a parameter's unit by its key; the contact offset belongs to the rig, not to the sensor."""

_FORCES = (FIGURES.index("stiffness_N_per_mm"), FIGURES.index("force_at_range_end_N"))

_BEYOND = 1.05
"""A driving pressure up to this share above the greatest measured one counts as measured: our choice."""


def replaced(calibration: SensorCalibration) -> frozenset[str]:
    """Inputs whose uncertainty the calibration brings: the sources of design and resin do not act on them."""
    return frozenset(_INPUT_OF[key][0] for key in calibration.covered if key in _INPUT_OF)


def calibrated_sources(batch: SensorBatch, calibration: SensorCalibration) -> list[UncertaintySource]:
    """Sources that a calibration brings, for n sensors that are the calibrated one at n driving pressures."""
    parameters = [_parameters(batch, calibration)] if replaced(calibration) else []
    response = calibration.response
    return parameters + ([] if response is None else _response(batch, calibration, response))


def _parameters(batch: SensorBatch, calibration: SensorCalibration) -> UncertaintySource:
    """One joint source: a root of the covariance by its eigenvectors."""
    keys = [key for key in calibration.covered if key in _INPUT_OF]
    places = [calibration.covered.index(key) for key in keys]
    factors = np.array([_INPUT_OF[key][1] for key in keys])
    covariance = np.array(calibration.covariance)[np.ix_(places, places)] * np.outer(factors, factors)
    # Of one scale, else the eigenvalue of a volume in mm3 would drown those of the logarithms.
    scale = np.sqrt(np.maximum(np.diag(covariance), 1e-30))
    values, vectors = np.linalg.eigh(covariance / np.outer(scale, scale))
    root = scale[:, None] * vectors * np.sqrt(np.maximum(values, 0.0))
    loads = {_INPUT_OF[key][0]: tuple(float(x) for x in row) for key, row in zip(keys, root, strict=True)}
    source, size = calibration.source, len(batch)
    origin = (
        f"covariance of the fit to sensor {source.sensor}, {source.curves} curves and {source.injections} injections; "
        "it holds for this specimen, not for another print"
    )
    return UncertaintySource(NAME, JOINT, np.zeros(size), "normal", counting(size), origin, True, loads=loads)


def _response(
    batch: SensorBatch, calibration: SensorCalibration, response: CalibratedResponse
) -> list[UncertaintySource]:
    size, pressures_kPa = len(batch), calibration.source.driving_pressures_kPa
    low, high = min(pressures_kPa) * KPA / _BEYOND, max(pressures_kPa) * KPA * _BEYOND
    outside = (batch.driving_pressure < low) | (batch.driving_pressure > high)
    span = f"{min(pressures_kPa):g} to {max(pressures_kPa):g} kPa"
    held = f", {len(response.held_out_pressures_kPa)} of them held out" if response.held_out_pressures_kPa else ""
    origin = (
        f"residuals of the fitted and corrected model at {len(pressures_kPa)} driving pressures{held}; outside {span} "
        "the correction counts as an error too"
    )
    force, rise = float(np.log(response.force_factor)), float(np.log(response.pressure_factor))

    def relative(error: float, correction: float) -> Array:
        return np.where(outside, np.hypot(error, correction), error)

    def source(
        name: str, standard: Array | float, figures: tuple[int, ...], origin: str, known: bool
    ) -> UncertaintySource:
        shape: Distribution = "lognormal" if known else "rectangular"
        filled = np.broadcast_to(np.asarray(standard, float), size)
        return UncertaintySource(name, FIGURE, filled, shape, counting(size, only=figures), origin, known)

    error = relative(response.sensitivity_error_relative, rise - force)
    root = np.sqrt(3.0)
    return [
        source("model as calibrated", error, (SENSITIVITY,), origin, True),
        source("model as calibrated", relative(response.force_error_relative, force), _FORCES, origin, True),
        source(
            "pressure gauge of the rig",
            GAUGE / root,
            (SENSITIVITY,),
            f"assumed: +-{GAUGE:.0%} of the reading, as of the driving pressure; the calibration can be no better",
            False,
        ),
        source(
            "force sensor of the rig",
            FORCE_GAUGE / root,
            (SENSITIVITY, *_FORCES),
            f"assumed: +-{FORCE_GAUGE:.0%} of the reading; the calibration can be no better",
            False,
        ),
    ]
