"""What the comparisons of docs/background/validation.md come to: the greatest difference from each reference, as table and chart."""

from __future__ import annotations

import json
import statistics
from collections.abc import Iterable
from types import ModuleType
from typing import Any, NamedTuple

from benchmarks import calculix_friction_half, off_axis_calculix
from pneutouch.report.style import ACCENT, FAINT, INK, MARKERS, MUTED, figure, svg

OTHER_SOURCE = "FLX9995-DM"
"""Left out of the median, as on every page: its modulus comes from another source."""

EXACT, PROGRAM, MEASURED = "closed form or exact membrane", "CalculiX", "measurement (median)"


class Reference(NamedTuple):
    """One comparison: what the reference is, of which kind, what is compared, and the greatest relative difference of each figure."""

    name: str
    kind: str
    figures: str
    differences: list[float]


def references(data: dict[str, Any]) -> list[Reference]:
    """All comparisons, those with exact results first."""
    off_axis, friction = (stored(module) for module in (off_axis_calculix, calculix_friction_half))
    found = [
        Reference("thick spheres", EXACT, "limit pressure, stretch", _greatest(_sphere_errors(data))),
        Reference(
            "thin membrane, inflated", EXACT, "limit pressure, height, extrapolated to no wall", _membrane_errors(data)
        ),
        Reference(
            "thin membrane, pressed by a plate",
            EXACT,
            "cavity pressure, force, contact radius",
            _greatest([row[3::2] for row in data["pressed_membrane"]]),
        ),
        Reference("Hertz, smallest contact", EXACT, "force", [abs(data["balls"]["hertz"][-1][1])]),
        Reference(
            "pressurised shell with shear, wall of 0.0025 R",
            EXACT,
            "first stiffness under a ball",
            [max(map(abs, data["balls"]["shell"][-1]["sheared"]))],
        ),
    ]
    if data["calculix"] is not None:
        found.append(Reference("CalculiX, inflation", PROGRAM, "limit pressure", [abs(calculix_error(data))]))
    return [
        *found,
        Reference(
            "CalculiX in 3D, friction",
            PROGRAM,
            "force, pressure rise",
            [max(map(abs, calculix_friction_half.differences(friction, key))) for key in ("force_N", "rise_kPa")],
        ),
        Reference(
            "CalculiX in 3D, off the axis",
            PROGRAM,
            "force, sideways force, pressure rise",
            [max(map(abs, off_axis_calculix.differences(off_axis, key))) for key in off_axis_calculix.FIGURES],
        ),
        Reference("Table S1 of the paper, twelve cells", MEASURED, "sensitivity", [median(data, 0)]),
    ]


def stored(module: ModuleType) -> Any:
    return json.loads(module.STORED.read_text(encoding="utf-8"))


def _greatest(rows: Iterable[Iterable[float]]) -> list[float]:
    return [max(map(abs, column)) for column in zip(*rows, strict=True)]


def _sphere_errors(data: dict[str, Any]) -> list[list[float]]:
    return [[row[3] / row[2] - 1, row[5] / row[4] - 1] for row in data["spheres"]]


def _membrane_errors(data: dict[str, Any]) -> list[float]:
    p, h = data["thin_walls"]["extrapolated"]
    return [abs(p / 1.57537 - 1), abs(h / 1.69 - 1)]


def calculix_error(data: dict[str, Any]) -> float:
    return float(data["calculix"]["calculix_kPa"] / data["calculix"]["solid_kPa"] - 1)


def median(data: dict[str, Any], column: int) -> float:
    rows = [row for row in data["dead_volumes"]["rows"] if row["resin"] != OTHER_SOURCE]
    return statistics.median(abs(row["errors"][column]) for row in rows)


def percent(value: float) -> str:
    return f"{100 * value:.1f} %" if value > 5e-3 else f"{100 * value:.2g} %"


def draw(data: dict[str, Any]) -> str:
    """Greatest difference from each reference."""
    found = references(data)[::-1]
    looks = {EXACT: (MARKERS[0], ACCENT), PROGRAM: (MARKERS[1], INK), MEASURED: (MARKERS[3], MUTED)}
    with figure(165, 82) as drawn:
        ax = drawn.subplots()
        for k, one in enumerate(found):
            marker, colour = looks[one.kind]
            values = [100 * value for value in one.differences]
            ax.plot([min(values), max(values)], [k, k], color=FAINT, lw=1.2, zorder=1)
            ax.plot(values, [k] * len(values), ls="", marker=marker, color=colour, ms=4.5)
        for kind, (marker, colour) in looks.items():
            ax.plot([], [], ls="", marker=marker, color=colour, label=kind)
        ax.set_yticks(range(len(found)), [one.name for one in found])
        ticks = [1e-4, 1e-3, 1e-2, 0.1, 1, 10]
        ax.set(xscale="log", xlabel="greatest difference  (%)", xlim=(ticks[0], 20))
        ax.set_xticks(ticks, ["0.0001", *(f"{tick:g}" for tick in ticks[1:])])
        ax.grid(axis="x", color=FAINT, lw=0.4)
        drawn.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=6.5)
        return svg(drawn)
