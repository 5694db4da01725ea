"""The print-and-measure sheet: pieces and settings of the print, quantities and instruments, cells to fill,
formulas."""

from collections.abc import Mapping

from pneutouch.parts.coupons import Coupon, Nominal
from pneutouch.workflows.coupons.lay import CouponPiece, job_mode
from pneutouch.workflows.coupons.order import CouponItem, CouponOrder

_CELLS = 5
"""Readings on one line."""

CAST_EXCESS = 1.3
"""Silicone mixed over that of the coupons: the part struck off and the part that stays in the cup; our choice."""

_CAST = "Cast as described above. Clean, dry, and wait 24 h after the cure; note the age."

_MIXES = (
    "Mixed pieces are composites of two base resins in the 3MF, in volume fractions. No catalogue material has a known "
    "fraction: do not choose one in their place. Where the machine's program takes no composites, print them droplet "
    "by "
    "droplet from voxel slices of the same fractions."
)
"""Instruction to get a mix from a machine that takes catalogue materials alone."""


def sheet(order: CouponOrder, trays: Mapping[str, tuple[CouponPiece, ...]]) -> str:
    """Markdown for the operator and the bench."""
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
        f"{mode.label}. **Choose the material of each object by hand**; pieces of one "
        "shape "
        "differ by their place on the tray alone, so bag and label them as they come off.",
        "\n".join([head, "|---|---|---|---|---|---|---|", *rows]),
        *mixes,
        *_casting([piece.item for piece in pieces if piece.item.mould is not None]),
        f"Support: {printer.support}. Do not turn the pieces.",
    ]


def _casting(items: list[CouponItem]) -> list[str]:
    """Steps to cast the coupons in the printed moulds, and the silicone to weigh."""
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
    """File of a piece; for another machine than the named one the machine is part of the name."""
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
    """Cells to fill: a line a feature and copy; where a feature has many sizes, a line a size."""
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
    """The sizes of each feature, and their instrument."""
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
