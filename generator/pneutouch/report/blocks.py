"""The blocks that a sheet is made of: built once, and set as a page and as a PDF by one template each."""

from __future__ import annotations

import datetime
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import TypeVar

Row = Sequence["str | Cell"]

_SHORT, _SENTENCE = 22, 40
"""Letters up to which a cell is never broken, and above which it is a sentence."""


@dataclass(frozen=True)
class Cell:
    """A cell with a small second line, or in bold."""

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
    """A heading of level 2 (a section) or 3; level 1 begins a part of the sheet, on a page of its own."""

    text: str
    level: int = 2


@dataclass(frozen=True)
class Text:
    """A paragraph; ``look``: ``muted``, ``strong``, ``status`` or ``warning`` (in a frame)."""

    text: str
    look: str = ""


@dataclass(frozen=True)
class Items:
    """A list, numbered or not."""

    lines: Sequence[str]
    numbered: bool = False


@dataclass(frozen=True)
class SheetTable:
    """A table; one without a head states facts: what, value, unit, and a longer last cell.

    Attributes:
        rows: Cells; a table without rows is left out.
        head: Names of the columns; ``\\n`` ends a line.
        numeric: Columns that stand on the right.
        strong: Rows in bold.
        turned: True for few rows that become columns on a narrow screen.
        small: True for a table that stays one on a narrow screen.
        merged: Number of first columns of which cells equal to those above are not repeated.
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
        """Names of the columns in one line each, the unit behind a comma."""
        units = [name.rpartition("\n") for name in self.head]
        return [", ".join(filter(None, (name.replace("\n", " ").rstrip(","), unit))) for name, _, unit in units]

    @property
    def lengths(self) -> list[int]:
        """Letters of the longest line of each column."""
        columns = zip(*([self.head] if self.head else []), *self.rows, strict=True)
        return [max(map(_letters, column)) for column in columns]

    @property
    def weights(self) -> list[int]:
        """Share of each column in the free width; 0 for a column that is as wide as its cells.

        Beside sentences short columns are narrow; without them all columns but those of numbers share it.
        """
        lengths = [0 if k in self.numeric else length for k, length in enumerate(self.lengths)]
        if self.head and 0 < max(lengths) <= _SENTENCE:
            return lengths
        weights = [0 if length <= _SHORT else round(10 * length**0.5) for length in lengths]
        return weights if any(weights) else [*weights[:-1], 1]

    @property
    def long(self) -> list[int]:
        """Columns of sentences."""
        return [k for k, length in enumerate(self.lengths) if length > _SENTENCE]

    @property
    def groups(self) -> list[list[Row]]:
        """Rows with the same first cells, those that are merged, together."""
        return [list(rows) for _, rows in groupby(self.rows, lambda row: tuple(map(str, row[: self.merged])))]


@dataclass(frozen=True)
class Plot:
    """A figure as SVG with its caption; ``full`` over the whole row, ``mm`` its greatest width."""

    svg: str
    caption: str = ""
    title: str = ""
    full: bool = False
    mm: float = 0.0


@dataclass(frozen=True)
class Plots:
    """Figures in columns, of relative ``widths``, over one caption."""

    plots: Sequence[Plot]
    widths: Sequence[int] = (1, 1)
    caption: str = ""


@dataclass(frozen=True)
class View:
    """A body in three dimensions: data (JSON) that a page turns, and the picture (PNG) where nothing turns."""

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
    """Blocks side by side on one page, each column of a share of the width."""

    columns: Sequence[Sequence[SheetBlock]]
    widths: Sequence[int] = (1, 1)


@dataclass(frozen=True)
class FramedBlocks:
    """Blocks in a frame under a title, where there is one: what the reader has to see first."""

    title: str
    blocks: Sequence[SheetBlock]


SheetBlock = Heading | Text | Items | SheetTable | Plot | Plots | View | Tiles | Columns | FramedBlocks


@dataclass(frozen=True)
class Sheet:
    """A sheet.

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
        date: Date of the PDF; None for none.
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
    """A heading and its blocks; nothing where none of them holds anything."""
    held = [block for block in blocks if _holds(block)]
    return [Heading(title, level), *held] if held else []


def _holds(block: SheetBlock) -> bool:
    match block:
        case SheetTable():
            return bool(block.rows)
        case Items():
            return bool(block.lines)
        case Plots():
            return bool(block.plots)
        case Tiles():
            return bool(block.tiles)
        case Text():
            return bool(block.text)
        case _:
            return True


Kind = TypeVar("Kind")


def found(blocks: Sequence[SheetBlock], kind: type[Kind]) -> list[Kind]:
    """Every block of a kind, those within columns and boxes too, in their order."""
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
