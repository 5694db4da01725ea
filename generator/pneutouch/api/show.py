"""Text and pictures of objects in a notebook: at most ten lines of text, or a table with a picture."""

from collections.abc import Iterable, Sequence
from html import escape
from typing import Any

from pydantic import BaseModel

from pneutouch.catalogue.listing import listing
from pneutouch.parts import Assembly
from pneutouch.results.record import plain
from pneutouch.spec.fields import declarations

LINES, WIDTH, ROWS = 10, 110, 40
"""Greatest number of lines of a text, of letters in a line, and of rows of a table in a notebook."""


class Shown:
    """Base of objects that show themselves: a head, rows of cells, and in a notebook the section of an assembly."""

    _columns: Sequence[str] = ()

    def _head(self) -> str:
        raise NotImplementedError

    def _rows(self) -> list[Any]:
        raise NotImplementedError

    def _cells(self) -> list[Any]:
        """The rows in a notebook, which has space for more."""
        return self._rows()

    def _picture(self) -> Assembly | None:
        return None

    def __repr__(self) -> str:
        return text(self._head(), self._rows())

    def _repr_html_(self) -> str:
        return html(self._head(), self._cells(), self._columns, self._picture())


class Documented(Shown):
    """Base of objects that a command prints as JSON."""

    def _document(self) -> Any:
        """Record or tables of the document."""
        raise NotImplementedError

    def to_dict(self) -> dict[str, Any]:
        """The document that the command prints as JSON."""
        return dict(plain(self._document()))


def short(value: Any) -> str:
    """A value in a few letters: six digits of a number, the length of a long list."""
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, list | tuple) and len(value) > 8:
        return f"[{len(value)} entries]"
    if isinstance(value, list | tuple):
        return f"[{', '.join(short(item) for item in value)}]"
    return f"{{{', '.join(value)}}}" if isinstance(value, dict) else str(value)


def text(head: str, rows: Iterable[Sequence[Any]]) -> str:
    """Text of a head and one line for each row, cells two spaces apart; at most `LINES` lines of `WIDTH` letters."""
    cells = [[short(cell) for cell in row] for row in rows]
    cut = cells if len(cells) < LINES else cells[: LINES - 2]
    widths = [
        max((len(row[k]) for row in cut if k < len(row)), default=0) for k in range(max(map(len, cut), default=0))
    ]
    lines = [head, *("  " + "  ".join(cell.ljust(w) for cell, w in zip(row, widths, strict=False)) for row in cut)]
    if len(cut) < len(cells):
        lines.append(f"  ... and {len(cells) - len(cut)} more")
    return "\n".join(shorten(line.rstrip()) for line in lines)


def shorten(line: str) -> str:
    """A line of at most `WIDTH` letters."""
    return line if len(line) <= WIDTH else f"{line[: WIDTH - 3]}..."


def html(head: str, rows: Iterable[Sequence[Any]], columns: Sequence[str], picture: Assembly | None) -> str:
    """A table of ``rows`` under ``head``, with the section of an assembly, if one is given, above it."""
    from pneutouch.report.section import section_picture

    drawn = "" if picture is None else section_picture(picture)
    top = f"<tr>{''.join(f'<th>{escape(name)}</th>' for name in columns)}</tr>" if columns else ""
    cells = (f"<tr>{''.join(f'<td>{escape(short(cell))}</td>' for cell in row)}</tr>" for row in list(rows)[:ROWS])
    return f"<div><b>{escape(head)}</b>{drawn}<table>{top}{''.join(cells)}</table></div>"


def field_rows(file: BaseModel) -> list[tuple[str, Any, str]]:
    """Key, value and unit of every field of a file that has a value."""
    plain = [(name, value, "") for name, value in file if value is not None and not isinstance(value, BaseModel)]
    return plain + [
        (f"{table}.{entry.key}", getattr(content, entry.key), entry.unit)
        for table, content in file
        if isinstance(content, BaseModel)
        for entry in declarations(type(content))
        if getattr(content, entry.key) is not None
    ]


def table_rows(file: BaseModel) -> list[tuple[str, str]]:
    """A row for each table of a file: its name and its fields."""
    rows = field_rows(file)
    plain = [(key, short(value)) for key, value, _ in rows if "." not in key]
    return plain + [
        (name, ", ".join(f"{key.partition('.')[2]}={short(v)}" for key, v, _ in rows if key.startswith(f"{name}.")))
        for name, content in file
        if isinstance(content, BaseModel)
    ]


class Listing(Shown, dict[str, str]):
    """Titles by name, shown as a table in a notebook."""

    def _head(self) -> str:
        return f"{len(self)} names"

    def _rows(self) -> list[Any]:
        return list(self.items())


def designs() -> Listing:
    """Titles of the designs by name: the user's and the shipped ones."""
    return _listed("designs")


def materials() -> Listing:
    """Titles of the cured materials by name."""
    return _listed("materials")


def calibrations() -> Listing:
    """Titles of the calibrations by name, which ``design.replace(calibration=NAME)`` takes."""
    return _listed("calibrations")


def printers() -> Listing:
    """Titles of the printers by name."""
    return _listed("printers")


def gauges() -> Listing:
    """Titles of the pressure gauges by name, which ``design.replace(gauge=NAME)`` takes."""
    return _listed("gauges")


def _listed(kind: str) -> Listing:
    """Titles by name; for a file that cannot be read the error in place of the title."""
    listed = Listing()
    for entry in listing(kind)[kind]:
        listed[entry["name"]] = f"cannot be read: {entry['error']}" if "error" in entry else entry["title"]
    return listed
