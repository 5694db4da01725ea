"""Files as bytes, the same for the same input: 3MF, STL, STEP, GLB, voxel slices, readers and simulator models."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from jinja2 import Environment


def templates(folder: Path, *, autoescape: bool, finalize: Callable[[Any], Any] | None = None) -> "Environment":
    """Jinja's environment of the templates in a folder: unknown names are errors, tags leave no lines of their own.

    A text that is filled in ends without the last line break of its template.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    return Environment(
        loader=FileSystemLoader(folder),
        autoescape=autoescape,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        finalize=finalize,
    )
