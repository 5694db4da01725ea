"""What a reader takes of memory is bounded by the size of its input: counted by Python, not the system."""

from __future__ import annotations

import contextlib
import tracemalloc

import pytest

from tests.fuzzing.grown import grown
from tests.fuzzing.seeds import seeds
from tests.fuzzing.targets import TARGETS, Target
from tests.fuzzing.test_grown import BINARY

SIZE, FIXED, EACH = 500, 2**18, 100
"""Entries of an input; bytes that any may take, and further ones for each byte of it: most are errors, of which twenty are shown."""

CHUNKED = {"run-csv": 2**23}
"""Of a reader that works on a chunk at a time, whatever the input."""


def peak(target: Target, content: bytes, folder) -> int:
    """Greatest memory in bytes to read ``content`` or refuse it."""
    path = folder / target.name
    path.write_bytes(target.written(content))
    tracemalloc.start()
    try:
        with contextlib.suppress(*target.allowed):
            target.read(path)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(set(TARGETS) - set(BINARY)))
def test_memory_is_bounded_by_the_input(name, tmp_path):
    target = TARGETS[name]
    peak(target, seeds(name)[0], tmp_path)
    for what, of_size in grown(name):
        content = of_size(SIZE)
        taken = peak(target, content, tmp_path)
        assert taken <= CHUNKED.get(name, FIXED) + EACH * len(content), (what, taken, len(content))


def test_a_reader_that_keeps_all_pairs_is_seen(tmp_path):
    def pairs(path):
        lines = path.read_text().split("\n")
        return [(one, other) for one in lines for other in lines]

    content = b"\n" * SIZE
    assert peak(Target("a", pairs), content, tmp_path) > FIXED + EACH * len(content)
