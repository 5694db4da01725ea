"""How fast the sensor reads, in rows of a datasheet."""

from collections.abc import Callable

from pneutouch.evaluation.dynamics import DynamicState
from pneutouch.evaluation.sheet_data import SheetData
from pneutouch.units import KPA

_DASH = "–"


def speed_rows(sheet: SheetData) -> list[list[str]]:
    """Rows of quantity, value and basis at the lowest and the highest driving pressure; of the first relaxation data.

    Empty where the bandwidth was not computed.
    """
    if sheet.bandwidth is None:
        return []
    first = {state.driving_pressure: state for state in reversed(sheet.bandwidth.states)}
    ends = [first[p] for p in sorted({min(first), max(first)})]
    at = " and ".join(f"{state.driving_pressure / KPA:g}" for state in ends) + " kPa"

    def values(of: Callable[[DynamicState], float | None], form: str, unit: str) -> str:
        texts = [_DASH if (value := of(state)) is None else format(value, form) for state in ends]
        return f"{' and '.join(texts)} {unit}"

    rate_Hz = sheet.bandwidth.rate_Hz
    usable = [state.usable(rate_Hz) for state in ends]
    limits = " and ".join(dict.fromkeys(why for _, why in usable if why is not None)) or "nothing found"
    narrow = " and ".join(dict.fromkeys(state.band.limited_by or _DASH for state in ends))
    gauge = "the gauge's rate is not known" if rate_Hz is None else f"{rate_Hz:g} readings a second"
    note = "" if sheet.bandwidth.note is None else f"; {sheet.bandwidth.note}"
    line = f"connector, tube and gauge as a line with losses, small step of force, at {at}{note}"
    return [
        ["First resonance", values(lambda s: s.band.resonance, ".3g", "Hz"), line],
        ["Bandwidth, gain within 3 dB", values(lambda s: s.usable(rate_Hz)[0], ".3g", "Hz"), f"{limits}; {gauge}"],
        ["Gain within 5 %", values(lambda s: s.band.within_tolerance, ".2g", "Hz"), f"of a slow press; {narrow}"],
        ["Rise time, 10 to 90 %", values(lambda s: 1e3 * s.step.rise_time, ".2g", "ms"), _step(ends)],
    ]


def _step(ends: list[DynamicState]) -> str:
    delays = " and ".join(f"{1e3 * state.step.delay:.2g}" for state in ends)
    over = " and ".join(f"{100 * state.step.overshoot:.0f}" for state in ends)
    return f"after a step of force; half is read after {delays} ms, overshoot {over} %"
