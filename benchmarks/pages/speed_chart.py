"""The chart of speed against accuracy."""

from __future__ import annotations

import statistics
from typing import TYPE_CHECKING, Any

from benchmarks.models import AT_ONCE, ATLAS, MODEL_METHODS
from benchmarks.pages import off_axis_speed
from benchmarks.peers import WITHIN
from benchmarks.speed_accuracy import METHODS
from pneutouch.report.style import ACCENT, FAINT, INK, LINES, MARKERS, MUTED, figure, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DEFAULT = "solid default"
SENSITIVITY_TARGET = 0.01
CUT = 0.8
"""A range shorter than this share of the reference's counts as cut: an event that the reference does not have."""


def of(rows: list[dict[str, Any]], method: str) -> list[dict[str, Any]]:
    """The rows in which a method has an answer."""
    return [row for row in rows if row["method"] == method and row["processor_s"] is not None]


def sizes(rows: list[dict[str, Any]], key: str) -> list[float]:
    """Absolute errors of rows that have one."""
    return [abs(row[key]) for row in rows if row[key] is not None]


def front(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Points (cost, error) that no other beats in both, by rising cost."""
    kept: list[tuple[float, float]] = []
    for cost, error in sorted(points):
        if not kept or error < kept[-1][1]:
            kept.append((cost, error))
    return kept


def chart(data: dict[str, Any], peers: dict[str, Any], off_axis: list[dict[str, Any]]) -> str:
    """Log-log panels: sensitivity over the work of both studies, limit pressure over the inflation sweep, and below them
    the forces off the axis in scenes of `off_axis_calculix`."""
    scenes = off_axis_speed.measured(off_axis)
    with figure(178, 176) as drawn:
        upper, lower = drawn.subfigures(2, 1)
        left, right = upper.subplots(1, 2)
        _sensitivity_panel(left, data)
        _limit_panel(right, data, peers)
        for ax, scene in zip(lower.subplots(1, len(scenes), squeeze=False)[0], scenes, strict=True):
            off_axis_speed.panel(ax, scene)
        return svg(drawn)


_ASIDE = {"8×1": -6, "12×1": -4, "16×1": 4, "24×1": 8}
"""Points by which the labels of meshes that stand at nearly one cost are moved."""


def _front_line(ax: Axes, points: list[tuple[float, float]]) -> None:
    line = front(points)
    ax.plot(*zip(*line, strict=True), color=FAINT, lw=5, solid_capstyle="round", zorder=0, label="Pareto front")


def _sensitivity_panel(ax: Axes, data: dict[str, Any]) -> None:
    points = []
    for method in METHODS:
        rows = of(data["rows"], method)
        errors = [100 * e for e in sizes(rows, "sensitivity_error")]
        cost = 1e3 * statistics.median(row["processor_s"] for row in rows)
        middle, worst = statistics.median(errors), max(errors)
        membrane, chosen, table = method.startswith("membrane"), method == DEFAULT, method in MODEL_METHODS
        marker = MARKERS[2] if membrane else (MARKERS[3] if chosen else MARKERS[1 if table else 0])
        colour = MUTED if membrane else (ACCENT if chosen or table else INK)
        cut = sum(row["range_share"] < CUT for row in rows) > len(rows) // 4
        ax.plot([cost, cost], [middle, worst], color=colour, lw=0.8, zorder=2)
        ax.plot(cost, worst, marker="_", color=colour, ms=5, zorder=2)
        face = "white" if cut and not membrane else colour
        ax.plot(cost, middle, marker=marker, color=colour, mfc=face, ms=6 if chosen else 4, ls="", zorder=3)
        label = method.replace("membrane ", "").replace("solid ", "").replace(" x ", "×")
        if membrane or table:
            # The atlas and what takes it stand at nearly one cost.
            place, side = ((-6, 6), "right") if method == ATLAS else ((6, 0 if membrane else -5), "left")
            words = {"xytext": place, "textcoords": "offset points", "ha": side, "va": "center"}
            ax.annotate(label, (cost, middle), **words, fontsize=6, color=colour)
        else:
            aside = _ASIDE.get(label, 0)
            ax.annotate(
                label,
                (cost, worst),
                xytext=(aside, 4),
                textcoords="offset points",
                ha="center",
                rotation=90,
                fontsize=6,
                color=colour,
            )
        if not cut or membrane:
            points.append((cost, middle))
    errors = [100 * e for e in sizes(of(data["rows"], ATLAS), "sensitivity_error")]
    many = 1e3 * data["atlas_at_once_s"], statistics.median(errors)
    ax.plot(*many, marker=MARKERS[1], color=ACCENT, mfc="white", ls="", ms=4, zorder=3)
    ax.annotate(
        f"atlas,\n{AT_ONCE:,} at once",
        many,
        xytext=(0, 6),
        textcoords="offset points",
        ha="left",
        fontsize=6,
        color=ACCENT,
    )
    _front_line(ax, [*points, many])
    ax.legend(loc="upper right", fontsize=6)
    ax.axhline(100 * SENSITIVITY_TARGET, color=MUTED, lw=0.5)
    ax.text(
        0.02, 100 * SENSITIVITY_TARGET, "1 %", transform=ax.get_yaxis_transform(), fontsize=6, va="bottom", color=MUTED
    )
    ax.set(
        xscale="log",
        yscale="log",
        xlabel="processor time, studies 1 and 2 in 14 steps  (ms)",
        ylabel="error of sensitivity, median to worst scene  (%)",
    )


def _limit_panel(ax: Axes, data: dict[str, Any], peers: dict[str, Any]) -> None:
    points = []
    looks = [
        (MARKERS[0], ACCENT, "-"),
        (MARKERS[1], INK, LINES[1]),
        (MARKERS[4], INK, LINES[2]),
        (MARKERS[2], MUTED, LINES[3]),
    ]
    names = list(dict.fromkeys(row["program"] for row in peers["rows"]))
    for k, name in enumerate(names):
        rows = [row for row in peers["rows"] if row["program"] == name]
        marker, colour, line = looks[k % len(looks)]
        errors = [max(100 * abs(row["limit_error"]), 1e-3) for row in rows]
        cost = [1e3 * row["solve_s"] for row in rows]
        points += zip(cost, errors, strict=True)
        ax.plot(
            cost, errors, marker=marker, color=colour, ls=line, lw=1.6 if k == 0 else 0.9, label=f"{name}, solve alone"
        )
        ax.plot(
            [1e3 * row["whole_s"] for row in rows], errors, marker=marker, mfc="white", color=colour, ls="", zorder=2
        )
    ax.plot([], [], marker="o", mfc="white", color=INK, ls="", label="hollow: whole process")
    _front_line(ax, points)
    ax.axhline(100 * WITHIN, color=MUTED, lw=0.5)
    ax.set(
        xscale="log",
        yscale="log",
        xlabel="processor time, inflation through the limit point  (ms)",
        ylabel="error of limit pressure, paper's sensor  (%)",
    )
    ax.text(0.02, 100 * WITHIN, "0.5 %", transform=ax.get_yaxis_transform(), fontsize=6, va="bottom", color=MUTED)
    ax.set_ylim(top=25)
    ax.legend(loc="upper left", fontsize=6, ncols=1)
