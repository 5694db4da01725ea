"""Features of one body against the smallest that its machine prints in its material. Measured on the mesh."""

from functools import partial
from typing import NamedTuple

from pneutouch.printability.finding import Finding
from pneutouch.printability.measure.thin import FeatureKind
from pneutouch.printability.sizes import compare
from pneutouch.printability.view import PrintView


class SizeRule(NamedTuple):
    """The printer's ``limit`` that a rule compares with, the kinds of feature by name, and what would fix one."""

    limit: str
    features: dict[FeatureKind, str]
    fix: str


_DETAIL: dict[FeatureKind, str] = {"raised": "a raised detail", "engraved": "an engraved detail"}

# A channel is a hole longer than three widths; details are ridges and grooves with flanks lower than a millimetre.
SIZE_RULES = {
    "walls": SizeRule("wall", {"wall": "a wall"}, "make the wall thicker, or take another printer"),
    "pins": SizeRule("pin", {"pin": "a pin"}, "make the pin thicker, or let it lean on a wall"),
    "holes": SizeRule("hole", {"hole": "a hole"}, "make the hole wider, or drill it through after printing"),
    "channels": SizeRule(
        "channel", {"channel": "a channel"}, "make the channel wider or shorter, or drill it through after printing"
    ),
    "emboss": SizeRule("emboss", _DETAIL, "make the detail wider and higher"),
}


def check(view: PrintView, name: str) -> list[Finding]:
    """Compare every feature of one of the `SIZE_RULES`."""
    rule = SIZE_RULES[name]
    return compare(view, name, rule.features, rule.limit, rule.fix)


CHECKS = {name: partial(check, name=name) for name in SIZE_RULES}
"""The rules as functions of the view."""
