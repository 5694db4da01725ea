"""Numbers and words for documents and texts: rounding, counts, lists, Markdown; and the mark of simulated data.

Numbers are rounded because their last bits differ between processors, and no figure needs these bits.
"""

import math
import tomllib
from collections.abc import Iterable, Sequence
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any, TypeVar, cast

SIMULATED = "SIMULATED DATA"
"""Mark before every figure that comes from simulated runs, on screen and on sheets."""

_ROUNDING = 1e-9

_Json = TypeVar("_Json")


def data_of(module: str) -> Any:
    """The data in the TOML file that lies beside a module and has its name; ``module`` is its ``__file__``."""
    return tomllib.loads(Path(module).with_suffix(".toml").read_text(encoding="utf-8"))


def rounded(value: _Json, digits: int, nothing: float = 0.0) -> _Json:
    """A JSON value or dataclass with floats to ``digits`` significant digits, 0 if smaller in size than ``nothing``."""
    result: Any = value
    if isinstance(value, float):
        result = float(f"{value:.{digits}g}") + 0.0 if abs(value) >= nothing else 0.0
    elif isinstance(value, dict):
        result = {key: rounded(item, digits, nothing) for key, item in value.items()}
    elif isinstance(value, list | tuple):
        result = type(value)(rounded(item, digits, nothing) for item in value)
    elif is_dataclass(value) and not isinstance(value, type):
        held = {f.name: rounded(getattr(value, f.name), digits, nothing) for f in fields(value)}
        result = replace(value, **held)
    return cast("_Json", result)


def finite(value: float) -> float | None:
    """The number, or None, which JSON can hold, in place of NaN or infinity."""
    return float(value) if math.isfinite(value) else None


def tenths_below(value: float) -> float:
    """A value rounded down to a tenth, so that no rated pressure is shown above the true one (but for 1e-10)."""
    return math.floor(10.0 * value + _ROUNDING) / 10.0


def markdown_escaped(text: str) -> str:
    """Text escaped so that Markdown sees no table, HTML or escape in it."""
    return text.replace("\\", "\\\\").replace("|", "\\|").replace("<", "&lt;")


def listed(names: Sequence[str], most: int) -> str:
    """The first ``most`` names and the number of the others, if there are more: ``a, b and 3 more``."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return f"{', '.join(names[:most])}{more}"


def enumerated(words: Sequence[str]) -> str:
    """Words joined by commas and a last "and": ``a, b and c``; no words give an empty text."""
    return " and ".join(filter(None, [", ".join(words[:-1]), *words[-1:]]))


def held_by(regulated: bool, sealed: bool) -> str:
    """Names of what holds an inflated state before contact."""
    return " or ".join(["regulator"] * regulated + ["syringe"] * sealed) or "nothing"


def counted(count: int, one: str, many: str = "") -> str:
    """A count with its noun: ``1 design``, ``2 designs``; ``many`` is the plural if it is not ``one`` with an s."""
    return f"{count} {one if count == 1 else many or one + 's'}"


def unknown_at(reasons: Iterable[tuple[float, str | None]]) -> list[str]:
    """Reasons why uncertainties are not known (None: known), each with its driving pressures (kPa) if they differ."""
    pressures: dict[str | None, list[str]] = {}
    for pressure_kPa, why in reasons:
        pressures.setdefault(why, []).append(f"{pressure_kPa:g}")
    places = {why: "" if len(pressures) == 1 else f" at {', '.join(at)} kPa" for why, at in pressures.items()}
    return [f"uncertainty not known{place}: {why}" for why, place in places.items() if why is not None]
