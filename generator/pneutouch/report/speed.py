"""How fast the sensor reads, in rows of a datasheet."""

from collections.abc import Sequence

from pneutouch.evaluation.sheet_data import SheetData
from pneutouch.units import KPA

_DASH = "–"


def speed_rows(sheet: SheetData) -> list[list[str]]:
    """Rows of quantity, value and basis at the lowest and the highest driving pressure; empty without the figures."""
    if sheet.speed is None:
        return []
    states = sheet.speed.states
    ends = [states[0], states[-1]] if len(states) > 1 else [states[0]]
    at = " and ".join(f"{state.driving_pressure / KPA:g}" for state in ends) + " kPa"
    rate_Hz = sheet.speed.rate_Hz
    gauge = "the gauge's rate is not known" if rate_Hz is None else f"the gauge reads {rate_Hz:g} times a second"
    note = "" if sheet.speed.note is None else f"; {sheet.speed.note}"
    bands = ", ".join(dict.fromkeys(state.bandwidth_limit or _DASH for state in ends))
    narrow = ", ".join(dict.fromkeys(state.within_limit or _DASH for state in ends))
    after = _values([1e3 * state.delay for state in ends], ".2g", "ms")
    over = _values([100 * state.overshoot for state in ends], ".0f", "%")
    return [
        [
            "First resonance",
            _values([state.resonance for state in ends], ".3g", "Hz"),
            f"small step of force at {at}; connector, tube and gauge as a line with losses{note}",
        ],
        [
            "Bandwidth",
            _values([state.bandwidth for state in ends], ".3g", "Hz"),
            f"gain within 3 dB of a slow press; limit: {bands}; {gauge}",
        ],
        [
            "Gain within 5 %",
            _values([state.within for state in ends], ".2g", "Hz"),
            f"of a slow press; limit: {narrow}",
        ],
        [
            "Rise time, 10 to 90 %",
            _values([1e3 * state.rise_time for state in ends], ".2g", "ms"),
            f"after a step of force; half is read after {after}, overshoot {over}",
        ],
    ]


def _values(numbers: Sequence[float | None], form: str, unit: str) -> str:
    texts = [_DASH if number is None else format(number, form) for number in numbers]
    return f"{' and '.join(texts)} {unit}"
