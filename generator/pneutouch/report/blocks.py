"""The blocks of which a sheet consists; one template writes them as an HTML page, another sets them as a PDF."""

import datetime
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import TypeVar

Row = Sequence["str | Cell"]

_SHORT, _SENTENCE = 22, 40
"""A cell of at most ``_SHORT`` letters is never broken into lines; one of more than ``_SENTENCE`` is a sentence."""


@dataclass(frozen=True)
class Cell:
    """A cell of a table: its text, a small second line ``note``, and True in ``strong`` for bold."""

    text: str
    note: str = ""
    strong: bool = False

    def __str__(self) -> str:
        return self.text


def _letters(cell: str | Cell) -> int:
    parts = (cell.text, cell.note) if isinstance(cell, Cell) else (cell,)
    return max(len(line) for part in parts for line in part.split("\n"))


@dataclass(frozen=True)
class Heading:
    """A heading: level 1 begins a part of the sheet, on a new page; 2 is a section, 3 a subsection."""

    text: str
    level: int = 2


@dataclass(frozen=True)
class Text:
    """A paragraph; ``look`` is ``muted``, ``strong``, ``status`` or ``warning`` (both in a frame), or empty: plain."""

    text: str
    look: str = ""


@dataclass(frozen=True)
class Items:
    """A list, numbered or not."""

    lines: Sequence[str]
    numbered: bool = False


@dataclass(frozen=True)
class SheetTable:
    """A table; in one without a head each row states a fact, such as name, value, unit and a longer note.

    Attributes:
        rows: Cells; a table without rows is left out.
        head: Names of the columns; ``\\n`` ends a line.
        numeric: Numbers of the columns that are aligned right.
        strong: Numbers of the rows in bold.
        turned: True if rows become columns on a narrow screen; done for fewer than six rows.
        small: True if the table keeps its form on a narrow screen, where others have a block for each row.
        merged: Number of leading columns; consecutive rows that are equal in all of them show their cells once.
        dense: True for small letters: many columns.
    """

    rows: Sequence[Row]
    head: Sequence[str] = ()
    numeric: Sequence[int] = ()
    strong: Sequence[int] = ()
    turned: bool = False
    small: bool = False
    merged: int = 0
    dense: bool = False

    @property
    def names(self) -> list[str]:
        """Names of the columns on one line each, with a comma before what was their last line, the unit."""
        units = [name.rpartition("\n") for name in self.head]
        return [", ".join(filter(None, (name.replace("\n", " ").rstrip(","), unit))) for name, _, unit in units]

    @property
    def lengths(self) -> list[int]:
        """Number of letters of the longest line in each column, its name included."""
        columns = zip(*([self.head] if self.head else []), *self.rows, strict=True)
        return [max(map(_letters, column)) for column in columns]

    @property
    def weights(self) -> list[int]:
        """Relative shares of the columns in the free width; 0 for a column that is as wide as its cells.

        With a head and no sentence all columns but numeric ones share it; else those with long cells, or the last one.
        """
        lengths = [0 if k in self.numeric else length for k, length in enumerate(self.lengths)]
        if self.head and 0 < max(lengths) <= _SENTENCE:
            return lengths
        weights = [0 if length <= _SHORT else round(10 * length**0.5) for length in lengths]
        return weights if any(weights) else [*weights[:-1], 1]

    @property
    def long(self) -> list[int]:
        """Numbers of the columns that hold a sentence."""
        return [k for k, length in enumerate(self.lengths) if length > _SENTENCE]

    @property
    def groups(self) -> list[list[Row]]:
        """Lists of consecutive rows that are equal in their first ``merged`` cells; all rows if that is 0."""
        return [list(rows) for _, rows in groupby(self.rows, lambda row: tuple(map(str, row[: self.merged])))]


@dataclass(frozen=True)
class Plot:
    """An SVG figure with title and caption; ``full``: over the whole row, ``mm``: greatest width (0: no bound)."""

    svg: str
    caption: str = ""
    title: str = ""
    full: bool = False
    mm: float = 0.0


@dataclass(frozen=True)
class Plots:
    """Figures in columns of relative ``widths``, with one caption below all of them."""

    plots: Sequence[Plot]
    widths: Sequence[int] = (1, 1)
    caption: str = ""


@dataclass(frozen=True)
class View:
    """A 3D view: JSON ``data`` that a page turns, PNG ``image`` elsewhere, alternative text ``words``, a ``scale``."""

    name: str
    data: str
    image: bytes
    words: str
    caption: str = ""
    scale: str = ""


@dataclass(frozen=True)
class Tile:
    """A key figure: name, value, unit, condition."""

    name: str
    value: str
    unit: str
    condition: str


@dataclass(frozen=True)
class Tiles:
    """Key figures, three in a row."""

    tiles: Sequence[Tile]


@dataclass(frozen=True)
class Columns:
    """Columns of blocks side by side, kept together on one page, with relative ``widths``."""

    columns: "Sequence[Sequence[SheetBlock]]"
    widths: Sequence[int] = (1, 1)


@dataclass(frozen=True)
class FramedBlocks:
    """Blocks in a frame, for statements to be seen first; an empty ``title`` is left out."""

    title: str
    blocks: "Sequence[SheetBlock]"


SheetBlock = Heading | Text | Items | SheetTable | Plot | Plots | View | Tiles | Columns | FramedBlocks


@dataclass(frozen=True)
class Sheet:
    """A document, such as a datasheet, that is written as an HTML page and as a PDF.

    Attributes:
        title: Title of the sheet.
        subtitle: Kind of sheet.
        name: Title of the document: of the page's tab and of the PDF.
        facts: Names and values next to the title.
        tool: Program that made it.
        foot: Text at the foot of every page.
        mark: Words on every page, such as that the data are simulated; empty for none.
        mark_note: Words after the mark on the first page.
        blocks: Blocks of the sheet.
        date: Creation date in the PDF; None for the same fixed date in all undated sheets.
    """

    title: str
    subtitle: str
    name: str
    facts: Sequence[tuple[str, str]]
    tool: str
    foot: str
    blocks: Sequence[SheetBlock]
    mark: str = ""
    mark_note: str = ""
    date: datetime.date | None = None


def section(title: str, *blocks: SheetBlock, level: int = 2) -> list[SheetBlock]:
    """A heading and those of ``blocks`` that are not empty; an empty list if all are empty."""
    held = [block for block in blocks if _holds(block)]
    return [Heading(title, level), *held] if held else []


def _holds(block: SheetBlock) -> bool:
    match block:
        case SheetTable(held) | Items(held) | Plots(held) | Tiles(held) | Text(held):
            return bool(held)
        case _:
            return True


Kind = TypeVar("Kind")


def found(blocks: Sequence[SheetBlock], kind: type[Kind]) -> list[Kind]:
    """All blocks of class ``kind`` in order, with those inside columns and frames, and the plots of `Plots`."""
    every: list[Kind] = []
    for block in blocks:
        if isinstance(block, kind):
            every.append(block)
        match block:
            case Columns():
                every += [one for column in block.columns for one in found(column, kind)]
            case FramedBlocks():
                every += found(block.blocks, kind)
            case Plots() if kind is Plot:
                every += block.plots  # type: ignore[arg-type]
    return every
