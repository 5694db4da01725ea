"""Write docs/background/speed-against-accuracy.md with its chart from what the other pages stored: ``make overview-page``."""

from __future__ import annotations

import json
import math
import statistics
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from benchmarks.models import ATLAS
from benchmarks.pages import off_axis_speed
from benchmarks.pages.speed_chart import DEFAULT, of, sizes
from pneutouch.report.style import ACCENT, INK, LINES, MARKERS, MUTED, figure, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DOCS = Path(__file__).resolve().parents[1] / "docs" / "background"
OURS = "pneutouch"


class Point(NamedTuple):
    """A way to answer: its name, its time over that of pneutouch's default way, and its relative error."""

    way: str
    time_ratio: float
    error: float

    @property
    def ours(self) -> bool:
        """Whether the way is one of this project."""
        return self.way.startswith(OURS)


class Panel(NamedTuple):
    """One kind of work: what the error is of, and every way that was measured."""

    title: str
    error: str
    points: list[Point]


def stored(name: str) -> Any:
    """A file of measurements next to the page."""
    return json.loads((DOCS / f"{name}.json").read_text(encoding="utf-8"))


def prediction() -> Panel:
    """Median error of the sensitivity over the scenes; the membrane is the paper's theory."""
    data = stored("speed-accuracy")
    base = statistics.median(row["processor_s"] for row in of(data["rows"], DEFAULT))
    names = {
        "membrane variational": "membrane theory",
        ATLAS: f"{OURS}, atlas",
        "solid 12 x 1": f"{OURS}, 12 x 1 cells",
        DEFAULT: f"{OURS}, default",
        "solid 48 x 3": f"{OURS}, 48 x 3 cells",
    }
    points = []
    for method, name in names.items():
        rows = of(data["rows"], method)
        cost = statistics.median(row["processor_s"] for row in rows)
        points.append(Point(name, cost / base, statistics.median(sizes(rows, "sensitivity_error"))))
    return Panel("Prediction, 14 scenes", "sensitivity", points)


def inflation() -> Panel:
    """The limit pressure of the paper's sensor by three programs, solve alone."""
    rows = stored("peers")["rows"]
    ours = [row for row in rows if row["program"] == OURS]
    base = min(ours, key=lambda row: abs(row["cells_along"] - 24))["solve_s"]
    points = [Point(row["program"], row["solve_s"] / base, abs(row["limit_error"])) for row in rows]
    return Panel("Inflation to the limit point", "limit pressure", points)


def contact() -> Panel:
    """A leaning plate, all figures, against CalculiX."""
    scene = off_axis_speed.measured(stored("off-axis-calculix"))[0]
    found = off_axis_speed.points(scene)
    # Six harmonics with four as their check, on the usual mesh: what `harmonic` takes for this scene.
    base = next(point.seconds for point in found if point.label == "M 6, 24 x 2")
    points = [Point(OURS if p.program == off_axis_speed.OURS else "CalculiX", p.seconds / base, p.error) for p in found]
    return Panel("Contact under a leaning plate", "forces and pressure", points)


def meshes() -> Panel:
    """Volume of the membrane's print mesh; every kernel at its tolerances."""
    rows = stored("meshing")["membrane"]
    base = next(row for row in rows if row["method"] == OURS and row["tolerance"] == 0.016)["milliseconds"]
    wanted = (OURS, "manifold3d alone", "CadQuery, angle 0.1", "plain grid, numpy")
    points = [
        Point(row["method"], row["milliseconds"] / base, row["deviation"] / 9.25)
        for row in rows
        if row["method"] in wanted
    ]
    return Panel("Print mesh of the membrane", "surface, over R0", points)


def voxels() -> Panel:
    """Volume of the membrane in voxels."""
    rows = [row for row in stored("voxels")["rasters"] if row["layer_um"] == 27.0 or row["method"] == "trimesh"]
    base = next(row for row in rows if row["method"] == "exact sections" and row["coarser"] == 1.0)["seconds"]
    names = {"exact sections": OURS, "manifold3d slices, Pillow": "mesh slices, Pillow"}
    names |= {"manifold3d slices, matplotlib": "mesh slices, Matplotlib"}
    points = [Point(names.get(r["method"], r["method"]), r["seconds"] / base, abs(r["volume"])) for r in rows]
    return Panel("Voxels of the membrane", "volume", points)


def selection() -> Panel:
    """How far the chosen designs are from their targets by a refined solid; median of the targets."""
    rows = stored("search")["searches"]
    base = statistics.median(row["processor_s"] for row in rows if row["way"] == "pneutouch select")
    points = []
    for way in dict.fromkeys(row["way"] for row in rows):
        own = [row for row in rows if row["way"] == way]
        off = [abs(row["off_relative"]) for row in own if row["off_relative"] is not None]
        name = way if len(off) == len(own) else f"{way}, {len(off)} of {len(own)} targets"
        cost = statistics.median(row["processor_s"] for row in own)
        points.append(Point(name, cost / base, statistics.median(off)))
    return Panel("Selection for a target", "distance from the target", points)


def sweep() -> Panel:
    """Median error of the sensitivity of 48 predictions."""
    rows = stored("search")["sweeps"]
    base = next(row for row in rows if row["way"] == "pneutouch sweep, solid")["processor_s"]
    return Panel(
        "Sweep of 16 designs",
        "sensitivity",
        [Point(row["way"], row["processor_s"] / base, row["median_error"]) for row in rows],
    )


def panels() -> list[Panel]:
    """Every kind of work that is measured against others."""
    return [prediction(), inflation(), contact(), meshes(), voxels(), selection(), sweep()]


def draw(found: list[Panel]) -> str:
    """A panel each: error over time, both logarithmic; black is this project."""
    with figure(180, 200) as drawn:
        axes = drawn.subplots(4, 2).ravel()
        for ax, panel in zip(axes, found, strict=False):
            _panel(ax, panel)
        for ax in axes[len(found) :]:
            ax.set_visible(False)
        return svg(drawn)


def _panel(ax: Axes, panel: Panel) -> None:
    ways = list(dict.fromkeys(point.way for point in panel.points))
    other = 0
    for way in ways:
        own = sorted((p for p in panel.points if p.way == way), key=lambda p: p.time_ratio)
        ours = own[0].ours
        if not ours:
            other += 1
        marker = MARKERS[ways.index(way) % len(MARKERS)]
        ax.plot(
            [p.time_ratio for p in own],
            [100 * p.error for p in own],
            marker=marker,
            color=ACCENT if ours else (INK if other % 2 else MUTED),
            mfc=ACCENT if ours else "white",
            ls=LINES[0] if ours else LINES[1 + other % 3],
            lw=1.6 if ours else 0.9,
            ms=4,
            label=way,
        )
    ax.set(xscale="log", yscale="log", xlabel="time / pneutouch's default", ylabel=f"error: {panel.error} (%)")
    ax.set_title(panel.title, fontsize=7.5)
    low, high = _decades([100 * p.error for p in panel.points])
    # A decade more, for the legend.
    ax.set(xlim=_decades([p.time_ratio for p in panel.points]), ylim=(low, 10 * high))
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_formatter(lambda value, _: f"{value:g}")
        axis.set_minor_formatter("")
    ax.legend(fontsize=5.5, loc="upper right", ncols=2 if len(ways) == 4 else 1, columnspacing=1.0)


def _decades(values: Sequence[float]) -> tuple[float, float]:
    """The whole decades that hold positive values with a tenth of a decade to spare."""
    ends = math.log10(min(values)) - 0.1, math.log10(max(values)) + 0.1
    return 10.0 ** math.floor(ends[0]), 10.0 ** math.ceil(ends[1])


_HEAD = """# Speed against accuracy

Every kind of work of the program against others that do the same, on one page. `make overview-page` writes it from the stored measurements of the
pages that the table names; `python -m benchmarks.search` measures selection and sweep.

![Error over time in seven panels: prediction, inflation, contact, mesh, voxels, selection, sweep](speed-against-accuracy.svg)

Times are processor times of one core, each divided by that of pneutouch's default in the same run: only such ratios hold on another machine. Selection
and sweep were measured on {machine}. Filled markers are pneutouch, hollow ones others: other programs, and other uses of pneutouch's own models
(loops, grids, root searches, the membrane theory). CalculiX's time in contact is that of its whole process. Errors of prediction, inflation, selection
and sweep are against extrapolated or refined meshes of pneutouch; those of contact are against the mean of the finest answers of both programs, whose
half difference, {half}, is the least error that can be seen.

| work | error of pneutouch's default | others: time at no greater error over that of the default, else their least error and its time | measured in |
|---|---|---|---|
"""

_FAILS = """
## Where methods fail

![Where each method holds](validity.svg)

Walls of 0.02 to 0.5 R0, driving pressures to 0.9 of the limit pressure, four depths; {count} states for each method, compared with the solid on 64 x 3
cells ([accuracy.md](accuracy.md#map-of-validity)).

| method | within 5 % | off by more | range ends before | outside its box | no such state |
|---|---|---|---|---|---|
"""

_MORE = """
No method raised an error there. Off the axis, 300 random scenes were drawn: 49 were refused, since the object would come down to the connector; of
the 251 that were solved on a coarse mesh, 38 ended by a jump and one without an equilibrium or a known event ([off-axis.md](off-axis.md#random-scenes)). Where the program gives no answer at all: [limits.md](limits.md).
"""

_SOURCES = (
    ("accuracy.md", "speed-against-accuracy"),
    ("accuracy.md", "other-programs"),
    ("accuracy.md", "contact-off-the-axis-time-at-equal-error"),
    ("meshing.md", ""),
    ("voxels.md", ""),
    ("", "python -m benchmarks.search"),
    ("", "python -m benchmarks.search"),
)
"""Page and section, or the command, of each panel."""


def page(found: list[Panel]) -> str:
    """The page's text."""
    rows = stored("validity")
    outcomes = ("within 5 %", "off by more", "ends before", "outside its box", "no such state")
    methods = list(dict.fromkeys(row["method"] for row in rows))
    lines = [
        f"| {method} | "
        + " | ".join(str(sum(r["method"] == method and r["outcome"] == o for r in rows)) for o in outcomes)
        + " |"
        for method in methods
    ]
    count = len(rows) // len(methods)
    return "\n".join(
        [
            _HEAD.format(machine=stored("search")["machine"], half=_percent(_unresolved())).rstrip("\n"),
            *(_row(panel, *source) for panel, source in zip(found, _SOURCES, strict=True)),
            _FAILS.format(count=count).rstrip("\n"),
            *lines,
            _MORE,
        ]
    )


def _unresolved() -> float:
    return off_axis_speed.distance(off_axis_speed.measured(stored("off-axis-calculix"))[0])


def _row(panel: Panel, name: str, section: str) -> str:
    own = [p for p in panel.points if p.ours]
    default = min(own, key=lambda p: abs(p.time_ratio - 1.0))
    said = []
    for way in dict.fromkeys(p.way for p in panel.points if not p.ours):
        points = [p for p in panel.points if p.way == way]
        good = [p.time_ratio for p in points if p.error <= default.error]
        best = min(points, key=lambda p: p.error)
        said.append(
            f"{way}: {_figure(min(good))} times"
            if good
            else f"{way}: {_percent(best.error)} at {_figure(best.time_ratio)} times"
        )
    where = f"[{name}]({name}{'#' + section if section else ''})" if name else f"`{section}`"
    return f"| {panel.title} | {_percent(default.error)}, {panel.error} | {'; '.join(said) or '-'} | {where} |"


def _percent(error: float) -> str:
    return f"{100 * error:.2g} %" if error < 1 else f"{100 * error:.0f} %"


def _figure(ratio: float) -> str:
    return f"{ratio:.2g}" if ratio < 100 else f"{ratio:.0f}"


def main() -> None:
    found = panels()
    for name, text in (("speed-against-accuracy.svg", draw(found)), ("speed-against-accuracy.md", page(found))):
        (DOCS / name).write_text(text, encoding="utf-8")
        print(f"wrote docs/background/{name}")


if __name__ == "__main__":
    main()
