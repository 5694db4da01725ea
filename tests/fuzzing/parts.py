"""A zip archive as one text of its parts: changed bytes then reach the readers behind its checksums."""

from __future__ import annotations

import io
import warnings
import zipfile

_MARK = b"\n=== "
_ARCHIVE = b"PK"


def archive(content: bytes) -> bytes:
    """The archive of an input: parts, each after a line ``=== NAME``; what begins as an archive is taken as it is."""
    if content.startswith(_ARCHIVE):
        return content
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_STORED) as file, warnings.catch_warnings():
        # A name that is there twice is what a reader has to refuse.
        warnings.simplefilter("ignore", UserWarning)
        for part in (b"\n" + content).split(_MARK)[1:]:
            name, _, body = part.partition(b"\n")
            file.writestr(zipfile.ZipInfo(name.decode("latin-1") or "x"), body)
    return packed.getvalue()


def parts(content: bytes) -> bytes:
    """The parts of an archive as such a text."""
    with zipfile.ZipFile(io.BytesIO(content)) as file:
        return b"\n".join(b"=== " + name.encode() + b"\n" + file.read(name) for name in file.namelist())
