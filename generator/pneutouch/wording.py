"""Words that follow from numbers, and the mark of simulated data."""

SIMULATED = "SIMULATED DATA"
"""Stands before every figure that no sensor was measured for, on screen and sheet."""


def counted(count: int, one: str, many: str = "") -> str:
    """``1 design``, ``2 designs``; ``many`` where the plural is not the singular with an s: ``2 bodies``."""
    return f"{count} {one if count == 1 else many or one + 's'}"
