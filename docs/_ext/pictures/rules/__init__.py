"""For every print rule a case that it passes and one that it reports, of real geometry, with what there is to draw."""

from __future__ import annotations

from collections.abc import Callable

from pictures.rules import blocks, casting, meshes, moulds, sensors
from pictures.rules.case import Case, Pair

EXHIBITS: dict[str, Callable[[], Pair]] = {
    **meshes.EXHIBITS,
    **blocks.EXHIBITS,
    **sensors.EXHIBITS,
    **casting.EXHIBITS,
    **moulds.EXHIBITS,
}
"""A pair of cases by the name of the rule."""

__all__ = ["EXHIBITS", "Case", "Pair"]
