"""Sensors side by side, predicted or measured: the inputs that differ, and the figures that differ significantly.

Sources of uncertainty that two sensors share cancel in part in the difference of their predicted figures. A predicted
curve can be read at the depths of measured runs, because a figure belongs to the range it is fitted over.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, NamedTuple

import numpy as np

from pneutouch import __version__
from pneutouch.arrays import Array
from pneutouch.bench.figures import line_figures
from pneutouch.errors import InputError
from pneutouch.mechanics.response import figures
from pneutouch.mechanics.uncertainty.sources.model_error import MODEL, MODEL_CORRELATION
from pneutouch.parts import Assembly
from pneutouch.results.comparison import (
    ColumnRecord,
    ComparedCurve,
    ComparisonRecord,
    DifferenceRecord,
    RowRecord,
    ValueRecord,
)
from pneutouch.results.prediction import CurvePoints
from pneutouch.results.record import extended
from pneutouch.wording import data_of, rounded

_OF_RESIN = ("published modulus", "mixing fraction", "ageing of the modulus", "ageing")
"""Sources that are one unknown number for all sensors in one resin, of one age."""


@dataclass(frozen=True, slots=True)
class SourceEffect:
    """Signed change of the logarithm of a figure by one standard uncertainty of the source ``name``."""

    name: str
    origin: str
    size: float


def effects_of(uncertainty: Mapping[str, Any], figure: str) -> tuple[SourceEffect, ...]:
    """Effects of every source on a figure, from a state's uncertainty as data; their squares sum to its variance."""
    entry = uncertainty["figures"][figure]
    total, slopes = entry["standard_uncertainty_relative"], uncertainty["elasticities"][figure]
    origins: dict[str, str] = {}
    inputs: dict[str, set[str]] = {}
    for source in uncertainty["sources"]:
        if figure in source["figures"]:
            origins[source["name"]] = source["origin"]
            inputs.setdefault(source["name"], set()).add(source["acts_on"])
    effects = []
    for name, share in entry["shares"].items():
        # What acts on several inputs at once has no sign that holds for it alone.
        acts_on = inputs.get(name, set())
        slope = slopes.get(next(iter(acts_on)), 1.0) if len(acts_on) == 1 else 1.0
        effects.append(SourceEffect(name, origins.get(name, ""), math.copysign(total * math.sqrt(share), slope)))
    return tuple(effects)


def variance_of_ratio(first: Sequence[SourceEffect], second: Sequence[SourceEffect], *, same_resin: bool) -> float:
    """Variance of the logarithm of the ratio of two figures (JCGM 100, 5.2.2).

    For sensors in the same resin, sources on the resin are taken as fully correlated, and the model's errors by
    `MODEL_CORRELATION` if both come from the same measurements. All else is taken as independent.
    """
    total = sum(effect.size**2 for effect in (*first, *second))
    if not same_resin:
        return total
    second_by_name = {effect.name: effect for effect in second}
    for one in first:
        other = second_by_name.get(one.name)
        if other is not None:
            total -= 2 * _coefficient(one, other) * one.size * other.size
    return max(total, 0.0)


def _coefficient(one: SourceEffect, other: SourceEffect) -> float:
    if one.name in _OF_RESIN:
        return 1.0
    # The calibrated parameters are several unknowns, whose effects two states weigh differently: as one unknown they
    # would cancel where they do not. Taken as independent they do not cancel at all, which errs on the wide side.
    return MODEL_CORRELATION if one.name == MODEL and one.origin == other.origin else 0.0


CURVE_KEYS = tuple(field.name for field in fields(CurvePoints))
"""Keys of the quantities of a drawn curve."""

COVERAGE = 2.0
"""k of every interval; a difference that exceeds k combined standard uncertainties is no chance at about 95 %."""

_CLOSE, _EXACT, _DIGITS = 1e-6, 1e-9, 6

_STATED = data_of(__file__)

CRITERION = str(_STATED["criterion"]).format(k=COVERAGE)


class FigureColumn(NamedTuple):
    """A figure that is compared: key, name and unit; ``of_state``: False for a figure of the whole sensor."""

    key: str
    name: str
    unit: str
    of_state: bool = True


FIGURES = tuple(FigureColumn(**figure) for figure in _STATED["figures"])


@dataclass(frozen=True, slots=True)
class ComparedFigure:
    """A figure, the ends of its k = 2 interval (None if unknown), and effects of its sources of uncertainty."""

    value: float
    low: float | None = None
    high: float | None = None
    effects: tuple[SourceEffect, ...] = ()

    @property
    def variance(self) -> float | None:
        """Variance of the figure's logarithm, from the effects, else from the k = 2 interval; None without either."""
        if self.effects:
            return sum(effect.size**2 for effect in self.effects)
        if self.low is None or self.high is None or self.value == 0:
            return None
        if min(self.low, self.value) <= 0:
            return float(((self.high - self.low) / (2 * COVERAGE * self.value)) ** 2)
        return (math.log(self.high / self.low) / (2 * COVERAGE)) ** 2


@dataclass(frozen=True, slots=True)
class ComparedState:
    """Figures by key at a driving pressure, and curves: the predicted one, or one for each measured run."""

    driving_pressure_kPa: float
    figures: Mapping[str, ComparedFigure]
    curves: tuple[CurvePoints, ...]


@dataclass(frozen=True)
class ComparedSensor:
    """One column of a comparison.

    ``inputs`` are by ``table.key``; ``resin`` is all that is known of the membrane's resin, None for a measured sensor;
    ``assembly`` draws the parts; ``simulated`` is True if its runs were simulated.
    """

    name: str
    kind: str
    source: str
    inputs: Mapping[str, Any]
    resin: Any
    states: tuple[ComparedState, ...]
    notes: tuple[str, ...] = ()
    assembly: Callable[[], Assembly] | None = None
    label: str = ""
    simulated: bool = False

    def state(self, pressure_kPa: float) -> ComparedState | None:
        """The state at a driving pressure; None if the sensor has none there."""
        return next((s for s in self.states if abs(s.driving_pressure_kPa - pressure_kPa) < _CLOSE), None)


def labelled(sensors: Sequence[ComparedSensor]) -> tuple[str, ...]:
    """Labels of the columns: the sensor's name, or its source if names are equal; equal labels are numbered."""
    names = [sensor.name for sensor in sensors]
    texts = [s.source if names.count(s.name) > 1 and s.source else s.name for s in sensors]
    return tuple(f"{text} ({k})" if texts.count(text) > 1 else text for k, text in enumerate(texts, start=1))


def shared_pressures_kPa(sensors: Sequence[ComparedSensor]) -> list[float]:
    """Driving pressures that all sensors share. Raises InputError if there are none."""
    first, *others = sensors
    shared_kPa = [
        s.driving_pressure_kPa for s in first.states if all(other.state(s.driving_pressure_kPa) for other in others)
    ]
    if not shared_kPa:
        listed = "; ".join(
            f"{sensor.label}: {', '.join(f'{s.driving_pressure_kPa:g}' for s in sensor.states)} kPa"
            for sensor in sensors
        )
        raise InputError(
            f"no driving pressure is common to all ({listed})",
            remedy="give the designs the driving pressures of the others, such as pneumatics.driving_pressures_kPa="
            f"[{', '.join(f'{s.driving_pressure_kPa:g}' for s in others[-1].states)}]",
        )
    return shared_kPa


def different_inputs(sensors: Sequence[ComparedSensor]) -> dict[str, tuple[Any, ...]]:
    """Inputs that differ between predicted sensors, by key: a value for each sensor, None if it is not known."""
    keys = dict.fromkeys(key for sensor in sensors for key in sensor.inputs)
    # What a prediction does not name it has not, but the wall, which a calibration alone names; of a measurement no
    # input is known.
    walls = {"prediction.wall_thickness_mm": "membrane.wall_thickness_mm"}
    rows = {key: tuple(s.inputs.get(key, s.inputs.get(walls.get(key, ""))) for s in sensors) for key in keys}
    known = {key: [value for s, value in zip(sensors, row, strict=True) if s.inputs] for key, row in rows.items()}
    return {key: values for key, values in rows.items() if any(value != known[key][0] for value in known[key])}


def comparison(sensors: Sequence[ComparedSensor]) -> ComparisonRecord:
    """Comparison of every other sensor with the first. Raises InputError if no driving pressure is common to all."""
    pressures_kPa = shared_pressures_kPa(sensors)
    rows = [_row(figure, None, sensors) for figure in FIGURES if not figure.of_state]
    rows += [_row(figure, p, sensors) for p in pressures_kPa for figure in FIGURES if figure.of_state]
    inputs = different_inputs(sensors)
    record = ComparisonRecord(
        pneutouch=__version__,
        compared=tuple(
            ColumnRecord(
                label=s.label,
                name=s.name,
                kind=s.kind,
                source=s.source,
                simulated=s.simulated,
                driving_pressures_kPa=tuple(state.driving_pressure_kPa for state in s.states),
            )
            for s in sensors
        ),
        inputs=inputs,
        driving_pressures_kPa=tuple(pressures_kPa),
        coverage_factor=COVERAGE,
        criterion=CRITERION,
        figures=tuple(row for row in rows if sum(value is not None for value in row.values) > 1),
        notes=tuple(_notes(sensors, pressures_kPa, inputs)),
        curves=tuple(
            extended(ComparedCurve, curve, label=s.label, measured=s.kind == "measured", driving_pressure_kPa=p)
            for p in pressures_kPa
            for s in sensors
            for state in [s.state(p)]
            for curve in (() if state is None else state.curves)
        ),
    )
    return rounded(record, _DIGITS, 1e-12)


def _row(figure: FigureColumn, pressure_kPa: float | None, sensors: Sequence[ComparedSensor]) -> RowRecord:
    first, *others = values = [_of(sensor, figure.key, pressure_kPa) for sensor in sensors]
    same = (sensors[0].resin is not None and sensors[0].resin == sensor.resin for sensor in sensors[1:])
    return RowRecord(
        figure=figure.key,
        name=figure.name,
        unit=figure.unit,
        driving_pressure_kPa=pressure_kPa,
        values=tuple(None if f is None else ValueRecord(f.value, f.low, f.high) for f in values),
        differences=tuple(
            _difference(first, other, same_resin=alike) for other, alike in zip(others, same, strict=True)
        ),
    )


def _of(sensor: ComparedSensor, key: str, pressure_kPa: float | None) -> ComparedFigure | None:
    states = sensor.states if pressure_kPa is None else (sensor.state(pressure_kPa),)
    return next((s.figures[key] for s in states if s is not None and key in s.figures), None)


def _difference(
    one: ComparedFigure | None, other: ComparedFigure | None, *, same_resin: bool
) -> DifferenceRecord | None:
    """``other`` less ``one``, with interval in percent and the criterion applied; None if one of them is missing."""
    if one is None or other is None:
        return None
    difference = other.value - one.value
    if one.value * other.value <= 0:
        return DifferenceRecord(difference, None, None, None, None)
    ratio = math.log(other.value / one.value)
    percent, first, second = 100 * math.expm1(ratio), one.variance, other.variance
    if first is None or second is None:
        return DifferenceRecord(difference, percent, None, None, None)
    both = one.effects and other.effects
    total = variance_of_ratio(one.effects, other.effects, same_resin=same_resin) if both else first + second
    width = COVERAGE * math.sqrt(total)
    low, high = (100 * math.expm1(ratio + sign * width) for sign in (-1, 1))
    return DifferenceRecord(difference, percent, low, high, abs(ratio) > max(width, _EXACT))


def _notes(sensors: Sequence[ComparedSensor], pressures_kPa: Sequence[float], inputs: Mapping[str, Any]) -> list[str]:
    """Notes on assumptions and on driving pressures that are left out, then the sensors' own."""
    notes, words = list[str](), _STATED["notes"]
    predicted = [s for s in sensors if s.resin is not None]
    if len(predicted) > 1 and sensors[0].resin is not None:
        if any(s.resin == sensors[0].resin for s in predicted[1:]):
            notes.append(words["one_resin"].format(correlation=MODEL_CORRELATION))
        notes.append(words["each_by_itself"])
    if any(s.kind != "measured" for s in sensors):
        if any("calibration" in s.inputs for s in predicted):
            notes.append(words["calibrated"])
        notes.append(words["model_error"])
    if any(s.kind == "measured" for s in sensors):
        notes.append(words["measured"])
    left_kPa = sorted({state.driving_pressure_kPa for s in sensors for state in s.states} - set(pressures_kPa))
    if left_kPa:
        notes.append(f"Not compared, because not all have them: {', '.join(f'{p:g}' for p in left_kPa)} kPa.")
    if not inputs and len(predicted) == len(sensors):
        notes.append("No input differs.")
    return [*notes, *dict.fromkeys(note for sensor in sensors for note in sensor.notes)]


_ROUNDING, _BEYOND, _LEAST_POINTS = 1e-9, 0.01, 3
"""Share of a range end up to which a measured depth beyond it is read there: no first contact is found more exactly."""


def figures_at(
    indentation: Array, force: Array, rise_kPa: Array, range_end: float, specimens: Sequence[Sequence[Array]]
) -> dict[str, float]:
    """Figures of a curve (mm, N, kPa; one length) by key of `bench.figures.FIGURES`, as measured runs would give them.

    ``specimens`` holds the depths of each run of each specimen, mm. The curve is read at every run's own depths, as far
    as ``range_end`` (mm), and the figures are averaged as measured ones are: over the runs, then over the specimens.
    Saturation is left out where a run does not reach it. Empty if the curve has too few points.
    """
    from scipy.interpolate import PchipInterpolator

    kept = indentation <= range_end * (1 + _ROUNDING)
    travel, first = np.unique(indentation[kept], return_index=True)
    if travel.size < _LEAST_POINTS:
        return {}
    read = PchipInterpolator(travel, np.stack([force[kept][first], rise_kPa[kept][first]], axis=1))
    averages = []
    for runs in specimens:
        inside = (np.minimum(at[at <= range_end * (1 + _BEYOND)], travel[-1]) for at in runs)
        fitted = [figures(at, *read(at).T) for at in inside]
        each = [line_figures(one) for one in fitted if one is not None]
        if each:
            averages.append(_mean(each))
    return _mean(averages) if averages else {}


def _mean(each: Sequence[dict[str, float]]) -> dict[str, float]:
    return {key: float(np.mean([one[key] for one in each])) for key in each[0] if all(key in one for one in each)}
