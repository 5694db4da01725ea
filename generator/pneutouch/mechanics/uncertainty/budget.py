"""The one entry: sensors, resin and printer to a budget."""

from collections.abc import Mapping

from pneutouch.arrays import Flags
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.uncertainty.contact import ContactModel
from pneutouch.mechanics.uncertainty.propagate import Budget, propagate
from pneutouch.mechanics.uncertainty.sources import sources
from pneutouch.mechanics.uncertainty.sources.model import ModelErrors
from pneutouch.spec.calibration import SensorCalibration
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer


def budget(
    batch: SensorBatch,
    material: Material,
    printer: Printer,
    *,
    near_paper: Flags | bool,
    errors: ModelErrors,
    numerical: Mapping[str, float],
    aged: bool = True,
    calibration: SensorCalibration | None = None,
    contact: ContactModel | None = None,
    anywhere: bool = False,
) -> Budget:
    """The uncertainty of the figures of n sensors that share a resin and a printer.

    Args:
        batch: The sensors, mm, MPa, mm3; see `batch_of`.
        material: Their resin; must have a shear modulus.
        printer: Who prints them.
        near_paper: Those to which the model's error on the paper's sensor applies, one flag or (n,).
        errors: The model's relative errors against Table S1; see `model_errors`.
        numerical: Greatest relative errors of discretisation and interpolation by figure (`FIGURES`).
        aged: True if the sensor may be up to a year old; else it is fresh, or of the age at which it was calibrated.
        calibration: Of the sensor in hand; its parameters and its model error take the place of those of design and
            resin.
        contact: Contact at the n driving pressures, if that is no plate without friction.
        anywhere: True if object and place of contact are unknown; see `sources.place`.

    Raises:
        InputError: ``numerical`` names a figure that there is not.
    """
    source_list = sources(
        batch,
        material,
        printer,
        near_paper=near_paper,
        errors=errors,
        numerical=numerical,
        aged=aged,
        calibration=calibration,
        contact=contact,
        anywhere=anywhere,
    )
    return propagate(batch, source_list, contact)
