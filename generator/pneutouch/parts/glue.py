"""Glues by the pair of surfaces that they join, and the gaps they fill; only silicone's own glue bonds to silicone."""

from collections.abc import Iterator
from typing import Any, Literal, NamedTuple

from pneutouch.catalogue import ResolvedDesign
from pneutouch.parts.air_path import annulus, draft, inside_flange
from pneutouch.parts.layout import Layout
from pneutouch.spec.part import CastRing, GluedFlange, OnePiece
from pneutouch.spec.printer import Printer
from pneutouch.wording import data_of

GlueSurface = Literal["silicone", "photopolymer", "thermoplastic"]
"""Kind of surface to be glued, by the process that made it."""

_SURFACES: dict[str, GlueSurface] = {
    "casting": "silicone",
    "polyjet": "photopolymer",
    "resin": "photopolymer",
    "filament": "thermoplastic",
}


class GlueBond(NamedTuple):
    """A pair of surfaces that a glue joins; ``weak`` if the bond peels under load."""

    pair: frozenset[GlueSurface]
    weak: bool = False


class Glue(NamedTuple):
    """A glue: its name in text, the bonds that it makes, and their source."""

    title: str
    bonds: tuple[GlueBond, ...]
    source: str

    def bond(self, one: GlueSurface, other: GlueSurface) -> GlueBond | None:
        """Bond between two surfaces, or None if the glue makes none."""
        return next((bond for bond in self.bonds if bond.pair == {one, other}), None)


def _bonds(entry: dict[str, Any]) -> Iterator[GlueBond]:
    for kind in ("lasting", "weak"):
        yield from (GlueBond(frozenset(pair), kind == "weak") for pair in entry.get(kind, ()))


GLUES = {name: Glue(one["title"], tuple(_bonds(one)), one["source"]) for name, one in data_of(__file__).items()}
"""The glues that a design can name, by name."""


def surface_of(printer: Printer) -> GlueSurface:
    """Surface of a body made with the profile of a printer."""
    return _SURFACES[printer.process]


def glue_surfaces(scene: ResolvedDesign) -> tuple[GlueSurface, GlueSurface] | None:
    """Surfaces that glue joins at the seat, the connector's surface last; None for a seat without glue.

    Of a cast ring it is the ring, made like the connector, that is glued; its holes, not glue, hold the silicone.
    """
    if isinstance(scene.seat, CastRing):
        return surface_of(scene.connector_printer), surface_of(scene.connector_printer)
    if not isinstance(scene.seat, GluedFlange):
        return None
    return surface_of(scene.printer), surface_of(scene.connector_printer)


def glue_volume(scene: ResolvedDesign, layout: Layout) -> float:
    """Volume in mm3 of the gaps filled with glue: around a glued flange, around a cast flange with its ring, or around
    the shoulder of a plug."""
    seat = scene.seat
    if isinstance(seat, CastRing):
        return inside_flange(layout) + annulus(layout.held_radius, layout.groove_outer, layout.flange_thickness)
    if isinstance(seat, GluedFlange):
        outside = annulus(layout.flange_radius, layout.groove_outer, layout.flange_thickness)
        return inside_flange(layout) + outside + draft(layout.flange_radius, -layout.flange_draft, layout)
    if isinstance(seat, OnePiece):
        wide = layout.opening_radius + seat.shoulder_width
        return annulus(wide - scene.fit_clearance, wide, seat.shoulder_thickness)
    return 0.0


def glue_of(scene: ResolvedDesign) -> str | None:
    """Name of the glue at the seat: that of the design, else silicone adhesive for a cast flange and epoxy, which fills
    gaps, for a cast ring; None if the choice is open, or without glue."""
    surfaces, named = glue_surfaces(scene), scene.design.connector.glue
    if surfaces is None or named is not None:
        return named
    if isinstance(scene.seat, CastRing):
        return "epoxy"
    return "silicone-adhesive" if "silicone" in surfaces else None


def glues_for(one: GlueSurface, other: GlueSurface) -> list[str]:
    """Names of the glues that join two surfaces, those with a lasting bond first."""
    weak = {name: bond.weak for name, glue in GLUES.items() if (bond := glue.bond(one, other)) is not None}
    return sorted(weak, key=lambda name: weak[name])
