"""Words that follow from numbers, and the mark of simulated data."""

from collections.abc import Sequence

SIMULATED = "SIMULATED DATA"
"""Stands before every figure that no sensor was measured for, on screen and sheet."""


def listed(names: Sequence[str], most: int) -> str:
    """The first ``most`` names, and how many more there are: ``a, b and 3 more``."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return f"{', '.join(names[:most])}{more}"


def counted(count: int, one: str, many: str = "") -> str:
    """``1 design``, ``2 designs``; ``many`` where the plural is not the singular with an s: ``2 bodies``."""
    return f"{count} {one if count == 1 else many or one + 's'}"
