"""The paper's membrane as a mesh: too coarse, crossing itself, off its connector, printed with its face down."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from pictures.rules.case import Case, Pair, assembled, item_of, of_rule, window
from pneutouch.arrays import Array
from pneutouch.body import Body
from pneutouch.body.section import mesh_outline, section_outline
from pneutouch.evaluation.subject import subject_of
from pneutouch.printability import PrintSubject
from pneutouch.printability.inspection import inspect
from pneutouch.printability.rulebook import RULES
from pneutouch.printability.view import PrintView
from pneutouch.report.section import draw_loops, leader
from pneutouch.report.style import FAINT, INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def mesh() -> Pair:
    """The membrane meshed within the printer's step and far beyond it."""
    return _meshed(0.016), _meshed(0.3)


def _meshed(tolerance: float) -> Case:
    assembly = assembled("paper-dome")
    whole, solid = item_of(assembly, "membrane"), assembly.solid("membrane")
    coarse = replace(whole, body=solid.mesh(tolerance))

    def draw(ax: Axes) -> None:
        draw_loops(ax, mesh_outline(coarse.body), "membrane")
        for loop in section_outline(solid, 1e-3):
            ax.plot(*np.vstack([loop, loop[:1]]).T, color=INK, lw=0.5, ls=(0, (4, 2)))
        window(ax, -0.5, 12.5, 5.5, 11.2)

    return Case(f"meshed within {tolerance:g} mm", of_rule("mesh", coarse), draw)


def contact_faces() -> Pair:
    """The membrane in its seat, and half a millimetre above it."""
    return _seated(0.0), _seated(0.5)


def _seated(lift: float) -> Case:
    subject = subject_of(assembled("paper-dome"))
    items = tuple(
        replace(item, body=_moved(item.body, lift)) if item.body.name == "membrane" else item for item in subject.items
    )
    findings = RULES["contact faces"](PrintView(PrintSubject(items, subject.joints)))

    def draw(ax: Axes) -> None:
        for item in items:
            draw_loops(ax, mesh_outline(item.body), item.body.role)
        window(ax, 6, 20, -5, 2)

    return Case(f"{lift:g} mm above its seat" if lift else "in its seat", findings, draw)


def _moved(body: Body, lift: float) -> Body:
    return replace(body, vertices=body.vertices + np.array([0.0, 0.0, lift]))


def matte() -> Pair:
    """The membrane printed with its dome up and down."""
    return _printed("dome up", 1.0), _printed("dome down", -1.0)


def _printed(label: str, up: float) -> Case:
    membrane = replace(item_of(assembled("paper-dome"), "membrane"), up=(0.0, 0.0, up))

    def draw(ax: Axes) -> None:
        loops = [loop * np.array([1.0, up]) for loop in mesh_outline(membrane.body)]
        x = np.linspace(*_span(loops, 0), 401)[1:-1]
        lowest, tray = _lowest(loops, x), _span(loops, 1)[0] - 0.4
        ax.fill_between(x, tray, lowest, facecolor=FAINT, edgecolor="none")
        draw_loops(ax, loops, "membrane")
        ax.plot(_span(loops, 0), [tray, tray], color=INK, lw=2)
        leader(ax, (7.0, tray + 0.8), (14.5, 6.0 * up + 3.0 * (1 - up) / 2), "support", "left")

    return Case(label, of_rule("matte", membrane), draw)


def _span(loops: list[Array], axis: int) -> tuple[float, float]:
    points = np.concatenate(loops)[:, axis]
    return float(points.min()), float(points.max())


def _lowest(loops: list[Array], x: Array) -> Array:
    """Height of the lowest point of a section over each place in x."""
    lowest = np.full(x.size, np.inf)
    for loop in loops:
        for (x0, z0), (x1, z1) in zip(loop, np.roll(loop, -1, axis=0), strict=True):
            if x0 == x1:
                continue
            share = (x - x0) / (x1 - x0)
            here = np.where((share >= 0) & (share <= 1), z0 + share * (z1 - z0), np.inf)
            lowest = np.minimum(lowest, here)
    return lowest


def deep() -> Pair:
    """Two shells of one body: joined, and crossing one another."""
    from tests.printability.gallery import ball, body_of

    one, other = ball(6, sides=48), ball(6, (7.0, 0.0, 0.0), 48)
    joined, parts = body_of(one + other), [body_of(one), body_of(other)]
    crossing = Body(
        "part",
        joined.role,
        joined.material,
        np.concatenate([part.vertices for part in parts]),
        np.concatenate([parts[0].triangles, parts[1].triangles + len(parts[0].vertices)]),
    )

    def drawn(bodies: list[Body]) -> Callable[[Axes], None]:
        def draw(ax: Axes) -> None:
            for body in bodies:
                for loop in mesh_outline(body):
                    ax.plot(*np.vstack([loop, loop[:1]]).T, color=INK, lw=0.9)

        return draw

    return (
        Case("one closed shell", inspect(joined), drawn([joined])),
        Case("two shells that cross", inspect(crossing), drawn(parts)),
    )


EXHIBITS = {"mesh": mesh, "contact faces": contact_faces, "matte": matte, "deep": deep}
