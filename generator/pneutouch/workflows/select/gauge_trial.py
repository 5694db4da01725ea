"""One gauge that a selection considered, and why it is chosen or not."""

from dataclasses import dataclass
from typing import Any

ANY = "any"
"""Stands for every gauge of the library."""


@dataclass(frozen=True, slots=True)
class GaugeTrial:
    """A gauge by name; ``smallest_force_N`` by the best design's sensitivity, None if its noise is not known."""

    name: str
    title: str
    chosen: bool
    why: str
    smallest_force_N: float | None = None

    def document(self) -> dict[str, Any]:
        """The trial as data."""
        return {
            "gauge": self.name,
            "title": self.title,
            "chosen": self.chosen,
            "why": self.why,
            "smallest_force_N": self.smallest_force_N,
        }
