"""The gauge on a datasheet: its range, and the smallest force that it detects."""

from pneutouch.evaluation.sheet_data import SheetData
from pneutouch.units import KPA


def gauge_range(sheet: SheetData) -> list[str]:
    """Range, unit and note of the gauge."""
    gauge, reading = sheet.scene.gauge, sheet.gauge
    note = f"{reading.title}, the paper's, assumed"
    if gauge is not None:
        note = f"{reading.title} ({_breakable(gauge.order_code)})"
    if gauge is not None and gauge.is_absolute:
        note += (
            f"; absolute, {gauge.range_kPa.low:g} to {gauge.range_kPa.high:g} kPa: it reads the ambient pressure too, "
            "which must be subtracted"
        )
    return [f"{reading.low_kPa:.4g} to {reading.limit_kPa:.4g}", "kPa gauge", note]


def _breakable(code: str) -> str:
    """An order code that a narrow column may break, at a space of no width after every eighth character."""
    return "\u200b".join(code[start : start + 8] for start in range(0, len(code), 8))


def gauge_volume(sheet: SheetData) -> str:
    """Volume that the gauge adds to the dead volume, in words; empty if the design names no gauge."""
    gauge = sheet.scene.gauge
    if gauge is None:
        return ""
    if gauge.inner_volume_mL is None:
        return "; the gauge's own volume is not known and not counted"
    return f" and gauge {sheet.assembly.gauge_volume_mL:.3f} mL"


def detection(sheet: SheetData) -> list[list[str]]:
    """Rows of quantity, value and basis: the smallest force, and the warming that reads the same."""
    reading, forces = sheet.gauge, sheet.gauge.forces
    ends = forces if len(forces) < 2 else (forces[0], forces[-1])
    at = " and ".join(f"{one.driving_pressure / KPA:g}" for one in ends) + " kPa"
    if reading.threshold_kPa is None:
        return [["Smallest force detected", "not known", f"{reading.limited_by} ({reading.title})"]]
    band = "" if reading.rate_Hz is None else f", to {reading.rate_Hz / 2:g} Hz"
    return [
        [
            "Smallest force detected",
            _both([one.force for one in ends], "N"),
            f"{reading.criterion}{band}, at {at}; limited by {reading.limited_by} ({reading.title})",
        ],
        [
            "at first contact",
            _both([one.at_first_contact for one in ends], "N"),
            f"warming by {_both([one.warming for one in ends], 'K')} reads as much as the row above",
        ],
    ]


def _both(values: list[float | None], unit: str) -> str:
    return " and ".join("–" if value is None else f"{value:.2g}" for value in values) + f" {unit}"
