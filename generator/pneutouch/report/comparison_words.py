"""The tables of a comparison in words: the same cells on a terminal, on the page and in the PDF."""

from collections.abc import Sequence
from typing import Any

from pneutouch.report.numbers import DASH, between, number, signed
from pneutouch.results.comparison import ComparisonRecord, DifferenceRecord, RowRecord
from pneutouch.wording import SIMULATED

_DIGITS = 4


def labels(comparison: ComparisonRecord) -> list[str]:
    """Names of the columns."""
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
    """Name and unit of a figure."""
    return f"{row.name}, {row.unit}" if row.unit else row.name


def figure_cells(row: RowRecord) -> list[tuple[str, str]]:
    """Value and interval, one pair per sensor."""
    return [
        (DASH, "") if one is None else (number(one.value, _DIGITS), _interval(one.value, one.low, one.high))
        for one in row.values
    ]


def _interval(value: float, low: float | None, high: float | None) -> str:
    """The interval; empty if unknown, or no wider than the digits that are shown."""
    if low is None or high is None or number(low, _DIGITS, value) == number(high, _DIGITS, value):
        return ""
    return between((value, low, high), _DIGITS)


def difference_cells(row: RowRecord) -> list[tuple[str, str, str]]:
    """Difference in percent, its interval, and the verdict on it, for each sensor but the first."""
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
    """Verdict, in a word, on a difference against its uncertainty."""
    return "not known" if exceeds is None else "exceeds" if exceeds else "within"


def pressures(comparison: ComparisonRecord) -> list[float | None]:
    """The groups of figures: those of the whole sensor (None), then by driving pressure, kPa."""
    return list(dict.fromkeys(row.driving_pressure_kPa for row in comparison.figures))


def heading(pressure_kPa: float | None) -> str:
    """Title of a group of figures."""
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
    """One sentence for each sensor after the first: in which figures the difference exceeds its uncertainty."""
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
