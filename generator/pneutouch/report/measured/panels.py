"""Small multiples: one panel a resin, specimens, pressures and ages distinguished alike on every plot.

Marker: specimen. Line and tone: driving pressure. Filled: the youngest age; open: older. Nothing rests on colour alone.

Content of the measured datasheet: groups of runs, each compared with its prediction.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from pneutouch.bench.figures import RunGroup
from pneutouch.bench.record import MeasuredCurve
from pneutouch.catalogue import ResolvedDesign
from pneutouch.mechanics.prediction import SensorState
from pneutouch.report.style import FAINT, INK, LINES, MARKERS, MUTED, figure, svg
from pneutouch.results.measured import AgeingChange, InjectionFigure, Verdict
from pneutouch.results.uncertainty import UncertaintyRecord
from pneutouch.spec.campaign import Campaign

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch


@dataclass(frozen=True)
class GroupComparison:
    """A group compared with its prediction.

    Attributes:
        group: The runs and their figures.
        label: Title of the resin.
        state: The predicted state at the group's driving pressure; None if there is none.
        uncertainty: Its uncertainty, as `Evaluation.uncertainty` has it for a state.
        predicted: Predicted figures by key of `bench.figure.FIGURES`, with the ends of their 95 % band where known:
            value, low, high.
        why: Reason why there is no prediction; empty if there is one.
        published: Measurements of the paper on this sensor, by key of `bench.figure.FIGURES`.
    """

    group: RunGroup
    label: str
    state: SensorState | None
    uncertainty: UncertaintyRecord
    predicted: dict[str, tuple[float, float | None, float | None]]
    why: str = ""
    published: dict[str, float] = field(default_factory=dict)

    def relative_band(self, figure: str) -> tuple[float, float] | None:
        """Ends of a figure's predicted band over its value; None if it has none."""
        value, low, high = self.predicted.get(figure, (0.0, None, None))
        return None if not value or low is None or high is None else (low / value, high / value)


@dataclass(frozen=True)
class CampaignReport:
    """A whole campaign.

    Attributes:
        campaign: The campaign file.
        scene: The design that it is compared with.
        folder: Folder of the campaign, as the user gave it.
        comparisons: Groups in the order of resin, age and pressure.
        curves: Every curve read, injections aside.
        failures: Files that are not used, with the message.
        questions: Data that look wrong and were not changed: file or run, and the question.
        verdicts: Of the target, empty without one.
        injections: Figures of leak and injection runs.
        ageing: Changes of the sensitivity between ages.
        model: Model of the predictions.
        input_hash: Of campaign, design and files.
    """

    campaign: Campaign
    scene: ResolvedDesign
    folder: Path
    comparisons: tuple[GroupComparison, ...]
    curves: tuple[MeasuredCurve, ...]
    failures: tuple[tuple[str, str], ...]
    questions: tuple[tuple[str, str], ...]
    verdicts: tuple[Verdict, ...]
    injections: tuple[InjectionFigure, ...]
    ageing: tuple[AgeingChange, ...]
    model: str
    input_hash: str


NARROW, WIDE = 86.0, 180.0
"""Widths in mm: two in a row on A4, and the whole row."""

_HEIGHT = 52.0
_ROW = {2: 60.0, 3: 55.0, 4: 55.0}
"""Height of a row of panels in mm by the number of columns."""
_LEGEND = 4.0
"""Height of a line of the legend, mm."""
_ENTRIES = {NARROW: 3, WIDE: 7}
_COLUMNS = 4

SKY = "#3F8FBF"
"""A tone that stays apart from INK in grayscale, as ACCENT does not."""
TONES = (INK, SKY, MUTED)
MOST_RUNS = 30
"""Runs of a group that are drawn: more hide one another."""


class Plot(NamedTuple):
    """A plot as SVG, and whether it takes the whole row."""

    svg: str
    wide: bool


@dataclass(frozen=True)
class Panel:
    """The groups of one resin in the order of age and pressure.

    ``campaign_pressures_kPa`` are the driving pressures of every resin, kPa; ``alone`` says that there is no other
    resin.
    """

    label: str
    comparisons: tuple[GroupComparison, ...]
    campaign_pressures_kPa: tuple[float, ...]
    alone: bool

    @cached_property
    def sensors(self) -> list[str]:
        """Names of the specimens; their places are their markers."""
        return sorted({name for comparison in self.comparisons for name in comparison.group.sensors})

    @cached_property
    def driving_pressures_kPa(self) -> list[float]:
        """Driving pressures, kPa, ascending."""
        return sorted({comparison.group.key.driving_pressure_kPa for comparison in self.comparisons})

    @cached_property
    def ages(self) -> list[float]:
        """Ages in days, ascending."""
        return sorted({comparison.group.key.age_days for comparison in self.comparisons})

    def tone(self, comparison: GroupComparison) -> tuple[str, Any]:
        """Colour and line style of a group's driving pressure: the same in every panel."""
        return _tone(self.campaign_pressures_kPa.index(comparison.group.key.driving_pressure_kPa))

    def spots(self, comparison: GroupComparison, curve: MeasuredCurve) -> dict[str, Any]:
        """Style in which the points of a run are drawn."""
        color, _ = self.tone(comparison)
        young = comparison.group.key.age_days == self.ages[0]
        marker = MARKERS[self.sensors.index(curve.run.sensor) % len(MARKERS)]
        return {"ls": "", "marker": marker, "ms": 2.6, "mew": 0.5, "mec": color, "mfc": color if young else "white"}

    def has(self, kind: str) -> bool:
        """True if there are runs of a kind."""
        return any(comparison.group.of_kind(kind) for comparison in self.comparisons)


def _tone(k: int) -> tuple[str, Any]:
    return TONES[k % len(TONES)], LINES[k % len(LINES)]


def panels_of(comparisons: Sequence[GroupComparison]) -> list[Panel]:
    """Groups by resin, in their order."""
    every_kPa = tuple(sorted({comparison.group.key.driving_pressure_kPa for comparison in comparisons}))
    by_resin = [tuple(some) for _, some in groupby(comparisons, key=lambda comparison: comparison.group.key.resin)]
    return [Panel(members[0].label, members, every_kPa, len(by_resin) == 1) for members in by_resin]


def some(curves: Sequence[MeasuredCurve]) -> list[MeasuredCurve]:
    """At most `MOST_RUNS` runs, spread evenly over all."""
    step = math.ceil(len(curves) / MOST_RUNS)
    return list(curves[::step]) if step else []


def multiples(
    panels: Sequence[Panel],
    draw: Callable[[Axes, Panel], None],
    labels: tuple[str, str],
    legend: dict[str, Any],
    *,
    shared: bool = False,
) -> Plot:
    """One panel a resin.

    ``labels`` are those of the axes, ``legend`` handles by their words. ``shared`` panels have the same axes.
    """
    down = math.ceil(len(panels) / _COLUMNS)
    across = math.ceil(len(panels) / down)
    wide = NARROW if across == 1 else WIDE
    lines = math.ceil(len(legend) / _ENTRIES[wide])
    with figure(wide, (_HEIGHT if across == 1 else _ROW[across] * down) + lines * _LEGEND) as drawn:
        grid = drawn.subplots(down, across, sharex=shared, sharey=shared, squeeze=False)
        for ax, panel in zip(_axes(grid, len(panels)), panels, strict=True):
            if not panel.alone:
                ax.set_title(panel.label.replace("$", r"\$"), fontsize=7.5, loc="left", pad=3)
            ax.tick_params(labelbottom=True, labelleft=True)
            draw(ax, panel)
        drawn.supxlabel(labels[0], fontsize=7.5)
        drawn.supylabel(labels[1], fontsize=7.5)
        _legend(drawn, legend, wide)
        return Plot(svg(drawn), wide > NARROW)


def _axes(grid: Any, count: int) -> Iterator[Axes]:
    for k, ax in enumerate(grid.flat):
        if k < count:
            yield ax
        else:
            ax.remove()


def _legend(drawn: Figure, legend: dict[str, Any], wide: float) -> None:
    if legend:
        ncols = min(_ENTRIES[wide], len(legend))
        # matplotlib fills columns: taken in this order the entries read row by row.
        words = [word for k in range(ncols) for word in list(legend)[k::ncols]]
        drawn.legend(
            [legend[word] for word in words],
            words,
            loc="outside upper left",
            ncols=ncols,
            handlelength=2.2,
            columnspacing=1.4,
            handletextpad=0.5,
            borderpad=0.1,
        )


def key(panels: Sequence[Panel]) -> dict[str, Line2D]:
    """Legend of a plot of runs: markers of the specimens, fill of the ages."""
    from matplotlib.lines import Line2D

    handles: dict[str, Line2D] = {}
    for k in range(min(max((len(panel.sensors) for panel in panels), default=0), len(MARKERS))):
        handles[f"specimen {k + 1}"] = Line2D([], [], ls="", marker=MARKERS[k], color=INK, ms=3.4)
    ages = sorted({age for panel in panels for age in panel.ages})
    if len(ages) > 1:
        handles["youngest"] = Line2D([], [], ls="", marker="o", color=INK, ms=3.4)
        handles["older"] = Line2D([], [], ls="", marker="o", mec=INK, mfc="white", ms=3.4)
    return handles


def lines_of(panels: Sequence[Panel], driving_pressures_kPa: Sequence[float]) -> dict[str, Line2D]:
    """Legend of the driving pressures, kPa, that are drawn."""
    from matplotlib.lines import Line2D

    handles = {}
    for pressure_kPa in driving_pressures_kPa:
        color, style = _tone(panels[0].campaign_pressures_kPa.index(pressure_kPa))
        handles[f"{pressure_kPa:g} kPa"] = Line2D([], [], color=color, ls=style, lw=1.1)
    return handles


def band_of() -> dict[str, Patch]:
    """Legend of a predicted band."""
    from matplotlib.patches import Patch

    return {"predicted, 95 %": Patch(fc=FAINT, ec=MUTED, lw=0.5, alpha=0.7)}


def ends_of(values: Sequence[float], most: int = 2) -> list[float]:
    """All of them where they are few, else the lowest and the highest."""
    return list(values) if len(values) <= most else [values[0], values[-1]]
