"""What ``sweep`` prints for people: the first rows of its table."""

from pathlib import Path
from typing import Any

from pneutouch.cli.table import table_text

_MOST = 24
"""Rows that are printed: what a screen shows."""

_FIGURES = {
    "sensitivity_kPa_per_N": "S kPa/N",
    "stiffness_N_per_mm": "N/mm",
    "force_range_high_N": "N at the end",
    "range_end_mm": "range mm",
    "limit_point_kPa": "limit kPa",
}


def sweep_text(rows: list[dict[str, Any]], table: Path) -> str:
    """The swept fields, figures and status of the first rows; where there are more, where they stand."""
    if not rows:
        return "no state"
    names = list(rows[0])
    swept = names[: names.index("driving_pressure_kPa")]
    head = [*swept, "kPa", "S kPa/N", "interval (k = 2)", *list(_FIGURES.values())[1:], "status"]
    shown = [_cells(row, swept) for row in rows[:_MOST]]
    text = table_text(head, shown)
    left = len(rows) - len(shown)
    return f"{text}\n... and {left} more: {table}" if left else text


def _cells(row: dict[str, Any], swept: list[str]) -> list[str]:
    low, high = row["sensitivity_low_kPa_per_N"], row["sensitivity_high_kPa_per_N"]
    sensitivity, *others = (_number(row[name]) for name in _FIGURES)
    interval = "-" if low is None else f"{low:.3g} to {high:.3g}"
    fields = [_number(row[name]) for name in (*swept, "driving_pressure_kPa")]
    return [*fields, sensitivity, interval, *others, row["status"]]


def _number(value: Any) -> str:
    return "-" if value is None else f"{value:.4g}" if isinstance(value, float) else str(value)
