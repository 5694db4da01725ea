"""The cast dome, for the rules on a liquid silicone in a thin wall."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from pictures.rules.case import Case, Pair, evaluated, of_sensor, window
from pneutouch.report.mould import draw_mould
from pneutouch.report.section import circle, draw_section, leader, polar
from pneutouch.report.style import ACCENT

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_REST = "pneumatics.driving_pressures_kPa=[0]"
"""Without pressure: the rules on casting look at the wall and its silicone alone."""


def filling() -> Pair:
    """A wall that the silicone runs into by its weight, and one in which it sets before."""
    return _filled(1.5), _filled(0.4)


def _filled(wall: float) -> Case:
    evaluation = evaluated("cast-dome", f"membrane.wall_thickness_mm={wall:g}", _REST, model="membrane")

    def draw(ax: Axes) -> None:
        draw_section(ax, evaluation.assembly)
        radius = evaluation.assembly.layout.inner_radius + 0.5 * wall
        leader(ax, polar(radius, 45), (13.0, 10.0), f"wall {wall:g}", "left")

    return Case(f"wall of {wall:g} mm", of_sensor("filling", evaluation), draw)


def bubbles() -> Pair:
    """The largest bubble that stays in a thick and in a thin wall."""
    return _bubbled(1.5), _bubbled(1.0)


def _bubbled(wall: float) -> Case:
    evaluation = evaluated("cast-dome", f"membrane.wall_thickness_mm={wall:g}", _REST, model="membrane")
    findings = of_sensor("bubbles", evaluation)
    diameter = float(re.search(r"up to ([\d.]+) mm", findings[0].message)[1])

    def draw(ax: Axes) -> None:
        draw_section(ax, evaluation.assembly)
        radius = evaluation.assembly.layout.inner_radius + 0.5 * wall
        for angle in (70, 90, 110):
            circle(ax, *polar(radius, angle), 0.5 * diameter, color=ACCENT, lw=1.4)
        leader(ax, polar(radius, 70), (5.6, radius + 0.6), f"Ø{diameter:g} in a\nwall of {wall:g}", "left")
        window(ax, -5, 8.5, 6.5, 12)

    return Case(f"wall of {wall:g} mm", findings, draw)


def inhibition() -> Pair:
    """A mould of filament, and one of a photopolymer."""
    return (
        _in_mould("mould of ABS filament"),
        _in_mould("mould of clear resin", "mould.profile=sla-resin", "mould.material=ClearResin"),
    )


def _in_mould(label: str, *changes: str) -> Case:
    evaluation = evaluated("cast-dome", *changes, _REST, model="membrane")

    def draw(ax: Axes) -> None:
        mould = evaluation.assembly.mould
        draw_mould(ax, mould, labels=False)
        wide = 0.5 * mould.size.pitch + mould.size.margin
        leader(ax, (0.85 * wide, -2.0), (1.4 * wide, 2.0), mould.material.label, "left")
        window(ax, -1.2 * wide, 2.6 * wide, -mould.size.cap_high - 1, -mould.size.base_low + 1)

    return Case(label, of_sensor("inhibition", evaluation), draw)


EXHIBITS = {"filling": filling, "bubbles": bubbles, "inhibition": inhibition}
