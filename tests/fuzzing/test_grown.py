"""What a reader does grows no faster than its input: counted in calls of functions, so that no clock decides."""

from __future__ import annotations

import contextlib
import sys
from pathlib import Path

import pytest

from tests.fuzzing.grown import grown, longer, places, wider
from tests.fuzzing.seeds import seeds
from tests.fuzzing.targets import TARGETS, Target

SIZE, MOST = 150, 2.2
"""Entries of the smaller input; and the calls for twice as many, over those for it."""

BINARY = ("run-xlsx", "run-parquet", "run-tdms", "dataset", "slice")
"""Compiled libraries read these: their calls are not seen. `tests.fuzzing.largest` measures them."""


def calls(target: Target, content: bytes, folder: Path) -> int:
    """Calls of functions, of Python and of C, to read ``content`` or refuse it."""
    path, count = folder / target.name, 0
    path.write_bytes(target.written(content))

    def note(frame: object, event: str, argument: object) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    with contextlib.suppress(*target.allowed):
        sys.setprofile(note)
        try:
            target.read(path)
        finally:
            sys.setprofile(None)
    return count


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(set(TARGETS) - set(BINARY)))
def test_twice_the_input_takes_at_most_twice_the_calls(name, tmp_path):
    target = TARGETS[name]
    calls(target, seeds(name)[0], tmp_path)
    for what, of_size in grown(name):
        few, many = (calls(target, of_size(size), tmp_path) for size in (SIZE, 2 * SIZE))
        assert many <= MOST * few, (what, few, many)


def test_a_reader_that_compares_all_pairs_is_seen(tmp_path):
    def pairs(path):
        lines = path.read_text().split("\n")
        return sum(one.startswith(other) for one in lines for other in lines)

    few, many = (calls(Target("a", pairs), b"\n" * size, tmp_path) for size in (SIZE, 2 * SIZE))
    assert many > 3.5 * few


def test_what_grows_is_every_list_and_every_table():
    content = {"a": [1.0], "b": {"c": [{"name": "x", "d": [2]}], "e": []}}
    assert places(content, list) == [("a",), ("b", "c"), ("b", "c", 0, "d")]
    assert places(content, dict) == [("b",), ("b", "c", 0)]
    assert longer(content, ("b", "c"), 2)["b"]["c"] == [{"name": "x0", "d": [2]}, {"name": "x1", "d": [2]}]
    assert wider(content, ("b",), 2)["b"] == content["b"] | {"unknown_0": 0, "unknown_1": 1}
