"""Write a file or an output folder whole or not at all: written next to its place, then renamed into it."""

import contextlib
import ctypes
import errno
import hashlib
import importlib.metadata
import json
import os
import shutil
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from pneutouch import __version__
from pneutouch.errors import InputError
from pneutouch.formats import check_format, versioned
from pneutouch.results.folder import FileEntry, Manifest
from pneutouch.results.record import plain
from pneutouch.spec.files import check_plain, read_bytes
from pneutouch.stopping import parent_folders, refuse_stopped, temporary_folder, uninterrupted

MANIFEST, CHARTS_MANIFEST = "manifest.json", "charts-manifest.json"

_OLD = ".old"
"""Ending of the temporary name that two folders need to exchange their names."""

_HERE, _EXCHANGE = -100, 2
"""Constants AT_FDCWD and RENAME_EXCHANGE of Linux (linux/fcntl.h, linux/fs.h)."""

_MOST_MANIFEST = 100_000_000
"""Greatest size of a manifest in bytes; a campaign of many runs has a long one."""


def digest(content: bytes) -> str:
    """SHA-256 of a file's content, hexadecimal."""
    return hashlib.sha256(content).hexdigest()


def file_digest(path: Path) -> str | None:
    """SHA-256 of a plain file, hexadecimal; None for anything else, and for a file that cannot be read."""
    try:
        check_plain(path, "file")
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except (InputError, OSError):
        return None


def json_bytes(document: object) -> bytes:
    """A JSON document as bytes: sorted keys, two spaces, one newline at the end."""
    return (json.dumps(document, indent=2, sort_keys=True, ensure_ascii=False, allow_nan=False) + "\n").encode()


def replace_file(path: Path, content: bytes, *, key: str = "out") -> None:
    """Write a file; an existing one stays until its replacement is whole. Raises InputError as `replace_files`."""
    replace_files({path: content}, key=key)


FileContent = bytes | memoryview | Iterable[bytes | memoryview]
"""Content of a file, whole or in pieces."""


@uninterrupted()
def replace_files(files: Mapping[Path, FileContent], *, key: str = "out") -> None:
    """Write files; existing ones stay until all their replacements are whole and on the disk.

    Raises InputError if one cannot be written; ``key`` is the parameter that gives the folder.
    """
    path = Path()
    try:
        for path in files:
            if path.exists() and not path.is_file():
                raise InputError(f"{path} is not a file", key=key, remedy="give another place, or move it away")
        with contextlib.ExitStack() as stack:
            fresh: list[tuple[Path, Path]] = []
            for path, content in files.items():
                fresh.append((stack.enter_context(_hidden(path, content)), path))
            for temporary, path in fresh:
                temporary.replace(path)
    except OSError as error:
        raise _refused(path, error, key) from None


def check_own(paths: Iterable[Path], listing: Path, key: str = "out") -> Mapping[str, Any]:
    """Entries of the manifest ``listing`` of loose files, by name. Raises InputError if one of ``paths`` exists
    otherwise than it states: a person wrote or changed it. ``key`` is the parameter of the place."""
    try:
        stated = json.loads(read_bytes(listing, _MOST_MANIFEST, "manifest")) if os.path.lexists(listing) else {}
        known = {name: one["sha256"] for name, one in stated.get("files", {}).items()}
    except (InputError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        raise _of_others(listing, key) from None
    for path in paths:
        if os.path.lexists(path) and (path.is_symlink() or file_digest(path) != known.get(path.name, "")):
            raise _of_others(path, key)
    return {name: stated["files"][name] for name in known}


def replace_own(files: Mapping[Path, FileContent], listing: Path, key: str = "out") -> None:
    """Write loose files and their manifest. Raises InputError as `check_own` and `replace_files`."""
    entries = dict(check_own(files, listing, key))

    def counted(name: str, content: FileContent) -> Iterator[bytes | memoryview]:
        size, hashed = 0, hashlib.sha256()
        for piece in (content,) if isinstance(content, bytes | memoryview) else content:
            size += len(piece)
            hashed.update(piece)
            yield piece
        entries[name] = plain(FileEntry(hashed.hexdigest(), size))

    # The last to be written, when the entries of all others are known.
    last = (manifest(dict(sorted(entries.items())), listing.stem) for _ in range(1))
    replace_files({**{path: counted(path.name, one) for path, one in files.items()}, listing: last}, key=key)


@uninterrupted()
def create_file(path: Path, content: bytes, *, key: str = "out") -> None:
    """Create a file. Raises InputError if it exists, or if it cannot be written, as `replace_files`."""
    try:
        with _hidden(path, content) as fresh:
            _link(fresh, path)
    except FileExistsError as error:
        if not os.path.lexists(path):
            raise _refused(path, error, key) from None
        raise InputError("there is such a file already; give another name", file=path) from None
    except OSError as error:
        raise _refused(path, error, key) from None


def write_synced(path: Path, content: FileContent) -> None:
    """Write a file that is on the disk when this returns. Raises OSError."""
    with path.open("wb") as file:
        file.writelines((content,) if isinstance(content, bytes | memoryview) else content)
        file.flush()
        os.fsync(file.fileno())


@contextlib.contextmanager
def _hidden(path: Path, content: FileContent) -> Iterator[Path]:
    """A hidden file next to ``path`` with its content, removed at the end unless renamed. Raises OSError."""
    with parent_folders(path):
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
        os.close(handle)
        fresh = Path(name)
        try:
            write_synced(fresh, content)
            fresh.chmod(0o644)
            yield fresh
        finally:
            fresh.unlink(missing_ok=True)


def _link(fresh: Path, path: Path) -> None:
    """Give the whole file ``fresh`` the name ``path``, never over another file. Raises OSError."""
    try:
        os.link(fresh, path)
    except OSError as error:
        # Memory sticks and some network folders have no second names for a file.
        if error.errno not in (errno.EPERM, errno.EOPNOTSUPP, errno.ENOSYS):
            raise
        if os.path.lexists(path):
            raise FileExistsError from None
        fresh.rename(path)


def _refused(path: Path, error: OSError, key: str) -> InputError:
    is_file = os.path.lexists(path.parent) and not path.parent.is_dir()
    problem = f"{path.parent} is not a folder" if is_file else error.strerror or error
    return InputError(f"{path}: {problem}", key=key, remedy="give a folder you may write to")


def check_writable(folder: Path, key: str = "out") -> None:
    """Raise InputError if an output folder cannot be written or was not written by pneutouch; ``key`` gave it.

    The same holds if one of its files is not as the manifest states: a person has changed that file.
    """
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder} is a file", key=key, remedy="it must be a folder")
    if folder.is_symlink():
        raise InputError(f"{folder} is a link", key=key, remedy="give the folder it leads to")
    if folder.is_dir() and any(folder.iterdir()):
        with alone_in(folder.parent):
            _our_files(folder)
    parent = next(path for path in (folder.parent, *folder.parent.parents) if path.exists())
    if not parent.is_dir():
        raise InputError(f"{parent} is a file", key=key, remedy="it must be a folder")
    if not os.access(parent, os.W_OK | os.X_OK):
        raise InputError(f"{parent} cannot be written", key=key, remedy="give a folder you may write to")


def write_folder(folder: Path, files: dict[str, bytes]) -> Path:
    """Replace ``folder`` by ``files`` (path inside it to content) and return it; files of others in it are kept.

    Raises InputError as `replacing`. Everything is written to a hidden folder next to it first. A run that stops before
    the last renames leaves the previous output as it was.
    """
    with replacing(folder) as fresh:
        for name, content in files.items():
            path = fresh / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
    return folder


@contextlib.contextmanager
def replacing(folder: Path) -> Iterator[Path]:
    """A hidden folder to write into, which takes the place of ``folder`` when the block ends; files of others are kept.

    Raises InputError if it cannot be written, even half way, or if it would replace or remove a file that is not as the
    folder's manifest states; then only the previous output remains. Of two processes in one folder the later one
    replaces the output of the other.
    """
    _restore(folder)
    check_writable(folder)
    try:
        with parent_folders(folder), temporary_folder(prefix=f".{folder.name}.", within=folder.parent) as fresh:
            yield fresh
            refuse_stopped()
            with uninterrupted(), alone_in(folder.parent):
                _swap(folder, fresh)
    except OSError as error:
        problem = f"{folder}: {error.strerror}"
        raise InputError(problem, key="out", remedy="give a folder you may write to; no output was changed") from None


def _swap(folder: Path, fresh: Path) -> None:
    """Put ``fresh`` in place of ``folder``: files of others are brought over, previous ones of pneutouch removed."""
    fresh.chmod(0o755)
    if not folder.exists():
        fresh.rename(folder)
        return
    if any(folder.iterdir()):
        _keep_foreign(folder, fresh)
    exchange(folder, fresh, lambda old, new: _keep_foreign(old, new, again=True))


def exchange(folder: Path, fresh: Path, keep: Callable[[Path, Path], None] = lambda old, new: None) -> None:
    """Put ``fresh`` in place of an existing ``folder``, which is removed; ``keep``, called with the old and the new
    folder, brings over what came meanwhile, or raises, so that the old one is put back.

    If the process is killed, one of the two is whole in the place of ``folder``, or is left where `_restore` finds it.
    """
    aside = fresh.with_name(f"{fresh.name}{_OLD}")
    _exchange_names(folder, fresh, aside)
    try:
        if any(fresh.iterdir()):
            keep(fresh, folder)
    except BaseException:
        _exchange_names(folder, fresh, aside)
        raise
    shutil.rmtree(fresh, ignore_errors=True)


def _exchange_names(one: Path, other: Path, aside: Path) -> None:
    """Exchange the names of two folders, at once if the system can, else by way of the name ``aside``."""
    if _at_once(one, other):
        return
    one.rename(aside)
    try:
        other.rename(one)
    except BaseException:
        aside.rename(one)
        raise
    aside.rename(other)


def _at_once(one: Path, other: Path) -> bool:
    """Exchange two names in one step; False if system or disk cannot. It calls renameat2, which Python has not."""
    try:
        rename = ctypes.CDLL(None, use_errno=True).renameat2
    except (OSError, AttributeError, TypeError):
        return False
    if rename(_HERE, os.fsencode(one.absolute()), _HERE, os.fsencode(other.absolute()), _EXCHANGE) == 0:
        return True
    number = ctypes.get_errno()
    if number in (errno.ENOSYS, errno.EINVAL, errno.EOPNOTSUPP):
        return False
    raise OSError(number, os.strerror(number), str(one))


def _restore(folder: Path) -> None:
    """Bring back a folder that a process, killed as it exchanged names, left under the temporary name."""
    if os.path.lexists(folder) or not folder.parent.is_dir():
        return
    left = [path for path in folder.parent.iterdir() if path.name.startswith(f".{folder.name}.")]
    olds = [path for path in left if path.name.endswith(_OLD) and path.is_dir() and not path.is_symlink()]
    if olds:
        with contextlib.suppress(OSError):
            max(olds, key=lambda path: path.stat().st_mtime).rename(folder)


@contextlib.contextmanager
def alone_in(parent: Path) -> Iterator[None]:
    """Lock ``parent`` so that only one process exchanges folders in it; no effect where folders cannot be locked."""
    try:
        import fcntl
    except ImportError:
        yield
        return
    handle = os.open(parent, os.O_RDONLY)
    try:
        with contextlib.suppress(OSError):
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        os.close(handle)


def _our_files(folder: Path) -> set[str]:
    """Names in the folder's manifest, and its own. Raises InputError if pneutouch did not write them as they are."""
    try:
        manifest = json.loads(read_bytes(folder / MANIFEST, _MOST_MANIFEST, "manifest"))
        listed = {name: str(entry["sha256"]) for name, entry in manifest["files"].items()}
    except (InputError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        text = f"holds files but no {MANIFEST}: not written by pneutouch"
        if os.path.lexists(folder / MANIFEST):
            text = f"has a {MANIFEST} that pneutouch did not write or that is damaged"
        raise InputError(f"{folder} {text}", key="out", remedy="give another folder, or empty this one") from None
    check_format("manifest", manifest, folder / MANIFEST)
    for path, stated in ((folder / name, digest_) for name, digest_ in listed.items()):
        if os.path.lexists(path) and (path.is_symlink() or file_digest(path) != stated):
            raise _of_others(path)
    return {*listed, MANIFEST}


def _of_others(path: Path, key: str = "out") -> InputError:
    problem = "is not as pneutouch wrote it, or not of pneutouch, and would be lost"
    return InputError(problem, file=path, remedy=f"move it away, or give another place with `{key}`")


def _keep_foreign(folder: Path, fresh: Path, *, again: bool = False) -> None:
    """Bring files, links and empty folders of others over. Raises InputError if one is in the way or is a pipe.

    With ``again`` one that is there already was brought over before, and is left.
    """
    listed = _our_files(folder)
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        target, is_folder = fresh / name, path.is_dir() and not path.is_symlink()
        there = os.path.lexists(target)
        if name in listed or (again and there) or (is_folder and (target.is_dir() or any(path.iterdir()))):
            continue
        if there or not (is_folder or path.is_symlink() or path.is_file()):
            raise _of_others(path)
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
        except (FileExistsError, NotADirectoryError):
            raise _of_others(path) from None
        if is_folder:
            target.mkdir()
            continue
        try:
            # Who has the file open goes on writing into the same one.
            os.link(path, target, follow_symlinks=False)
        except OSError:
            shutil.copy2(path, target, follow_symlinks=False)
    for path in (folder, *(path for path in folder.rglob("*") if path.is_dir() and not path.is_symlink())):
        target = fresh / path.relative_to(folder)
        if target.is_dir():
            shutil.copymode(path, target)


LIBRARIES = ("numpy", "manifold3d", "trimesh", "lib3mf", "cadquery", "cadquery-ocp", "matplotlib", "jinja2", "typst")
"""Libraries on whose versions the bytes of a build depend."""


def input_hash(inputs: Mapping[str, Any], version: str = __version__) -> str:
    """Short digest of the inputs and the version of pneutouch."""
    return short_digest({"inputs": inputs, "version": version})


def short_digest(document: Mapping[str, Any]) -> str:
    """First twelve digits of the SHA-256 of a JSON document."""
    return digest(json_bytes(document))[:12]


def versions() -> dict[str, str]:
    """Versions of pneutouch and of installed `LIBRARIES`, on which the bytes of a build depend."""
    found = {"pneutouch": __version__}
    for name in LIBRARIES:
        with contextlib.suppress(importlib.metadata.PackageNotFoundError):
            found[name] = importlib.metadata.version(name)
    return found


def file_entry(content: bytes) -> FileEntry:
    """Entry of a file in a manifest: its digest and its size."""
    return FileEntry(digest(content), len(content))


def with_manifest(files: Mapping[str, bytes], name: str, inputs: Mapping[str, Any], **more: Any) -> dict[str, bytes]:
    """The files with their manifest added; ``more``: further fields, of which an ``input_hash`` replaces the usual."""
    listed = {path: file_entry(content) for path, content in sorted(files.items())}
    return {**files, MANIFEST: manifest(listed, name, inputs=inputs, **{"input_hash": input_hash(inputs), **more})}


def manifest(listed: Mapping[str, Any], name: str, **more: Any) -> bytes:
    """The manifest of files whose entries (see `file_entry`) are given by path; ``more`` are further fields."""
    return json_bytes(versioned("manifest", plain(Manifest(name, versions(), listed, **more))))
