"""Text tables, read in chunks of bytes that end at a line end, so that every row and every fault has its row number."""

import csv
import io
import itertools
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import InputError
from pneutouch.tables.layout import NUMBER, STAMP, RowChunk, TableLayout, blank, cells, places
from pneutouch.tables.locate import COMMENT, comment
from pneutouch.tables.text import LONGEST_LINE, TOO_LONG, TextBytes

_MARKS = tuple(mark.encode() for mark in COMMENT)
_DAY = 86400.0
_ROWS = 1000
"""Rows that are written at once."""

CHUNK = 4 * 2**20
"""Bytes parsed at once: about 100 000 rows; larger chunks are not faster and take more memory."""


class _Reader(NamedTuple):
    """A text table with its columns located; ``least`` and ``most`` are the numbers of cells of a row.

    ``stamps`` are the indices of columns with dates and times; by such an index ``begin`` has the column's first time,
    s, and ``latest`` its latest time of day, its date as written, and the number of midnights before it."""

    path: Path
    delimiter: str
    decimal: str
    least: int
    most: int
    names: Sequence[str]
    places: list[int]
    stamps: tuple[int, ...]
    begin: dict[int, float]
    latest: dict[int, tuple[float, str, int]]

    def fault(self, row: int, problem: str, remedy: str | None = None) -> InputError:
        return InputError(problem, file=self.path, key=f"row {row}", remedy=remedy)

    def number(self, text: str) -> float | None:
        if not NUMBER[self.decimal].fullmatch(text):
            return None
        return float(text.replace(",", "."))

    def value(self, text: str, place: int) -> float | None:
        """Number in a cell, or for a date and time the seconds since the column's first; None for other texts."""
        if place not in self.stamps:
            return self.number(text)
        try:
            return float(self.seconds([text], place)[0]) if STAMP.fullmatch(text) else None
        except ValueError:
            return None

    def seconds(self, texts: Sequence[str], place: int) -> Array:
        """Seconds since the first cell of a column of dates and times. Raises ValueError for other texts.

        A time of day that falls by more than half a day, or another date before it, has passed midnight; so the order
        of day and month does not matter."""
        import pandas as pd

        written = pd.Series(texts).str.replace(",", ".")
        if texts[0][4:5] == "-":
            stamps = pd.to_datetime(written, format="ISO8601", utc=True)
            passed = stamps.astype("datetime64[ns, UTC]").astype("int64").to_numpy() * 1e-9
        else:
            # The conversion takes 61 minutes as an hour and a minute.
            if not written.str.fullmatch(STAMP).all():
                raise ValueError("no times of day")
            read = written.str.extract(STAMP).fillna("")
            clock = read["clock"].str.replace(r"(:\d+:\d+):", r"\1.", regex=True) + read["minutes"]
            clock = clock.where(read["minutes"] == "", clock + ":00")
            passed, half = pd.to_timedelta(clock).dt.total_seconds().to_numpy(), read["half"].str.upper()
            passed = np.where(half == "", passed, passed % (0.5 * _DAY) + 0.5 * _DAY * (half == "P"))
            dates = read["date"] + read["day"]
            last, date, days = self.latest.get(place, (float(passed[0]), dates.iloc[0], 0))
            other = dates.to_numpy() != dates.shift(fill_value=date).to_numpy()
            midnights = days + np.cumsum(other if date else np.diff(passed, prepend=last) < -0.5 * _DAY)
            self.latest[place] = float(passed[-1]), dates.iloc[-1], int(midnights[-1])
            passed = passed + _DAY * midnights
        return np.asarray(passed - self.begin.setdefault(place, float(passed[0])))


def csv_chunks(path: Path, names: Sequence[str], layout: TableLayout) -> Iterator[RowChunk]:
    """Chunks of a text file; see `read.chunks`.

    Empty lines and comments are skipped but counted. A complete last row without a line end is returned as
    `RowChunk.last`, because its last number may be cut."""
    how = layout.format
    reader = _Reader(
        path,
        how.delimiter or ",",
        how.decimal or ".",
        layout.least or len(layout.names),
        len(layout.names),
        names,
        places(path, layout, names),
        layout.stamps,
        {},
        {},
    )
    size = path.stat().st_size
    with path.open("rb") as file:
        stream = TextBytes(path, file, how.encoding or "utf-8")
        data, row = _after(stream, layout.first_row - 1), layout.first_row
        while data:
            end = data.rfind(b"\n") + 1
            whole, rest = data[:end], data[end:]
            if len(rest) > LONGEST_LINE:
                raise reader.fault(row, TOO_LONG)
            if whole:
                rows, values, lines = _parse(whole, row, reader)
                row += lines
                left = (size - stream.consumed) * stream.given / stream.consumed + len(rest)
                share, total = 1 - left / stream.given if left else 1.0, row - layout.first_row
                yield RowChunk(rows, values, min(max(share, 0.0), 1.0), round(total + left * lines / len(whole)))
            more = stream.read(CHUNK)
            if not more:
                break
            data = rest + more
        if data and rest.strip() and not comment(rest.decode("utf-8", "replace")):
            last, total = _last(rest, row, reader), row - layout.first_row + 1
            yield RowChunk(np.empty(0), np.empty((len(names), 0)), 1.0, total, last, row)


def _after(stream: TextBytes, lines: int) -> bytes:
    """First bytes after a number of lines; empty if the file ends before that."""
    data = stream.read(CHUNK)
    while data:
        at = -1
        while lines and (at := data.find(b"\n", at + 1)) >= 0:
            lines -= 1
            if not lines:
                data = data[at + 1 :]
        if not lines:
            return data or stream.read(CHUNK)
        data = stream.read(CHUNK)
    return b""


def _check_text(data: bytes, row: int, reader: _Reader) -> None:
    """Raise InputError for bytes that are not UTF-8 or hold a zero byte; ``row`` is the number of their first line."""
    if b"\0" in data:
        at = row + data.count(b"\n", 0, data.index(b"\0"))
        raise reader.fault(at, "holds a zero byte: a binary file", "must be CSV text")
    try:
        data.decode("utf-8")
    except UnicodeDecodeError as error:
        at = row + data.count(b"\n", 0, error.start)
        problem = f"not UTF-8 text (byte 0x{data[error.start]:02x})"
        raise reader.fault(at, problem, 'state `encoding`, such as "cp1252"') from None


def _parse(data: bytes, row: int, reader: _Reader) -> tuple[Array, Array, int]:
    """Row numbers, values and number of lines, from whole lines that begin with ``row``.

    The default float conversion of pandas is used: of its three it is the fastest here, and its error is a few units in
    the last place of a double at most, far below any sensor's resolution.
    """
    import pandas as pd

    if not data.isascii() or b"\0" in data:
        _check_text(data, row, reader)
    lines, spaces = data.count(b"\n"), reader.delimiter == " "
    # The parser silently ignores superfluous fields, so they are counted here; comments have other numbers of them.
    uneven = (
        spaces
        or any(mark in data for mark in _MARKS)
        or data.count(reader.delimiter.encode()) not in (lines * (reader.most - 1), lines * (reader.least - 1))
    )
    kept = _check_widths(data, row, reader) if uneven or b'"' in data or reader.most == 1 else None
    rows = row + (np.arange(lines, dtype=float) if kept is None else kept)
    table = data
    if kept is not None and kept.size < lines:
        each = data.split(b"\n")
        table = b"".join(each[int(k)] + b"\n" for k in kept)
    if not rows.size:
        return rows, np.empty((len(reader.places), 0)), lines
    try:
        frame = pd.read_csv(
            io.BytesIO(table),
            sep=r"\s+" if spaces else reader.delimiter,
            decimal=reader.decimal,
            header=None,
            # A column of remarks that rows omit does not exist for the parser.
            names=list(range(max(reader.least, max(reader.places) + 1))),
            index_col=False,
            usecols=reader.places,
            dtype={place: "str" if place in reader.stamps else "float64" for place in reader.places},
            engine="c",
        )
        values = np.stack(
            [
                reader.seconds(frame[place].tolist(), place) if place in reader.stamps else frame[place].to_numpy()
                for place in reader.places
            ]
        )
    except (ValueError, pd.errors.ParserError):
        values = np.full((len(reader.places), rows.size), np.nan)
    if values.shape[1] != rows.size or not np.isfinite(values).all():
        _raise_fault(data, row, reader)
    return rows, values, lines


def _check_widths(data: bytes, row: int, reader: _Reader) -> Array:
    """Indices (n,) of the lines that are neither empty nor comments. Raises InputError for too few or too many
    fields."""
    kept = []
    # Only line feeds end rows: the other line ends of Unicode belong to the cell.
    for k, line in enumerate(data.decode("utf-8").split("\n")[:-1]):
        if blank(line, reader.delimiter) or comment(line):
            continue
        if "\r" in line.rstrip("\r"):
            raise reader.fault(row + k, "a carriage return within it", "rows must end in line feeds")
        _check_width(cells(line, reader.delimiter), row + k, reader)
        kept.append(k)
    return np.array(kept, float)


def _check_width(in_row: Sequence[str], row: int, reader: _Reader) -> None:
    if reader.least <= len(in_row) <= reader.most:
        return
    first = next((cell for cell in in_row if cell), "")
    if reader.number(first) is None:
        raise reader.fault(
            row,
            f"'{first[:40]}' where numbers were read before",
            "a footer, or a second recording? must be one recording, and end with its numbers",
        )
    comma = len(in_row) > reader.most and reader.delimiter == ","
    point = " Decimals must have a point between commas." if comma else ""
    raise reader.fault(row, f"{len(in_row)} fields; the header has {reader.most}.{point}")


def _raise_fault(data: bytes, row: int, reader: _Reader) -> None:
    """Raise InputError for the first cell that is not a finite number; ``row`` is the number of the first line."""
    lines = data.decode("utf-8").split("\n")[:-1]
    mark = "decimal point" if reader.decimal == "." else "decimal comma"
    for k, line in enumerate(lines):
        if blank(line, reader.delimiter) or comment(line):
            continue
        in_row = cells(line, reader.delimiter)
        for name, place in zip(reader.names, reader.places, strict=True):
            text = in_row[place] if place < len(in_row) else ""
            number = reader.value(text, place)
            if number is None or not np.isfinite(number):
                problem = f"column {name}: '{text[:40]}' is no finite number" if text else f"column {name}: empty"
                must = f"must be a number with a {mark}, without marks of thousands"
                left_out = "; a recording may miss some rows: delete those without a reading, or begin them with #"
                raise reader.fault(row + k, problem, must + (left_out if text.lower() in ("", "nan") else ""))
    raise InputError(f"rows {row} to {row + len(lines) - 1}: cannot be read as columns of numbers", file=reader.path)


def _last(rest: bytes, row: int, reader: _Reader) -> Array:
    """Values (k, 1) of a last row without a line end. Raises InputError if the row is incomplete."""
    _check_text(rest, row, reader)
    text = rest.decode("utf-8")
    in_row = cells(text, reader.delimiter)
    numbers = [reader.value(in_row[place], place) if place < len(in_row) else None for place in reader.places]
    if len(in_row) < reader.least or None in numbers:
        problem = f"the file ends within this row, '{text.strip()[:60]}'; it is cut off"
        raise reader.fault(row, f"{problem}: copy it again, or delete its last row")
    _check_width(in_row, row, reader)
    values = np.array([[number] for number in numbers], float)
    if not np.isfinite(values).all():
        _raise_fault(rest + b"\n", row, reader)
    return values


_FORMULA = ("=", "+", "-", "@", "\t", "\r", "\n", "＝", "＋", "－", "＠")


def safe_cell(value: object) -> object:
    """Cell for a CSV file: text that a spreadsheet would run as a formula gets an apostrophe in front.

    Numbers are unchanged, also those given as text: ``-0.25`` is not a formula.
    """
    if not isinstance(value, str) or not value.lstrip(" ").startswith(_FORMULA):
        return value
    try:
        float(value)
    except ValueError:
        return f"'{value}"
    return value


def csv_bytes(head: Sequence[str], rows: Iterable[Sequence[object]]) -> bytes:
    """Table as a CSV file in UTF-8: a header row and ``rows``, every cell made safe by `safe_cell`."""
    return b"".join(csv_pieces(head, rows))


def csv_pieces(head: Sequence[str], rows: Iterable[Sequence[object]]) -> Iterator[bytes]:
    """`csv_bytes` piece by piece, for tables of any length."""
    text, every = io.StringIO(newline=""), itertools.chain([head], rows)
    writer = csv.writer(text, lineterminator="\n")
    while some := list(itertools.islice(every, _ROWS)):
        writer.writerows([safe_cell(cell) for cell in row] for row in some)
        yield text.getvalue().encode()
        text.seek(text.truncate(0))


def columns_csv(columns: Mapping[str, Array]) -> bytes:
    """Columns (n,) by name as a CSV file: numbers to nine digits and nine decimals."""
    # Zeros that are rounding have one form.
    table = np.round(np.stack(list(columns.values()), axis=1), 9) + 0.0
    text = io.StringIO()
    np.savetxt(text, table, fmt="%.9g", delimiter=",", header=",".join(columns), comments="")
    return text.getvalue().encode()
