"""Predictions for groups of runs: expected readings, comparison, questions, and figures as ``characterize`` prints
them.

Also verdicts on measured figures: against a target, and on a change with age."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.figures import BY_KEY, RunGroup, line_figures
from pneutouch.bench.record import MeasuredCurve, SuspectInterval
from pneutouch.bench.run_checks import ExpectedRun
from pneutouch.bench.statistics import LEVEL, Estimate
from pneutouch.catalogue import DesignSource, Library
from pneutouch.errors import PneutouchError
from pneutouch.evaluation.comparison import figures_at
from pneutouch.evaluation.evaluate import Evaluation, evaluate
from pneutouch.evaluation.table_s1 import published_sensitivities
from pneutouch.mechanics.prediction import SensorState
from pneutouch.report.measured import CampaignReport, GroupComparison
from pneutouch.results.measured import (
    AgeingChange,
    CampaignFigure,
    DataQuestion,
    FileFailure,
    MeasuredCampaign,
    MeasuredGroup,
    MeasuredRun,
    PredictedFigure,
    ReadFiles,
    RunWarning,
    Verdict,
)
from pneutouch.results.record import SENSITIVITY_KEY, STIFFNESS_KEY
from pneutouch.results.uncertainty import UncertaintyRecord
from pneutouch.spec.campaign import AS_DESIGNED, CampaignRun, RunKind
from pneutouch.spec.material import Material
from pneutouch.spec.read import Changes
from pneutouch.spec.target import Target, TargetFigures
from pneutouch.units import KPA

_OF_STATE = (SENSITIVITY_KEY, STIFFNESS_KEY)
"""Figures with the same key in a state's uncertainty; the force at the greatest depth has that of the range end."""


@dataclass(frozen=True)
class StatePrediction:
    """Predicted state of one resin at one driving pressure: index ``place`` in an evaluation; ``why`` if there is
    none."""

    evaluation: Evaluation | None
    place: int
    why: str = ""

    @property
    def state(self) -> SensorState | None:
        """The predicted state; None if there is none."""
        return None if self.evaluation is None else self.evaluation.prediction.states[self.place]

    def expected(self) -> ExpectedRun | None:
        """Readings that the runs should show, up to the end of the range; None without a state or figures."""
        state = self.state
        if state is None or state.figures is None:
            return None
        kept = state.indentation <= state.range_end * (1 + 1e-12)
        return ExpectedRun(state.indentation[kept], state.force[kept], state.pressure_rise[kept])


def answers(
    design: str | DesignSource, changes: Changes, pairs_of: Iterable[tuple[str, float]], model: str, library: Library
) -> dict[tuple[str, float], StatePrediction]:
    """Predict the design for every (resin, driving pressure in kPa) given.

    If a resin's pressures cannot be predicted together, each is tried alone; one that fails has a reason instead of a
    state."""
    predictions: dict[tuple[str, float], StatePrediction] = {}
    pairs = sorted(set(pairs_of))
    for resin in dict.fromkeys(resin for resin, _ in pairs):
        pressures_kPa = [p for name, p in pairs if name == resin]
        try:
            evaluation = _evaluated(design, changes, resin, pressures_kPa, model, library)
            predictions |= {(resin, p): StatePrediction(evaluation, k) for k, p in enumerate(pressures_kPa)}
        except PneutouchError:
            predictions |= {(resin, p): _alone(design, changes, resin, p, model, library) for p in pressures_kPa}
    return predictions


def _alone(
    design: str | DesignSource, changes: Changes, resin: str, pressure_kPa: float, model: str, library: Library
) -> StatePrediction:
    try:
        return StatePrediction(_evaluated(design, changes, resin, [pressure_kPa], model, library), 0)
    except PneutouchError as error:
        return StatePrediction(None, 0, str(error))


def _evaluated(
    design: str | DesignSource, changes: Changes, resin: str, pressures_kPa: list[float], model: str, library: Library
) -> Evaluation:
    material = {} if resin == AS_DESIGNED else {"membrane.material": resin}
    pressed = {"pneumatics.driving_pressures_kPa": pressures_kPa}
    return evaluate(design, {**changes, **material, **pressed}, model=model, library=library)


def compared(group: RunGroup, answer: StatePrediction) -> GroupComparison:
    """A group compared with its prediction; without predicted figures, but a reason, for an aged print or a failed
    prediction."""
    state = answer.state
    if state is None or answer.evaluation is None:
        return GroupComparison(group, group.key.resin, None, UncertaintyRecord(), {}, answer.why)
    label = answer.evaluation.scene.membrane_material.title
    if group.key.age_days > 0:
        return GroupComparison(
            group, label, None, UncertaintyRecord(), {}, "predictions are of fresh prints; see aged predictions"
        )
    uncertainty = answer.evaluation.uncertainty[answer.place]
    predicted = _figures(state, uncertainty, depths_of(group, state))
    # In kPa/N, if the sensor is the paper's and was measured at a driving pressure of its Table S1.
    known = published_sensitivities(answer.evaluation.sensor, answer.evaluation.scene.membrane_material)
    at = [value for pressure, value in known.items() if math.isclose(pressure, group.key.driving_pressure_kPa)]
    published = {SENSITIVITY_KEY: at[0]} if at else {}
    return GroupComparison(group, label, state, uncertainty, predicted, published=published)


def depths_of(group: RunGroup, state: SensorState) -> list[list[Array]]:
    """Depths (n,) mm of each run of each specimen that gives a group's straight line; for a press by hand those at
    which the prediction has the same forces."""
    by_specimen: dict[str, list[Array]] = {}
    for curve in group.lined:
        if curve.indentation.size > 1:
            travel = np.interp(curve.force, state.force, state.indentation)
            depths = travel if curve.run.kind == "hand" else curve.indentation
            by_specimen.setdefault(curve.run.sensor, []).append(depths)
    return list(by_specimen.values())


def _figures(
    state: SensorState, uncertainty: UncertaintyRecord, depths: list[list[Array]]
) -> dict[str, tuple[float, float | None, float | None]]:
    known = uncertainty.known
    if state.figures is None:
        return {}
    curve = state.indentation, state.force, state.pressure_rise / KPA
    plain = figures_at(*curve, state.range_end, depths) if depths else line_figures(state.figures)
    names = {**{name: name for name in _OF_STATE}, "force_range_N": "force_at_range_end_N"}
    predictions: dict[str, tuple[float, float | None, float | None]] = {}
    for key, value in plain.items():
        ends = known.get(names.get(key, ""))
        # The relative uncertainty is that of the whole range.
        scale = 0.0 if ends is None else value / ends.value
        predictions[key] = (value, None, None) if ends is None else (value, scale * ends.low, scale * ends.high)
    return predictions


def unexpected(comparisons: Iterable[GroupComparison]) -> tuple[tuple[str, str], ...]:
    """Questions about groups whose figures lie outside the predicted interval: a file of the group, and possible
    reasons."""
    questions: list[tuple[str, str]] = []
    for comparison in comparisons:
        group, before = comparison.group, len(questions)
        for key, why in _EXPLAINED.items():
            _, low, high = comparison.predicted.get(key, (math.nan, None, None))
            measured = group.figures.get(key)
            late = any(curve.late for curve in group.lined)
            if late or measured is None or low is None or high is None or low <= measured.value <= high:
                continue
            if key == STIFFNESS_KEY and measured.value < low and len(questions) == before:
                why = f"{_yielding(group.lined[0], comparison.state)}; {why}"
            figure = BY_KEY[key]
            problem = (
                f"{figure.name} {measured.value:.4g} {figure.unit} at {group.key.driving_pressure_kPa:g} kPa is "
                f"outside the predicted {low:.4g} to {high:.4g}: {why}?"
            )
            questions.append((group.lined[0].run.file, problem))
    return tuple(questions)


def _yielding(curve: MeasuredCurve, state: SensorState | None) -> str:
    """Compliance of a rig that explains a stiffness too low at the predicted pressure, and its remedy, in words."""
    assert state is not None
    reach = min(float(curve.force[-1]), float(state.force[-1]))
    travels = [np.interp(reach, one.force, one.indentation) for one in (curve, state)]
    return (
        f"a rig that yields by {float(travels[0] - travels[1]) / reach:.2g} mm/N, which a press on a rigid block shows "
        "(state it in campaign.toml as rig.compliance_mm_per_N)"
    )


_EXPLAINED = {
    SENSITIVITY_KEY: "units of force or pressure, another resin, or gas behind the cavity (pneumatics.dead_volume_mL)",
    STIFFNESS_KEY: "units of force or travel, another resin or wall, or a record that begins with the sensor pressed",
}
"""Figures that are questioned outside the predicted interval, with possible reasons."""

_INFINITE = float("inf")

_SAME_KPA = 1e-6

_YEAR = 300.0, 430.0
"""Ages in days that are compared with the paper's change in a year."""


def verdicts(target: Target, groups: Sequence[RunGroup]) -> tuple[Verdict, ...]:
    """Verdicts on each requirement of a target for each group that measured its figure; sizes are not measured.

    A requirement that no group measured gets one undecided verdict."""
    figures = target.target
    outcomes = []
    for what, key, low, high, text in _requirements(figures):
        only_kPa = figures.driving_pressure_kPa
        answers = [
            group
            for group in groups
            if key in group.figures
            and (only_kPa is None or np.isclose(only_kPa, group.key.driving_pressure_kPa, atol=_SAME_KPA))
        ]
        for group in answers:
            where = f"{group.key.resin}, {group.key.age}, {group.key.driving_pressure_kPa:g} kPa"
            estimate = group.figures[key]
            outcomes.append(Verdict(f"{what}, {where}", text, _interval(estimate), _passed(estimate, low, high)))
        if not answers:
            where = "" if only_kPa is None else f", {only_kPa:g} kPa"
            outcomes.append(Verdict(f"{what}{where}", text, "not measured", None))
    return tuple(outcomes)


def _requirements(figures: TargetFigures) -> list[tuple[str, str, float, float, str]]:
    """Requirements of a target on figures: name, key of the figure, least, most, and text."""
    rows = []
    if (s := figures.sensitivity_kPa_per_N) is not None:
        part = figures.tolerance_percent / 100
        text = f"{s:g} kPa/N within {figures.tolerance_percent:g} %"
        rows.append(("Sensitivity", SENSITIVITY_KEY, s * (1 - part), s * (1 + part), text))
    if (f := figures.force_range_N) is not None:
        rows.append(("Force range", "force_range_N", f, _INFINITE, f"at least {f:g} N"))
    if figures.stiffness_depth_mm is not None:
        return rows
    if (k := figures.stiffness_least_N_per_mm) is not None:
        rows.append(("Stiffness", STIFFNESS_KEY, k, _INFINITE, f"at least {k:g} N/mm"))
    if (k := figures.stiffness_most_N_per_mm) is not None:
        rows.append(("Stiffness", STIFFNESS_KEY, 0.0, k, f"at most {k:g} N/mm"))
    return rows


def _interval(estimate: Estimate) -> str:
    if estimate.low is None or estimate.high is None:
        return f"{estimate.value:.4g} (one run: no interval)"
    remark = "" if estimate.over == "specimens" else ", this specimen alone"
    return f"{estimate.value:.4g} ({estimate.low:.4g} to {estimate.high:.4g}{remark})"


def _passed(estimate: Estimate, low: float, high: float) -> bool | None:
    """True if the whole interval lies within the limits, False if it lies outside; None if it lies on both sides, or
    there is no interval."""
    if estimate.low is None or estimate.high is None:
        return None
    if low <= estimate.low and estimate.high <= high:
        return True
    return False if estimate.high < low or estimate.low > high else None


def ageing(groups: Sequence[RunGroup], library: Library) -> tuple[AgeingChange, ...]:
    """Change of the sensitivity since fresh, in percent of the aged value, as in the paper's Supplement E.

    With the ends of its 95 % interval, and for an age of about a year the paper's change where it has one.
    """
    known = [group for group in groups if SENSITIVITY_KEY in group.figures]
    by_sensor: Callable[[RunGroup], tuple[str, float]] = lambda group: (group.key.resin, group.key.driving_pressure_kPa)  # noqa: E731
    changes: list[AgeingChange] = []
    for (resin, pressure), some in groupby(sorted(known, key=by_sensor), key=by_sensor):
        fresh, *aged = sorted(some, key=lambda group: group.key.age_days)
        if fresh.key.age_days == 0:
            for group in aged:
                published = (
                    _published_sensitivity(resin, library) if _YEAR[0] <= group.key.age_days <= _YEAR[1] else None
                )
                changes.append(AgeingChange(resin, pressure, group.key.age, *_change(fresh, group), published))
    return tuple(changes)


def _published_sensitivity(resin: str, library: Library) -> float | None:
    if resin == AS_DESIGNED:
        return None
    material: Material = library.load("materials", resin)
    measured = material.measured
    change = None if measured is None else measured.sensitivity_change_one_year_percent
    return None if change is None else change.nominal


def _change(fresh: RunGroup, aged: RunGroup) -> tuple[float, float | None, float | None]:
    """Change in percent and the ends of its interval, None without one; half widths of both intervals are added as
    squares."""
    new, old = fresh.figures[SENSITIVITY_KEY], aged.figures[SENSITIVITY_KEY]
    value = 100 * (old.value - new.value) / old.value
    shares = [(each.high - each.value) / each.value for each in (new, old) if each.high is not None]
    if len(shares) < 2:
        return value, None, None
    half = 100 * math.hypot(*shares) * new.value / old.value
    return value, value - half, value + half


def figures_of(measured: CampaignReport, read_as: tuple[ReadFiles, ...]) -> MeasuredCampaign:
    """Figures of a campaign, measured and predicted, as a record; ``read_as`` are the layouts that were guessed."""
    campaign = measured.campaign
    return MeasuredCampaign(
        title=campaign.title,
        lab=campaign.lab,
        simulated=campaign.simulated,
        design=measured.scene.name,
        input_hash=measured.input_hash,
        model=measured.model,
        level=LEVEL,
        groups=tuple(_group(comparison) for comparison in measured.comparisons),
        runs=tuple(_run(*of) for b in measured.comparisons for of in zip(b.group.curves, b.group.each, strict=True)),
        injections=measured.injections,
        ageing=measured.ageing,
        target=measured.verdicts,
        questions=tuple(DataQuestion(*each) for each in measured.questions),
        failures=tuple(FileFailure(*each) for each in measured.failures),
        read_as=read_as,
    )


def _group(comparison: GroupComparison) -> MeasuredGroup:
    group = comparison.group
    return MeasuredGroup(
        group.key.resin,
        group.key.age,
        group.key.driving_pressure_kPa,
        tuple(group.sensors),
        tuple(curve.run.file for curve in group.curves),
        comparison.why or None,
        {key: _figure(key, estimate, comparison) for key, estimate in group.figures.items()},
        _depth(comparison),
        None if comparison.state is None else round(comparison.state.range_end, 4),
    )


def _depth(comparison: GroupComparison) -> float | None:
    """Greatest depth of the runs that give a group's straight line, mm; None if there is none or it is not known."""
    depths = [float(curve.indentation[-1]) for curve in comparison.group.lined if curve.indentation.size > 1]
    return round(max(depths), 4) if depths and np.isfinite(depths).all() else None


def _figure(key: str, estimate: Estimate, comparison: GroupComparison) -> CampaignFigure:
    predicted = None
    if key in comparison.predicted:
        value, low, high = comparison.predicted[key]
        predicted = PredictedFigure(value, low, high, 100 * (estimate.value / value - 1) if value else None)
    over, unit = estimate.over or None, BY_KEY[key].unit
    ends = estimate.value, estimate.low, estimate.high
    return CampaignFigure(*ends, unit, estimate.specimens, estimate.runs, over, predicted)


def of_run(run: CampaignRun) -> tuple[str, RunKind, str, str, int, float, float]:
    """Values for the fields of `results.measured.RunOfSensor`."""
    return run.file, run.kind, run.sensor, run.resin, run.run, run.driving_pressure_kPa, run.age_days


def _run(curve: MeasuredCurve, values: dict[str, float]) -> MeasuredRun:
    warnings = (RunWarning(*doubtful(each), each.kind) for each in curve.warnings)
    return MeasuredRun(*of_run(curve.run), len(curve.force) - 1, values, tuple(warnings), curve.told)


def doubtful(part: SuspectInterval) -> tuple[float, float, str, bool]:
    """Values for the fields of `results.measured.DoubtfulPart`."""
    return round(part.start, 4), round(part.end, 4), part.why, part.used
