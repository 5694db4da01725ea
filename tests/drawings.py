"""Whether two charts are the same drawing.

Bytes are the same with the same libraries alone: versions of numpy and scipy round differently, which moves a point of a chart
in its ninth digit.
"""

from __future__ import annotations

import re
from pathlib import Path

_NUMBER = re.compile(r"(?<![\w#.])-?\d+\.\d+")
_VISIBLE = 1e-3
"""Pixels that a point may be off."""


def same_drawing(stored: Path, drawn: str) -> bool:
    """Whether a stored SVG differs from one that was drawn now by less than can be seen."""
    kept = stored.read_text(encoding="utf-8")
    numbers = (map(float, _NUMBER.findall(text)) for text in (kept, drawn))
    return _NUMBER.sub("", kept) == _NUMBER.sub("", drawn) and all(
        abs(one - other) <= _VISIBLE for one, other in zip(*numbers, strict=True)
    )
