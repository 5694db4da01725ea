"""Charts of a graded membrane: its resins and modulus along the arc, and its response beside constant mixes."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.arrays import Array
from pneutouch.evaluation.sheet_data import ComparedMembrane, SheetData
from pneutouch.report.blocks import Plot
from pneutouch.report.chart import SIZE, Chart, Note, Panel, PlotLine, drawn_svg
from pneutouch.report.curves import predicted_press, rises, sensitivities
from pneutouch.report.pictures import GRADE_COLOURS, greatest_share
from pneutouch.report.style import ACCENT, INK, LINES, figure, svg
from pneutouch.shape.dome import DomeShape
from pneutouch.spec.material import ArcGrading
from pneutouch.units import KPA

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_CELLS = 90
"""Number of cells along the arc of the shaded section; more would not be seen."""


def grade_section(sheet: SheetData) -> Plot | None:
    """Half sections of the dome shaded by the stiff resin's fraction; None without a grade."""
    material = sheet.scene.membrane_material
    if material.along is None:
        return None
    with figure(SIZE[0], 1.15 * SIZE[1]) as drawn:
        ax = drawn.add_subplot()
        _section(ax, material.along, sheet.scene.design.membrane.dome, material.base_resins[-1])
        return Plot(svg(drawn), "Half sections of the wall: the stiff resin's share, laid droplet by droplet.")


def grade_share(sheet: SheetData) -> Plot | None:
    """Share of the stiff resin along the arc; None without a grade."""
    material = sheet.scene.membrane_material
    if material.along is None:
        return None
    words = (
        "Share of the stiff resin along the arc from the pole to the rim. The mixing curve behind it is assumed, see "
        "the sources."
    )
    share, label = 100 * np.array(material.along.stiff_fraction), f"{material.base_resins[-1]}  (% of the volume)"
    return Plot(_along(material.along, share, label), words)


def grade_modulus(sheet: SheetData) -> Plot | None:
    """Shear modulus along the arc, and its mean; None without a grade."""
    material = sheet.scene.membrane_material
    if material.along is None:
        return None
    mean = None if material.shear_modulus_MPa is None else material.shear_modulus_MPa.nominal
    modulus = np.array(material.along.shear_modulus_MPa)
    return Plot(_along(material.along, modulus, "shear modulus  (MPa)", mean), "Modulus along the arc, and its mean.")


def _along(along: ArcGrading, values: Array, label: str, mean: float | None = None) -> str:
    """SVG of values (n,) along the arc from the pole to the rim, with a line at ``mean`` in MPa if it is given."""
    lines, notes = [PlotLine(along.arc, values, tone=ACCENT, width=1.8)], []
    if mean is not None:
        lines.append(PlotLine((0, 1), (mean, mean), width=0.8, dashes=LINES[1]))
        notes.append(Note(f"mean {mean:.2f} MPa", (0.5, mean)))
    top = (0, 1.08 * float(values.max()) or 1.0)
    panel = Panel("arc from the pole (0) to the rim (1)", label, tuple(lines), tuple(notes), xlim=(0, 1), ylim=top)
    return drawn_svg(Chart((panel,), (SIZE[0], 0.75 * SIZE[1])))


def _section(ax: "Axes", along: ArcGrading, shape: DomeShape, stiff: str) -> None:
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import LinearSegmentedColormap

    edges = np.linspace(0.0, 1.0, _CELLS + 1)
    low, high = np.moveaxis(shape.points(1.0 - edges, np.array([0.0, 1.0])), 1, 0)
    cells = np.stack([low[:-1], low[1:], high[1:], high[:-1]], axis=1)
    share = 100 * np.interp(0.5 * (edges[1:] + edges[:-1]), along.arc, along.stiff_fraction)
    shades = LinearSegmentedColormap.from_list("stiff", GRADE_COLOURS)
    for side in (1.0, -1.0):
        wall_cells = PolyCollection(
            list(cells * np.array([side, 1.0])), array=share, cmap=shades, edgecolors="face", linewidths=0.2
        )
        wall_cells.set_clim(0.0, 100 * greatest_share(along))
        ax.add_collection(wall_cells)
        for line in (low, high):
            ax.plot(side * line[:, 0], line[:, 1], color=INK, lw=0.8)
        ax.plot(side * np.array([shape.inner_radius, shape.outer_radius]), [0, 0], color=INK, lw=0.8)
    reach = 1.06 * max(shape.outer_radius, shape.outer_height)
    ax.set(
        xlim=(-reach, reach), ylim=(-0.06 * reach, reach), aspect="equal", xlabel="radius  (mm)", ylabel="height  (mm)"
    )
    ax.grid(visible=False)
    scale = ax.figure.colorbar(wall_cells, ax=ax, location="top", shrink=0.8, aspect=30)
    scale.set_label(f"{stiff}  (% of the volume)", fontsize=7)
    scale.outline.set_linewidth(0.5)


def graded_sensitivity(sheet: SheetData) -> Plot | None:
    """Sensitivity over driving pressure, of the graded and of constant membranes; None without a grade."""
    if sheet.scene.membrane_material.along is None:
        return None
    lines = []
    for one, look in _compared(sheet):
        figures = [(s.driving_pressure / KPA, s.figures.sensitivity) for s in one.states if s.figures]
        x, y = np.array(figures).reshape(-1, 2).T
        lines.append(replace(look, x=x, y=y, marker="o", size=3))
    words = (
        "The graded membrane against constant ones of its size, all by the solid: as stiff throughout as at its "
        "softest, on average and at its stiffest. Sensitivity over driving pressure."
    )
    return Plot(drawn_svg(sensitivities(lines)), words)


def graded_response(sheet: SheetData) -> Plot | None:
    """Pressure rise over force at the highest driving pressure, of the same membranes; None without a grade."""
    if sheet.scene.membrane_material.along is None:
        return None
    panel = rises([predicted_press(one.states[-1], look) for one, look in _compared(sheet)])
    at = f"contact force at {sheet.prediction.states[-1].driving_pressure / KPA:g} kPa  (N)"
    words = "The same membranes: response at the highest driving pressure."
    return Plot(drawn_svg(replace(panel, x=at)), words)


def _compared(sheet: SheetData) -> list[tuple[ComparedMembrane, PlotLine]]:
    """Every membrane with its line style, the graded one last and drawn on top."""
    looks = [PlotLine(end=one.label, width=0.9, dashes=LINES[1 + k % 4]) for k, one in enumerate(sheet.constants)]
    graded = ComparedMembrane("graded", sheet.prediction.states)
    picked = PlotLine(end=graded.label, tone=ACCENT, width=2.0, picked=True, over=4)
    return [*zip(sheet.constants, looks, strict=True), (graded, picked)]
