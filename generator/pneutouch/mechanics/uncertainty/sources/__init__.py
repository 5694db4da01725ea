"""All sources of uncertainty of n sensors of one resin and printer."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.arrays import Flags
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.uncertainty.source import UncertaintySource
from pneutouch.mechanics.uncertainty.sources.model_error import (
    ModelErrors,
    build_sources,
    model_sources,
    numerical_sources,
)
from pneutouch.mechanics.uncertainty.sources.modulus import ageing_sources, biaxial_sources, modulus_sources
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer

if TYPE_CHECKING:
    from pneutouch.mechanics.uncertainty.contact_model import ContactModel
    from pneutouch.spec.calibration import SensorCalibration


def sources(
    batch: SensorBatch,
    material: Material,
    printer: Printer,
    *,
    near_paper: Flags | bool,
    errors: ModelErrors,
    numerical: Mapping[str, float],
    aged: float = 1.0,
    calibration: "SensorCalibration | None" = None,
    contact: "ContactModel | None" = None,
    anywhere: bool = False,
) -> list[UncertaintySource]:
    """Sources that count for at least one figure of one of n sensors of one resin and printer.

    Args:
        batch: The sensors, mm, MPa, mm3; see `batch_of`.
        material: Their resin; must have a shear modulus.
        printer: Their printer.
        near_paper: True for sensors to which the model's error on the paper's sensor applies, one flag or (n,).
        errors: The model's relative errors against Table S1; see `model_errors`.
        numerical: Greatest relative errors of discretisation and interpolation by figure (`FIGURES`).
        aged: Greatest age of the sensor, or the greatest time since it was calibrated, in years; a year counts at most.
        calibration: Calibration of the built sensor, whose parameters and model error replace those of design and
            resin; None without one.
        contact: Contact at the n driving pressures; None: a frictionless plate.
        anywhere: True if object and place of contact are unknown; see `contact_model.place_sources`.

    Raises:
        InputError: ``numerical`` names an unknown figure.
    """
    size = len(batch)
    near = np.broadcast_to(np.asarray(near_paper, dtype=bool), size)
    source_list = [*modulus_sources(material, near & bool(errors.resin_errors)), *biaxial_sources(material, size)]
    source_list += build_sources(batch, printer)
    if contact is not None:
        from pneutouch.mechanics.uncertainty.contact_model import contact_sources

        source_list += contact_sources(contact, source_list)
    model_error, remaining = model_sources(near, errors), 1.0
    if calibration is not None:
        # Loaded where a sensor has a calibration.
        from pneutouch.mechanics.uncertainty.sources.calibrated import calibrated_sources, kept_of_design, kept_of_model

        remaining = calibration.remaining_year
        source_list = [*kept_of_design(batch, calibration, source_list), *calibrated_sources(batch, calibration)]
        model_error = kept_of_model(batch, calibration, model_error)
    ahead = min(aged, remaining)
    source_list += [
        *(ageing_sources(material, size, ahead) if ahead > 0.0 else []),
        *model_error,
        *numerical_sources(size, numerical),
    ]
    if anywhere:
        # Its table of presses loads where a design asks for it.
        from pneutouch.mechanics.uncertainty.contact_model import place_sources

        source_list += place_sources(batch)
    return [source for source in source_list if source.counts.any()]
