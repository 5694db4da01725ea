"""Reading of files that others wrote (plain, of bounded size, inside a folder), and the mark on files of a command."""

import stat
from os import PathLike
from pathlib import Path

from pneutouch.errors import InputError

MOST_BYTES = 1_000_000
"""Usual limit on the size of a file, bytes: what a person writes is far smaller."""


def read_bytes(path: Path, most: int = MOST_BYTES, kind: str = "TOML file") -> bytes:
    """Content of a plain file of at most ``most`` bytes. Raises InputError, with the expected ``kind``, for others."""
    size = check_plain(path, kind)
    if size > most:
        raise oversized(path, size, most, kind)
    try:
        with path.open("rb") as file:
            content = file.read(size + 1)
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror}", file=path) from None
    if len(content) > most:
        # It has grown since.
        raise oversized(path, len(content), most, kind)
    return content


def oversized(path: Path, size: int, most: int, kind: str) -> InputError:
    """Error for a file of ``size`` bytes where a file of its ``kind`` has at most ``most`` bytes."""
    limit = f"{most / 1e6:g} MB"
    if most % 2**10 == 0:
        limit = f"{most >> 20} MiB" if most % 2**20 == 0 else f"{most >> 10} KiB"
    return InputError(f"larger than {limit}: {size} bytes", file=path, remedy=f"no {kind} is")


def check_plain(path: Path, kind: str) -> int:
    """Size of a plain file in bytes. Raises InputError for a folder, device or pipe, and if there is no such file."""
    try:
        status = path.stat()
    except FileNotFoundError:
        raise InputError("no such file", file=path) from None
    except (OSError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) else error
        raise InputError(f"cannot be read: {why}", file=path) from None
    if stat.S_ISDIR(status.st_mode):
        raise InputError("this is a folder", file=path, remedy=f"give a {kind}")
    if not stat.S_ISREG(status.st_mode):
        raise InputError("not a plain file, but a device or a pipe", file=path, remedy=f"give a {kind}")
    return status.st_size


def is_file(path: Path) -> bool:
    """True if there is a file of this name; False also for a name that no file can have, such as one too long."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def exists(path: Path) -> bool:
    """True if a file or folder of this name exists; False also for a name that none can have."""
    try:
        return path.exists()
    except (OSError, ValueError):
        return False


def inside(folder: Path, name: str, *, file: str | PathLike[str], key: str) -> Path:
    """Path of ``name`` in ``folder``. Raises InputError if it is absolute, leads out of the folder, be it by a link, or
    cannot be read.

    ``file`` and ``key``, where the name was written, stand in the error: a file may name only files of its own folder.
    """
    path = folder / name
    try:
        target = path.resolve()
        # From 3.13 on, Python leaves a link that leads to itself as it is.
        within = not Path(name).is_absolute() and target.is_relative_to(folder.resolve()) and not target.is_symlink()
    except PermissionError as error:
        raise InputError(f"cannot be read: {error.strerror}", file=path) from None
    except (OSError, ValueError, RuntimeError):
        within = False
    if not within:
        remedy = "give a path in the folder of the file that names it, without .. and without a link that leads out"
        raise InputError("leads out of the folder", file=file, key=key, value=name, remedy=remedy)
    return path


def design_inside(folder: Path, design: str, *, file: str | PathLike[str], key: str) -> str:
    """Design that a file in ``folder`` names: a catalogue name unchanged, a path as `inside` returns it.

    A calibration after a path is kept: ``dome.toml@mine``. Raises InputError as `inside` does.
    """
    plain, at, calibration = design.partition("@")
    if at and plain.endswith(".toml"):
        return f"{inside(folder, plain, file=file, key=key)}{at}{calibration}"
    if design.endswith(".toml") or "/" in design or "\\" in design:
        return str(inside(folder, design, file=file, key=key))
    return design


def head_of(command: str) -> str:
    """First words of a text file that ``command`` wrote; it may overwrite a file that still begins with them."""
    return f"# Written by pneutouch {command}"


def whole_head(command: str, source: str) -> str:
    """First lines of a text file that ``command`` made from ``source``, with a hint on how to keep the file."""
    return (
        f"{head_of(command)} from {source}.\n"
        "# Edit this line away and the command will no longer overwrite the file; delete the file to go back.\n"
    )


def is_of(path: Path, command: str) -> bool:
    """True if a text file begins with the words that `head_of` gives for ``command``."""
    head = head_of(command)
    with path.open(encoding="utf-8", errors="replace") as file:
        return file.read(len(head)) == head


def check_of(path: Path, command: str, remedy: str) -> bool:
    """True if ``command`` wrote the file, False if there is none. Raises InputError for a file of other origin."""
    if not (path.exists() or path.is_symlink()):
        return False
    if path.is_file() and not path.is_symlink() and is_of(path, command):
        return True
    raise InputError(f"was not written by pneutouch {command}, so it is left as it is", file=path, remedy=remedy)
