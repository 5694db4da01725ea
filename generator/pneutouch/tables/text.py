"""Text files of any encoding: which it is, their first lines, and their bytes in UTF-8."""

import codecs
import io
from pathlib import Path
from typing import BinaryIO

from pneutouch.errors import InputError

HEAD = 2**18
"""Bytes in which a table must begin: a few thousand rows of what instruments write before it."""

LONGEST_LINE = 2**16
"""Bytes of the longest line: some thousand cells."""

TOO_LONG = f"over {LONGEST_LINE} bytes without a line end; not a CSV file of numbers"

_MARKS = ((codecs.BOM_UTF8, "utf-8"), (codecs.BOM_UTF16_LE, "utf-16"), (codecs.BOM_UTF16_BE, "utf-16"))
_MANY = 0.3
"""Share of zero bytes, all at even or all at odd places, from which bytes are UTF-16 without a mark: half in ASCII."""

_CONTROL = frozenset(range(32)) - {9, 10, 11, 12, 13, 26, 27, 28, 29, 30, 31}
_UNDEFINED = frozenset({0x81, 0x8D, 0x8F, 0x90, 0x9D})
"""Bytes without a meaning in CP1252."""


class TextBytes(io.RawIOBase):
    """The bytes of a text file in UTF-8, whatever its encoding; a byte order mark is left out.

    Raises InputError, naming the row, where bytes are not of the encoding."""

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
        """The next bytes, about ``size`` of the file's; empty at its end."""
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
    """Encoding of a file by its first bytes, and whether that is by their look and not by a mark or by being UTF-8.

    Raises InputError for zero bytes and control characters, which no text has."""
    for mark, encoding in _MARKS:
        if start.startswith(mark):
            return encoding, False
    for offset, encoding in ((1, "utf-16-le"), (0, "utf-16-be")):
        zeros = start[offset::2].count(0)
        if zeros > _MANY * len(start) and not start[1 - offset :: 2].count(0):
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
    """The first lines, without line ends; the encoding, and whether that was guessed. Raises InputError.

    The last line is left out where it is not whole."""
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
