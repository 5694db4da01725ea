"""A sensor's bodies in one frame, and the gas that lies behind its cavity."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pneutouch.body import Body, Solid
from pneutouch.catalogue import Scene
from pneutouch.meridian.segments import Array
from pneutouch.parts.connector import CHANNEL, connector_meridian
from pneutouch.parts.layout import Layout, lay_out
from pneutouch.parts.membrane import INNER_WALL, membrane_meridian
from pneutouch.parts.mount import mounting_bores
from pneutouch.units import ML

_MARGIN = 1.0
"""Distance in mm of the print frame's bodies from its coordinate planes: all coordinates are positive."""


@dataclass(frozen=True)
class Assembly:
    """The solids of a scene in the design frame (base plane z = 0), and their meshes."""

    scene: Scene
    layout: Layout
    solids: tuple[Solid, ...]

    @cached_property
    def bodies(self) -> tuple[Body, ...]:
        """Print meshes within the scene's tolerance, in the design frame."""
        return tuple(solid.mesh(self.scene.mesh_tolerance) for solid in self.solids)

    @cached_property
    def print_offset(self) -> Array:
        """Shift (3,) in mm from the design frame to the print frame, whole millimetres."""
        low = np.min([body.bounds[0] for body in self.bodies], axis=0)
        offset: Array = np.ceil(_MARGIN - low)
        return offset

    def deviation(self, body: Body) -> float:
        """Greatest distance in mm of a body's mesh from its exact surface, measured on dense points."""
        solid = next(solid for solid in self.solids if solid.name == body.name)
        return float(solid.distance(body.surface_points()).max())

    @cached_property
    def cavity_volume(self) -> float:
        """Volume under the unloaded dome down to the base plane, mm3."""
        return self.solids[0].meridian.swept(INNER_WALL)

    @property
    def channel_volume(self) -> float:
        """Volume of the connector's air channel and port, mm3."""
        return self.solids[1].meridian.swept(CHANNEL)

    @property
    def tube_volume(self) -> float:
        """Volume of the tube, mm3."""
        radius = 0.5 * self.scene.port.tube_inner_diameter
        return math.pi * radius**2 * self.scene.design.pneumatics.tube_length_mm

    @property
    def dead_volume(self) -> float:
        """Gas behind the cavity in mm3: as the design states it, else channel and tube."""
        stated = self.scene.design.pneumatics.dead_volume_mL
        return self.channel_volume + self.tube_volume if stated is None else stated * ML


def assemble(scene: Scene) -> Assembly:
    """Draw the membrane and the connector of a scene."""
    layout = lay_out(scene)
    membrane = Solid("membrane", "membrane", scene.membrane_material, membrane_meridian(layout))
    connector = Solid(
        "connector", "connector", scene.connector_material, connector_meridian(layout, scene.port),
        mounting_bores(scene.mount, layout),
    )  # fmt: skip
    return Assembly(scene, layout, (membrane, connector))
