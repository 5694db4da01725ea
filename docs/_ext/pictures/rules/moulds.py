"""The mould of the cast dome, for the rules on moulds."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from pictures.rules.case import LIBRARY, Case, Pair, window
from pneutouch.body.section import section_outline
from pneutouch.catalogue import load_scene
from pneutouch.parts.mould import MouldAssembly, mould_of
from pneutouch.parts.mould.filling import release_of
from pneutouch.parts.mould.pieces import core, silicone
from pneutouch.printability.rulebook import MOULD_RULES
from pneutouch.report.mould import draw_mould
from pneutouch.report.section import draw_loops, horizontal, leader
from pneutouch.spec.material import Material
from pneutouch.spec.read import parse_changes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SLICE = 5e-3


def _mould(*changes: str) -> MouldAssembly:
    return mould_of(load_scene("cast-dome", parse_changes(changes), LIBRARY))


def mould_fit() -> Pair:
    """Cones that centre the core, and cones with so much play that the wall is uneven."""
    return _fitted(0.1), _fitted(0.3)


def _fitted(clearance: float) -> Case:
    mould = _mould(f"mould.clearance_mm={clearance:g}")
    size = mould.size

    def draw(ax: Axes) -> None:
        draw_mould(ax, mould, labels=False)
        outer, middle = size.seat(size.foot_low), -0.5 * (size.low + size.foot_low)
        leader(ax, (outer - 0.6, middle), (outer + 2.5, middle + 1.5), f"clearance {clearance:g}", "left")
        window(ax, size.seat_radius - 5, outer + 9, -size.low - 5, -size.foot_low + 2)

    return Case(f"clearance of {clearance:g} mm", MOULD_RULES["mould fit"](mould), draw)


def mould_filling() -> Pair:
    """A pour channel through which the silicone runs in time, and one that is too narrow for sixteen domes."""
    return (
        _poured("channel of 3.5 mm", "mould.sprue_diameter_mm=3.5"),
        _poured("channel of 0.8 mm, 16 domes", "mould.sprue_diameter_mm=0.8", "mould.cavities=16"),
    )


def _poured(label: str, *changes: str) -> Case:
    mould = _mould(*changes)

    def draw(ax: Axes) -> None:
        draw_mould(ax, mould, labels=False)
        size = mould.size
        wide = 0.5 * size.pitch + size.margin
        at = (size.channel_radius, -size.foot_low - 0.1 * size.foot)
        leader(ax, at, (1.3 * wide, at[1]), f"Ø{size.shape.sprue_diameter:g}", "left")
        window(ax, -1.2 * wide, 1.9 * wide, -size.cap_high - 1, -size.base_low + 1)

    return Case(label, MOULD_RULES["mould filling"](mould), draw)


def release() -> Pair:
    """A silicone that stretches, and one that breaks before the membrane leaves its core."""
    return _released("DragonSkin20", None), _released("a silicone that breaks at 60 %", 60.0)


def _released(label: str, breaks_at_percent: float | None) -> Case:
    mould = _mould()
    if breaks_at_percent is not None:
        material: Material = mould.scene.membrane_material
        quantity = material.elongation_at_break_percent.model_copy(
            update={"value": breaks_at_percent, "low": None, "high": None}
        )
        weak = material.model_copy(update={"elongation_at_break_percent": quantity})
        mould = replace(mould, scene=replace(mould.scene, membrane_material=weak))

    def draw(ax: Axes) -> None:
        size, let = mould.size, release_of(mould.membrane, mould.size)
        for solid, role in ((core(size, mould.material), "connector"), (silicone(size, mould.material), "membrane")):
            draw_loops(ax, [loop * np.array([1.0, -1.0]) for loop in section_outline(solid, _SLICE)], role)
        foot = -size.foot_low
        horizontal(
            ax, foot + 2.5, -0.5 * let.opening_mm, 0.5 * let.opening_mm, -size.low, f"opening {let.opening_mm:.1f}"
        )
        horizontal(ax, foot + 5.5, -0.5 * let.core_mm, 0.5 * let.core_mm, 0.0, f"core {let.core_mm:.1f}")

    return Case(label, MOULD_RULES["release"](mould), draw)


EXHIBITS = {"mould fit": mould_fit, "mould filling": mould_filling, "release": release}
