"""Variables of a sweep's dataset, each declared once: its place in a prediction, unit and meaning."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.evaluation.evaluate import Evaluation
from pneutouch.evaluation.table_s1 import is_near_paper
from pneutouch.evaluation.uncertainty import DIGITS, SensorSpread, spread, why_unknown
from pneutouch.mechanics import SensorState
from pneutouch.mechanics.atlas.coverage import under_plate
from pneutouch.mechanics.atlas.figures import SENSITIVITY
from pneutouch.mechanics.atlas.press import SensorBatch, batch_of
from pneutouch.mechanics.uncertainty.propagate import propagate_groups
from pneutouch.results.prediction import PredictionRecord, StateRecord
from pneutouch.results.record import SENSITIVITY_KEY, STIFFNESS_KEY
from pneutouch.wording import rounded

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
    """Function that reads a nested attribute; it returns None if one on the way is None."""

    def read(record: Any) -> Any:
        for key in keys:
            record = None if record is None else getattr(record, key)
        return record

    return read


def _number(name: str, units: str, long_name: str, *keys: str) -> SweepVariable:
    return SweepVariable(name, units, long_name, _at(*(keys or (name,))))


def _force(end: int) -> Callable[[StateRecord], Any]:
    return lambda state: None if state.force_range_N is None else state.force_range_N[end]


def _off_axis(name: str, units: str, long_name: str) -> SweepVariable:
    """Variable for the value of an off-axis curve at the end of the range."""

    def read(state: StateRecord) -> Any:
        values, travel = _at("off_axis", name)(state), state.curve.indentation_mm
        return None if values is None else float(np.interp(state.range_end_mm, travel, values))

    return SweepVariable(name, units, f"{long_name}, at the end of the range; central contact: NaN", read)


def _shear(name: str, units: str, long_name: str) -> SweepVariable:
    read = _at("off_axis", "shear", name)
    return SweepVariable(f"shear_{name}", units, f"{long_name}, where the object moves sideways; else NaN", read)


def _range_event(state: StateRecord) -> str:
    return next((event.kind for event in state.events if event.ends_range), "depth")


def _unread(state: StateRecord) -> None:
    """Return no value: an interval is not part of a state (see `state_values`)."""


ENDS = "sensitivity_low_kPa_per_N", "sensitivity_high_kPa_per_N"
_END = "end of the interval of the sensitivity, k = 2; unknown: NaN"

STATE: tuple[SweepVariable, ...] = (
    SweepVariable(
        "status", "", "ok, refused (not possible), failed (not computed); empty if not asked for", lambda _: "ok", True
    ),
    SweepVariable("message", "", "why a state is refused or failed", lambda _: "", True),
    _number(SENSITIVITY_KEY, "kPa/N", "slope of pressure rise over contact force, first contact to range end"),
    SweepVariable(ENDS[0], "kPa/N", f"lower {_END}", _unread),
    SweepVariable(ENDS[1], "kPa/N", f"upper {_END}", _unread),
    _number("sensitivity_through_origin_kPa_per_N", "kPa/N", "the same slope of a line through the origin"),
    _number("r_squared", "1", "coefficient of determination of the straight line"),
    _number("nonlinearity_percent", "percent", "greatest distance from the straight line over the full-scale rise"),
    _number(STIFFNESS_KEY, "N/mm", "mean slope of contact force over indentation, first contact to range end"),
    _number("range_end_mm", "mm", "indentation up to which the figures hold"),
    SweepVariable("range_end_event", "", "what ends the range: depth (nothing does), or the event", _range_event, True),
    SweepVariable("force_range_low_N", "N", "least contact force of the range", _force(0)),
    SweepVariable("force_range_high_N", "N", "greatest contact force of the range", _force(1)),
    _number("saturation_force_N", "N", "force where the local slope falls below half the fitted one; none: NaN"),
    _number("apex_height_inner_mm", "mm", "apex height of the inner surface, inflated, before contact"),
    _number("apex_height_outer_mm", "mm", "apex height of the outer surface, inflated, before contact"),
    _number("cavity_volume_mL", "mL", "gas under the inflated dome, before contact"),
    _off_axis("sideways_force_N", "N", "force of the dome on the object towards the offset"),
    _off_axis("moment_N_mm", "N mm", "moment of the dome on the object about the centre of the base plane"),
    _shear("stiffness_N_per_mm", "N/mm", "initial slope of the sideways force against the travel"),
    _shear("peak_sideways_force_N", "N", "sideways force where it is greatest against the travel"),
    _shear("slips_throughout_mm", "mm", "first travel at which every point of the contact slides"),
)
"""Variables for every point and driving pressure."""


def _apex_at_limit(side: str) -> SweepVariable:
    key, meaning = f"apex_height_{side}_mm", f"apex height of the {side} surface at the limit point"
    return _number(f"limit_point_{key}", "mm", meaning, "limit_point", key)


def _filled(key: str, units: str, meaning: str, *within: str) -> SweepVariable:
    """Variable of the state that a point has by its injected gas or apex height."""

    def read(record: PredictionRecord) -> Any:
        value = _at(*within, key)(record.filled[0]) if record.filled else None
        return None if value is None else float(value)

    return SweepVariable(f"filled_{key}", units, f"{meaning}, of the state by gas or height; none: NaN", read)


FILLED_SENSITIVITY = f"filled_{SENSITIVITY_KEY}"

_TEAR = "driving pressure at which the resin may tear; not before the limit point: NaN"
_RATED = "greatest driving pressure to be used: 0.9 of the lower end (k = 2) of the least limit"
_ERROR = "greatest known error of the sensitivity; unknown: NaN"
_LIMIT_ERROR = "known error of the limit pressure; unknown: NaN"
_BASIS = "basis of the error of the sensitivity"

POINT: tuple[SweepVariable, ...] = (
    SweepVariable("model", "", "model that answered; empty if no state is ok", _at("model"), True),
    _number("limit_point_kPa", "kPa", "driving pressure of the limit point; none: NaN", "limits", "limit_point_kPa"),
    _number("break_strain_kPa", "kPa", _TEAR, "limits", "break_strain_kPa"),
    _number("gauge_range_kPa", "kPa", "range of the pressure sensor", "limits", "gauge_range_kPa"),
    SweepVariable("binding_limit", "", "the limit that is met first", _at("limits", "binding"), True),
    _number("rated_pressure_kPa", "kPa", _RATED, "rating", "rated_pressure_kPa"),
    SweepVariable("rated_by", "", "the limit that the rated pressure follows from", _at("rating", "limit"), True),
    _apex_at_limit("inner"),
    _apex_at_limit("outer"),
    _number("dead_volume_mL", "mL", "gas behind the cavity"),
    _number("error_sensitivity_relative", "1", _ERROR, "error_estimate", "sensitivity_relative"),
    _number("error_limit_pressure_relative", "1", _LIMIT_ERROR, "error_estimate", "limit_pressure_relative"),
    SweepVariable("error_sensitivity_basis", "", _BASIS, _at("error_estimate", "sensitivity_basis"), True),
    _filled("injected_volume_mL", "mL", "gas injected into the vented sensor, at ambient pressure", "held"),
    _filled("driving_pressure_kPa", "kPa", "pressure before contact"),
    _filled("apex_height_outer_mm", "mm", "apex height of the outer surface before contact"),
    _filled("stable_regulated", "1", "1: a regulator holds it", "held"),
    _filled("stable_sealed", "1", "1: a syringe holds it", "held"),
    _filled(SENSITIVITY_KEY, "kPa/N", "sensitivity"),
    _filled(STIFFNESS_KEY, "N/mm", "stiffness"),
    _filled("range_end_mm", "mm", "range end"),
)
"""Variables for every point."""


def state_values(state: StateRecord, interval: Interval) -> dict[str, float | str | None]:
    """Values of a state for the dataset, with the ends of its sensitivity's interval; None where unknown."""
    ends = dict(zip(ENDS, interval or (None, None), strict=True))
    return {variable.name: ends.get(variable.name, variable.read(state)) for variable in STATE}


def point_values(prediction: PredictionRecord) -> dict[str, float | str | None]:
    """Values of a prediction for the dataset, without those of its states."""
    return {variable.name: variable.read(prediction) for variable in POINT}


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

MAPPED = {
    "sensitivity": ("sensitivity  (kPa/N)", SENSITIVITY_KEY),
    "force-range": ("greatest force of the range  (N)", "force_range_high_N"),
    "rated-pressure": ("rated pressure  (kPa)", "rated_pressure_kPa"),
    "interval": ("interval of the sensitivity, k = 2  (± %)", INTERVAL),
}
"""Label and variable of every figure that is mapped, by the name of the map's file."""

_REASONS = (
    ("beyond the limit point", "beyond the limit point"),
    ("plate's edge", "contact reaches the plate's edge"),
    ('model = "atlas": wall', "wall outside the atlas"),
    ("must be less than inner_radius_mm", "wall not thinner than the inner radius"),
    ("too small for the", "too small for the connector"),
    ("no equilibrium at", "no equilibrium found"),
    ("internal fault", "internal fault"),
)
"""Part of a message, and the words shown for every message that contains it."""


def reason_words(message: str) -> str:
    """Short words for a state's message; the same for messages that differ only in numbers."""
    for part, words in _REASONS:
        if part in message:
            return words
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
