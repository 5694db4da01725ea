"""Pictures of a graded membrane: how its two resins are laid out, and its effect compared with constant mixes.

Additions to a datasheet for a graded membrane: two pictures, and the constant mixes it is compared with.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.arrays import Array
from pneutouch.catalogue import ResolvedDesign
from pneutouch.evaluation.sheet_data import ComparedMembrane, SheetData
from pneutouch.report.pictures import GRADE_COLOURS, greatest_share
from pneutouch.report.style import ACCENT, BOLD, INK, LINES, MUTED, Label, figure, label_ends, note, svg
from pneutouch.shape.dome import DomeShape
from pneutouch.spec.material import ArcGrading, Material
from pneutouch.units import KPA

if TYPE_CHECKING:
    from matplotlib.axes import Axes


_CELLS = 90
"""Cells along the arc of the shaded section; one more would not be seen."""
_SIZE = (86.0, 62.0)
"""Width and height of a picture in mm: two in a row on A4."""


def grade_figures(material: Material, scene: ResolvedDesign) -> dict[str, str]:
    """Half section of the dome shaded by the stiff resin's fraction, and fraction and modulus along the arc, as SVG.

    ``material`` must be graded.
    """
    assert material.along is not None
    stiff, along = material.base_resins[-1], material.along
    with figure(_SIZE[0], 1.15 * _SIZE[1]) as drawn:
        _section(drawn.add_subplot(), along, scene.design.membrane.dome, stiff)
        section = svg(drawn)
    mean = material.shear_modulus_MPa
    return {
        "grade-section": section,
        "grade-share": _along(along, 100 * np.array(along.stiff_fraction), f"{stiff}  (% of the volume)"),
        "grade-modulus": _along(
            along, np.array(along.shear_modulus_MPa), "shear modulus  (MPa)", None if mean is None else mean.nominal
        ),
    }


def _along(along: ArcGrading, values: Array, label: str, mean: float | None = None) -> str:
    """A value along the arc from the pole to the rim."""
    with figure(_SIZE[0], 0.75 * _SIZE[1]) as drawn:
        ax = drawn.add_subplot()
        ax.plot(along.arc, values, color=ACCENT, lw=1.8)
        if mean is not None:
            ax.axhline(mean, color=INK, lw=0.8, ls=LINES[1])
            note(ax, f"mean {mean:.2f} MPa", (0.5, mean))
        ax.set(ylabel=label, ylim=(0, 1.08 * float(values.max()) or 1.0))
        ax.set(xlim=(0, 1), xticks=[0, 0.5, 1], xticklabels=["pole", "arc", "rim"])
        return svg(drawn)


def _section(ax: Axes, along: ArcGrading, shape: DomeShape, stiff: str) -> None:
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


def graded_against_constant(graded: ComparedMembrane, constants: Sequence[ComparedMembrane]) -> dict[str, str]:
    """Sensitivity over driving pressure, and pressure rise over force at the highest, graded and constant, as SVG."""
    charts = {}
    for name, draw in (("graded-sensitivity", _sensitivities), ("graded-response", _rises)):
        with figure(*_SIZE) as drawn:
            draw(drawn.add_subplot(), graded, constants)
            charts[name] = svg(drawn)
    return charts


def _looks(
    graded: ComparedMembrane, constants: Sequence[ComparedMembrane]
) -> list[tuple[ComparedMembrane, dict[str, object], dict[str, object]]]:
    """Every membrane with the look of its line and of its label, the graded one last and on top."""
    lines = [
        (one, {"color": INK, "lw": 0.9, "ls": LINES[1 + k % 4]}, {"fontsize": 6.5, "color": MUTED})
        for k, one in enumerate(constants)
    ]
    return [*lines, (graded, {"color": ACCENT, "lw": 2.0, "zorder": 4}, {"fontsize": 6.5, "color": INK, **BOLD})]


def _sensitivities(ax: Axes, graded: ComparedMembrane, constants: Sequence[ComparedMembrane]) -> None:
    ends: list[Label] = []
    for one, line, look in _looks(graded, constants):
        points = [
            (s.driving_pressure / KPA, s.figures.sensitivity_kPa_per_N) for s in one.states if s.figures is not None
        ]
        if not points:
            continue
        x, y = np.array(points).T
        ax.plot(x, y, marker="o", ms=3, mfc="white", **line)  # type: ignore[arg-type]
        ends.append((float(x[-1]), float(y[-1]), one.label, dict(look)))
    ax.set(xlabel="driving pressure  (kPa)", ylabel="sensitivity  (kPa/N)", ylim=(0, None), xlim=(0, None))
    label_ends(ax, ends)


def _rises(ax: Axes, graded: ComparedMembrane, constants: Sequence[ComparedMembrane]) -> None:
    ends: list[Label] = []
    for one, line, look in _looks(graded, constants):
        state = one.states[-1]
        keep = state.indentation <= state.range_end * (1 + 1e-9)
        force, rise_kPa = state.force[keep], state.pressure_rise[keep] / KPA
        ax.plot(force, rise_kPa, **line)  # type: ignore[arg-type]
        ends.append((float(force[-1]), float(rise_kPa[-1]), one.label, dict(look)))
    at = graded.states[-1].driving_pressure / KPA
    ax.set(xlabel=f"contact force at {at:g} kPa  (N)", ylabel="pressure rise  (kPa)", ylim=(0, None), xlim=(0, None))
    label_ends(ax, ends)


CAPTIONS = {
    "grade-section": "Half sections of the wall: the stiff resin's share, laid droplet by droplet.",
    "grade-share": "Share of the stiff resin along the arc from the pole to the rim. The mixing curve behind it is "
    "assumed, see the sources.",
    "grade-modulus": "Modulus along the arc, and its mean.",
    "graded-sensitivity": "The graded membrane against constant ones of its size, all by the solid: as stiff "
    "throughout as at its softest, on average and at its stiffest. Sensitivity over driving pressure.",
    "graded-response": "The same membranes: response at the highest driving pressure.",
}


def graded_figures(sheet: SheetData) -> dict[str, str]:
    """The figures that `CAPTIONS` names as SVG for a graded membrane; nothing for any other."""
    if sheet.scene.membrane_material.along is None:
        return {}
    return {
        **grade_figures(sheet.scene.membrane_material, sheet.scene),
        **graded_against_constant(ComparedMembrane("graded", sheet.prediction.states), sheet.constants),
    }
