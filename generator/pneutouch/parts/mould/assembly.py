"""The mould of a cast membrane: its parts, how often each is made, and its bodies closed and as printed."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Body, Solid
from pneutouch.catalogue import ResolvedDesign
from pneutouch.meridian import Meridian
from pneutouch.parts.cast_ring import RING
from pneutouch.parts.layout import Layout, lay_out
from pneutouch.parts.membrane import membrane_meridian
from pneutouch.parts.mould.lay import lay_out_mould
from pneutouch.parts.mould.pieces import mould_solids
from pneutouch.parts.mould.size import MouldShape, MouldSize
from pneutouch.parts.mould.space import check_mould_space
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Mode, Printer


@dataclass(frozen=True)
class MouldAssembly:
    """The mould of a scene in the design frame, the first cavity about the z axis; every length is compensated.

    ``solids`` are cap, ring, core and base, the ring and the core once; ``counts`` states how many of each are made.
    ``insert`` is the ring of the sensor that the flange is cast around, no part of the mould; None without one.
    """

    scene: ResolvedDesign
    membrane: Meridian
    size: MouldSize
    solids: tuple[Solid, ...]
    printer: Printer
    mode: Mode
    insert: Solid | None = None

    def __repr__(self) -> str:
        return f"MouldAssembly({self.scene.name!r}, {self.size.shape.cavities} cavities)"

    @property
    def material(self) -> Material:
        """Material of the mould."""
        return self.solids[0].material

    @property
    def tolerance(self) -> float:
        """Chord tolerance of the meshes, mm: that of the membrane, which the mould forms."""
        return self.scene.mesh_tolerance

    @property
    def counts(self) -> dict[str, int]:
        """Number of each printed part, by name: a core and a ring for each cavity."""
        cavities = self.size.shape.cavities
        return {solid.name: cavities if repeated(solid) else 1 for solid in self.solids}

    @cached_property
    def bodies(self) -> tuple[Body, ...]:
        """Meshes of the four parts as they stand in the closed mould, ring and core of the first cavity."""
        return tuple(solid.mesh(self.tolerance) for solid in self.solids)

    @cached_property
    def closed(self) -> tuple[Body, ...]:
        """Every body of the closed mould, ring, core and insert in each cavity; later ones are numbered."""
        every = []
        inserts = () if self.insert is None else (self.insert.mesh(self.tolerance),)
        for body in (*self.bodies, *inserts):
            places = self.size.places if repeated(body) else self.size.places[:1]
            for k, (x, y) in enumerate(places):
                name = body.name if k == 0 else f"{body.name}-{k + 1}"
                every.append(replace(body, name=name).moved(np.array([x, y, 0.0])))
        return tuple(every)

    @cached_property
    def printed(self) -> tuple[Body, ...]:
        """The four parts as they are printed: on the plane z = 0, coordinates positive, the cap's pockets up."""
        turned = (body.turned_over() if body.name == "mould-cap" else body for body in self.bodies)
        return tuple(body.moved(-body.bounds[0]) for body in turned)

    @property
    def print_offset(self) -> Array:
        """Shift (3,) in mm from the design frame to positive coordinates, whole millimetres."""
        low = np.min([body.bounds[0] for body in self.bodies], axis=0)
        offset: Array = np.ceil(1.0 - low)
        return offset

    @property
    def thickness(self) -> float:
        """Thickness of the closed mould, mm."""
        return self.size.cap_high - self.size.base_low


def repeated(part: Solid | Body) -> bool:
    """True if every cavity has such a part of its own."""
    return part.name in ("mould-ring", "mould-core", RING)


def mould_of(scene: ResolvedDesign, layout: Layout | None = None) -> MouldAssembly:
    """Draw the mould of a scene whose membrane is cast.

    Raises InputError that names file and key where a part of the mould has no space, and TypeError for a scene whose
    membrane is printed.
    """
    if scene.mould_printer is None or scene.mould_material is None:
        raise TypeError("the membrane of this scene is printed, not cast")
    layout = layout or lay_out(scene)
    membrane = membrane_meridian(layout)
    size = lay_out_mould(membrane, shape_of(scene), layout.ring)
    check_mould_space(scene.where, size)
    mode = scene.mould_printer.mode_for(scene.mould_material)
    assert mode is not None
    solids = mould_solids(size, scene.mould_material)
    insert = None if layout.ring is None else layout.ring.solid(scene.connector_material)
    return MouldAssembly(scene, membrane, size, solids, scene.mould_printer, mode, insert)


def shape_of(scene: ResolvedDesign) -> MouldShape:
    """Shape of the mould as a scene describes it."""
    stated, casting = scene.design.mould, scene.membrane_material.casting
    assert scene.mould_printer is not None
    shrinkage = stated.shrinkage_percent
    if shrinkage is None:
        shrinkage = 0.0 if casting is None else casting.shrinkage_percent.nominal
    return MouldShape(
        cavities=stated.cavities,
        wall=stated.wall_mm,
        draft=math.radians(stated.draft_deg),
        fastener=stated.fastener,
        vent_diameter=stated.vent_diameter_mm,
        sprue_diameter=stated.sprue_diameter_mm,
        clearance=stated.clearance_mm,
        shrinkage=0.01 * shrinkage,
        hole_undersize=scene.mould_printer.hole_undersize_mm.nominal,
    )
