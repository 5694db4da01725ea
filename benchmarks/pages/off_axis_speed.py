"""Contact off the axis on the page: the errors of the harmonic solid and of CalculiX over their processor times."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

from benchmarks.off_axis_calculix import FIGURES, compares
from pneutouch.report.style import ACCENT, FAINT, INK, LINES, MARKERS, MUTED

if TYPE_CHECKING:
    from matplotlib.axes import Axes

HEADING = "## Contact off the axis: time at equal error"
OURS, THEIRS = "pneutouch harmonic", "CalculiX C3D20R"
TARGET = 0.1
"""Greatest share of CalculiX's time at equal error."""

_TICKS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0)


class SpeedPoint(NamedTuple):
    """One program with one resolution on a scene: processor time (s) and the greatest relative error of its figures."""

    program: str
    label: str
    seconds: float
    error: float


def measured(data: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The scenes in which the harmonic solid was timed with several resolutions in the run in which CalculiX was."""
    return [scene for scene in data if "settling" in scene]


def distance(scene: dict[str, Any]) -> float:
    """Half of the greatest relative difference between the finest answers of both programs: an error that is smaller
    is not known."""
    return _error(scene, [row["calculix"][-1] for row in scene["rows"]])


def points(scene: dict[str, Any]) -> list[SpeedPoint]:
    """Every resolution of both programs on a scene, by rising time for each program."""
    ours = [(run["harmonics"], run["cells"], run["processor_s"], run["rows"]) for run in scene["settling"]]
    found = [
        SpeedPoint(OURS, f"M {order}, {_times(cells)}", seconds, _error(scene, rows))
        for order, cells, seconds, rows in ours
    ]
    for k, (cells, cost) in enumerate(zip(scene["cells"], scene["calculix_cost"], strict=True)):
        error = _error(scene, [row["calculix"][k] for row in scene["rows"]])
        found.append(SpeedPoint(THEIRS, _times(cells), cost["processor_s"], error))
    return sorted(found, key=lambda point: (point.program == THEIRS, point.seconds))


def _times(cells: list[int]) -> str:
    return " x ".join(map(str, cells))


def _error(scene: dict[str, Any], found: list[dict[str, float]]) -> float:
    """Greatest relative error of figures at every place against the mean of both programs' finest answers."""
    worst = 0.0
    for row, finest, values in zip(scene["rows"], scene["settling"][-1]["rows"], found, strict=True):
        for figure in FIGURES:
            if compares(row, figure):
                middle = 0.5 * (finest[figure] + row["calculix"][-1][figure])
                worst = max(worst, abs(values[figure] / middle - 1.0))
    return worst


def shares(scene: dict[str, Any]) -> list[tuple[SpeedPoint, SpeedPoint]]:
    """Each resolution of CalculiX with the cheapest one of the harmonic solid whose error is no greater."""
    ours = [point for point in points(scene) if point.program == OURS]
    out = []
    for theirs in (point for point in points(scene) if point.program == THEIRS):
        good = [point for point in ours if point.error <= max(theirs.error, distance(scene))]
        out += [(theirs, min(good, key=lambda point: point.seconds))] if good else []
    return out


def section(data: list[dict[str, Any]]) -> list[str]:
    """The lines for the page."""
    scenes = measured(data)
    pairs = [(scene, *pair) for scene in scenes for pair in shares(scene)]
    ratios = [ours.seconds / theirs.seconds for _, theirs, ours in pairs]
    met = "**met**" if max(ratios) <= TARGET else "**not met**"
    return [
        HEADING,
        "",
        "The press to two depths, from the mesh on, on one thread: pneutouch with M harmonics and cells along the arc and through the wall, CalculiX with "
        "cells along the arc, through the wall and around half the axis. CalculiX's time is that of its whole process, with the second pressure "
        "from which Boyle's law follows and the increments at rest that its contact needs "
        "([validation.md](validation.md#calculix-contact-off-the-axis)). The error is the greatest of force, sideways force and pressure rise at both depths, against the mean of "
        "the finest answers of both programs. These differ from their mean by "
        f"{' and '.join(f'{distance(scene):.2%}' for scene in scenes)}; smaller errors cannot be resolved.",
        "",
        "| scene | program | resolution | error | time over that of CalculiX's coarsest mesh |",
        "|---|---|---|---|---|",
        *(line for scene in scenes for line in _lines(scene)),
        "",
        f"Target, at most {TARGET:g} of CalculiX's time at equal error: {met}. For each mesh of CalculiX, the cheapest resolution of pneutouch with no "
        "greater error, or with one below what can be resolved, takes this fraction of its time: "
        + "; ".join(
            f"{ours.seconds / theirs.seconds:.3f} ({scene['scene'].split(',')[0]}, {ours.label} for {theirs.label})"
            for scene, theirs, ours in pairs
        )
        + ".",
        "",
    ]


def _lines(scene: dict[str, Any]) -> list[str]:
    found = points(scene)
    base = min(point.seconds for point in found if point.program == THEIRS)
    return [
        f"| {scene['scene']} | {point.program} | {point.label} | {point.error:.2%} | {point.seconds / base:.3f} |"
        for point in found
    ]


def panel(ax: Axes, scene: dict[str, Any]) -> None:
    """Error over processor time of both programs on one scene."""
    looks = {OURS: (MARKERS[0], ACCENT, LINES[0]), THEIRS: (MARKERS[1], INK, LINES[1])}
    found = points(scene)
    for program, (marker, colour, line) in looks.items():
        own = [point for point in found if point.program == program]
        cost, errors = [1e3 * point.seconds for point in own], [100 * point.error for point in own]
        ax.plot(cost, errors, marker=marker, color=colour, ls=line, lw=0.9, ms=4, label=program)
        # Away from the line to the next point; the last on the other side.
        above = [one >= following for one, following in pairwise(errors)]
        above.append(not above[-1] if above else True)
        for point, at, error, up in zip(own, cost, errors, above, strict=True):
            place = {"xytext": (0, 6 if up else -10), "textcoords": "offset points", "ha": "center"}
            ax.annotate(point.label.replace(" x ", "×"), (at, error), fontsize=6, color=colour, **place)
    known, errors = 100 * distance(scene), [100 * point.error for point in found]
    ax.axhspan(1e-3, known, color=FAINT, alpha=0.4, lw=0, zorder=0)
    ax.text(
        *(0.98, 0.04, "grey: errors not known, the finest answers differ by more"),
        **{"transform": ax.transAxes, "fontsize": 6, "ha": "right", "color": MUTED},
    )
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
