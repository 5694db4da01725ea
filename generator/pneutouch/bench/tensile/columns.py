"""Columns of a tensile file recognised by their names: stretch, strain or travel, and stress or force."""

import re
from collections.abc import Sequence
from typing import NamedTuple

from pneutouch.errors import InputError
from pneutouch.tables.unit_words import BRACKETS, UNITS, unit_of

_WORDS = {
    "stress": ("stress", "spannung", "contrainte"),
    "strain": ("strain", "dehnung", "elongation", "allongement"),
    "stretch": ("stretch", "lambda", "streckung"),
    "force": ("force", "load", "kraft"),
    "travel": ("extension", "displacement", "travel", "compression", "indentation", "position", "crosshead", "weg"),
}
"""Words of a header, by the kind of column that they mean."""

_TRUE = ("true", "log", "logarithmic", "hencky", "cauchy")
_NOMINAL = ("engineering", "nominal", "eng", "eng.", "technical")
_STRESS_WORDS = {"n/mm2": 1.0, "n/mm²": 1.0, "n/mm^2": 1.0}
_PERCENT = ("%", "percent", "per cent", "pct")
_PLAIN = ("", "-", "mm/mm", "m/m", "1", "mm mm-1")

_PAIRS = ((("stretch", "strain"), "stress"), (("stretch", "strain"), "force"), (("travel",), "force"))
"""Kinds of the column of the length with that of the load, the best first."""

NAMES = "Engineering Strain, Engineering Stress (MPa)"
"""Names of columns that are understood, for messages."""


class TensileColumn(NamedTuple):
    """One column: its name in the file, its kind, whether it is true or nominal, and its factor to 1, mm, MPa, N.

    ``factor`` is None if its name gives no unit.
    """

    name: str
    kind: str
    true: bool
    stated: bool
    factor: float | None


class ColumnPair(NamedTuple):
    """The column of the length and that of the load."""

    length: TensileColumn
    load: TensileColumn


def column_pairs(names: Sequence[str], units: Sequence[str], file: str) -> list[ColumnPair]:
    """The pairs that a file has, the best first: nominal before true, stress before force.

    Raises InputError if there is none, where a stress states no unit, or a unit is none of that quantity.
    """
    known = [column for pair in zip(names, units, strict=True) if (column := _column(*pair, file)) is not None]
    pairs = []
    for true in (False, True):
        for kinds, load in _PAIRS:
            lengths = [one for one in known if one.kind in kinds and one.true == true]
            loads = [one for one in known if one.kind == load and one.true == (true and load == "stress")]
            if lengths and loads:
                pairs.append(ColumnPair(_only(lengths, file), _only(loads, file)))
    lengths = [one for one in known if one.kind in ("strain", "stretch")]
    loads = [one for one in known if one.kind == "stress"]
    if not pairs and lengths and loads:
        # One of them is true and the other nominal, or the one does not state it.
        raise InputError(
            f"column {lengths[0].name} and column {loads[0].name}: one is true, the other is not named so",
            file=file,
            remedy=f"name both, as {NAMES}, or True Strain, True Stress (MPa)",
        )
    if not pairs:
        problem = f"no columns of stretch and stress among {', '.join(name for name in names if name)}"
        raise InputError(problem, file=file, remedy=f"name them, as {NAMES}; or Extension (mm), Force (N)")
    return pairs


def _only(columns: list[TensileColumn], file: str) -> TensileColumn:
    if len(columns) > 1:
        named = " and ".join(f"{one.name}" for one in columns)
        raise InputError(f"columns {named}: which of them is the {columns[0].kind}?", file=file, remedy="leave one")
    return columns[0]


def _column(name: str, unit: str, file: str) -> TensileColumn | None:
    label, stated = (name, unit.strip("()[] ")) if unit.strip() else _parted(name)
    words = [word for word in re.split(r"[^\w.]+|_", label.lower()) if word]
    kind = next((kind for kind, known in _WORDS.items() if any(word in known for word in words)), None)
    if kind is None or any(word in ("rate", "speed", "time") for word in words):
        return None
    true = any(word in _TRUE for word in words)
    return TensileColumn(name, kind, true, true or any(w in _NOMINAL for w in words), _factor(name, kind, stated, file))


def _parted(name: str) -> tuple[str, str]:
    """Label and unit of a header: in brackets, else its last part where that is a unit."""
    brackets = list(BRACKETS.finditer(name))
    if brackets:
        last = brackets[-1]
        return f"{name[: last.start()]} {name[last.end() :]}".strip(), last[1].strip() or "-"
    head, mark, tail = name.strip().replace("_", " ").rpartition(" ")
    known = unit_of(tail) is not None or tail.lower() in (*_PERCENT, *_STRESS_WORDS)
    return (head, tail) if mark and known else (name, "")


def _factor(name: str, kind: str, unit: str, file: str) -> float | None:
    if kind in ("strain", "stretch"):
        if unit.lower() in _PERCENT:
            return 0.01
        if unit.lower() in _PLAIN:
            return 1.0 if unit else None
        raise InputError(f"{unit}: no unit of a {kind}", file=file, key=f"column {name}", remedy="give none, or %")
    channel = {"stress": "pressure", "force": "force", "travel": "position"}[kind]
    known = unit_of(unit) if unit else None
    if kind == "stress" and unit.lower() in _STRESS_WORDS:
        return _STRESS_WORDS[unit.lower()]
    if known is not None and known[0] == channel:
        return UNITS[channel][known[1]]
    right = {"stress": "MPa, kPa or psi", "force": "N", "travel": "mm"}[kind]
    problem = f"{unit}: no unit of a {kind}" if unit else "states no unit"
    raise InputError(problem, file=file, key=f"column {name}", remedy=f"write it into the name, as {kind} ({right})")
