"""Text files of any encoding: detection of encoding and layout, first lines, and bytes in UTF-8."""

import codecs
import io
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import BinaryIO

from pneutouch.errors import InputError
from pneutouch.tables.layout import DECIMALS, NAMES, STAMP, TableFormat, TableLayout, blank, cells, undecided_comma
from pneutouch.tables.locate import (
    Located,
    comment,
    fewest,
    header_of,
    is_lvm,
    locate,
    lvm_layout,
    stated_format,
    width_of,
)

HEAD = 2**18
"""Number of bytes within which a table must begin: more than instruments write before it, a few thousand rows."""

LONGEST_LINE = 2**16
"""Greatest length of a line in bytes: some thousand cells."""

TOO_LONG = f"over {LONGEST_LINE} bytes without a line end; not a CSV file of numbers"

_MARKS = ((codecs.BOM_UTF8, "utf-8"), (codecs.BOM_UTF16_LE, "utf-16"), (codecs.BOM_UTF16_BE, "utf-16"))
_MANY = 0.3
"""Least share of zero bytes, all at even or all at odd places, that shows UTF-16 without a mark: ASCII has half."""

_CONTROL = frozenset(range(32)) - {9, 10, 11, 12, 13, 26, 27, 28, 29, 30, 31}
_UNDEFINED = frozenset({0x81, 0x8D, 0x8F, 0x90, 0x9D})
"""Bytes that are undefined in CP1252."""


class TextBytes(io.RawIOBase):
    """Bytes of a text file of any encoding, converted to UTF-8; a byte order mark is omitted.

    Raises InputError, naming the row, for bytes that the encoding does not allow."""

    def __init__(self, path: Path, stream: BinaryIO, encoding: str) -> None:
        self._path, self._stream, self._encoding = path, stream, encoding
        start = stream.read(3)
        skip = 3 if encoding == "utf-8" and start.startswith(codecs.BOM_UTF8) else 0
        stream.seek(skip)
        self._decoder = None if encoding == "utf-8" else codecs.getincrementaldecoder(encoding)()
        self._rows = 1
        self.consumed = skip
        """Bytes of the file read so far."""
        self.given = 0
        """Bytes in UTF-8 returned so far."""

    def read(self, size: int = -1) -> bytes:
        """The next bytes, from about ``size`` bytes of the file; empty at its end."""
        while data := self._stream.read(size):
            self.consumed += len(data)
            text = data if self._decoder is None else self._decoded(data, False)
            if text:
                self.given += len(text)
                return text
        text = b"" if self._decoder is None else self._decoded(b"", True)
        self.given += len(text)
        return text

    def _decoded(self, data: bytes, final: bool) -> bytes:
        assert self._decoder is not None
        try:
            text = self._decoder.decode(data, final).removeprefix("\ufeff" if self._rows == 1 else "")
            encoded = text.encode("utf-8")
        except UnicodeError:
            problem = f"not {self._encoding} text"
            raise InputError(problem, file=self._path, key=f"row {self._rows} or below", remedy="cut off?") from None
        self._rows += encoded.count(b"\n")
        return encoded


def encoding_of(path: Path, start: bytes) -> tuple[str, bool]:
    """Encoding of a file from its first bytes, and True if it is a guess: neither marked nor UTF-8.

    Raises InputError for zero bytes, and for control characters in text that is not UTF-8."""
    for mark, encoding in _MARKS:
        if start.startswith(mark):
            return encoding, False
    for offset, encoding in ((1, "utf-16-le"), (0, "utf-16-be")):
        if start[offset::2].count(0) > _MANY * len(start) and not start[1 - offset :: 2].count(0):
            return encoding, True
    if b"\0" in start:
        row = 1 + start.count(b"\n", 0, start.index(b"\0"))
        raise InputError("holds a zero byte: a binary file", file=path, key=f"row {row}", remedy="must be CSV text")
    try:
        # The last character may be cut.
        codecs.getincrementaldecoder("utf-8")().decode(start)
        return "utf-8", False
    except UnicodeDecodeError as error:
        strange = next((byte for byte in start if byte in _CONTROL or byte in _UNDEFINED), None)
        if strange is not None:
            row = 1 + start.count(b"\n", 0, error.start)
            problem = (
                f"not UTF-8 text (byte 0x{start[error.start]:02x}) and no other text either (byte 0x{strange:02x})"
            )
            raise InputError(problem, file=path, key=f"row {row}", remedy="must be CSV text") from None
        return "cp1252", True


def head_lines(path: Path, encoding: str | None) -> tuple[list[str], str, bool]:
    """First whole lines without line ends, encoding, and True if that was guessed. Raises InputError for no text."""
    with path.open("rb") as stream:
        guessed = False
        if encoding is None:
            encoding, guessed = encoding_of(path, stream.read(HEAD))
            stream.seek(0)
        text = TextBytes(path, stream, encoding)
        data = b""
        while len(data) < HEAD and (part := text.read(HEAD)):
            data += part
        ended = not text.read(1)
    lines = data.split(b"\n")
    if max(len(line) for line in lines) >= LONGEST_LINE:
        row = 1 + next(k for k, line in enumerate(lines) if len(line) >= LONGEST_LINE)
        raise InputError(TOO_LONG, file=path, key=f"row {row}")
    if not ended and len(lines) > 1:
        del lines[-1]
    return [line.decode("utf-8", "replace").rstrip("\r") for line in lines], encoding, guessed


LOOKED_AT = 600
"""Number of rows that are examined: more than instruments write before their table."""

_STATE = "state it in the campaign file, or give `delimiter`, `decimal` or `skip_rows`"
_FORMAT = '[format]\ndelimiter = ";"  # or "," or "\\t" or " "\ndecimal = ","  # or "."\nskip_rows = 7'

_ORDER = ("\t", ";", ",", " ")
"""Delimiters, the preferred first, for rows that are equally good with several."""


def text_layout(path: Path, given: TableFormat, known: Sequence[str]) -> TableLayout:
    """Layout of a text file; its header is the first row with all ``known`` columns, else the one above the numbers.

    Raises InputError if no table is found, and if a comma may be either decimal or a separator of thousands."""
    lines, encoding, guessed = head_lines(path, given.encoding)
    if not any(line.strip() for line in lines):
        raise InputError("no header row", file=path, remedy=f"must name the columns, as {','.join(known)}")
    stated = stated_format(lines, replace(given, encoding=encoding))
    layout = lvm_layout(path, lines, stated) if is_lvm(lines) else _of_rows(path, lines[:LOOKED_AT], stated, known)
    marks = [("encoding", guessed), ("decimal", stated.decimal is None and layout.format.decimal == ",")]
    return replace(layout, guessed=tuple(key for key, guess in marks if guess))


def _of_rows(path: Path, lines: Sequence[str], given: TableFormat, known: Sequence[str]) -> TableLayout:
    skip = given.skip_rows
    begin = skip if skip is not None else 0
    rows = lines[begin:]
    delimiter, header = _known_header(rows, given, known)
    if header is None and skip is not None:
        header = next((k for k, line in enumerate(rows) if line.strip() and not comment(line)), None)
    top = next((k for k, line in enumerate(rows) if line.strip()), 0) if header is None else header
    if rows and "\r" in rows[top]:
        problem, remedy = "carriage returns within it", "rows must end in line feeds: save it as CSV again"
        raise InputError(problem, file=path, key=f"row {begin + top + 1}", remedy=remedy)
    below = rows if header is None else rows[header + 1 :]
    delimiter, decimal = _written(below, replace(given, delimiter=delimiter))
    # A table without numbers, which would decide it, has the delimiter that gives its header most cells.
    text = "" if header is None else rows[header]
    delimiter = delimiter or max((",", ";", "\t"), key=lambda mark: len(cells(text, mark)))
    table = [_cells(line, delimiter) for line in rows]
    located = locate(table, decimal, header)
    if located is None:
        problem = f"no rows of numbers among the first {len(lines)}, and no header that names {', '.join(known)}"
        raise InputError(problem, file=path, remedy=f"{_STATE}:\n{_FORMAT}")
    _check_header(path, table, located, begin, delimiter)
    data = [row for row, line in zip(table[located.first :], rows[located.first :], strict=True) if line.strip()]
    if given.decimal is None and decimal == "," and (number := undecided_comma(data)):
        problem = f"{number}: a decimal comma, or one of thousands?"
        remedy = f'{_STATE} (without marks of thousands):\n[format]\ndecimal = ","'
        raise InputError(problem, file=path, key=f"row {begin + located.first + 1}", remedy=remedy)
    names, least = fewest(located.names, data, decimal)
    units = [*located.units, *[""] * len(names)][: len(names)]
    stamps = tuple(k for k, cell in enumerate(data[0][: len(names)] if data else []) if STAMP.fullmatch(cell))
    for k in stamps:
        units[k] = "s"
    at = None if located.header is None else begin + located.header + 1
    before = begin + (located.first if located.header is None else located.header)
    if skip is None and all(comment(line) or not line.strip() for line in rows[:before]):
        before = 0
    written = replace(given, delimiter=delimiter, decimal=decimal, skip_rows=before if skip is None else skip)
    first = begin + located.first + 1
    return TableLayout(tuple(names), tuple(units), written, (), at, first, least, stamps=stamps)


def _cells(line: str, delimiter: str) -> list[str]:
    """Cells of a line; those of a comment without its mark, because numpy writes a header as a comment."""
    if blank(line, delimiter):
        return []
    return cells(line.lstrip().lstrip("#").strip() if comment(line) else line, delimiter)


def _known_header(rows: Sequence[str], given: TableFormat, known: Sequence[str]) -> tuple[str | None, int | None]:
    """Delimiter with which a row names all ``known`` columns, and the row's index; the given one and None without."""
    for delimiter in (given.delimiter,) if given.delimiter else _ORDER:
        split = [_cells(line, delimiter) if all(name in line for name in known) else [] for line in rows]
        header = header_of(split, known)
        if header is not None:
            return delimiter, header
    return given.delimiter, None


def _written(rows: Sequence[str], given: TableFormat) -> tuple[str | None, str]:
    """Delimiter and decimal mark that give the rows most numbers; those given, or None and a point, without numbers."""
    best, chosen = 0.0, (given.delimiter, given.decimal or ".")
    for delimiter in (given.delimiter,) if given.delimiter else _ORDER:
        table = [_cells(line, delimiter) for line in rows]
        for decimal in (given.decimal,) if given.decimal else DECIMALS:
            score = width_of(table, decimal)[1] if decimal != delimiter else 0.0
            if score > best:
                best, chosen = score, (delimiter, decimal)
    return chosen


def _check_header(path: Path, table: Sequence[Sequence[str]], located: Located, begin: int, delimiter: str) -> None:
    """Raise InputError if a row stands above the numbers but is no header, as its number of cells differs."""
    above = [k for k in range(located.first) if table[k]]
    if located.header is not None or not above:
        return
    width, row = len(table[located.first]), table[above[-1]]
    hint = " Decimal commas between commas cannot be distinguished." if delimiter == "," else ""
    problem = (
        f"{len(row)} cells, and {width} in the rows of numbers from row {begin + located.first + 1} on, by "
        f"{NAMES[delimiter]}.{hint}"
    )
    raise InputError(problem, file=path, key=f"row {begin + above[-1] + 1}", remedy=f"{_STATE}:\n{_FORMAT}")
