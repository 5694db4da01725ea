"""Inputs that grow: the first ones of a target with more of what they hold, to count what reading takes as it grows."""

from __future__ import annotations

import copy
import json
import tomllib
from collections.abc import Callable, Iterator
from typing import Any

from pneutouch.spec.toml_text import toml_text
from tests.fuzzing.seeds import seeds
from tests.fuzzing.targets import TARGETS

Grown = Callable[[int], bytes]
"""The input of a size."""

MOST_PLACES = 6
"""Lists and tables of a document that grow, one at a time: a recipe has a hundred alike."""

NAMES = ("name", "file", "title", "id", "key")
"""Keys whose values must differ from entry to entry."""


def grown(target: str) -> Iterator[tuple[str, Grown]]:
    """What grows, in words, and the input of any size: lists, one after the other, and unknown keys of tables."""
    if target in LINES:
        yield from LINES[target].items()
        return
    first, ending = seeds(target)[0], TARGETS[target].name.rpartition(".")[2]
    content = tomllib.loads(first.decode()) if ending == "toml" else json.loads(first)
    write = toml_text if ending == "toml" else json.dumps
    for path in places(content, list)[:MOST_PLACES]:
        yield f"entries of {_words(path)}", lambda size, path=path: write(longer(content, path, size)).encode()
    for path in [(), *places(content, dict)][:MOST_PLACES]:
        yield f"keys of {_words(path)}", lambda size, path=path: write(wider(content, path, size)).encode()


def places(content: Any, kind: type, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Where lists or tables that hold something are, by keys and indices; of a list, in its first entry alone."""
    entries = (
        content.items() if isinstance(content, dict) else enumerate(content[:1]) if isinstance(content, list) else ()
    )
    found = [path] if path and isinstance(content, kind) and content else []
    return found + [each for key, value in entries for each in places(value, kind, (*path, key))]


def longer(content: Any, path: tuple[Any, ...], size: int) -> Any:
    """The content with ``size`` entries in the list at ``path``."""
    fresh = copy.deepcopy(content)
    entries = _at(fresh, path)
    entries[:] = [_other(entries[k % len(entries)], k) for k in range(size)]
    return fresh


def wider(content: Any, path: tuple[Any, ...], size: int) -> Any:
    """The content with ``size`` unknown keys in the table at ``path``."""
    fresh = copy.deepcopy(content)
    _at(fresh, path).update({f"unknown_{k}": k for k in range(size)})
    return fresh


def _at(content: Any, path: tuple[Any, ...]) -> Any:
    for key in path:
        content = content[key]
    return content


def _other(entry: Any, k: int) -> Any:
    if isinstance(entry, dict):
        return {key: f"{value}{k}" if key in NAMES else copy.deepcopy(value) for key, value in entry.items()}
    return entry + 1e-3 * k if isinstance(entry, float) else copy.deepcopy(entry)


def _words(path: tuple[Any, ...]) -> str:
    return ".".join(map(str, path)) or "the document"


def _run(size: int) -> bytes:
    rows = "".join(f"{k / 100},{k / 1000},{k / 500},{k / 700}\n" for k in range(size))
    return b"time_s,position_mm,force_N,pressure_kPa\n" + rows.encode()


def _journal(size: int) -> bytes:
    records = [{"point": k, "states": [{"status": "ok"}], "values": {"a": 1.0}} for k in range(size)]
    return b"\n".join(json.dumps({"sweep": "ab", "records": [each]}).encode() for each in records)


def _model(vertices: int = 1, triangles: int = 1, parts: int = 0) -> Grown:
    def write(size: int) -> bytes:
        text = seeds("threemf")[0].decode()
        corner, side = '<vertex x="0" y="0" z="1"/>', '<triangle v1="0" v2="2" v3="1"/>'
        text = text.replace(corner, corner * (size if vertices else 1)).replace(side, side * (size if triangles else 1))
        return (text + "".join(f"=== Other/{k}.txt\nx\n" for k in range(parts * size))).encode()

    return write


LINES: dict[str, dict[str, Grown]] = {
    "tasks-csv": {
        "rows": lambda size: b"name,force_range_N\n" + b"".join(b"t%d,15\n" % k for k in range(size)),
        "columns": lambda size: b"name," + b",".join(b"c%d" % k for k in range(size)) + b"\n",
    },
    "run-csv": {
        "rows": _run,
        "lines before the table": lambda size: b"text: a\n" * size + _run(20),
        "columns": lambda size: b",".join(b"c%d" % k for k in range(size)) + (b"\n" + b",".join([b"1"] * size)) * 3,
    },
    "journal": {"lines": _journal, "torn lines": lambda size: b"{\n" * size},
    "threemf": {"vertices": _model(triangles=0), "triangles": _model(vertices=0), "parts": _model(0, 0, 1)},
    "head": {
        "headers": lambda size: b"GET / \nhost: 127.0.0.1:8123\n" + b"".join(b"x-%d: 1\n" % k for k in range(size)),
        "questions": lambda size: (
            b"GET /?" + b"&".join(b"a%d=1" % k for k in range(size)) + b"\nhost: 127.0.0.1:8123\n"
        ),
    },
}
