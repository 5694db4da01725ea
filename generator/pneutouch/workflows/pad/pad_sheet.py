"""Print sheet of a pad, its drawing on one page, and its record."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.body.section import mesh_outline
from pneutouch.body.shapes import polygon
from pneutouch.parts.glue import GLUES, glue_of
from pneutouch.parts.pad.solids import channel_length
from pneutouch.printability import Finding
from pneutouch.report.pages import filled
from pneutouch.report.print_sheet import LEAK, fill_kPa, leak_tools
from pneutouch.report.section import HIDDEN, circle, draw_loops
from pneutouch.report.style import BOLD, INK, figure, svg
from pneutouch.results.pad import PadCell, PadRecord, PadState
from pneutouch.results.printing import JobEstimate
from pneutouch.units import KPA, ML
from pneutouch.workflows.pad.findings import widest
from pneutouch.workflows.pad.load import ResolvedPad

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_DIGITS = 4
_WIDTH, _HEIGHT = 180.0, 72.0
"""Size of the drawing, mm."""

ALONE = (
    "each cell is predicted alone: what a pressed neighbour does to it through the membrane between them is left out",
    "each cell is pressed by a plate of its own, as its design states it",
    "a cell with an upright wall is held by its flange, as printed, one with another wall at its base plane",
)
"""Assumptions of the prediction of the cells."""


def pad_record(pad: ResolvedPad) -> PadRecord:
    """Record of a pad and its cells."""
    layout, extent = pad.layout, np.ptp(np.concatenate([body.bounds for body in pad.bodies]), axis=0)
    pitch = min(math.dist(a, b) for a, b in combinations(layout.places, 2))
    return PadRecord(
        name=pad.name,
        cell=pad.file.pad.cell,
        layout=pad.file.pad.layout,
        pitch_mm=_rounded(pitch),
        width_mm=(_rounded(extent[0]), _rounded(extent[1])),
        thickness_mm=_rounded(layout.cell.plate_high - layout.low),
        channel_diameter_mm=_rounded(2.0 * layout.channel),
        port_pitch_mm=_rounded(layout.fan * pitch),
        pressed_diameter_mm=_rounded(2.0 * max(widest(pad))),
        cells=tuple(_cell(pad, k) for k in range(len(layout.places))),
        assumptions=ALONE,
    )


def _cell(pad: ResolvedPad, k: int) -> PadCell:
    layout, volume_mL = pad.layout, pad.dead_volumes_mL[k]
    states = pad.evaluations[pad.kinds[k]].prediction.states
    (x, y), (u, v) = layout.places[k], layout.ports[k]
    return PadCell(
        number=k + 1,
        place_mm=(_rounded(x), _rounded(y)),
        port_mm=(_rounded(u), _rounded(v)),
        channel_mm=_rounded(channel_length(layout, k)),
        dead_volume_mL=volume_mL,
        states=tuple(
            PadState(
                _rounded(one.driving_pressure / KPA),
                None if one.figures is None else _rounded(one.figures.sensitivity),
                None if one.figures is None else _rounded(one.figures.force_high),
            )
            for one in states
        ),
    )


def _rounded(value: float) -> float:
    return round(float(value), _DIGITS) + 0.0


def sheet(
    pad: ResolvedPad,
    record: PadRecord,
    findings: list[Finding],
    jobs: tuple[JobEstimate, ...],
    input_hash: str,
    left_out: Mapping[str, str],
) -> str:
    """Print sheet as Markdown, for the operator; ``left_out``: files not written, and why."""
    scene, rated_kPa = pad.scene, [cell.rating.pressure_kPa for cell in pad.worst]
    last = [[one.figures for one in cell.prediction.states if one.figures is not None][-1:] for cell in pad.worst]
    fall = min((LEAK * one.sensitivity * one.force_high for figures in last for one in figures), default=None)
    filled_kPa = [fill_kPa(one, own_kPa) for one, own_kPa in zip((scene, *pad.groups), rated_kPa, strict=True)]
    gas_mL = max(dome.shape.cavity_volume for dome in pad.layout.domes) / ML + max(pad.dead_volumes_mL)
    return filled(
        "pad.md.j2",
        pad=pad,
        record=record,
        scene=scene,
        document=pad.file.document,
        bodies=list(zip(pad.bodies, pad.solids, strict=True)),
        stands=pad.stands_up,
        findings=findings,
        jobs=jobs,
        input_hash=input_hash,
        left_out=left_out,
        glue=GLUES[name].title if (name := glue_of(scene)) else None,
        fill_kPa=_by_group(pad, filled_kPa),
        rated_kPa=_by_group(pad, rated_kPa),
        fall=fall,
        leak_tools=leak_tools(gas_mL, max(filled_kPa), fall),
    )


def _by_group(pad: ResolvedPad, values: Sequence[float]) -> str:
    """The value of the cells in no group, and those of groups that differ."""
    first, *others = (f"{value:.3g}" for value in values)
    pairs = zip(pad.file.pad.groups, others, strict=True)
    differ = [f"cells {', '.join(map(str, group.cells))}: {own}" for group, own in pairs if own != first]
    return f"{first} ({'; '.join(differ)})" if differ else first


def drawing_svg(pad: ResolvedPad) -> bytes:
    """SVG of the pad from the front and from behind, with numbers of cells and ports, and its section at y = 0; the
    same bytes every time."""
    layout = pad.layout
    with figure(_WIDTH, _HEIGHT) as page:
        front, rear, cut = page.subplots(1, 3)
        around = max(math.dist(point, layout.centre) for point in polygon(layout.outline, 0.05))
        reach = max(layout.plate, around) + 1.0
        _view(front, pad, reach, behind=False)
        _view(rear, pad, reach, behind=True)
        for body, solid in zip(pad.bodies, pad.solids, strict=True):
            draw_loops(cut, mesh_outline(body, layout.centre[1]), solid.role)
        bounds = np.concatenate([body.bounds[:, 2] for body in pad.bodies])
        heights = (bounds.min() - 1.0, bounds.max() + 1.0)
        middle = layout.centre[0]
        cut.set(xlim=(middle - reach, middle + reach), ylim=heights, aspect="equal", xlabel="x, mm", ylabel="z, mm")
        cut.set_title(f"section at y = {round(layout.centre[1], 3) + 0.0:g} mm")
        cut.grid(visible=False)
        document = pad.file.document
        text = f"{document.title}, revision {document.revision}: {len(layout.places)} cells, {pad.file.pad.layout}"
        page.suptitle(text, x=0.01, ha="left", fontsize=8.5, **BOLD)
        return svg(page).encode()


def _view(ax: Axes, pad: ResolvedPad, reach: float, *, behind: bool) -> None:
    """Draw a view along z; from ``behind`` x runs to the left."""
    layout, side = pad.layout, -1.0 if behind else 1.0
    for outline, look in ((layout.outline, "-"), (layout.membrane_outline, HIDDEN if behind else "-")):
        edge = np.array([*(loop := polygon(outline, 0.02)), loop[0]])
        ax.plot(side * edge[:, 0], edge[:, 1], color=INK, lw=0.7, ls=look)
    if layout.plate:
        circle(ax, side * layout.centre[0], layout.centre[1], layout.plate)
        for bore in pad.solids[1].bores:
            circle(ax, side * bore.x, bore.y, bore.radius)
    for number, (x, y) in enumerate(layout.ports if behind else layout.places, start=1):
        circle(ax, side * x, y, layout.cell.port.root if behind else layout.domes[number - 1].outer_radius)
        if behind:
            circle(ax, side * x, y, layout.cell.port.hollow[0][0], lw=0.5)
        ax.text(side * x, y, str(number), ha="center", va="center", fontsize=7, **BOLD)
    u, v = side * layout.centre[0], layout.centre[1]
    ax.set(xlim=(u - reach, u + reach), ylim=(v - reach, v + reach), aspect="equal", xlabel="x, mm", ylabel="y, mm")
    ax.set_title("from behind: ports" if behind else "from the front: cells")
    if behind:
        ax.set_xlabel("-x, mm")
    ax.grid(visible=False)
