"""Content of the measured datasheet: groups of runs, each compared with its prediction, and the groups of a resin."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import groupby
from pathlib import Path

from pneutouch.bench.figures import RunGroup
from pneutouch.bench.record import MeasuredCurve
from pneutouch.catalogue import ResolvedDesign
from pneutouch.mechanics.prediction import SensorState
from pneutouch.results.measured import AgeingChange, InjectionFigure, Verdict
from pneutouch.results.uncertainty import UncertaintyRecord
from pneutouch.spec.campaign import Campaign


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


MOST_RUNS = 30
"""Runs of a group that are drawn: more hide one another."""


@dataclass(frozen=True)
class ResinGroups:
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
    def ages(self) -> dict[float, str]:
        """Ages in days, ascending, and in words."""
        keys = sorted((comparison.group.key for comparison in self.comparisons), key=lambda key: key.age_days)
        return {key.age_days: key.age for key in keys}


def groups_of(comparisons: Sequence[GroupComparison]) -> list[ResinGroups]:
    """Groups by resin, in their order."""
    every_kPa = tuple(sorted({comparison.group.key.driving_pressure_kPa for comparison in comparisons}))
    by_resin = [tuple(some) for _, some in groupby(comparisons, key=lambda comparison: comparison.group.key.resin)]
    return [ResinGroups(members[0].label, members, every_kPa, len(by_resin) == 1) for members in by_resin]


def some(curves: Sequence[MeasuredCurve]) -> list[MeasuredCurve]:
    """At most `MOST_RUNS` runs, spread evenly over all."""
    step = math.ceil(len(curves) / MOST_RUNS)
    return list(curves[::step]) if step else []
