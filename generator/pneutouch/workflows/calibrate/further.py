"""Further tests of a calibrated sensor, at no more than its rated pressure."""

from dataclasses import replace

from pneutouch.bench.calibrate.further import further_tests
from pneutouch.catalogue import KINDS
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.evaluation.resins import rating_of
from pneutouch.parts import assemble
from pneutouch.spec.calibration import SensorCalibration
from pneutouch.workflows.calibrate.files import CampaignSource, savable
from pneutouch.workflows.calibrate.fit import Calibration


def with_further_tests(calibration: Calibration, source: CampaignSource) -> Calibration:
    """The calibration with the further tests that would reduce its uncertainty most."""
    return replace(calibration, further=further_tests(calibration.fit, _rated(calibration, source)))


def _rated(calibration: Calibration, source: CampaignSource) -> float:
    """The rated pressure of the calibrated sensor, MPa; as designed where the fit cannot be a calibration."""
    scene = calibration.scene
    try:
        known = KINDS["calibrations"].validate(savable(calibration, source), "calibration")
    except InputError:
        known = None
    assert known is None or isinstance(known, SensorCalibration)
    scene = replace(scene, calibration=known)
    return rating_of(scene, sensor_of(assemble(scene))).pressure
