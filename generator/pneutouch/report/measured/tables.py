"""The measured datasheet's groups of runs, their predictions, and tables; formulas: docs/howto/measuring.md."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import groupby
from pathlib import Path

import numpy as np

from pneutouch.bench.figures import FIGURES, FigureDefinition, RunGroup
from pneutouch.bench.record import MeasuredCurve, SuspectInterval
from pneutouch.catalogue import ResolvedDesign
from pneutouch.mechanics.prediction import SensorState
from pneutouch.report.blocks import Cell, SheetBlock, SheetTable, Text, section
from pneutouch.report.numbers import DASH, Bounds, between, difference, number, overlap, signed, word_of
from pneutouch.report.prose import WORDS
from pneutouch.report.style import MARKERS
from pneutouch.results.measured import AgeingChange, InjectionFigure, Verdict
from pneutouch.results.record import SENSITIVITY_KEY, STIFFNESS_KEY
from pneutouch.results.uncertainty import UncertaintyRecord
from pneutouch.spec.campaign import Campaign


@dataclass(frozen=True)
class GroupComparison:
    """A group of runs compared with its prediction.

    Attributes:
        group: The runs and their figures.
        label: Title of the resin.
        state: The predicted state at the group's driving pressure; None if there is none.
        uncertainty: Uncertainty of that state.
        predicted: Predicted figures by key of `bench.figures.FIGURES`: value, lower and upper end of its 95 % band,
            each end None if it is not known.
        why: Reason why there is no prediction; empty if there is one.
        published: Measurements of the paper on this sensor, by key of `bench.figures.FIGURES`.
    """

    group: RunGroup
    label: str
    state: SensorState | None
    uncertainty: UncertaintyRecord
    predicted: dict[str, tuple[float, float | None, float | None]]
    why: str = ""
    published: dict[str, float] = field(default_factory=dict)

    def relative_band(self, figure: str) -> tuple[float, float] | None:
        """Ends of a figure's predicted band, divided by its value; None without a band or if the value is zero."""
        value, low, high = self.predicted.get(figure, (0.0, None, None))
        return None if not value or low is None or high is None else (low / value, high / value)


@dataclass(frozen=True)
class CampaignReport:
    """The results of a whole campaign, from which its measured datasheet is made.

    Attributes:
        campaign: The campaign file.
        scene: The design that it is compared with.
        folder: Folder of the campaign, as the user gave it.
        comparisons: Groups with their predictions, in the order of resin, age and driving pressure.
        curves: Every curve that was read; injections have none.
        failures: Files that are not used, with the message.
        questions: Data that look wrong and were not changed: file or run, and the question.
        verdicts: Verdicts on the target; empty without a target.
        injections: Figures of leak and injection runs.
        ageing: Changes of the sensitivity between ages.
        model: Model of the predictions.
        input_hash: Hash of campaign, design and files.
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


MOST_RUNS = 30
"""Greatest number of runs of a group that are drawn: more hide one another."""


@dataclass(frozen=True)
class ResinGroups:
    """The groups of one resin in the order of age and driving pressure.

    ``campaign_pressures_kPa`` are the driving pressures of all resins of the campaign, ascending; ``alone`` is True if
    there is no other resin.
    """

    label: str
    comparisons: tuple[GroupComparison, ...]
    campaign_pressures_kPa: tuple[float, ...]
    alone: bool

    @cached_property
    def sensors(self) -> list[str]:
        """Names of the specimens, sorted; the place of a name in the list gives its marker."""
        return sorted({name for comparison in self.comparisons for name in comparison.group.sensors})

    @cached_property
    def driving_pressures_kPa(self) -> list[float]:
        """Driving pressures, kPa, ascending."""
        return sorted({comparison.group.key.driving_pressure_kPa for comparison in self.comparisons})

    @cached_property
    def ages(self) -> dict[float, str]:
        """Ages in words by age in days, ascending."""
        keys = sorted((comparison.group.key for comparison in self.comparisons), key=lambda key: key.age_days)
        return {key.age_days: key.age for key in keys}


def groups_of(comparisons: Sequence[GroupComparison]) -> list[ResinGroups]:
    """Comparisons, ordered by resin, gathered into one `ResinGroups` for each resin."""
    every_kPa = tuple(sorted({comparison.group.key.driving_pressure_kPa for comparison in comparisons}))
    by_resin = [tuple(some) for _, some in groupby(comparisons, key=lambda comparison: comparison.group.key.resin)]
    return [ResinGroups(members[0].label, members, every_kPa, len(by_resin) == 1) for members in by_resin]


def some(curves: Sequence[MeasuredCurve]) -> list[MeasuredCurve]:
    """At most `MOST_RUNS` of the curves, spread evenly over all."""
    step = math.ceil(len(curves) / MOST_RUNS)
    return list(curves[::step]) if step else []


MOST = 40
"""Most entries of a list of warnings, questions, failures, leaks or volumes that are printed."""
MOST_SPECIMENS = 120
"""Most rows of the specimen table that are printed."""

_SHAPES = dict(zip(MARKERS, ("circle", "square", "triangle", "diamond", "triangle down", "plus", "cross"), strict=True))
"""Names of the markers of the plots."""

_WORDS = WORDS["measured"]
_NAMES = [figure.name for figure in FIGURES]


def resin_section(groups: ResinGroups) -> list[SheetBlock]:
    """Table of every measured figure of a resin beside its prediction, and names of the figures not measured."""
    found = [(each, b) for each in FIGURES for b in groups.comparisons if each.key in b.group.figures]
    rows = [[each.name, each.unit, *_condition(b), *_figure(each, b)] for each, b in found]
    there = {each.key for each, _ in found}
    absent = [
        f"{each.name}, {each.unit}" if _NAMES.count(each.name) > 1 else each.name
        for each in FIGURES
        if each.key not in there
    ]
    unknown = {b.group.key.driving_pressure_kPa: b.why for b in groups.comparisons if b.why}
    return section(
        f"Figures of {groups.label}",
        SheetTable(rows, _WORDS["figures"], numeric=(2, 4, 5, 6, 7, 8, 9), merged=2, dense=True),
        Text(f"Not measured: {'; '.join(absent)}." if absent else "", "muted"),
        *(Text(f"No prediction at {pressure:g} kPa: {why}", "muted") for pressure, why in sorted(unknown.items())),
    )


def _condition(comparison: GroupComparison) -> list[str]:
    return [f"{comparison.group.key.driving_pressure_kPa:g}", comparison.group.key.age]


def _figure(figure: FigureDefinition, comparison: GroupComparison) -> list[str | Cell]:
    estimate, digits = comparison.group.figures[figure.key], figure.digits
    measured: Bounds = (estimate.value, estimate.low, estimate.high)
    count = f"{estimate.specimens} / {estimate.runs}"
    cells: list[str | Cell] = [number(estimate.value, digits), between(measured, digits), count]
    predicted = comparison.predicted.get(figure.key)
    if predicted is None:
        return [*cells, "", "", "", ""]
    meets = overlap(measured, predicted)
    apart = signed(difference(estimate.value, predicted[0]))
    word = Cell(word_of(meets, ("yes", "no", "")), strong=meets is not None and not meets)
    return [*cells, number(predicted[0], digits), between(predicted, digits), apart, word]


def specimen_section(groups: Sequence[ResinGroups]) -> list[SheetBlock]:
    """Sensitivity and stiffness of each specimen, mean and standard deviation over its runs."""
    rows = []
    for group in groups:
        for k, sensor in enumerate(group.sensors):
            for comparison in group.comparisons:
                values = _of_sensor(comparison, sensor)
                if values:
                    marker = f"{k + 1}, {_SHAPES[MARKERS[k % len(MARKERS)]]}"
                    rows.append([group.label, sensor, marker, *_condition(comparison), *values])
    note = Text("s: standard deviation between the runs of the specimen.", "muted")
    return _listed("Specimens", rows, _WORDS["specimens"], (3, 5, 6, 7, 8, 9), note, most=MOST_SPECIMENS, merged=3)


def _of_sensor(comparison: GroupComparison, sensor: str) -> list[str]:
    group = comparison.group
    each = [figures for curve, figures in zip(group.curves, group.each, strict=True) if curve.run.sensor == sensor]
    cells: list[str] = []
    for name, digits in ((SENSITIVITY_KEY, 4), (STIFFNESS_KEY, 3)):
        values = np.array([figures[name] for figures in each if name in figures])
        if not values.size:
            cells += [DASH, DASH]
            continue
        mean = float(values.mean())
        spread = number(float(values.std(ddof=1)), 2) if values.size > 1 else DASH
        cells += [number(mean, digits), spread]
    count = sum(SENSITIVITY_KEY in figures for figures in each)
    return [str(count), *cells] if set(cells) != {DASH} else []


def ageing_table(measured: CampaignReport) -> SheetTable:
    """Resin, driving pressure, age, change in percent, its interval, and the paper's change without sign."""
    rows = []
    for row in measured.ageing:
        at, change, paper = f"{row.driving_pressure_kPa:g}", signed(row.sensitivity_change_percent), DASH
        ends = DASH if row.low is None or row.high is None else f"{signed(row.low)} to {signed(row.high)}"
        if row.published_change_one_year_percent is not None:
            paper = f"± {row.published_change_one_year_percent:.3g}"
        rows.append([row.resin, at, row.age, change, ends, paper])
    return SheetTable(rows, _WORDS["ageing"], numeric=(1, 3, 4, 5), dense=True)


def lists(measured: CampaignReport) -> list[SheetBlock]:
    """Sections on leak and dead volume, failures, questions and warnings; those without entries are left out."""
    injections = [
        [row.sensor, row.figure, number(row.value, 4), number(row.predicted), number(row.standard_error, 2), row.unit]
        for row in measured.injections
    ]
    # The message begins with the file's path, which is printed next to it.
    failures = [[file, why.split(f"{file}: ", 1)[-1]] for file, why in measured.failures]
    words = _WORDS["lists"]
    wrong, doubtful, rigid = (Text(words[key], "muted") for key in ("wrong", "doubtful", "rigid"))
    return [
        *_listed("Leak and dead volume", injections, words["volumes"], (2, 3, 4), rigid),
        *_listed("Failures", failures, ("File", "Why it is not used")),
        *_listed("Questions", measured.questions, ("File or run", "Question"), (), wrong),
        *_listed("Warnings", _warnings(measured), words["alike"], (2, 4), doubtful),
    ]


def _warnings(measured: CampaignReport) -> list[list[str]]:
    """Rows on doubtful parts of records, one a reason: used or not, count, first file, its seconds; notes left out."""
    parts: dict[tuple[str, bool], list[tuple[str, SuspectInterval]]] = {}
    for curve in measured.curves:
        for warning in curve.warnings:
            if warning.kind != "note":
                parts.setdefault((warning.why, warning.used), []).append((curve.run.file, warning))
    return [
        [why, word_of(used), str(len(places)), places[0][0], f"{places[0][1].start:.2f} to {places[0][1].end:.2f}"]
        for (why, used), places in parts.items()
    ]


def _listed(
    title: str,
    rows: Sequence[Sequence[str]],
    head: Sequence[str],
    numeric: Sequence[int] = (),
    *notes: Text,
    most: int = MOST,
    merged: int = 0,
) -> list[SheetBlock]:
    """A section with the first ``most`` rows, the number of further ones, and notes; empty without rows."""
    left = len(rows) - most
    more = Text(f"and {left} more: see figures.json" if left > 0 else "", "muted")
    return section(title, SheetTable(rows[:most], head, numeric, merged=merged), more, *notes) if rows else []


def definitions() -> SheetTable:
    """Table of definitions: of every figure, named with its unit, then of the tables' other words."""
    named = [[f"{f.name}, {f.unit}" if f.unit else f.name, _WORDS["definitions"][f.key]] for f in FIGURES]
    return SheetTable([*named, *_WORDS["terms"]])
