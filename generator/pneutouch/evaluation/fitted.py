"""Check that parameters of a design's sensor can be fitted to measured runs."""

from pneutouch.catalogue import ResolvedDesign
from pneutouch.errors import InputError
from pneutouch.mechanics.fit_cover import outside_fit
from pneutouch.mechanics.sensor import Sensor


def check_fitted(scene: ResolvedDesign, sensor: Sensor) -> None:
    """Raise InputError where the atlas, which every fit is made with, does not cover the sensor at a depth it has."""
    why = outside_fit(sensor)
    if why is None:
        return
    contact = scene.design.contact
    key = next(iter(contact.off_axis), None if contact.base else "base")
    raise InputError(
        f"the atlas does not cover this sensor, {why}, and the fit is made with the atlas",
        file=scene.where,
        key=None if key is None else f"contact.{key}",
        value=None if key is None else getattr(contact, key),
        remedy="`compare` sets design and measurement side by side without a fit",
    )
