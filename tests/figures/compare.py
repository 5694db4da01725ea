"""Compare two documents: the figures, not the prose."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator
from typing import Any

# Processors of two kinds differ in what their linear algebra rounds: by 2.2e-6 in the interval of a calibration, by 2e-8
# elsewhere (an EPYC with AVX-512 over the one that the reference was computed on).
RELATIVE = 5e-6
# In a list a number is compared by the scale of the list: what should be zero has no digits of its own.
OF_LIST = 1e-7
ABSOLUTE = 1e-9
# The covariance of a fit comes from differences of its residuals: 9e-5 between the same two processors.
OF_FIT = 1e-3
FITTED = frozenset({"correlation", "covariance"})
# Follow the bytes of drawings and texts, or the version, and are no figures.
LEFT_OUT = frozenset({"input_hash", "sha256", "bytes", "versions", "version", "pneutouch_version"})
DIGEST = re.compile(r"[0-9a-f]{12}(?:[0-9a-f]{52})?")


def plain(value: Any) -> Any:
    """A document without what must differ between two states of the program: digests, versions, folders of the machine.

    A mapping whose keys are digests becomes a list, in an order that the names of keys do not decide.
    """
    if isinstance(value, dict):
        if value and all(DIGEST.fullmatch(key) for key in value):
            return sorted((plain(item) for item in value.values()), key=order)
        return {key: plain(item) for key, item in value.items() if key not in LEFT_OUT and not is_format(key, item)}
    if isinstance(value, list):
        return [plain(item) for item in value]
    if isinstance(value, str):
        return "(digest)" if DIGEST.fullmatch(value) else value.rsplit("/", 1)[-1] if value.startswith("/") else value
    return value


def is_format(key: str, value: Any) -> bool:
    """Whether an entry states the format of its file; the format of a campaign is a table, and stays."""
    return key == "campaign_format" or (key == "format" and not isinstance(value, dict))


def order(value: Any) -> str:
    return json.dumps(sorted(str(leaf) for leaf in leaves(value) if not is_prose(leaf)))


def leaves(value: Any) -> Iterator[Any]:
    if isinstance(value, dict | list):
        for item in value.values() if isinstance(value, dict) else value:
            yield from leaves(item)
    else:
        yield value


def is_prose(value: Any) -> bool:
    """Text with a space is written for people and may be reworded; names, kinds and units have none."""
    return isinstance(value, str) and " " in value


def differences(old: Any, new: Any, path: tuple[str, ...] = ()) -> Iterator[str]:
    """A line for each figure that differs: path, old, new."""
    where = ".".join(path) or "document"
    if isinstance(old, dict) and isinstance(new, dict):
        yield from differences_of_keys(old, new, path)
    elif isinstance(old, list) and isinstance(new, list):
        if len(old) != len(new):
            yield f"{where}: {len(old)} entries before, {len(new)} now"
        near = scale(old) * (OF_LIST if FITTED.isdisjoint(path) else OF_FIT)
        for at, pair in enumerate(zip(old, new, strict=False)):
            if not all(is_number(each) and math.isfinite(each) for each in pair) or abs(pair[0] - pair[1]) > near:
                yield from differences(*pair, (*path, str(at)))
    elif not equal(old, new):
        yield f"{where}: {old!r} before, {new!r} now"


def is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def scale(values: list[Any]) -> float:
    """The greatest of the finite numbers in a list, by its size."""
    return max((abs(each) for each in values if is_number(each) and math.isfinite(each)), default=0.0)


def differences_of_keys(old: dict[str, Any], new: dict[str, Any], path: tuple[str, ...]) -> Iterator[str]:
    for key in sorted(old.keys() | new.keys()):
        inner = (*path, key)
        if key not in new:
            yield f"{'.'.join(inner)}: {short(old[key])} before, not there now"
        elif key not in old:
            yield f"{'.'.join(inner)}: not there before, {short(new[key])} now"
        else:
            yield from differences(old[key], new[key], inner)


def short(value: Any) -> str:
    return f"{value!r:.60}"


def equal(old: Any, new: Any) -> bool:
    if isinstance(old, bool) or isinstance(new, bool) or old is None or new is None:
        return old is new
    if isinstance(old, str) and isinstance(new, str):
        return old == new or (is_prose(old) and is_prose(new))
    if isinstance(old, int | float) and isinstance(new, int | float):
        return math.isclose(old, new, rel_tol=RELATIVE, abs_tol=ABSOLUTE) or (math.isnan(old) and math.isnan(new))
    return False


def changes(old: dict[str, Any], new: dict[str, Any]) -> Iterator[str]:
    """Differences of the documents of one group."""
    for run, document in old.items():
        now = new[run]
        for part in ("exit", "json"):
            yield from differences(document[part], now[part], (run, part))
        files = document["files"]
        yield from differences(dict.fromkeys(files), dict.fromkeys(now["files"]), (run, "files"))
        for name in files.keys() & now["files"].keys():
            yield from differences(files[name], now["files"][name], (run, name))
