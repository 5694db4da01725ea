"""Coupons on a printer's tray: side by side in rows, never turned, because a gauge's x and y are the machine's."""

from dataclasses import dataclass, replace

import numpy as np

from pneutouch.body import Body, Solid
from pneutouch.errors import InputError
from pneutouch.packing import PackingArea, in_rows
from pneutouch.spec.printer import Mode, Printer
from pneutouch.workflows.coupons.order import CouponItem

MARGIN, SPACING = 5.0, 5.0
"""mm around the tray, and between bounding boxes: space for a spatula; Objet refuses boxes that touch (DOC-37004)."""


@dataclass(frozen=True)
class CouponPiece:
    """One solid of an item, its mesh lying on z = 0 with its least x and y at 0, and where its copies go."""

    item: CouponItem
    solid: Solid
    body: Body
    deviation: float
    places: tuple[tuple[float, float], ...] = ()

    @property
    def size(self) -> tuple[float, float, float]:
        """Size of the bounding box, mm."""
        x, y, z = (self.body.bounds[1] - self.body.bounds[0]).tolist()
        return x, y, z

    def copies(self) -> tuple[Body, ...]:
        """The bodies in their places, numbered."""
        return tuple(
            replace(self.body, name=f"{self.body.name}-{k}").moved(np.array([x, y, 0.0]))
            for k, (x, y) in enumerate(self.places, start=1)
        )


def lay(printer_name: str, items: tuple[CouponItem, ...]) -> tuple[CouponPiece, ...]:
    """The pieces of one machine with their places. Raises InputError for what does not fit, or not in one job."""
    printer = items[0].printer
    mode = job_mode(printer_name, items)
    pieces = [_piece(item, solid, printer, mode) for item in items for solid in item.solids()]
    envelope = printer.envelope
    # The deepest first, so that a row wastes little; equal ones stay in the order of the sheet.
    order = [
        k for k in sorted(range(len(pieces)), key=lambda k: -pieces[k].size[1]) for _ in range(pieces[k].item.copies)
    ]
    positions = in_rows([pieces[k].size[:2] for k in order], PackingArea(envelope.x, envelope.y, MARGIN, SPACING))
    places: dict[int, list[tuple[float, float]]] = {k: [] for k in order}
    for k, position in zip(order, positions, strict=True):
        wide, deep, high = pieces[k].size
        if position is None or high > envelope.z:
            problem = (
                f"{pieces[k].body.name} is {wide:.1f} x {deep:.1f} x {high:.1f} mm and no longer fits the tray of "
                f"{envelope.x:g} x {envelope.y:g} x {envelope.z:g} mm next to the others"
            )
            remedy = "take fewer `copies`, `only` some, or fewer `material`"
            raise InputError(problem, file=printer_name, remedy=remedy)
        places[k].append((round(position.x, 3), round(position.y, 3)))
    return tuple(replace(piece, places=tuple(places[k])) for k, piece in enumerate(pieces))


def job_mode(printer_name: str, items: tuple[CouponItem, ...]) -> Mode:
    """The mode that prints everything in one job. Raises InputError if there is none."""
    printer = items[0].printer
    mode = printer.mode_for(*(item.printed for item in items))
    if mode is None:
        names = ", ".join(dict.fromkeys(item.about for item in items))
        raise InputError(
            f"{names} do not run in one job on the {printer.title}, which holds {printer.resins_at_once} resins",
            file=printer_name,
            remedy="give fewer `material` at a time",
        )
    return mode


def _piece(item: CouponItem, solid: Solid, printer: Printer, mode: Mode) -> CouponPiece:
    mesh = solid.mesh(printer.finest_step(mode))
    deviation = float(solid.distance(mesh.surface_points()).max())
    if item.coupon.turned_over:
        mesh = replace(mesh, vertices=mesh.vertices * np.array([1.0, -1.0, -1.0]))
    body = replace(mesh, name=f"{solid.name}-{item.about}").moved(-mesh.bounds[0])
    return CouponPiece(item, solid, body, deviation)
