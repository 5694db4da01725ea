"""Output of ``sweep`` for people: the first rows of its table."""

from pathlib import Path
from typing import Any

from pneutouch.cli.table import table_text
from pneutouch.rounding import tenths_below

_MOST = 24
"""Number of rows that are printed: as many as a screen shows."""

_FIGURES = {
    "sensitivity_kPa_per_N": ("S kPa/N", 3),
    "stiffness_N_per_mm": ("N/mm", 3),
    "force_range_high_N": ("N at the end", 2),
    "range_end_mm": ("range mm", 2),
    "limit_point_kPa": ("limit kPa", 1),
    "rated_pressure_kPa": ("rated kPa", 1),
}
"""Columns with their decimals, as `predict` shows the same figures."""


def sweep_text(rows: list[dict[str, Any]], table: Path) -> str:
    """The swept fields, figures and status of the first rows; where there are more, where they stand."""
    if not rows:
        return "no state"
    names = list(rows[0])
    swept = names[: names.index("driving_pressure_kPa")]
    head = [*swept, "kPa", "S kPa/N", "interval (k = 2)", *(name for name, _ in list(_FIGURES.values())[1:]), "status"]
    shown = [_cells(row, swept) for row in rows[:_MOST]]
    text = table_text(head, shown)
    left = len(rows) - len(shown)
    return f"{text}\n... and {left} more: {table}" if left else text


def _cells(row: dict[str, Any], swept: list[str]) -> list[str]:
    low, high = row["sensitivity_low_kPa_per_N"], row["sensitivity_high_kPa_per_N"]
    sensitivity, *others = (_figure(name, row[name]) for name in _FIGURES)
    interval = "-" if low is None else f"{low:.2f} to {high:.2f}"
    fields = [_field(row[name]) for name in (*swept, "driving_pressure_kPa")]
    return [*fields, sensitivity, interval, *others, row["status"]]


def _figure(name: str, value: float | None) -> str:
    """A figure with its decimals; a rated pressure is rounded down, so that the shown one is never above it."""
    if value is None:
        return "-"
    return f"{tenths_below(value) if name == 'rated_pressure_kPa' else value:.{_FIGURES[name][1]}f}"


def _field(value: Any) -> str:
    return "-" if value is None else f"{value:g}" if isinstance(value, float) else str(value)
