"""[mould]: the mould of a cast membrane, printed on a machine of its own. It matters where the membrane is cast."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from pneutouch.spec.fields import Table, name, number

MOST_CAVITIES = 16


class Mould(Table):
    """[mould]: the machine and material of the mould, how many domes it makes, and its details.

    Defaults without a source are this project's own choice and untested; `pneutouch check` judges them.
    """

    profile: str = name("abs-filament", registry="printers", help="Printer of the mould.")
    material: str = name("ABS", registry="materials", help="Material of the mould.")
    cavities: int = number(1, unit="", low=1, high=MOST_CAVITIES, help="Domes that one mould makes at a time.")
    wall_mm: float = number(4.0, unit="mm", low=1, high=20, help="Thickness of plates and of walls between cavities.")
    draft_deg: float = number(
        2.0,
        unit="deg",
        low=0.5,
        high=10,
        help="Slope of faces along their draw; the flange of a cast membrane has it too.",
    )
    fastener: Literal["screws", "clips"] = Field(
        default="screws", description="What holds the mould closed: M3 screws, or spring clips on ledges."
    )
    vent_diameter_mm: float = number(
        1.5, unit="mm", low=0.5, high=10, help="Vents at the flange's underside, the highest place as poured."
    )
    sprue_diameter_mm: float = number(1.8, unit="mm", low=0.5, high=20, help="Pour channel where it meets the flange.")
    clearance_mm: float = number(
        0.1, unit="mm", low=0.05, high=1, help="Clearance per side of the cones that centre core and cap."
    )
    shrinkage_percent: float | None = number(
        None, unit="%", low=0, high=10, help="Linear shrinkage of the silicone; left out: the material's."
    )
