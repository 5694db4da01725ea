"""[cast_ring]: the perforated ring that the flange of a cast membrane is cast around. It matters for such a seat."""

from __future__ import annotations

from pneutouch.spec.fields import Table, number


class PerforatedRing(Table):
    """[cast_ring]: the web of the ring, which the silicone encloses, and its holes.

    Defaults are this project's own choice and untested: walls and holes are what a filament printer of 0.4 mm makes.
    """

    hole_count: int | None = number(
        None,
        unit="",
        low=3,
        high=400,
        help="Holes around the ring that silicone goes through; left out: as many as leave between two of them what "
        "they are wide.",
    )
    hole_diameter_mm: float = number(2.0, unit="mm", low=0.5, high=10, help="Diameter of these holes.")
    thickness_mm: float = number(1.6, unit="mm", low=0.4, high=10, help="Thickness of the ring within the silicone.")
    width_mm: float = number(4.0, unit="mm", low=1, high=30, help="Width of the ring within the silicone.")
