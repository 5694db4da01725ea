"""A sensor's bodies in one frame, and the gas volume behind its cavity."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.arrays import Array
from pneutouch.catalogue import ResolvedDesign
from pneutouch.parts.air_path import internal_volume
from pneutouch.parts.layout import Layout, lay_out
from pneutouch.parts.space import check_space
from pneutouch.spec.part import OnePiece
from pneutouch.spec.printer import Mode, Printer
from pneutouch.units import ML

if TYPE_CHECKING:
    from pneutouch.body import Body, Solid
    from pneutouch.parts.mould import MouldAssembly

# The mould is imported only for a cast membrane: most are printed. A prediction takes layout and volumes alone: the
# solids are drawn where they are used.

_MARGIN = 1.0
"""Distance in mm of the bodies from the coordinate planes of the print frame, so that all coordinates are positive."""


@dataclass(frozen=True)
class Assembly:
    """A scene laid out in the design frame (base plane z = 0), its solids and their meshes."""

    scene: ResolvedDesign
    layout: Layout

    def __repr__(self) -> str:
        return f"Assembly({self.scene.name!r}: {', '.join(solid.name for solid in self.solids)})"

    @cached_property
    def solids(self) -> tuple[Solid, ...]:
        """The membrane first, then the rigid bodies."""
        from pneutouch.parts.connector import rigid_solids
        from pneutouch.parts.membrane import membrane_solid

        membrane = membrane_solid(self.layout, self.scene.membrane_material)
        return (membrane, *rigid_solids(self.scene, self.layout))

    @cached_property
    def bodies(self) -> tuple[Body, ...]:
        """Print meshes within the scene's tolerance, in the design frame."""
        return tuple(solid.mesh(self.scene.mesh_tolerance) for solid in self.solids)

    @cached_property
    def mould(self) -> MouldAssembly | None:
        """The mould of a cast membrane; None if it is printed. Raises InputError if a detail has no space."""
        if self.scene.mould_printer is None:
            return None
        from pneutouch.parts.mould import mould_of

        return mould_of(self.scene, self.layout)

    def solid(self, name: str) -> Solid:
        """The solid of this name: membrane, connector, ring or plug."""
        return next(solid for solid in self.solids if solid.name == name)

    def machine(self, name: str) -> tuple[Printer, Mode]:
        """Printer of the body of this name, and its mode."""
        scene = self.scene
        if name == "membrane":
            return scene.printer, scene.membrane_mode
        return scene.connector_printer, scene.connector_mode

    def job(self, name: str) -> str:
        """Name of the print job of the body of this name; bodies of one job are printed together."""
        grown = isinstance(self.scene.seat, OnePiece) and name in ("membrane", "connector")
        return "one piece" if grown else name

    def stands_up(self, name: str) -> bool:
        """True if the body of this name is printed as it stands in the design frame, False if turned over.

        The design says it for the membrane; a rigid body of a filament printer stands as it needs less support.
        """
        if self.job(name) == self.job("membrane"):
            return self.scene.design.print.orientation == "dome-up"
        if self.machine(name)[0].process != "filament":
            return True
        body = next(body for body in self.bodies if body.name == name)
        return body.under_ceilings(1.0) <= body.under_ceilings(-1.0)

    @cached_property
    def print_offset(self) -> Array:
        """Shift (3,) in mm from the design frame to the print frame, whole millimetres."""
        return print_offset(self.bodies)

    @cached_property
    def internal_volume(self) -> float:
        """Gas volume between the base plane and the port's mouth, the fitting in place, mm3."""
        return internal_volume(self.scene, self.layout)

    @property
    def tube_volume(self) -> float:
        """Volume of the tube and of the adaptors behind it, mm3."""
        pneumatics, bore = self.scene.design.pneumatics, self.scene.tube.inner_diameter
        pieces = [[pneumatics.tube_length_mm, bore], *(pneumatics.adaptors_mm or ())]
        return math.fsum(math.pi * (0.5 * wide) ** 2 * length for length, wide in pieces)

    @property
    def dead_volume(self) -> float:
        """Gas volume behind the cavity in mm3: as stated in the design, else as drawn."""
        stated_mL = self.scene.design.pneumatics.dead_volume_mL
        return self.drawn_volume if stated_mL is None else stated_mL * ML

    @property
    def known_gauge_volume_mL(self) -> float | None:
        """Gas volume inside the gauge, mL, as the design or the gauge's maker states it; None if neither does."""
        stated_mL, gauge = self.scene.design.pneumatics.gauge_volume_mL, self.scene.gauge
        if stated_mL is not None or gauge is None or gauge.inner_volume_mL is None:
            return stated_mL
        return gauge.inner_volume_mL.nominal

    @property
    def gauge_volume_mL(self) -> float:
        """Gas volume inside the gauge, mL; 0 if it is not known."""
        return self.known_gauge_volume_mL or 0.0

    @property
    def drawn_volume(self) -> float:
        """Gas volume in connector, tube and gauge as drawn, mm3, independent of a stated one."""
        return self.internal_volume + self.tube_volume + self.gauge_volume_mL * ML

    @property
    def dead_volume_note(self) -> str:
        """Note on a stated dead volume of zero behind a tube, as in the paper's theory; else empty, as for a calibrated
        sensor, whose dead volume was measured."""
        pneumatics, calibrated = self.scene.design.pneumatics, self.scene.calibration is not None
        if pneumatics.dead_volume_mL != 0 or pneumatics.tube_length_mm == 0 or calibrated:
            return ""
        drawn_mL = self.drawn_volume / ML
        return f"the paper's idealisation: connector and tube as drawn hold {drawn_mL:.2f} mL"


def print_offset(bodies: tuple[Body, ...]) -> Array:
    """Shift (3,) in mm, whole millimetres, after which all coordinates of bodies are positive."""
    low = np.min([body.bounds[0] for body in bodies], axis=0)
    return np.asarray(np.ceil(_MARGIN - low))


def assemble(scene: ResolvedDesign) -> Assembly:
    """Lay out the bodies of a scene. Raises InputError if a part has no space."""
    layout = lay_out(scene)
    check_space(scene, layout)
    return Assembly(scene, layout)
