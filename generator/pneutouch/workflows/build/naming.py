"""Name of a build if none is given."""

from pneutouch.catalogue import DesignSource
from pneutouch.spec.design import CALIBRATION, NO_CALIBRATION
from pneutouch.spec.read import Changes


def calibrated_name(source: DesignSource, changes: Changes) -> str | None:
    """Name of the build of a calibrated sensor, so that it does not replace the design's; None without calibration."""
    calibration = changes.get(CALIBRATION, source.content.get(CALIBRATION, NO_CALIBRATION))
    if calibration == NO_CALIBRATION or not isinstance(calibration, str):
        return None
    return calibration if calibration.startswith(source.name) else f"{source.name}-{calibration}"
