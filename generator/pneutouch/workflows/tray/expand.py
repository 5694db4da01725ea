"""A tray's entries as designs, one a value, and the bodies of each that the tray's printer prints."""

from dataclasses import dataclass
from typing import Any

from pneutouch.body import Solid
from pneutouch.catalogue import Library, load_scene
from pneutouch.errors import InputError, shown
from pneutouch.parts import Assembly, assemble
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer
from pneutouch.spec.tray import Entry, EntryValue
from pneutouch.workflows.tray.order import TrayOrder

LETTERS = "ABCDEFGHJKLMNPQRSTUVWXYZ"
"""Without I and O, which read as 1 and 0."""

MOST_PARTS = 2000
"""More bodies than this are a mistake: a tray holds some hundred."""


@dataclass(frozen=True)
class TrayVariant:
    """One design of a tray. ``index`` counts from 1, ``letter`` is it in letters; ``key`` and ``value`` vary."""

    index: int
    letter: str
    design: str
    key: str | None
    value: EntryValue | None
    copies: int
    assembly: Assembly


@dataclass(frozen=True)
class TrayPiece:
    """Part of a value that is printed as one: a body, or the bodies of an assembly grown in one print."""

    value: TrayVariant
    solids: tuple[Solid, ...]

    @property
    def materials(self) -> tuple[Material, ...]:
        """Materials of the bodies."""
        return tuple(solid.material for solid in self.solids)


@dataclass(frozen=True)
class ExpandedTray:
    """All pieces of a tray for its printer, and notes on the parts left out."""

    printer: Printer
    profile: str
    pieces: tuple[TrayPiece, ...]
    left_out: tuple[str, ...]


def expand(order: TrayOrder, library: Library | None = None) -> ExpandedTray:
    """Load and draw every design of a tray, without prediction. Raises InputError if one is wrong or none left."""
    library = library or Library.default()
    values = [value for entry in order.tray.entry for value in _values(order, entry, library)]
    values = [
        TrayVariant(**{**vars(value), "index": k, "letter": letter(k)}) for k, value in enumerate(values, start=1)
    ]
    profile = order.tray.tray.profile or values[0].assembly.scene.design.print.profile
    printer = library.load("printers", profile, file=order.where, key="tray.profile")
    pieces: list[TrayPiece] = []
    notes: list[str] = []
    for value in values:
        printed, others = _pieces(value, printer, order)
        pieces += printed
        notes += others
    left_out = tuple(dict.fromkeys(notes))
    if not pieces:
        raise InputError(
            f"nothing is left for the {printer.title}: {'; '.join(left_out) or 'no design has such a body'}",
            file=order.where,
            remedy=f"give another tray.profile or tray.bodies, or set print.profile to {shown(profile)}",
        )
    if sum(len(piece.solids) * piece.value.copies for piece in pieces) > MOST_PARTS:
        raise InputError(f"more than {MOST_PARTS} bodies", file=order.where, remedy="take fewer copies")
    return ExpandedTray(printer, profile, tuple(pieces), left_out)


def letter(index: int) -> str:
    """The letters of a value: A to Z without I and O, then AA, AB ..."""
    text = ""
    while index > 0:
        index, digit = divmod(index - 1, len(LETTERS))
        text = LETTERS[digit] + text
    return text


def _values(order: TrayOrder, entry: Entry, library: Library) -> list[TrayVariant]:
    key = next(iter(entry.over), None)
    variants = []
    for value in entry.over[key] if key is not None else [None]:
        settings = {**entry.set, **({key: value} if key is not None and value is not None else {})}
        assembly = _assembly(order, entry, settings, library)
        variants.append(TrayVariant(0, "", entry.design, key, value, entry.copies, assembly))
    return variants


def _assembly(order: TrayOrder, entry: Entry, settings: dict[str, Any], library: Library) -> Assembly:
    try:
        return assemble(load_scene(order.design(entry.design), {**settings, **order.overrides}, library))
    except InputError as error:
        raise InputError(f"entry {shown(entry.design)}: {error}", file=order.where) from None


def _pieces(value: TrayVariant, printer: Printer, order: TrayOrder) -> tuple[list[TrayPiece], list[str]]:
    """The pieces of a value by print job, and notes on the parts left out."""
    assembly, bodies = value.assembly, order.tray.tray.bodies
    groups: dict[str, list[Solid]] = {}
    for solid in assembly.solids:
        groups.setdefault(assembly.job(solid.name), []).append(solid)
    pieces, notes = [], []
    for solids in groups.values():
        names = [solid.name for solid in solids]
        listed = [name for name in names if bodies is None or name in bodies]
        machine, _ = assembly.machine(names[0])
        if not listed:
            continue
        if machine != printer:
            notes.append(f"{' and '.join(names)} of {value.design}: for the {machine.title}")
            continue
        if listed != names:
            notes.append(f"{' and '.join(names)} of {value.design} grow in one print: all of it is on the tray")
        pieces.append(TrayPiece(value, tuple(solids)))
    return pieces, notes
