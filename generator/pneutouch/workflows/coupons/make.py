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
from pneutouch.parts.coupons import Coupon, Nominal
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


_CELLS = 5
"""Greatest number of readings on one line."""

CAST_EXCESS = 1.3
"""Ratio of silicone mixed to silicone in the coupons: some is struck off, some stays in the cup; our choice."""

_CAST = "Cast as described above. Clean, dry, and wait 24 h after the cure; note the age."

_MIXES = (
    "Mixed pieces are composites of two base resins in the 3MF, in volume fractions. No catalogue material has a known "
    "fraction: do not choose one in their place. Where the machine's program takes no composites, print them droplet "
    "by droplet from voxel slices of the same fractions."
)
"""Instruction for mixes on a machine that takes only catalogue materials."""


def sheet(order: CouponOrder, trays: Mapping[str, tuple[CouponPiece, ...]]) -> str:
    """Print-and-measure sheet as Markdown."""
    parts = [
        f"# Coupons: print and measure ({order.name})",
        "Print, measure, write the readings into `results.toml`, then run `pneutouch coupons --results FILE`, with the "
        "path of that file, in the folder from which you use pneutouch: it writes profiles of your own machine and "
        "resins, which come before the shipped ones.",
        "Lab: ______________________  Date: ______________  Room: _____ °C  Printed on: ______________",
        "## Print",
    ]
    for name, pieces in trays.items():
        parts += _printing(name, pieces, order)
    parts.append("## Measure")
    for coupon in dict.fromkeys(item.coupon for item in order.items):
        parts += _measuring(coupon, [item for item in order.items if item.coupon is coupon])
    return "\n\n".join(parts) + "\n"


def _printing(name: str, pieces: tuple[CouponPiece, ...], order: CouponOrder) -> list[str]:
    printer = pieces[0].item.printer
    mode = job_mode(name, tuple(piece.item for piece in pieces))
    rows = [
        f"| {piece.body.name} | {len(piece.places)} | stl/{stl_name(piece, order)} | {piece.solid.material.label} | "
        f"{' x '.join(f'{length:.1f}' for length in piece.size)} | {piece.solid.mass:.2f} g | {_places(piece)} |"
        for piece in pieces
    ]
    head = "| piece | copies | file | material | size, mm | mass each | middle of each on the tray, mm |"
    mixes = [_MIXES] if any(piece.item.blend is not None for piece in pieces) else []
    return [
        f"### {printer.title} (`{name}`)",
        f"`{order.name if name == order.profile else name}.3mf`: all copies in place, one material an object; mode "
        f"{mode.label}. **Choose the material of each object by hand**; pieces of one shape differ by their place on "
        "the tray alone, so bag and label them as they come off.",
        "\n".join([head, "|---|---|---|---|---|---|---|", *rows]),
        *mixes,
        *_casting([piece.item for piece in pieces if piece.item.mould is not None]),
        f"Support: {printer.support}. Do not turn the pieces.",
    ]


def _casting(items: list[CouponItem]) -> list[str]:
    """Steps to cast the coupons in the printed moulds, with the silicone to weigh; none without moulds."""
    if not items:
        return []
    lines = ["The pieces above are open moulds; cast the coupons in them before you measure:"]
    for item in items:
        casting = item.material.casting
        assert casting is not None
        mass_g = CAST_EXCESS * item.copies * sum(solid.mass for solid in item.coupon.draw(item.context))
        parts = " + ".join(f"{part:.1f} g" for part in casting.masses_g(mass_g))
        lines.append(
            f"- {item.coupon.title}, {item.about}: mix {mass_g:.1f} g ({parts}) for {item.copies}, degas, pour until "
            "it stands above the top, strike it off along the top with a straight edge, cure "
            f"{casting.cure_h.text()} h, peel it out. Release: {casting.release}."
        )
    return ["\n".join(lines)]


def stl_name(piece: CouponPiece, order: CouponOrder) -> str:
    """Name of a piece's STL file; it begins with the machine's name if that is not the order's printer."""
    item = piece.item
    return (
        f"{piece.body.name}.stl" if item.printer_name == order.profile else f"{item.printer_name}-{piece.body.name}.stl"
    )


def _places(piece: CouponPiece) -> str:
    wide, deep, _ = piece.size
    return ", ".join(f"({x + 0.5 * wide:.0f}, {y + 0.5 * deep:.0f})" for x, y in piece.places)


def _measuring(coupon: Coupon, items: list[CouponItem]) -> list[str]:
    # The first step of a coupon is how it is printed.
    listed = (_CAST, *coupon.steps[1:]) if items[0].mould is not None else coupon.steps
    steps = "\n".join(f"{k}. {step}" for k, step in enumerate(listed, start=1))
    parts = [f"### {coupon.title[0].upper()}{coupon.title[1:]}", steps]
    for item in items:
        on = f" on {item.printer_name}" if coupon.belongs == "printer" else ""
        parts += [f"**{item.about}**{on}", "\n".join(_table(item))]
    return [*parts, "Formulas:", "\n".join(f"- {formula}" for formula in coupon.formulas)]


def _table(item: CouponItem) -> list[str]:
    """Table to fill in: a line for each feature and copy, or for each size of a feature with many sizes."""
    nominals = item.nominals
    if len({nominal.feature for nominal in nominals}) < len(nominals):
        return _sizes(nominals)
    cells = min(_CELLS, max(nominal.readings for nominal in nominals))
    copies = range(1, item.copies + 1)
    rows = [
        "| copy | feature | nominal | instrument |" + "".join(f" {k} |" for k in range(1, cells + 1)),
        "|" + "---|" * (cells + 4),
    ]
    for copy in copies:
        for nominal in nominals:
            for start in range(0, nominal.readings, cells):
                free = min(cells, nominal.readings - start)
                blank = "".join(["     |"] * free + [" – |"] * (cells - free))
                rows.append(f"| {copy} | {nominal.feature} | {_drawn(nominal)} | {nominal.instrument} |{blank}")
    return rows


def _sizes(nominals: tuple[Nominal, ...]) -> list[str]:
    """Table to fill in for features with many sizes, below their instruments."""
    instruments = {nominal.feature: nominal.instrument for nominal in nominals}
    instruments_of = [f"- {feature}: {instrument}" for feature, instrument in instruments.items()]
    most = max(nominal.readings for nominal in nominals)
    rows = [
        "| feature | nominal |" + "".join(f" {k} |" for k in range(1, most + 1)) + " came out |",
        "|" + "---|" * (most + 3),
    ]
    rows += [f"| {nominal.feature} | {_drawn(nominal)} |" + "     |" * (most + 1) for nominal in nominals]
    return [*instruments_of, "", *rows]


def _drawn(nominal: Nominal) -> str:
    return nominal.unit if nominal.value is None else f"{nominal.value:.4g} {nominal.unit}"


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
