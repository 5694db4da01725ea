"""The texts of the tables of a comparison, the same on a terminal, on the page and in the PDF."""

from collections.abc import Sequence
from typing import Any

from pneutouch.report.numbers import DASH, between, number, signed
from pneutouch.results.comparison import ComparisonRecord, DifferenceRecord, RowRecord
from pneutouch.wording import SIMULATED

_DIGITS = 4


def labels(comparison: ComparisonRecord) -> list[str]:
    """Labels of the compared sensors, in order."""
    return [one.label for one in comparison.compared]


def input_rows(comparison: ComparisonRecord) -> list[list[str]]:
    """The inputs that differ, one row each: the key, and one value per sensor."""
    return [[key, *(_value(value) for value in values)] for key, values in comparison.inputs.items()]


def _value(value: Any) -> str:
    if value is None:
        return DASH
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, list | tuple):
        return ", ".join(_value(item) for item in value) if len(value) <= 8 else f"{len(value)} entries"
    if isinstance(value, dict):
        return ", ".join(f"{key} {_value(item)}" for key, item in value.items())
    return str(value)


def figure_name(row: RowRecord) -> str:
    """Name of a figure, with its unit if it has one."""
    return f"{row.name}, {row.unit}" if row.unit else row.name


def figure_cells(row: RowRecord) -> list[tuple[str, str]]:
    """Value and interval of a figure as texts, one pair for each sensor; a dash for an unknown value."""
    return [
        (DASH, "") if one is None else (number(one.value, _DIGITS), _interval(one.value, one.low, one.high))
        for one in row.values
    ]


def _interval(value: float, low: float | None, high: float | None) -> str:
    """An interval as text; empty if unknown, or if its ends look the same in the digits shown."""
    if low is None or high is None or number(low, _DIGITS, value) == number(high, _DIGITS, value):
        return ""
    return between((value, low, high), _DIGITS)


def difference_cells(row: RowRecord) -> list[tuple[str, str, str]]:
    """Difference in percent, its interval and `verdict`, for each sensor after the first; a dash if unknown."""
    return [_difference(one) for one in row.differences]


def _difference(one: DifferenceRecord | None) -> tuple[str, str, str]:
    if one is None:
        return DASH, "", DASH
    if one.percent is None:
        return number(one.difference, _DIGITS), "", DASH
    low, high = one.low_percent, one.high_percent
    interval = "" if low is None or signed(low) == signed(high) else f"{signed(low)} to {signed(high)} %"
    return f"{signed(one.percent)} %", interval, verdict(one.exceeds)


def verdict(exceeds: bool | None) -> str:
    """Comparison of a difference with its uncertainty as a word; "not known" for None."""
    return "not known" if exceeds is None else "exceeds" if exceeds else "within"


def pressures(comparison: ComparisonRecord) -> list[float | None]:
    """Driving pressures of the groups of figures, kPa, in the order of the figures; None: the whole sensor."""
    return list(dict.fromkeys(row.driving_pressure_kPa for row in comparison.figures))


def heading(pressure_kPa: float | None) -> str:
    """Title of the group of figures at a driving pressure; None: of the whole sensor."""
    return "the sensor" if pressure_kPa is None else f"at {pressure_kPa:g} kPa"


def marks(comparison: ComparisonRecord) -> list[str]:
    """One sentence for each sensor whose figures rest on simulated runs."""
    how = {"measured": "a program made these runs; no sensor was measured"}
    return [
        f"{SIMULATED}: {one.label}: {how.get(one.kind, 'calibrated on simulated runs; no unit has been tested')}."
        for one in comparison.compared
        if one.simulated
    ]


def summary(comparison: ComparisonRecord) -> list[str]:
    """One sentence for each sensor after the first: figures whose difference exceeds its uncertainty."""
    first, *others = labels(comparison)
    sentences = []
    for k, label in enumerate(others):
        known_rows = [(row, one) for row in comparison.figures if (one := row.differences[k]) is not None]
        beyond = [(row, one) for row, one in known_rows if one.exceeds]
        known = [one for _, one in known_rows if one.exceeds is not None]
        if not known:
            sentences.append(f"{label} and {first}: no interval is known, so no difference can be judged.")
        elif not beyond:
            sentences.append(f"{label} against {first}: no difference exceeds its uncertainty.")
        else:
            sentences.append(f"{label} against {first}: {_joined(beyond)}; the other differences do not exceed theirs.")
            if len(beyond) == len(known):
                sentences[-1] = f"{label} against {first}: {_joined(beyond)}."
    return sentences


def _joined(beyond: Sequence[tuple[RowRecord, DifferenceRecord]]) -> str:
    by_name: dict[str, list[str]] = {}
    for row, one in beyond:
        p = row.driving_pressure_kPa
        by_name.setdefault(row.name, []).append(f"{signed(one.percent)} %" + ("" if p is None else f" at {p:g} kPa"))
    return "; ".join(f"{name} {', '.join(texts)}" for name, texts in by_name.items()) + (
        " exceeds its uncertainty" if len(beyond) == 1 else " exceed their uncertainties"
    )
