"""Print sheet of a specimen, its drawing on one page, and the record of its true patterns, to compare scans with."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from pneutouch.body.solid import manifold_of
from pneutouch.parts.specimen import Mesh, PatternGeometry
from pneutouch.printability import Finding
from pneutouch.report.pages import filled
from pneutouch.report.section import loops_path
from pneutouch.report.style import ACCENT, BOLD, INK, MUTED, figure, halo, svg
from pneutouch.results.specimen import BlockRecord, PatternLayer, ScanPathRecord, SpecimenRecord
from pneutouch.spec.specimen import Layer
from pneutouch.units import grams
from pneutouch.workflows.specimen.draw import SpecimenBodies

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


_DECIMALS = 6


def specimen_record(drawn: SpecimenBodies) -> SpecimenRecord:
    """Record of block, path and layers, in the block's frame of reference."""
    scene, block = drawn.scene, drawn.scene.specimen.block
    volumes = {body.name: body.volume for body in drawn.bodies}
    return SpecimenRecord(
        name=scene.name,
        title=scene.specimen.document.title,
        block=BlockRecord(block.length_mm, block.width_mm, block.height_mm, _rounded(scene.block.volume)),
        materials={body.name: body.material.label for body in drawn.bodies},
        volumes_mm3={name: _rounded(volume) for name, volume in volumes.items()},
        inclusion_fraction=_rounded(volumes["inclusion"] / scene.block.volume),
        block_to_print_frame_mm=tuple(drawn.offset.tolist()),
        scan=ScanPathRecord(scene.specimen.scan.speed_mm_per_s, "x", block.height_mm),
        layers=tuple(_layer(drawn, *layer) for layer in _layers(drawn)),
    )


def _layers(drawn: SpecimenBodies) -> list[tuple[str, Layer, PatternGeometry, list[float]]]:
    """Layers by name, or by number from 1 without one, with pattern and frequencies, Hz, at the speed of the scan."""
    speed, pairs = (
        drawn.scene.specimen.scan.speed_mm_per_s,
        zip(drawn.scene.specimen.layer, drawn.patterns, strict=True),
    )
    return [
        (layer.name or f"layer {number}", layer, pattern, [speed / pitch for pitch in pattern.pitches])
        for number, (layer, pattern) in enumerate(pairs, start=1)
    ]


def _layer(
    drawn: SpecimenBodies, name: str, layer: Layer, pattern: PatternGeometry, frequencies: list[float]
) -> PatternLayer:
    top, low, high = drawn.scene.block.high[2], pattern.box.low, pattern.box.high
    return PatternLayer(
        name=name,
        kind=layer.kind,
        pitches_mm=tuple(map(_rounded, pattern.pitches)),
        frequencies_Hz=tuple(map(_rounded, frequencies)),
        depth_mm=_rounded(top - high[2]),
        bottom_depth_mm=_rounded(top - low[2]),
        start_mm=_rounded(low[0]),
        end_mm=_rounded(high[0]),
        width_mm_range=(_rounded(low[1]), _rounded(high[1])),
        volume_mm3=_rounded(pattern.mesh.volume),
        exact_volume_mm3=None if pattern.volume is None else _rounded(pattern.volume),
        pattern={key: _rounded(value) if isinstance(value, float) else value for key, value in pattern.truth.items()},
    )


def _rounded(value: float) -> float:
    return round(float(value), _DECIMALS) + 0.0


def sheet(drawn: SpecimenBodies, findings: list[Finding], input_hash: str, left_out: Mapping[str, str]) -> str:
    """Print sheet as Markdown, for the operator, who chooses resins; ``left_out``: files not written, and why."""
    return filled(
        "specimen.md.j2",
        scene=drawn.scene,
        document=drawn.scene.specimen.document,
        bodies=drawn.bodies,
        layers=_layers(drawn),
        top=drawn.scene.block.high[2],
        grams=grams,
        findings=findings,
        input_hash=input_hash,
        left_out=left_out,
    )


_WIDTH = 180.0
"""Width of the drawing, mm."""

_ASIDE = 0.011
"""Distance of the section from the middle, mm, so that it runs along no face of a lattice."""

_LINE = 5.0
"""Height of a line of the table, mm."""


def drawing_svg(drawn: SpecimenBodies) -> bytes:
    """SVG of the section along the path and a table of the layers; the same bytes every time."""
    box, frame = drawn.scene.block, drawn.scene.specimen.frame
    under = 0.0 if frame is None else frame.thickness_mm
    aside = 0.0 if frame is None else frame.border_mm
    length = box.high[0] + 2 * aside
    height = (box.high[2] + under + 7.0) * (_WIDTH - 18.0) / (1.06 * length)
    table = _LINE * (len(drawn.patterns) + 2.5)
    with figure(_WIDTH, height + table + 18.0) as page:
        upper, lower = page.subplots(2, 1, height_ratios=[height + 14.0, table])
        _section(upper, drawn, under, aside)
        _table(lower, drawn)
        _head(page, drawn)
        return svg(page).encode()


def _head(page: Figure, drawn: SpecimenBodies) -> None:
    document, block = drawn.scene.specimen.document, drawn.scene.specimen.block
    text = (
        f"{document.title}, revision {document.revision}: {block.length_mm:g} x {block.width_mm:g} x "
        f"{block.height_mm:g} mm, section along the path at y = {0.5 * block.width_mm:g} mm"
    )
    page.suptitle(text, x=0.01, ha="left", fontsize=8.5, **BOLD)


def _section(ax: Axes, drawn: SpecimenBodies, under: float, aside: float) -> None:
    from matplotlib.patches import Rectangle

    box, scene = drawn.scene.block, drawn.scene
    top, end = box.high[2], box.high[0]
    ax.add_patch(Rectangle((0, 0), end, top, facecolor=scene.matrix.colour, edgecolor="none", zorder=1))
    if under:
        colour = drawn.bodies[2].material.colour
        ax.add_patch(
            Rectangle((-aside, -under), end + 2 * aside, under, facecolor=colour, edgecolor=INK, lw=0.6, zorder=1)
        )
    for pattern in drawn.patterns:
        _cut(ax, pattern, scene.inclusion.colour)
    ax.add_patch(Rectangle((0, 0), end, top, fill=False, edgecolor=INK, lw=0.8, zorder=4))
    for number, pattern in enumerate(drawn.patterns):
        _label(ax, number, pattern)
    speed = scene.specimen.scan.speed_mm_per_s
    ax.annotate(
        "", (0.24 * end, top + 4.2), (0, top + 4.2), arrowprops={"arrowstyle": "-|>", "color": ACCENT, "lw": 1.0}
    )
    ax.text(0.25 * end, top + 4.2, f"scan, {speed:g} mm/s", color=ACCENT, va="center", fontsize=7)
    ax.set_xlim(-aside - 0.03 * end, end + aside + 0.03 * end)
    ax.set_ylim(-under - 0.5, top + 6.0)
    ax.set_aspect("equal")
    ax.set_xlabel("x along the path, mm")
    ax.set_ylabel("z, mm")
    ax.grid(visible=False)


def _cut(ax: Axes, pattern: PatternGeometry, colour: str) -> None:
    from matplotlib.patches import PathPatch

    polygons = section(pattern.mesh, 0.5 * (pattern.box.low[1] + pattern.box.high[1]) + _ASIDE)
    if not polygons:
        return
    look = {"edgecolor": INK, "lw": 0.4, "hatch": "////", "zorder": 2}
    ax.add_patch(PathPatch(loops_path(polygons), facecolor=colour, **look))


def section(mesh: Mesh, y: float) -> list[Any]:
    """Loops, (n, 2) each in (x, z), mm, of a closed mesh cut at ``y``."""
    # x, z and y as the kernel's x, y and z: the swap mirrors, so the triangles are turned round.
    whole = manifold_of(mesh.vertices[:, [0, 2, 1]], mesh.triangles[:, ::-1])
    return list(whole.slice(y).to_polygons())


def _label(ax: Axes, number: int, pattern: PatternGeometry) -> None:
    """Draw the layer's number in its middle, and its first pitch as a dimension if that fits."""
    low, high = pattern.box.low, pattern.box.high
    middle = 0.5 * (low[2] + high[2])
    ax.text(
        0.5 * (low[0] + high[0]),
        middle,
        str(number + 1),
        ha="center",
        va="center",
        fontsize=8,
        zorder=6,
        path_effects=halo(),
        **BOLD,
    )
    pitch = pattern.pitches[0]
    if low[0] + pitch > high[0]:
        return
    height = low[2] - 0.75
    ax.annotate(
        "",
        (low[0] + pitch, height),
        (low[0], height),
        zorder=5,
        arrowprops={"arrowstyle": "<|-|>", "color": INK, "lw": 0.5, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 5},
    )
    for x in (low[0], low[0] + pitch):
        ax.plot([x, x], [height - 0.25, low[2]], color=INK, lw=0.4, zorder=5)
    ax.text(low[0] + pitch + 0.4, height, f"{pitch:.4g}", va="center", fontsize=6.5, zorder=6, path_effects=halo())


def _table(ax: Axes, drawn: SpecimenBodies) -> None:
    """Draw a table of the layers under the section."""
    ax.set_axis_off()
    ax.set_xlim(0, 1)
    rows, top = len(drawn.patterns), drawn.scene.block.high[2]
    ax.set_ylim(-rows - 1.5, 1.0)
    columns = (0.0, 0.045, 0.29, 0.43, 0.57, 0.73, 0.87)
    heads = ("", "layer", "kind", "pitch, mm", "frequency, Hz", "depth, mm", "x, mm")
    lines = [heads]
    for number, (name, layer, pattern, frequencies) in enumerate(_layers(drawn), start=1):
        low, high = pattern.box.low, pattern.box.high
        lines.append(
            (
                str(number),
                name,
                layer.kind,
                _several(list(pattern.pitches)),
                _several(frequencies),
                f"{top - high[2]:.4g} to {top - low[2]:.4g}",
                f"{low[0]:.4g} to {high[0]:.4g}",
            )
        )
    for k, line in enumerate(lines):
        for x, text in zip(columns, line, strict=True):
            ax.text(x, -k, text, fontsize=7, va="center", color=MUTED if k == 0 else INK, parse_math=False)
    materials = ", ".join(f"{body.name}: {body.material.label}" for body in drawn.bodies)
    ax.text(0.0, -rows - 1.2, f"{materials}; patterns hatched", fontsize=6.5, color=MUTED, va="center")


def _several(values: list[float]) -> str:
    text = ", ".join(f"{value:.3g}" for value in values[:3])
    return text if len(values) <= 3 else f"{text} ..."
