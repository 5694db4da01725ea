"""The closed mould as a drawing: the section through the axis of one cavity, as it is poured, with labels."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.body import Solid
from pneutouch.body.section import section_outline
from pneutouch.parts.cast_ring import RING, RingSize
from pneutouch.parts.mould import MouldAssembly, silicone_batch
from pneutouch.parts.mould.filling import release_of
from pneutouch.parts.mould.pieces import LEDGE_HEIGHT, lay_out_mould, mould_solids, screw_places, silicone
from pneutouch.parts.mould.size import PROUD, SCREW, MouldSize
from pneutouch.report.blocks import Plot, SheetBlock, SheetTable, section
from pneutouch.report.section import CENTRE, GRAY, THIN, draw_loops, leader
from pneutouch.report.style import INK, MM, MUTED, figure, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_TOLERANCE = 5e-3
_WIDE = 150.0
"""Width of the drawing in mm; it is as high as the section needs."""

_HATCHES = {
    "mould-cap": "////////",
    "mould-ring": "----",
    "mould-core": "\\\\\\\\",
    "mould-base": "||||",
    RING: "xxxxxx",
    "silicone": "",
}


def mould_section(mould: MouldAssembly) -> str:
    """One cavity of the closed mould in section, turned over as it is poured, as SVG."""
    with figure(_WIDE, _WIDE) as drawn:
        ax = drawn.add_subplot()
        draw_mould(ax, mould)
        ax.set_aspect("equal")
        ax.axis("off")
        drawn.set_figheight(_WIDE * float(np.ptp(ax.get_ylim()) / np.ptp(ax.get_xlim())) * MM)
        return svg(drawn)


def draw_mould(ax: "Axes", mould: MouldAssembly, labels: bool = True) -> None:
    """Draw the section of one cavity into axes, turned over, with heights as it is poured; lengths in mm."""
    size = lay_out_mould(mould.membrane, replace(mould.size.shape, cavities=1), mould.size.insert)
    insert = () if mould.insert is None else (mould.insert,)
    for solid in (*mould_solids(size, mould.material), *insert, silicone(size, mould.material)):
        _fill(ax, solid)
    if labels:
        _labels(ax, size)
    if size.insert is not None:
        _holes(ax, size.insert)


def mould_section_blocks(mould: MouldAssembly) -> list[SheetBlock]:
    """The datasheet's section on the mould."""
    words = (
        "The closed mould in section, turned over as it is poured: air leaves at the flange's underside, and parting "
        "lines meet the flange alone. Lengths in mm; own design, untested."
    )
    return section("Mould", Plot(mould_section(mould), words, mm=_WIDE), SheetTable(mould_rows(mould)))


def mould_rows(mould: MouldAssembly) -> list[list[str]]:
    """Rows (name, text) that describe the mould and its silicone."""
    size, shape, batch = mould.size, mould.size.shape, silicone_batch(mould)
    release = release_of(mould.membrane, size)
    parts = ", ".join(f"{count} x {name.removeprefix('mould-')}" for name, count in mould.counts.items())
    masses = " + ".join(f"{part:.1f} g" for part in batch.parts_g)
    broken = mould.scene.membrane_material.elongation_at_break_percent
    limit = "not known" if broken is None else f"{broken.text()} %"
    return [
        ["Parts", f"{parts}; {mould.material.label} on the {mould.printer.title}, {mould.mode.label}"],
        ["Scale", f"{shape.factor:.5f}, for a linear shrinkage of {100 * shape.shrinkage:.3g} %"],
        ["Wall", f"±{size.wall_error:.2f} mm at the rim by the clearance of the cones, none at the pole"],
        ["Silicone to mix", f"{batch.volume_mL:.1f} mL, {batch.mass_g:.1f} g ({masses}), loss included"],
        ["Leaving the core", f"strain of {100 * release.strain:.0f} %; elongation at break {limit}"],
        ["Closed by", _fastening(mould)],
        *_inserted(mould),
    ]


def _inserted(mould: MouldAssembly) -> list[list[str]]:
    if mould.insert is None:
        return []
    cavities = mould.size.shape.cavities
    each = "one" if cavities == 1 else f"{cavities}, one in each cavity"
    return [
        ["Cast around", f"the sensor's perforated ring: {each}; it lies in the mould's ring and stands on the foot"]
    ]


def _fastening(mould: MouldAssembly) -> str:
    size = mould.size
    if size.shape.fastener == "clips":
        return f"spring clips on the ledges at both ends, opening {size.shape.wall + PROUD + LEDGE_HEIGHT:.1f} mm"
    length = size.shape.wall + PROUD + SCREW.depth - 1.0
    return f"{len(screw_places(size))} screws {SCREW.name}, at most {length:.0f} mm long, cut into the plastic"


def _fill(ax: "Axes", solid: Solid) -> None:
    """Draw the section of a part turned over, at heights -z: silicone in gray, printed parts and ring hatched."""
    loops = [loop * np.array([1.0, -1.0]) for loop in section_outline(solid, _TOLERANCE)]
    draw_loops(ax, loops, solid.name, _HATCHES)


def _holes(ax: "Axes", ring: RingSize) -> None:
    """Draw the holes of the ring, turned into the plane of the section and full of silicone."""
    z = -np.array([ring.web_low, ring.web_low, ring.web_high, ring.web_high])
    for x in (-ring.hole_circle, ring.hole_circle):
        ax.fill(x + ring.hole_radius * np.array([-1.0, 1.0, 1.0, -1.0]), z, facecolor=GRAY, edgecolor=INK, lw=THIN)


def _labels(ax: "Axes", size: MouldSize) -> None:
    """Draw the names of the parts and of the silicone's passages, from the top down on both sides."""
    shape, wide = size.shape, 0.5 * size.pitch + size.margin
    low, high, foot = -size.cap_high, -size.base_low, -size.foot_low
    step, outer = (high - low) / 6, size.seat(size.foot_low)
    edge = 0.5 * (size.bore.start[0] + size.seat_radius)
    wall = -0.5 * np.sum(size.faces.halfway, axis=0)
    right = [
        (f"pour channel Ø{shape.sprue_diameter:g}, with funnel", (size.channel_radius, foot - 0.1 * size.foot)),
        (f"base, {shape.wall:g} thick", (0.5 * (size.window + outer), foot + 0.5 * shape.wall)),
        ("cone that centres core and cap", (outer - 0.5, 0.5 * (foot - size.low))),
        ("ring", (edge, -0.5 * size.low)),
        ("parting line, at the flange", (size.bore.end[0], 0.0)),
        ("cap", (0.85 * wide, 0.6 * low)),
    ]
    left = [
        ("window: silicone runs over here", (-0.6 * size.window, foot + 0.3 * shape.wall)),
        (f"vents Ø{shape.vent_diameter:g}, {size.gates - 1} of them", (-size.channel_radius, foot - 0.2 * size.foot)),
        ("core with its foot", (-0.6 * size.faces.rim.start[0], 0.1 * low)),
        ("silicone", (wall[0], wall[1])),
    ]
    if size.insert is not None:
        collar = 0.5 * (size.insert.flange_radius + size.insert.collar_radius)
        left.insert(2, (f"ring in the flange, {size.insert.hole_count} holes", (-collar, -0.6 * size.low)))
    for notes, x, side in ((right, 1.2 * wide, "left"), (left, -1.2 * wide, "right")):
        for k, (text, at) in enumerate(notes):
            leader(ax, at, (x, high + (0.5 - 1.1 * k) * step), text, side)
    ax.plot([0, 0], [low - 0.4 * step, high + 0.4 * step], color=MUTED, lw=THIN, ls=CENTRE)
    ax.set_xlim(-2.5 * wide, 2.5 * wide)
    ax.set_ylim(low - 0.6 * step, high + step)
