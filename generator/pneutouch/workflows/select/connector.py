"""The connector around a candidate's dome: the space for its parts, how wide the whole sensor is, its dead volume."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.catalogue import ResolvedDesign
from pneutouch.errors import InputError, PneutouchError
from pneutouch.evaluation.contact_object import rigid_base
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.solid.rigid_base import RigidBase
from pneutouch.parts import Assembly, assemble
from pneutouch.parts.layout import lay_out_dome
from pneutouch.parts.port import port_shape
from pneutouch.parts.space import space_margin
from pneutouch.selection.problem import ConnectorFit

_RADII = np.geomspace(2.0, 60.0, 8)
"""Radii in mm at which the connector is drawn for its dead volume; between them it is straight."""

_WALL_SHARE = 0.15
"""Wall over radius of the domes drawn there: the dead volume does not go with the wall."""


def connector_fit(scene: ResolvedDesign) -> Callable[[Array, Array], ConnectorFit]:
    """The connector of a scene around domes of inner radius (n,) and wall (n,), mm."""
    port = port_shape(scene.port, scene.tube, scene.hole_undersize)

    def fit(radius: Array, wall: Array) -> ConnectorFit:
        layouts = [lay_out_dome(scene, port, *size) for size in zip(radius.tolist(), wall.tolist(), strict=True)]
        margins = [space_margin(scene, layout) for layout in layouts]
        return ConnectorFit(np.array(margins), np.array([2.0 * layout.plate_radius for layout in layouts]))

    return fit


def base_sensor(scene: ResolvedDesign) -> Sensor:
    """The sensor of a base, whose own dome is drawn in another size where the connector has no space for it.

    Raises InputError if no size has space.
    """
    try:
        return sensor_of(assemble(scene))
    except InputError:
        other = next((assembly for _, assembly in _sizes(scene) if assembly is not None), None)
        if other is None:
            raise
        return sensor_of(other)


def dead_volume(scene: ResolvedDesign, sensor: Sensor) -> Callable[[Array], Array]:
    """Dead volume (mm3) over the inner radius: drawn at a few radii where the connector's channel follows it."""
    if scene.design.pneumatics.dead_volume_mL is not None:
        return lambda radius: np.full_like(radius, sensor.gas.dead_volume)
    drawn = [(radius, assembly.dead_volume) for radius, assembly in _sizes(scene) if assembly is not None]
    if not drawn:
        return lambda radius: np.full_like(radius, sensor.gas.dead_volume)
    at, volumes = np.array(drawn).T
    return lambda radius: np.interp(radius, at, volumes)


def base_around(scene: ResolvedDesign, radius: float, wall: float) -> RigidBase | None:
    """Base that the wall of a dome of inner radius and wall (mm) can lie down on: the scene's connector as drawn for
    it.

    None if the wall passes through; a plane where the connector cannot be drawn.
    """
    drawn = _resized(scene, radius, wall)
    return RigidBase() if drawn is None else rigid_base(drawn)


def _sizes(scene: ResolvedDesign) -> Iterator[tuple[float, Assembly | None]]:
    """The scene with domes of several radii (mm), smallest first."""
    for radius in _RADII.tolist():
        yield radius, _resized(scene, radius, _WALL_SHARE * radius)


def _resized(scene: ResolvedDesign, radius: float, wall: float) -> Assembly | None:
    """The scene with another dome (mm), or None if its connector cannot be drawn."""
    sizes = {"inner_radius_mm": radius, "wall_thickness_mm": wall}
    membrane = scene.design.membrane.model_copy(update=sizes)
    try:
        return assemble(replace(scene, design=scene.design.model_copy(update={"membrane": membrane})))
    except PneutouchError:
        return None
