"""Order of a tray, from a file or from flags: its designs, the bodies that the printer prints, and their jobs."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise, permutations
from pathlib import Path
from typing import Any

from pneutouch.arrays import grouped
from pneutouch.body import Solid
from pneutouch.catalogue import Library, load_scene
from pneutouch.errors import InputError, shown
from pneutouch.parts import Assembly, assemble
from pneutouch.spec.files import design_inside, is_file
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer
from pneutouch.spec.read import Changes, read_toml, validate
from pneutouch.spec.tray import LEAST_COPIES, MOST_COPIES, EntryValue, Tray, parse_over
from pneutouch.spec.values import file_name, name_of


@dataclass(frozen=True)
class TrayOrder:
    """A tray with the name of its output, its file or flags for messages, overrides of all entries, and its folder."""

    name: str
    where: str
    tray: Tray
    overrides: Changes = field(default_factory=dict)
    folder: Path | None = None

    def design(self, name: str) -> str:
        """Design as the catalogue takes it; a path in a tray file is relative to that file's folder."""
        return name if self.folder is None else design_inside(self.folder, name, file=self.where, key="entry.design")


def is_tray_file(path: Path) -> bool:
    """True for a TOML file with a table of a tray; False for a design or a missing file."""
    return path.suffix == ".toml" and is_file(path) and not {"tray", "entry"}.isdisjoint(read_toml(path))


def order_of_file(path: Path, overrides: Changes | None = None, **head: Any) -> TrayOrder:
    """Order from a tray file; ``head`` (profile, marks) overrides its [tray]. Raises InputError naming file and key."""
    content = read_toml(path)
    given = {key: value for key, value in head.items() if value is not None}
    if given:
        table = content.setdefault("tray", {})
        if isinstance(table, dict):
            table.update(given)
    return TrayOrder(name_of(path), str(path), validate(Tray, content, str(path)), overrides or {}, path.parent)


def order_of_flags(
    designs: Sequence[str], over: Sequence[str] = (), copies: int = 1, overrides: Changes | None = None, **head: Any
) -> TrayOrder:
    """Order with an entry a design, varied over ``table.key=VALUES``. Raises InputError naming the parameter."""
    if not LEAST_COPIES <= copies <= MOST_COPIES:
        raise InputError(f"must be from {LEAST_COPIES} to {MOST_COPIES}", key="copies", value=copies)
    varied = parse_over(over)
    entries = [{"design": design, "copies": copies, "over": varied} for design in designs]
    stem = file_name(Path(designs[0]).stem)
    title = f"{stem}, {copies} of each" if len(designs) == 1 else f"{len(designs)} designs, {copies} of each"
    content = {"tray": {"title": title, **{k: v for k, v in head.items() if v is not None}}, "entry": entries}
    return TrayOrder(f"{stem}-tray", "the command line", validate(Tray, content, "the command line"), overrides or {})


LETTERS = "ABCDEFGHJKLMNPQRSTUVWXYZ"
"""Letters of the variants, without I and O, which read as 1 and 0."""

MOST_PARTS = 2000
"""Greatest number of bodies of a tray: one holds some hundred, so more are a mistake."""


@dataclass(frozen=True)
class TrayVariant:
    """One design of a tray: its number ``index`` from 1, as ``letter`` too; the varied ``key`` and value, or None."""

    index: int
    letter: str
    design: str
    key: str | None
    value: EntryValue | None
    copies: int
    assembly: Assembly


@dataclass(frozen=True)
class TrayPiece:
    """Part of a variant that is printed as one: a body, or the bodies of an assembly that grow in one print."""

    value: TrayVariant
    solids: tuple[Solid, ...]

    @property
    def materials(self) -> tuple[Material, ...]:
        """Materials of the bodies."""
        return tuple(solid.material for solid in self.solids)


@dataclass(frozen=True)
class ExpandedTray:
    """All pieces that a printer prints of a tray, and notes on the parts left out."""

    printer: Printer
    profile: str
    pieces: tuple[TrayPiece, ...]
    left_out: tuple[str, ...]


def expand(order: TrayOrder, library: Library | None = None) -> ExpandedTray:
    """Load and draw every design of a tray, without prediction. Raises InputError if one is wrong or none is left."""
    library = library or Library.default()
    values = _variants(order, library)
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
    """Number of a variant as letters: A to Z without I and O, then AA, AB ..."""
    text = ""
    while index > 0:
        index, digit = divmod(index - 1, len(LETTERS))
        text = LETTERS[digit] + text
    return text


def _variants(order: TrayOrder, library: Library) -> list[TrayVariant]:
    variants: list[TrayVariant] = []
    for entry in order.tray.entry:
        key = next(iter(entry.over), None)
        for value in entry.over[key] if key is not None else [None]:
            settings = {**entry.set, **({key: value} if key is not None and value is not None else {})}
            try:
                scene = load_scene(order.design(entry.design), {**settings, **order.overrides}, library)
                about = entry.design, key, value, entry.copies, assemble(scene)
            except InputError as error:
                raise InputError(f"entry {shown(entry.design)}: {error}", file=order.where) from None
            variants.append(TrayVariant(len(variants) + 1, letter(len(variants) + 1), *about))
    return variants


def _pieces(value: TrayVariant, printer: Printer, order: TrayOrder) -> tuple[list[TrayPiece], list[str]]:
    """Pieces of a variant that the printer prints, one a job, and notes on the parts left out."""
    assembly, bodies = value.assembly, order.tray.tray.bodies
    groups = grouped((assembly.job(solid.name), solid) for solid in assembly.solids)
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


_EXACT = 7
"""Number of different sets of resins up to which the fewest jobs and the best order are found by trying all."""


def jobs(materials: Sequence[tuple[Material, ...]], printer: Printer, where: str = "tray") -> list[list[int]]:
    """Indices by job of ``materials``, those of one part each: fewest jobs, then fewest resins to load.

    The base resins of a job must be in the printer at once, in one mode (`Printer.mode_for`). Raises InputError if a
    part cannot be printed at all.
    """
    kinds: dict[frozenset[str], list[int]] = {}
    for index, alone in enumerate(materials):
        kinds.setdefault(frozenset(resin for material in alone for resin in material.base_resins), []).append(index)
        if printer.mode_for(*alone) is None:
            labels = " and ".join(dict.fromkeys(material.label for material in alone))
            raise InputError(f"the {printer.title} cannot print {labels} in one job", file=where)
    examples = [
        list({tuple(m.base_resins): m for i in indices for m in materials[i]}.values()) for indices in kinds.values()
    ]
    sets, indices = list(kinds), list(kinds.values())

    def fits(group: list[int]) -> bool:
        return printer.mode_for(*(m for k in group for m in examples[k])) is not None

    def load(group: list[int]) -> frozenset[str]:
        return frozenset[str]().union(*(sets[k] for k in group))

    orders = [_ordered(groups, list(map(load, groups))) for groups in _fewest(len(kinds), fits)]
    best = min(orders, key=lambda groups: changes(list(map(load, groups))))
    return [sorted(i for k in group for i in indices[k]) for group in best]


def changes(loads: Sequence[frozenset[str]]) -> int:
    """Number of resins that are loaded between jobs; those of the first job are not counted."""
    return sum(len(after - before) for before, after in pairwise(loads))


def _fewest(count: int, fits: Callable[[list[int]], bool]) -> list[list[list[int]]]:
    """Partitions of ``range(count)`` into the fewest groups that fit; a single one, by first fit, beyond `_EXACT`."""
    if count > _EXACT:
        groups: list[list[int]] = []
        for k in range(count):
            home = next((group for group in groups if fits([*group, k])), None)
            if home is None:
                groups.append([k])
            else:
                home.append(k)
        return [groups]
    partitions = [groups for groups in _partitions(count) if all(map(fits, groups))]
    least = min(map(len, partitions))
    return [groups for groups in partitions if len(groups) == least]


def _partitions(count: int) -> Iterator[list[list[int]]]:
    if count == 0:
        yield []
        return
    for groups in _partitions(count - 1):
        for k in range(len(groups)):
            yield [*groups[:k], [*groups[k], count - 1], *groups[k + 1 :]]
        yield [*groups, [count - 1]]


def _ordered(groups: list[list[int]], loads: Sequence[frozenset[str]]) -> list[list[int]]:
    """Groups in the order with the fewest changes; beyond `_EXACT` by taking the nearest next one."""
    if len(loads) <= _EXACT:
        orders = permutations(range(len(loads)))
        best = min(orders, key=lambda order: (changes([loads[k] for k in order]), order))
        return [groups[k] for k in best]
    order, left = [0], list(range(1, len(loads)))
    while left:
        after = min(left, key=lambda k: (len(loads[k] - loads[order[-1]]), k))
        order.append(after)
        left.remove(after)
    return [groups[k] for k in order]
