"""The channel and the unit that a column's name gives."""

import re
from typing import NamedTuple

from pneutouch.tables.unit_words import BRACKETS, unit_of

_WORDS = {
    "time": "time t zeit temps tiempo tempo x_value elapsed seconds millis",
    "position": "position pos displacement disp extension travel stroke depth crosshead indentation deflection "
    "deformation verformung weg z deplacement déplacement posizione",
    "force": "force f load kraft charge effort fuerza forza",
    "pressure": "pressure press p druck pression presión presion pressione",
    "volume": "volume vol v volumen",
}
"""Words for the channels in English, German, French, Spanish and Italian."""

_ENDINGS = {"kraft": "force", "weg": "position", "zeit": "time", "druck": "pressure"}
"""Last parts of German compounds, such as Standardkraft."""

_OTHER_QUANTITIES = frozenset(
    {
        "rate",
        "speed",
        "velocity",
        "geschwindigkeit",
        "setpoint",
        "sp",
        "sollwert",
        "target",
        "command",
        "demand",
        "limit",
        "absolute",
        "abs",
        "ambient",
        "atmospheric",
        "barometric",
        "baro",
        "stress",
        "spannung",
        "modulus",
        "cycle",
        "cycles",
    }
)
"""Words that show a column to be no channel at all, whatever its unit: no measured force, no gauge pressure."""

_SPLIT = re.compile(r"[^\W_]+")
_LONGEST = 200
"""Letters of a name that may state its unit without brackets."""

_LAST = re.compile(r"(.*?)(?:[\s_,:;/.-]+|\bin\s+)([^\s_,:;/]+)")


class HeaderMeaning(NamedTuple):
    """Meaning of a header: the channel that its words name, and the channel and the unit of its unit; "" if unknown.

    ``odd``: it gives a unit, or another quantity, which no channel has."""

    word: str
    kind: str
    unit: str
    odd: bool = False

    @property
    def channel(self) -> str:
        """The channel, "" where words and unit name none, or two."""
        if self.odd or (self.word and self.kind and self.word != self.kind):
            return ""
        return self.word or self.kind

    @property
    def certain(self) -> bool:
        """True if words and unit name the same channel."""
        return bool(self.channel) and self.word == self.kind


def meaning_of(name: str, unit: str = "") -> HeaderMeaning:
    """Meaning of a header such as "Load [N]", "P_kPa" or "Kraft (N)"; ``unit`` is that of a row of units."""
    label, stated = (name, unit) if unit.strip() else _parted(name)
    known = unit_of(stated) if stated else None
    if known is None and not unit.strip() and unit_of(name.strip()):
        return HeaderMeaning("", *_both(name))
    words = [word.lower() for word in _SPLIT.findall(label)]
    odd = (bool(stated.strip("()[] -")) and known is None) or any(word in _OTHER_QUANTITIES for word in words)
    return HeaderMeaning(_channel(label, words), *(known or ("", "")), odd)


def _both(name: str) -> tuple[str, str]:
    known = unit_of(name)
    assert known is not None
    return known


def _parted(name: str) -> tuple[str, str]:
    """Label and unit of a header: in brackets, else its last part where that is a unit."""
    brackets = list(BRACKETS.finditer(name))
    if brackets:
        last = brackets[-1]
        return f"{name[: last.start()]} {name[last.end() :]}".strip(), last[1] or "?"
    # The pattern takes the square of the length.
    parts = _LAST.fullmatch(name.strip()) if len(name) <= _LONGEST else None
    if parts and parts[1].strip() and unit_of(parts[2]):
        return parts[1], parts[2]
    return name, ""


def _channel(label: str, words: list[str]) -> str:
    """The channel that a label's words name; single letters count alone, "" where they name none or several."""
    if label.strip().lower() == "x_value":
        return "time"
    named = set()
    for channel, known in _WORDS.items():
        if any(word in known.split() and (len(word) > 1 or len(words) == 1) for word in words):
            named.add(channel)
    named |= {channel for ending, channel in _ENDINGS.items() if any(word.endswith(ending) for word in words)}
    return named.pop() if len(named) == 1 else ""
