"""Writing of a set of coupons: STL, 3MF, print-and-measure sheet, results file to fill in, and manifest.

Coupons lie on a printer's tray side by side in rows, never turned: x and y of `GAUGE` are the machine's."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from pneutouch import __version__
from pneutouch.body import Body, Solid
from pneutouch.catalogue import Library
from pneutouch.errors import InputError
from pneutouch.export.scene import stl
from pneutouch.export.threemf import threemf
from pneutouch.output.files import check_writable, input_hash, with_manifest, write_folder
from pneutouch.packing import PackingArea, in_rows
from pneutouch.report.pages import filled
from pneutouch.results.coupons import CouponSet, PrintedCoupon
from pneutouch.spec.printer import Mode, Printer
from pneutouch.workflows.coupons.order import CouponItem, CouponOptions, CouponOrder, order, results_template

MARGIN, SPACING = 5.0, 5.0
"""Border of the tray and space between boxes, mm: room for a spatula; Objet refuses boxes that touch (DOC-37004)."""


@dataclass(frozen=True)
class CouponPiece:
    """One solid of an item; its mesh on z = 0 with least x and y at 0, the mesh's greatest deviation from the solid,
    mm, and the places of its copies."""

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
        """The bodies in their places, their names numbered."""
        return tuple(
            replace(self.body, name=f"{self.body.name}-{k}").moved(np.array([x, y, 0.0]))
            for k, (x, y) in enumerate(self.places, start=1)
        )


def lay(printer_name: str, items: tuple[CouponItem, ...]) -> tuple[CouponPiece, ...]:
    """Pieces of one machine with their places. Raises InputError for a piece that does not fit, or what takes two
    jobs."""
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
    """Print mode that prints everything in one job. Raises InputError if there is none."""
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


def sheet(order: CouponOrder, trays: Mapping[str, tuple[CouponPiece, ...]]) -> str:
    """Print-and-measure sheet as Markdown."""
    coupons = dict.fromkeys(item.coupon for item in order.items)
    return filled(
        "coupons.md.j2",
        order=order,
        trays=[(name, job_mode(name, tuple(piece.item for piece in pieces)), pieces) for name, pieces in trays.items()],
        coupons=[(coupon, [item for item in order.items if item.coupon is coupon]) for coupon in coupons],
        stl_name=stl_name,
    )


def stl_name(piece: CouponPiece, order: CouponOrder) -> str:
    """Name of a piece's STL file; it begins with the machine's name if that is not the order's printer."""
    item = piece.item
    return (
        f"{piece.body.name}.stl" if item.printer_name == order.profile else f"{item.printer_name}-{piece.body.name}.stl"
    )


RESULTS, SHEET = "results.toml", "measure.md"


def build_coupons(options: CouponOptions, out: Path, library: Library | None = None) -> CouponSet:
    """Write the coupons into ``out/coupons-<printer>/``.

    Raises InputError for what is unknown or does not fit the tray, and if readings in the folder would be lost. The
    same input gives the same bytes."""
    ordered = order(options, library)
    folder = out / ordered.name
    check_writable(folder)
    trays = {name: lay(name, items) for name, items in ordered.machines().items()}
    follows_from, files = inputs(ordered), dict[str, bytes]()
    for name, pieces in trays.items():
        bodies = tuple(body for piece in pieces for body in piece.copies())
        title = ordered.name if name == ordered.profile else name
        files[f"{title}.3mf"] = threemf(title, bodies, _metadata(name, len(bodies), input_hash(follows_from)))
        files |= {f"stl/{stl_name(piece, ordered)}": stl(piece.body) for piece in pieces}
    files[SHEET] = sheet(ordered, trays).encode()
    files[RESULTS] = results_template(ordered).encode()
    coupons = _coupons(trays)
    write_folder(folder, with_manifest(files, ordered.name, follows_from, coupons=coupons))
    return CouponSet(ordered.name, coupons, str(folder))


def inputs(ordered: CouponOrder) -> Mapping[str, object]:
    """All that the coupons depend on, as data."""
    scene = ordered.scene
    return {
        "profile": ordered.profile,
        "design": None if scene is None else scene.design.model_dump(mode="json"),
        "items": [
            {
                "coupon": item.coupon.name,
                "about": item.about,
                "copies": item.copies,
                "printer": item.printer_name,
                "material": item.material.model_dump(mode="json"),
                **({} if item.mould is None else {"mould": item.mould.model_dump(mode="json")}),
            }
            for item in ordered.items
        ],
        "printers": {name: items[0].printer.model_dump(mode="json") for name, items in ordered.machines().items()},
    }


def _metadata(name: str, count: int, hashed: str) -> dict[str, str]:
    return {
        "Title": f"Coupons for {name}",
        "Application": f"pneutouch {__version__}",
        "Description": f"{count} coupons to print and measure; see {SHEET}",
        "input-hash": hashed,
    }


def _coupons(trays: Mapping[str, tuple[CouponPiece, ...]]) -> tuple[PrintedCoupon, ...]:
    return tuple(
        PrintedCoupon(
            coupon=piece.item.coupon.name,
            piece=piece.body.name,
            material=piece.solid.material.title,
            printer=name,
            copies=len(piece.places),
            places_mm=tuple(piece.places),
            size_mm=tuple(round(length, 3) for length in piece.size),
            exact_volume_mm3=round(piece.solid.volume, 3),
            volume_mm3=round(piece.body.volume, 3),
            measured_deviation_mm=round(piece.deviation, 6),
        )
        for name, pieces in trays.items()
        for piece in pieces
    )
