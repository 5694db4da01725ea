"""Charts of accuracy, of speed against accuracy and of validation, drawn from the stored measurements."""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from stored_pages import stored

from pictures.outcomes import draw_outcomes
from pneutouch.report.style import ACCENT, FAINT, INK, LINES, MARKERS, MUTED, figure, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DEFAULT, ATLAS = "solid default", "atlas"
TABLES = (ATLAS, "auto at 2%")
SENSITIVITY_TARGET, LIMIT_TARGET = 0.01, 0.005
OURS = "pneutouch"
_TICKS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0)
_ASIDE = {"8×1": -6, "12×1": -4, "16×1": 4, "24×1": 8}
"""Points by which the labels of meshes that stand at nearly one cost are moved."""

Rows = list[dict[str, Any]]


def front(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Points (cost, error) that no other beats in both, by rising cost."""
    kept: list[tuple[float, float]] = []
    for cost, error in sorted(points):
        if not kept or error < kept[-1][1]:
            kept.append((cost, error))
    return kept


def speed_accuracy() -> str:
    """Sensitivity over the work of both studies, limit pressure over the inflation sweep, and forces off the axis."""
    scenes = stored("accuracy")["off_axis"]
    with figure(178, 176) as drawn:
        upper, lower = drawn.subfigures(2, 1)
        left, right = upper.subplots(1, 2)
        _sensitivity_panel(left, stored("speed-accuracy"))
        _limit_panel(right, stored("peers")["rows"])
        for ax, scene in zip(lower.subplots(1, len(scenes), squeeze=False)[0], scenes, strict=True):
            _off_axis_panel(ax, scene)
        return svg(drawn)


def _front_line(ax: Axes, points: list[tuple[float, float]]) -> None:
    line = front(points)
    ax.plot(*zip(*line, strict=True), color=FAINT, lw=5, solid_capstyle="round", zorder=0, label="Pareto front")


def _target(ax: Axes, value: float, words: str) -> None:
    ax.axhline(100 * value, color=MUTED, lw=0.5)
    place = {"transform": ax.get_yaxis_transform(), "fontsize": 6, "va": "bottom", "color": MUTED}
    ax.text(0.02, 100 * value, words, **place)


def _sensitivity_panel(ax: Axes, data: dict[str, Any]) -> None:
    points = []
    for method in dict.fromkeys(row["method"] for row in data["rows"]):
        rows = [row for row in data["rows"] if row["method"] == method and row["processor_s"] is not None]
        errors = [100 * abs(row["sensitivity_error"]) for row in rows if row["sensitivity_error"] is not None]
        cost = 1e3 * statistics.median(row["processor_s"] for row in rows)
        cut = sum(row["range_share"] < 0.8 for row in rows) > len(rows) // 4
        _mark_method(ax, method, cost, errors, cut)
        if not cut or method.startswith("membrane"):
            points.append((cost, statistics.median(errors)))
        if method == ATLAS:
            many = 1e3 * data["atlas_at_once_s"], statistics.median(errors)
    ax.plot(*many, marker=MARKERS[1], color=ACCENT, mfc="white", ls="", ms=4, zorder=3)
    place = {"xytext": (0, 6), "textcoords": "offset points", "ha": "left"}
    ax.annotate("atlas,\n1,000 at once", many, **place, fontsize=6, color=ACCENT)
    _front_line(ax, [*points, many])
    ax.legend(loc="upper right", fontsize=6)
    _target(ax, SENSITIVITY_TARGET, "1 %")
    ax.set(
        xscale="log",
        yscale="log",
        xlabel="processor time, studies 1 and 2 in 14 steps  (ms)",
        ylabel="error of sensitivity, median to worst scene  (%)",
    )


def _mark_method(ax: Axes, method: str, cost: float, errors: list[float], cut: bool) -> None:
    """A method's median error and the line up to its worst, hollow where its range is often cut."""
    middle, worst = statistics.median(errors), max(errors)
    membrane, chosen, table = method.startswith("membrane"), method == DEFAULT, method in TABLES
    marker = MARKERS[2] if membrane else (MARKERS[3] if chosen else MARKERS[1 if table else 0])
    colour = MUTED if membrane else (ACCENT if chosen or table else INK)
    ax.plot([cost, cost], [middle, worst], color=colour, lw=0.8, zorder=2)
    ax.plot(cost, worst, marker="_", color=colour, ms=5, zorder=2)
    face = "white" if cut and not membrane else colour
    ax.plot(cost, middle, marker=marker, color=colour, mfc=face, ms=6 if chosen else 4, ls="", zorder=3)
    label = method.replace("membrane ", "").replace("solid ", "").replace(" x ", "×")
    look = {"textcoords": "offset points", "fontsize": 6, "color": colour}
    if membrane or table:
        # The atlas and what takes it stand at nearly one cost.
        place, side = ((-6, 6), "right") if method == ATLAS else ((6, 0 if membrane else -5), "left")
        ax.annotate(label, (cost, middle), xytext=place, ha=side, va="center", **look)
    else:
        ax.annotate(label, (cost, worst), xytext=(_ASIDE.get(label, 0), 4), ha="center", rotation=90, **look)


def _limit_panel(ax: Axes, every: Rows) -> None:
    points = []
    looks = ((0, ACCENT, "-"), (1, INK, LINES[1]), (4, INK, LINES[2]), (2, MUTED, LINES[3]))
    for k, name in enumerate(dict.fromkeys(row["program"] for row in every)):
        rows = [row for row in every if row["program"] == name]
        mark, colour, line = looks[k % len(looks)]
        errors = [max(100 * abs(row["limit_error"]), 1e-3) for row in rows]
        cost = [1e3 * row["solve_s"] for row in rows]
        points += zip(cost, errors, strict=True)
        look = {"marker": MARKERS[mark], "color": colour}
        ax.plot(cost, errors, ls=line, lw=1.6 if k == 0 else 0.9, label=f"{name}, solve alone", **look)
        ax.plot([1e3 * row["whole_s"] for row in rows], errors, mfc="white", ls="", zorder=2, **look)
    ax.plot([], [], marker="o", mfc="white", color=INK, ls="", label="hollow: whole process")
    _front_line(ax, points)
    ax.axhline(100 * LIMIT_TARGET, color=MUTED, lw=0.5)
    ax.set(
        xscale="log",
        yscale="log",
        xlabel="processor time, inflation through the limit point  (ms)",
        ylabel="error of limit pressure, paper's sensor  (%)",
    )
    place = {"transform": ax.get_yaxis_transform(), "fontsize": 6, "va": "bottom", "color": MUTED}
    ax.text(0.02, 100 * LIMIT_TARGET, "0.5 %", **place)
    ax.set_ylim(top=25)
    ax.legend(loc="upper left", fontsize=6, ncols=1)


def _off_axis_panel(ax: Axes, scene: dict[str, Any]) -> None:
    """Error over processor time of both programs on one scene."""
    looks = {OURS: ("pneutouch harmonic", 0, ACCENT), "CalculiX": ("CalculiX C3D20R", 1, INK)}
    for program, (label, k, colour) in looks.items():
        own = [point for point in scene["points"] if point["program"] == program]
        cost, errors = [1e3 * point["seconds"] for point in own], [100 * point["error"] for point in own]
        ax.plot(cost, errors, marker=MARKERS[k], color=colour, ls=LINES[k], lw=0.9, ms=4, label=label)
        # Away from the line to the next point; the last on the other side.
        above = [one >= following for one, following in pairwise(errors)]
        above.append(not above[-1] if above else True)
        for point, at, error, up in zip(own, cost, errors, above, strict=True):
            place = {"xytext": (0, 6 if up else -10), "textcoords": "offset points", "ha": "center"}
            ax.annotate(point["label"].replace(" x ", "×"), (at, error), fontsize=6, color=colour, **place)
    known, errors = 100 * scene["resolved"], [100 * point["error"] for point in scene["points"]]
    ax.axhspan(1e-3, known, color=FAINT, alpha=0.4, lw=0, zorder=0)
    words = "grey: errors not known, the finest answers differ by more"
    ax.text(0.98, 0.04, words, transform=ax.transAxes, fontsize=6, ha="right", color=MUTED)
    ax.set(
        xscale="log",
        yscale="log",
        ylim=(0.5 * min(errors), 4.0 * max(errors)),
        xlabel="processor time, press to two depths  (ms)",
        ylabel="greatest error of forces and pressure  (%)",
    )
    low, high = ax.get_ylim()
    ticks = [tick for tick in _TICKS if low < tick < high]
    ax.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
    ax.tick_params(axis="y", which="minor", left=False, labelleft=False)
    ax.margins(x=0.14)
    ax.set_title(scene["scene"], fontsize=7)
    ax.legend(loc="upper right", fontsize=6)


OUTCOMES: dict[str, dict[str, Any]] = {
    "within 5 %": {"marker": "o", "color": ACCENT, "ms": 5.5},
    "off by more": {"marker": "o", "color": INK, "mfc": "white", "ms": 5.5},
    "ends before": {"marker": "x", "color": INK, "ms": 5},
    "fails": {"marker": "s", "color": INK, "ms": 5},
    "outside its box": {"marker": "|", "color": INK, "ms": 6},
    "no such state": {"marker": "_", "color": MUTED, "ms": 6},
}


def validity() -> str:
    """Outcome of every state, methods down and depths across."""
    rows = stored("validity")
    methods, depths, walls = (
        list(dict.fromkeys(r[key] for r in rows)) for key in ("method", "depth_ratio", "wall_ratio")
    )
    with figure(178, 215) as drawn:
        drawn.get_layout_engine().set(rect=(0, 0, 1, 0.965))  # type: ignore[union-attr]
        axes = drawn.subplots(len(methods), len(depths), sharex=True, sharey=True)
        for i, method in enumerate(methods):
            for k, depth in enumerate(depths):
                ax = axes[i, k]
                here = [row for row in rows if (row["method"], row["depth_ratio"]) == (method, depth)]
                draw_outcomes(ax, here, OUTCOMES, walls)
                ax.set(xlim=(0.016, 0.62), ylim=(-0.08, 1.03))
                if i == 0:
                    ax.set_title(f"to {depth:g} R0", fontsize=7.5)
                if k == 0:
                    ax.set_ylabel(f"{method}\np / limit  (-)", fontsize=7)
                if i == len(methods) - 1:
                    ax.set_xlabel("wall / R0  (-)")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        drawn.legend(handles, labels, loc="upper center", ncols=6)
        return svg(drawn)


def laws() -> str:
    """Inflation of the paper's dome by every law."""
    with figure(165, 72) as drawn:
        ax = drawn.add_subplot()
        for k, curve in enumerate(stored("paper")["laws"]):
            colour = (ACCENT, INK, INK, MUTED)[k]
            ax.plot(curve["height"], curve["pressure"], color=colour, ls=LINES[k], lw=1.5, label=curve["law"])
            if curve["limit"]:
                ax.plot(*curve["limit"], "D", color=colour, ms=4)
        ax.set(
            xlabel="inner apex height / R0  (-)", ylabel="pressure x R0 / (mu t0)  (-)", xlim=(1.0, 2.4), ylim=(0, 3.2)
        )
        ax.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=6.5)
        return svg(drawn)


def validation() -> str:
    """Greatest difference of the solid from each reference."""
    found = stored("validation")["references"][::-1]
    looks = {
        "exact": ("closed form or theory", MARKERS[0], ACCENT),
        "program": ("CalculiX", MARKERS[1], INK),
        "measured": ("measurement (median)", MARKERS[3], MUTED),
    }
    with figure(165, 112) as drawn:
        ax = drawn.subplots()
        for k, one in enumerate(found):
            _, marker, colour = looks[one["kind"]]
            values = [100 * value for value in one["differences"]]
            ax.plot([min(values), max(values)], [k, k], color=FAINT, lw=1.2, zorder=1)
            ax.plot(values, [k] * len(values), ls="", marker=marker, color=colour, ms=4.5)
        for kind, marker, colour in looks.values():
            ax.plot([], [], ls="", marker=marker, color=colour, label=kind)
        ax.set_yticks(range(len(found)), [one["name"] for one in found])
        ticks = [1e-4, 1e-3, 1e-2, 0.1, 1, 10]
        ax.set(xscale="log", xlabel="greatest difference  (%)", xlim=(ticks[0], 20))
        ax.set_xticks(ticks, ["0.0001", *(f"{tick:g}" for tick in ticks[1:])])
        ax.grid(axis="x", color=FAINT, lw=0.4)
        drawn.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=6.5)
        return svg(drawn)


def speed_against_accuracy() -> str:
    """Error over time for each kind of work, and time over the number of designs; filled is this project."""
    found = stored("accuracy")["work"]
    with figure(180, 200) as drawn:
        axes = drawn.subplots(4, 2).ravel()
        for ax, panel in zip(axes, found, strict=False):
            _panel(ax, panel)
        _growth(axes[len(found)], stored("search")["growth"])
        return svg(drawn)


def _growth(ax: Axes, ways: Rows) -> None:
    """Processor time over the number of designs."""
    for k, way in enumerate(ways):
        ours, limit = way["way"].startswith(OURS), way["way"].startswith("array")
        ax.plot(
            way["designs"],
            way["processor_s"],
            marker="" if limit else MARKERS[k],
            color=ACCENT if ours else INK,
            mfc=ACCENT if ours else "white",
            ls=LINES[1] if limit else LINES[0],
            lw=1.4 if ours else 0.9,
            ms=4,
            label=way["way"],
        )
    ax.set(xscale="log", yscale="log", xlabel="designs", ylabel="processor time (s)")
    ax.set_title("Many designs, three driving pressures", fontsize=7.5)
    ax.set(xlim=(0.7, 2e5), ylim=(5e-3, 3e5))
    ax.legend(fontsize=5.5, loc="upper left", ncols=2, columnspacing=1.0)


def _panel(ax: Axes, panel: dict[str, Any]) -> None:
    ways = list(dict.fromkeys(point["way"] for point in panel["points"]))
    other = 0
    for way in ways:
        own = sorted((p for p in panel["points"] if p["way"] == way), key=lambda p: p["time_ratio"])
        ours = way.startswith(OURS)
        if not ours:
            other += 1
        marker = MARKERS[ways.index(way) % len(MARKERS)]
        ax.plot(
            [p["time_ratio"] for p in own],
            [100 * p["error"] for p in own],
            marker=marker,
            color=ACCENT if ours else (INK if other % 2 else MUTED),
            mfc=ACCENT if ours else "white",
            ls=LINES[0] if ours else LINES[1 + other % 3],
            lw=1.6 if ours else 0.9,
            ms=4,
            label=way,
        )
    ax.set(xscale="log", yscale="log", xlabel="time / pneutouch's default", ylabel=f"error: {panel['figure']} (%)")
    ax.set_title(panel["title"], fontsize=7.5)
    low, high = _decades([100 * p["error"] for p in panel["points"]])
    # A decade more, for the legend.
    ax.set(xlim=_decades([p["time_ratio"] for p in panel["points"]]), ylim=(low, 10 * high))
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_formatter(lambda value, _: f"{value:g}")
        axis.set_minor_formatter("")
    ax.legend(fontsize=5.5, loc="upper right", ncols=2 if len(ways) == 4 else 1, columnspacing=1.0)


def _decades(values: Sequence[float]) -> tuple[float, float]:
    """The whole decades that hold positive values with a tenth of a decade to spare."""
    ends = math.log10(min(values)) - 0.1, math.log10(max(values)) + 0.1
    return 10.0 ** math.floor(ends[0]), 10.0 ** math.ceil(ends[1])


CHARTS: dict[str, Callable[[], str]] = {
    "speed-accuracy": speed_accuracy,
    "validity": validity,
    "laws": laws,
    "validation": validation,
    "speed-against-accuracy": speed_against_accuracy,
}
