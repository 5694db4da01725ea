"""Units of measured columns, as instruments write them; without numpy, because command-line completion reads it."""

import re

from pneutouch.wording import data_of

_GAUGES = {"kPa": 1e-3, "Pa": 1e-6, "MPa": 1.0, "hPa": 1e-4, "mbar": 1e-4, "bar": 0.1, "psi": 6.894757293168e-3}
_COLUMNS = {"mmHg": 1.33322387415e-4, "inH2O": 2.4908891e-4}

UNITS: dict[str, dict[str, float]] = {
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0, "d": 86400.0},
    "position": {"mm": 1.0, "um": 1e-3, "cm": 10.0, "m": 1e3, "in": 25.4},
    "force": {"N": 1.0, "mN": 1e-3, "kN": 1e3, "gf": 9.80665e-3, "kgf": 9.80665, "lbf": 4.4482216152605},
    "pressure": _GAUGES | _COLUMNS | {f"{u}_abs": _GAUGES[u] for u in _GAUGES},
    "volume": {"mL": 1e3, "uL": 1.0, "mm3": 1.0, "L": 1e6},
}
"""Units of columns by channel, with the factor to the internal unit: s, mm, N, MPa, mm3."""

ABSOLUTE = "_abs"
"""Ending of the units of absolute pressures, from which the ambient pressure is subtracted."""

_SMALL = frozenset({"psi", "bar", "lbf", "sec", "mm"})


def _table() -> dict[str, tuple[str, str]]:
    table = {unit: (key, unit) for key, units in UNITS.items() for unit in units}
    # Other spellings.
    for key, units in data_of(__file__).items():
        for unit, words in units.items():
            table |= dict.fromkeys(words.split(), (key, unit))
    return table


_TABLE = _table()
_LONG = 4
"""Least length of a word whose case is ignored, as for words of `_SMALL`; in shorter ones it tells milli from mega."""

BRACKETS = re.compile(r"[(\[{<]\s*([^(\[{<]*?(?:\((?:g|a|abs)\))?)\s*[)\]}>]")


def unit_of(word: str) -> tuple[str, str] | None:
    """Channel and unit that a word stands for, such as "kPa" or "[µm]"; None if it is no unit of a channel."""
    word = word.strip()
    bracketed = BRACKETS.fullmatch(word)
    word = bracketed[1] if bracketed else word
    if word in _TABLE:
        return _TABLE[word]
    small = word.lower()
    return _TABLE.get(small) if len(word) >= _LONG or small in _SMALL else None
