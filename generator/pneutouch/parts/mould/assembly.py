"""The mould of a cast membrane: its parts, their numbers, its bodies as closed and as printed, and its silicone."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Body, Solid
from pneutouch.catalogue import ResolvedDesign
from pneutouch.errors import InputError
from pneutouch.parts.cast_ring import RING
from pneutouch.parts.layout import Layout, lay_out
from pneutouch.parts.membrane import membrane_meridian
from pneutouch.parts.mould.pieces import channels, lay_out_mould, mould_solids
from pneutouch.parts.mould.size import FILLET, MouldShape, MouldSize
from pneutouch.shape.meridian import Meridian
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Mode, Printer
from pneutouch.units import ML, grams

_EDGE = 0.05
"""Width in mm of the flange that must be left on both sides of a channel: less would cut ring or core."""

_LEAST_HOLE = 0.3
"""Least diameter in mm of a channel at its narrowest point: own choice."""

_LEAST_GAP = 0.5
"""Least thickness in mm of silicone between core and ring: own choice."""


def check_mould_space(where: str, size: MouldSize) -> None:
    """Raise InputError, in the design file ``where``, on the key that leaves too little space for a detail."""
    _check_insert(where, size)
    shape, faces = size.shape, size.faces
    width, slope = faces.edge.start[0] - faces.rim.end[0] - 2 * _EDGE, math.tan(shape.draft)
    for key, diameter, narrowest in (
        ("sprue_diameter_mm", shape.sprue_diameter, 2 * size.neck),
        ("vent_diameter_mm", shape.vent_diameter, 2 * (0.5 * shape.vent_diameter - size.foot * slope)),
    ):
        if diameter > width:
            raise InputError(
                f"wider than the flange; it must be at most {width:.2f} mm",
                file=where,
                key=f"mould.{key}",
                value=diameter,
                remedy="take a smaller one, or raise membrane.wall_thickness_mm, which the flange follows",
            )
        if narrowest < _LEAST_HOLE:
            raise InputError(
                f"its draft closes it: {max(narrowest, 0.0):.2f} mm is left in diameter",
                file=where,
                key=f"mould.{key}",
                value=diameter,
                remedy="take a larger one, or less mould.draft_deg or mould.wall_mm",
            )
    flange = -size.low
    if FILLET + shape.clearance > 0.9 * flange:
        raise InputError(
            f"the flange of {flange:.2f} mm has no space for the ring's rounding",
            file=where,
            key="mould.clearance_mm",
            value=shape.clearance,
            remedy=f"it must be at most {0.9 * flange - FILLET:.2f} mm",
        )


def _check_insert(where: str, size: MouldSize) -> None:
    """Raise InputError if silicone cannot pass between core and ring; shrinkage enlarges the core, not the ring."""
    if size.insert is None:
        return
    gap = size.insert.web_inner - max(size.faces.rim.start[0], size.faces.rim.end[0])
    if gap < _LEAST_GAP:
        raise InputError(
            f"the core leaves {max(gap, 0.0):.2f} mm inside the ring that the flange is cast around; at least "
            f"{_LEAST_GAP:g} mm lets silicone through",
            file=where,
            key="mould.shrinkage_percent",
            value=round(100 * size.shape.shrinkage, 6),
            remedy="take a silicone that shrinks less, or less mould.draft_deg",
        )


@dataclass(frozen=True)
class MouldAssembly:
    """Parts of the mould of a cast membrane, mm, its cavities larger by the shrinkage, the first one about the z axis.

    ``solids`` are cap, ring, core and base, one of each kind; ``counts`` has how many of each to print. ``insert`` is
    the sensor's own ring, around which the flange is cast; None without one.
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
        """Chord tolerance of the meshes, mm: that of the membrane, whose faces the mould forms."""
        return self.scene.mesh_tolerance

    @property
    def counts(self) -> dict[str, int]:
        """Number of each printed part, by name: a core and a ring for each cavity."""
        cavities = self.size.shape.cavities
        return {solid.name: cavities if repeated(solid) else 1 for solid in self.solids}

    @cached_property
    def bodies(self) -> tuple[Body, ...]:
        """Meshes of the four parts in their positions in the closed mould, with ring and core of the first cavity."""
        return tuple(solid.mesh(self.tolerance) for solid in self.solids)

    @cached_property
    def closed(self) -> tuple[Body, ...]:
        """All bodies of the closed mould, with ring, core and insert in each cavity; later ones are numbered."""
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
        """Meshes of the four parts as printed: on z = 0, with positive coordinates, the cap's pockets up."""
        turned = (body.turned_over() if body.name == "mould-cap" else body for body in self.bodies)
        return tuple(body.moved(-body.bounds[0]) for body in turned)

    @property
    def print_offset(self) -> Array:
        """Shift (3,) in mm from the design frame to positive coordinates, whole millimetres."""
        low = np.min([body.bounds[0] for body in self.bodies], axis=0)
        return np.asarray(np.ceil(1.0 - low))

    @property
    def thickness(self) -> float:
        """Thickness of the closed mould, mm."""
        return self.size.cap_high - self.size.base_low


def repeated(part: Solid | Body) -> bool:
    """True if every cavity has a part of this kind."""
    return part.name in ("mould-ring", "mould-core", RING)


def mould_of(scene: ResolvedDesign, layout: Layout | None = None) -> MouldAssembly:
    """Draw the mould of a scene with a cast membrane.

    Raises InputError with file and key if a part of the mould does not fit, and TypeError for a printed membrane.
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
    """Shape of the mould that a scene states; the shrinkage is the material's, else 0, if none is stated."""
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


FILM = 0.5
"""Thickness in mm of the silicone that may overflow into a window of the base: own choice."""

LOSS_SHARE = 0.15
LEAST_LOSS_ML = 2.0
"""Silicone lost on cup, stirrer and syringe: a share of the filling, at least so many mL; our choice, measure yours."""


@dataclass(frozen=True)
class SiliconeBatch:
    """Silicone of one filling, volumes per cavity of the mould. ``parts_by_mass``: mixing ratio, empty if unknown."""

    cavities: int
    cavity_mL: float
    channels_mL: float
    overflow_mL: float
    density_g_per_cm3: float
    parts_by_mass: tuple[float, ...]

    @cached_property
    def filled_mL(self) -> float:
        """Volume of silicone that the mould takes: cavities, channels and overflow."""
        return self.cavities * (self.cavity_mL + self.channels_mL + self.overflow_mL)

    @property
    def loss_mL(self) -> float:
        """Volume that is lost: `LOSS_SHARE` of the filling, but at least `LEAST_LOSS_ML`."""
        return max(LOSS_SHARE * self.filled_mL, LEAST_LOSS_ML)

    @property
    def volume_mL(self) -> float:
        """Volume to mix: filling and loss."""
        return self.filled_mL + self.loss_mL

    @property
    def mass_g(self) -> float:
        """Mass to weigh, of all parts together."""
        return grams(self.volume_mL * ML, self.density_g_per_cm3)

    @property
    def parts_g(self) -> tuple[float, ...]:
        """Mass to weigh of each part, in the order of ``parts_by_mass``."""
        whole = sum(self.parts_by_mass)
        return tuple(self.mass_g * part / whole for part in self.parts_by_mass)


def silicone_batch(mould: MouldAssembly) -> SiliconeBatch:
    """The batch that fills a mould once."""
    size, material = mould.size, mould.scene.membrane_material
    return SiliconeBatch(
        cavities=size.shape.cavities,
        cavity_mL=size.cavity_volume / ML,
        channels_mL=sum(channel.volume() for channel in channels(size)) / ML,
        overflow_mL=math.pi * size.window**2 * FILM / ML,
        density_g_per_cm3=material.density_g_per_cm3.nominal,
        parts_by_mass=() if material.casting is None else tuple(material.casting.parts_by_mass),
    )
