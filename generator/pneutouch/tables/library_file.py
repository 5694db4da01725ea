"""Files that the library of an extra reads: its faults as errors of the file."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from pneutouch.errors import InputError


@contextmanager
def library_file(path: Path, kind: str, library: str, extra: str) -> Iterator[None]:
    """Import and use the library of ``extra`` that reads files of a ``kind``.

    Raises InputError if it is not installed, and in place of whatever its parsers raise.
    """
    try:
        yield
    except (InputError, OSError):
        raise
    except ImportError:
        raise InputError(f'{kind} files need {library}: pip install "pneutouch[{extra}]"', file=path) from None
    except Exception as error:
        text = " ".join(str(error).split())[:120] or type(error).__name__
        raise InputError(
            f"no whole {kind} file: {text}", file=path, remedy="cut off, or another kind of file?"
        ) from None
