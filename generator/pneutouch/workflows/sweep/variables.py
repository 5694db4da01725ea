"""Variables of a sweep's dataset, each declared once: its place in a prediction, unit and meaning."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.evaluation.evaluate import Evaluation
from pneutouch.evaluation.table_s1 import is_near_paper
from pneutouch.evaluation.uncertainty import SensorSpread, spread, why_unknown
from pneutouch.mechanics import SensorState
from pneutouch.mechanics.atlas.coverage import under_plate
from pneutouch.mechanics.atlas.figures import SENSITIVITY
from pneutouch.mechanics.atlas.press import SensorBatch, batch_of
from pneutouch.mechanics.uncertainty.document import DIGITS
from pneutouch.mechanics.uncertainty.propagate import propagate_groups
from pneutouch.results.prediction import PredictionRecord, StateRecord
from pneutouch.results.record import SENSITIVITY_KEY
from pneutouch.wording import data_of, rounded
from pneutouch.workflows.sweep.grid import FILLINGS

Interval = tuple[float, float] | None


@dataclass(frozen=True, slots=True)
class SweepVariable:
    """A variable, with the function that reads it from a state or a prediction (records of `results`)."""

    name: str
    units: str
    long_name: str
    read: Callable[[Any], Any]
    text: bool = False


def _at(*keys: str) -> Callable[[Any], Any]:
    """Function that reads a nested attribute, or the first of a list; it returns None if one on the way is missing."""

    def read(record: Any) -> Any:
        for key in keys:
            if key == "first":
                record = record[0] if record else None
            else:
                record = None if record is None else getattr(record, key)
        return record

    return read


def _at_range_end(key: str) -> Callable[[StateRecord], float | None]:
    """Function that reads an off-axis curve at the end of the range."""

    def read(state: StateRecord) -> float | None:
        values, travel = _at("off_axis", key)(state), state.curve.indentation_mm
        return None if values is None else float(np.interp(state.range_end_mm, travel, values))

    return read


def _force(end: int) -> Callable[[StateRecord], Any]:
    return lambda state: None if state.force_range_N is None else state.force_range_N[end]


def _range_event(state: StateRecord) -> str:
    return next((event.kind for event in state.events if event.ends_range), "depth")


_STATED = data_of(__file__)

ENDS = "sensitivity_low_kPa_per_N", "sensitivity_high_kPa_per_N"

_READ: dict[str, Callable[[Any], Any]] = {
    "status": lambda _: "ok",
    "message": lambda _: "",
    # An interval is not part of a state: see `state_values`.
    **dict.fromkeys(ENDS, lambda _: None),
    "range_end_event": _range_event,
    "force_range_low_N": _force(0),
    "force_range_high_N": _force(1),
    "sideways_force_N": _at_range_end("sideways_force_N"),
    "moment_N_mm": _at_range_end("moment_N_mm"),
}
"""Functions for the variables of a state that have no place of their own in it."""


def _declared(kind: str) -> tuple[SweepVariable, ...]:
    return tuple(
        SweepVariable(
            name,
            one.get("units", ""),
            one["long_name"],
            _READ.get(name) or _at(*one.get("read", name).split(".")),
            one.get("text", False),
        )
        for name, one in _STATED[kind].items()
    )


FILLED_SENSITIVITY = f"filled_{SENSITIVITY_KEY}"

STATE = _declared("state")
"""Variables for every point and driving pressure."""

POINT = _declared("point")
"""Variables for every point."""


def state_values(state: StateRecord, interval: Interval) -> dict[str, float | str | None]:
    """Values of a state for the dataset, with the ends of its sensitivity's interval; None where unknown."""
    ends = dict(zip(ENDS, interval or (None, None), strict=True))
    return {variable.name: ends.get(variable.name, variable.read(state)) for variable in STATE}


def point_values(prediction: PredictionRecord) -> dict[str, float | str | None]:
    """Values of a prediction for the dataset, without those of its states."""
    return {variable.name: variable.read(prediction) for variable in POINT}


def empty_columns(variables: Sequence[SweepVariable], count: int, widths: dict[str, int]) -> dict[str, np.ndarray]:
    """Arrays (count,) by name for the values of variables: NaN, or an empty text, where nothing is filled in."""
    return {v.name: np.zeros(count, f"S{widths[v.name]}") if v.text else np.full(count, np.nan) for v in variables}


def fill_row(columns: dict[str, np.ndarray], row: int, values: dict[str, Any]) -> None:
    """Put the known values of a row into their columns."""
    for name, value in values.items():
        if value is not None and name in columns:
            columns[name][row] = value.encode() if isinstance(value, str) else value


def sensitivity_intervals(evaluations: Sequence[Evaluation]) -> list[list[Interval]]:
    """Ends of the k = 2 interval of each state's sensitivity, kPa/N, for each evaluation, as ``predict`` states them;
    None where it is unknown. All sensors in one pass through the atlas, their sources once for those alike."""
    widths: list[Array | None] = [None] * len(evaluations)
    alike: dict[tuple[Any, ...], list[int]] = {}
    for k, one in enumerate(evaluations):
        if why_unknown(one.sensor.even, one.prediction.model) is not None:
            continue
        scene, near = one.scene, is_near_paper(one.sensor.even)
        if scene.calibration or scene.design.contact.anywhere or one.sensor.protocol.other_contact is not None:
            widths[k] = _spread([one]).combined().budget.expanded[SENSITIVITY]
        else:
            shared = id(scene.membrane_material), id(scene.printer), one.prediction.model, near
            alike.setdefault(shared, []).append(k)
    groups = [_spread([evaluations[k] for k in rows])[:2] for rows in alike.values()]
    for rows, budget in zip(alike.values(), propagate_groups(groups) if groups else (), strict=True):
        ends = np.cumsum([len(evaluations[k].prediction.states) for k in rows])
        for k, part in zip(rows, np.split(budget.expanded[SENSITIVITY], ends[:-1]), strict=True):
            widths[k] = part
    return [
        [None if width is None else _interval(state, float(width[i])) for i, state in enumerate(one.prediction.states)]
        for one, width in zip(evaluations, widths, strict=True)
    ]


def _spread(evaluations: Sequence[Evaluation]) -> SensorSpread:
    """The sources of an evaluation's states, or of those of several whose sources are alike."""
    first = evaluations[0]
    scene, states = first.scene, first.prediction.states
    sensors = [(under_plate(e.sensor.even), [s.driving_pressure for s in e.prediction.states]) for e in evaluations]
    return spread(
        first.sensor.even,
        sensors[0][1],
        scene.membrane_material,
        list(first.resins.values()),
        scene.printer,
        first.prediction.model,
        scene.calibration,
        states,
        anywhere=scene.design.contact.anywhere,
        batch=SensorBatch.join([batch_of(*each) for each in sensors]),
    )


def _interval(state: SensorState, width: float) -> Interval:
    if state.figures is None or not np.isfinite(width):
        return None
    value = state.figures.sensitivity
    return rounded((value * float(np.exp(-width)), value * float(np.exp(width))), DIGITS)


INTERVAL = "sensitivity_interval_percent"
"""Name of the half width of the sensitivity's interval, which follows from its ends."""

MAPPED: dict[str, tuple[str, str]] = {name: tuple(pair) for name, pair in _STATED["mapped"].items()}
"""Label and variable of every figure that is mapped, by the name of the map's file."""

FILLED_MAPPED = {"sensitivity": (MAPPED["sensitivity"][0], FILLED_SENSITIVITY)}
"""`MAPPED` of a sweep over fillings."""


def over_filling(content: Any) -> bool:
    """True if injected gas or the apex height is swept in a dataset."""
    return any(values.attrs.get("key") in FILLINGS for values in content.coords.values())


def reason_words(message: str) -> str:
    """Short words for a state's message; the same for messages that differ only in numbers."""
    for part, words in _STATED["reasons"].items():
        if part in message:
            return str(words)
    problem = re.sub(r"^(?:[\w./\[\]-]+(?: = [^:]+)?: )+", "", message.split("; ")[0])
    words = re.sub(r"(?<![A-Za-z])-?\d[\d.e+-]*", "…", problem)
    return words if len(words) <= 60 else f"{words[:59].rstrip()}…"


def missing_reasons(values: Array, messages: Array) -> tuple[tuple[str, ...], ...]:
    """Words for every value (n, m): "" if finite; else from its first non-empty message (n, m, k), or "not known"."""
    known = np.isfinite(values)
    words = np.full(known.shape, "", object)
    for place in np.argwhere(~known).tolist():
        words[tuple(place)] = next((reason_words(text) for text in messages[tuple(place)] if text), "not known")
    return tuple(map(tuple, words.tolist()))
