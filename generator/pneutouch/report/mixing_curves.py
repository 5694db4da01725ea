"""The table of a datasheet that sets a mix by its pair's mixing curves side by side."""

from typing import Any

from pneutouch.evaluation.sheet_data import SheetData
from pneutouch.mechanics.curve_outcome import CurveOutcome
from pneutouch.mechanics.prediction import SensorState
from pneutouch.rounding import tenths_below
from pneutouch.units import KPA

DASH = "–"

_CAPTION = (
    "The fraction of the stiff resin is printed exactly; its modulus is assumed. The published characterizations of "
    "such mixes differ, and none is of these two resins: each column predicts this design if its curve is true "
    "(docs/background/mixing.md). A curve measured on coupons of the printer in use replaces all of them."
)
_BEYOND = (
    "{curves}: the wall holds more of the stiff resin than this curve covers. The column takes its "
    "stiffest; the wall may be rigid there."
)


def curves_section(sheet: SheetData) -> dict[str, Any]:
    """Head, rows and lines of the table: a row a figure, a column a curve, the softest first."""
    if not sheet.curves:
        return {"known": False, "head": [], "rows": [], "lines": []}
    head = ["Figure", *(f"{one.by_curve.curve}: {one.by_curve.place}" for one in sheet.curves), "Unit"]
    rows = [
        _row("Mean shear modulus", "MPa", [f"{one.by_curve.shear_modulus_MPa.nominal:.2f}" for one in sheet.curves])
    ]
    for k, state in enumerate(sheet.prediction.states):
        at = f"at {state.driving_pressure / KPA:g} kPa"
        states = [one.states[k] if k < len(one.states) else None for one in sheet.curves]
        rows.append(_row(f"Sensitivity {at}", "kPa/N", [_sensitivity(one) for one in states]))
        rows.append(_row(f"Force range {at}", "N", [_range(one) for one in states]))
    rows.append(_row("Rated pressure", "kPa", [_rated(one) for one in sheet.curves]))
    beyond = ", ".join(one.by_curve.curve for one in sheet.curves if one.by_curve.beyond)
    lines = [_CAPTION, *([_BEYOND.format(curves=beyond)] if beyond else [])]
    return {"known": True, "head": head, "rows": rows, "lines": lines}


def _row(name: str, unit: str, values: list[str]) -> list[str]:
    return [name, *values, unit]


def _sensitivity(state: SensorState | None) -> str:
    return DASH if state is None or state.figures is None else f"{state.figures.sensitivity_kPa_per_N:.3f}"


def _range(state: SensorState | None) -> str:
    if state is None or state.figures is None:
        return DASH
    low, high = state.figures.force_range
    return f"{low:.1f} to {high:.1f}"


def _rated(outcome: CurveOutcome) -> str:
    return DASH if outcome.rated is None else f"{tenths_below(outcome.rated / KPA):.1f}"
