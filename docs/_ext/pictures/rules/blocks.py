"""Blocks with one feature each, for the rules on features that no parameter of a sensor sets alone."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from tests.printability.gallery import ball, box, item, printer, prism, rod

from pictures.rules.case import Case, Pair, of_rule
from pneutouch.body.section import mesh_outline
from pneutouch.printability import PrintItem
from pneutouch.printability.rules.resins import check_stack
from pneutouch.report.section import draw_loops, horizontal, leader, vertical
from pneutouch.report.style import INK

if TYPE_CHECKING:
    from manifold3d import Manifold
    from matplotlib.axes import Axes

_MIDDLE = 6.0
"""Place of the section in y, mm: every block is 12 mm deep."""


def _case(rule: str, label: str, shape: Manifold, at: tuple[float, float], text: str) -> Case:
    """A block, with a note at a point (x, z) of its section."""
    block = item(shape)
    loops = mesh_outline(block.body, _MIDDLE)

    def draw(ax: Axes) -> None:
        draw_loops(ax, loops, "connector")
        high = max(float(loop[:, 1].max()) for loop in loops)
        leader(ax, at, (14.0, high - 1.0), text, "left")
        ax.set_xlim(-0.5, 21)

    return Case(label, of_rule(rule, block), draw)


def _pin(width: float) -> Manifold:
    return box(12, 12, 3) + rod(0.5 * width, 6, (6, 6, 2))


def pins() -> Pair:
    """A slender pin breaks under the water jet."""
    return tuple(
        _case("pins", f"pin of {width:g} mm", _pin(width), (6 + 0.5 * width, 6), f"Ø{width:g}") for width in (1.2, 0.4)
    )


def holes() -> Pair:
    """Through a plate thinner than three widths."""
    return tuple(
        _case(
            "holes",
            f"hole of {width:g} mm",
            box(12, 12, thick) - rod(0.5 * width, 5, (6, 6, -1)),
            (6 + 0.5 * width, 0.5 * thick),
            f"Ø{width:g}",
        )
        for width, thick in ((1.2, 2.0), (0.4, 1.05))
    )


def channels() -> Pair:
    """Through a block thicker than three widths."""
    return tuple(
        _case(
            "channels",
            f"channel of {width:g} mm",
            box(12, 12, 8) - rod(0.5 * width, 10, (6, 6, -1)),
            (6 + 0.5 * width, 6),
            f"Ø{width:g}",
        )
        for width in (2.2, 0.5)
    )


def gaps() -> Pair:
    """A slot from above."""
    return tuple(
        _case(
            "gaps",
            f"slot of {width:g} mm",
            box(12, 12, 8) - box(width, 14, 4, (6 - 0.5 * width, -1, 4.5)),
            (6 + 0.5 * width, 6),
            f"{width:g} wide",
        )
        for width in (0.6, 0.15)
    )


def emboss() -> Pair:
    """A ridge on a plate."""
    return tuple(
        _case(
            "emboss",
            f"ridge of {width:g} mm",
            box(12, 12, 4) + box(width, 8, 0.7, (6 - 0.5 * width, 2, 4)),
            (6 + 0.5 * width, 4.4),
            f"{width:g} wide",
        )
        for width in (0.7, 0.25)
    )


def edges() -> Pair:
    """Wedges, seen from the side."""
    shapes = ((36, 7.27), (15, 2.68))
    return tuple(
        _case(
            "edges",
            f"edge of {angle} degrees",
            prism([(0, 0), (10, 0), (10, high)], 12).rotate((90, 0, 0)).translate((0, 12, 0)),
            (0.4, 0.1),
            f"{angle}°",
        )
        for angle, high in shapes
    )


def _pot(neck: float) -> Manifold:
    return (
        box(12, 12, 12) - ball(4, (6, 6, 6), 64) - (rod(neck, 8, (6, 6, 6)) if neck else box(0.1, 0.1, 0.1, (20, 0, 0)))
    )


def hollows() -> Pair:
    """A hollow with an opening, and one without."""
    return (
        _case("hollows", "open above", _pot(3.2), (6, 6), "washed out\nfrom above"),
        _case("hollows", "closed hollow", _pot(0.0), (6, 6), "support stays"),
    )


def cleaning() -> Pair:
    """A hollow behind a neck."""
    return (
        _case("cleaning", "opening of 6.4 mm", _pot(3.2), (6 + 3.2, 10.5), "Ø6.4"),
        _case("cleaning", "opening of 2.4 mm", _pot(1.2), (6 + 1.2, 10.5), "Ø2.4"),
    )


def envelope() -> Pair:
    """A part in the build volume of the Objet260."""
    return _in_the_machine("200 mm long", 200.0), _in_the_machine("280 mm long", 280.0)


def _in_the_machine(label: str, length: float) -> Case:
    beam = item(box(length, 12, 12))
    volume = beam.printer.envelope

    def draw(ax: Axes) -> None:
        draw_loops(ax, mesh_outline(beam.body, _MIDDLE), "connector")
        ax.plot([0, volume.x, volume.x, 0, 0], [0, 0, volume.z, volume.z, 0], color=INK, lw=0.8, ls=(0, (5, 2)))
        horizontal(ax, 40, 0, length, 12, f"{length:g}")
        ax.text(0.5 * volume.x, 0.6 * volume.z, f"build volume {volume.x:g} × {volume.z:g}", ha="center")

    return Case(label, of_rule("envelope", beam), draw)


def voxels() -> Pair:
    """A plate of few slices on the J735, which sets their least number."""
    return _stack(1.0), _stack(0.3)


def _stack(high: float) -> Case:
    machine = printer("j735")
    mode = next(mode for mode in machine.mode if mode.digital_materials)
    plate: PrintItem = item(box(12, 12, high))
    count = round(high / (1e-3 * mode.layer_um))
    findings = check_stack(machine, mode, ["TangoPlus", "VeroClear"], count, (12.0, 12.0, high), "membrane")

    def draw(ax: Axes) -> None:
        for loop in mesh_outline(plate.body, _MIDDLE):
            ax.fill(*(loop * [0.2, 1.0]).T, facecolor="white", edgecolor=INK, lw=0.9)
        for k in range(1, count):
            ax.plot([0, 2.4], [k * high / count] * 2, color=INK, lw=0.3)
        vertical(ax, 2.7, 0, high, 2.4, f"{count} slices")
        ax.set_xlim(-0.1, 3.6)
        ax.set_ylim(-0.1, 1.2)

    return Case(f"{count} slices of {mode.layer_um:g} µm", findings, draw)


def resins() -> Pair:
    """Two blocks of two resins: in two jobs, and in one job of a mode that runs one resin."""
    return _two_resins("two jobs, one resin each", ("", "")), _two_resins("both in one job", ("tray", "tray"))


def _two_resins(label: str, jobs: tuple[str, str]) -> Case:
    apart = 3.0 if jobs[0] else 7.0
    low = item(box(12, 12, 4), "base", "VeroClear", job=jobs[0])
    high = replace(item(box(12, 12, 4, (12 + apart, 0, 0)), "pad", "TangoPlus"), job=jobs[1])

    def draw(ax: Axes) -> None:
        draw_loops(ax, mesh_outline(low.body, _MIDDLE), "connector")
        draw_loops(ax, mesh_outline(high.body, _MIDDLE), "membrane")
        trays = [(-1, 25 + apart)] if jobs[0] else [(-1, 13), (11 + apart, 25 + apart)]
        for left, right in trays:
            ax.plot([left, right], [-0.3, -0.3], color=INK, lw=2)
        ax.text(6, 5, "VeroClear", ha="center")
        ax.text(18 + apart, 5, "TangoPlus", ha="center")
        ax.set_ylim(-2, 9)

    return Case(label, of_rule("resins", low, high), draw)


EXHIBITS = {
    "envelope": envelope,
    "resins": resins,
    "pins": pins,
    "holes": holes,
    "channels": channels,
    "gaps": gaps,
    "emboss": emboss,
    "edges": edges,
    "hollows": hollows,
    "cleaning": cleaning,
    "voxels": voxels,
}
