"""The declaration of a coupon family: its subject, drawing, measurements and instruments."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from pneutouch.body import Solid
from pneutouch.catalogue import ResolvedDesign
from pneutouch.parts.layout import Layout, lay_out
from pneutouch.spec.fields import MaterialKind
from pneutouch.spec.material import Material
from pneutouch.wording import data_of

ROLE = "coupon"
"""Role of every coupon's solids."""

Belongs = Literal["material", "printer", "design"]


@dataclass(frozen=True, slots=True)
class Nominal:
    """A feature to be measured.

    Attributes:
        feature: Feature whose size is measured, such as hole; features of one name form one table.
        value: Value as drawn, in ``unit``; None if nothing is drawn and only the reading counts.
        unit: mm, g, mL, kPa ... or Shore A.
        instrument: Instrument that measures it.
        readings: Number of readings on each copy.
    """

    feature: str
    value: float | None
    unit: str
    instrument: str
    readings: int = 3


@dataclass(frozen=True, slots=True)
class CouponContext:
    """Subject that a coupon is drawn for: a material, and the scene of a design if the coupon belongs to one."""

    material: Material
    scene: ResolvedDesign | None = None

    def layout(self) -> Layout:
        """Layout of the design. Raises InputError if a part of the design has no space."""
        return lay_out(self.design())

    def design(self) -> ResolvedDesign:
        """Scene of the design. Raises TypeError if the coupon does not belong to a design."""
        if self.scene is None:
            raise TypeError("this coupon belongs to a design; give its scene")
        return self.scene


@dataclass(frozen=True)
class Coupon:
    """A family of coupons.

    Attributes:
        name: Name on the command line and in the results file.
        title: Name in text.
        belongs: material: one set per material; printer: one per printer and material; design: one per design.
        copies: Number of copies printed by default.
        draw: Returns the exact solids, in mm; for a coupon of a design, in the frame of the design.
        nominals: Returns the sizes to measure, in the order of the sheet.
        steps: Steps of printing and measuring, for the sheet.
        formulas: Formulas for the readings, for the sheet.
        each: Name of the separate table of every copy in the results file; empty: one table for all.
        kinds: Kinds of material that it is made for.
        turned_over: True if printed upside down: the sealing or filled side then faces up and needs no support.
    """

    name: str
    title: str
    belongs: Belongs
    copies: int
    draw: Callable[[CouponContext], tuple[Solid, ...]]
    nominals: Callable[[CouponContext], tuple[Nominal, ...]]
    steps: tuple[str, ...]
    formulas: tuple[str, ...]
    each: str = ""
    kinds: tuple[MaterialKind, ...] = ("elastomer", "rigid")
    turned_over: bool = False


def instructions(module: str) -> Any:
    """``steps`` and ``formulas`` of a coupon, from the file beside its module, whose ``__file__`` is given."""
    return {key: tuple(lines) for key, lines in data_of(module).items()}


CALIPER = "caliper, 0.01 mm, closed without pressing"
GAUGE_PINS = "gauge pins, or a microscope"
BALANCE = "balance, 0.001 g"
PRESSURE = "the sensor's own pressure gauge"
