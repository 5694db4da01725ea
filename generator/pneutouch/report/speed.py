"""Speed of the sensor's reading, in rows of a datasheet."""

from collections.abc import Sequence

from pneutouch.evaluation.sheet_data import SheetData

_DASH = "–"


def speed_rows(sheet: SheetData) -> list[list[str]]:
    """Rows of quantity, value and basis at the lowest and the highest driving pressure; empty without the figures."""
    if sheet.speed is None:
        return []
    states = sheet.speed.states
    ends = [states[0], states[-1]] if len(states) > 1 else [states[0]]
    rate_Hz = sheet.speed.rate_Hz
    gauge = "" if rate_Hz is None else f"; the gauge reads {rate_Hz:g} times a second"
    bands = ", ".join(dict.fromkeys(state.bandwidth_limit or _DASH for state in ends))
    narrow = ", ".join(dict.fromkeys(state.within_limit or _DASH for state in ends))
    after = _values([1e3 * state.delay for state in ends], ".2g", "ms")
    return [
        [
            "First resonance",
            _values([state.resonance for state in ends], ".3g", "Hz"),
            "line as drawn, force at first contact",
        ],
        [
            "Bandwidth",
            _values([state.bandwidth for state in ends], ".3g", "Hz"),
            f"gain within 3 dB; limit: {bands}{gauge}",
        ],
        ["Gain within 5 %", _values([state.within for state in ends], ".2g", "Hz"), f"limit: {narrow}"],
        [
            "Rise time",
            _values([1e3 * state.rise_time for state in ends], ".2g", "ms"),
            f"10 to 90 %, step of force; half after {after}",
        ],
    ]


def _values(numbers: Sequence[float | None], form: str, unit: str) -> str:
    texts = [_DASH if number is None else format(number, form) for number in numbers]
    return f"{' and '.join(texts)} {unit}"
