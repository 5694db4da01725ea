"""The declaration of a coupon family: its subject, its drawing, its measurement and the instrument."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from pneutouch.body import Solid
from pneutouch.catalogue import ResolvedDesign
from pneutouch.parts.layout import Layout, lay_out
from pneutouch.spec.fields import MaterialKind
from pneutouch.spec.material import Material

ROLE = "coupon"
"""Role of every coupon's solids."""

Belongs = Literal["material", "printer", "design"]


@dataclass(frozen=True, slots=True)
class Nominal:
    """A feature to be measured.

    Attributes:
        feature: Feature that it is a size of, such as hole; features of one name make one table.
        value: As drawn, in ``unit``; None if nothing is drawn and the reading alone counts.
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
    """Subject of a coupon: a material, and the scene of a design if the coupon belongs to one."""

    material: Material
    scene: ResolvedDesign | None = None

    def layout(self) -> Layout:
        """Layout of the design. Raises InputError if a part of the design has no space."""
        return lay_out(self.design())

    def design(self) -> ResolvedDesign:
        """The scene. Raises TypeError if the coupon belongs to no design."""
        if self.scene is None:
            raise TypeError("this coupon belongs to a design; give its scene")
        return self.scene


@dataclass(frozen=True)
class Coupon:
    """A family of coupons.

    Attributes:
        name: As the command line and the results file call it.
        title: The name in text.
        belongs: Material: one set a material; printer: one a printer and material; design: one a design.
        copies: Number that are printed by default.
        draw: The exact solids, in mm; those of a design in its frame.
        nominals: Sizes to measure, in the order of the sheet.
        steps: Steps of printing and measuring, for the sheet.
        formulas: Formulas for the readings, for the sheet.
        each: Name of the table that every copy has of its own in the results file; empty: one table for all.
        kinds: Kinds of material it is made for.
        turned_over: Printed upside down: what seals or is filled then faces up and needs no support.
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


CALIPER = "caliper, 0.01 mm, closed without pressing"
GAUGE_PINS = "gauge pins, or a microscope"
BALANCE = "balance, 0.001 g"
PRESSURE = "the sensor's own pressure gauge"
