"""The kept inputs of the fuzzing, read again: every reader answers or refuses, within bounds of time and memory."""

from __future__ import annotations

import importlib.util

import pytest

from tests.fuzzing.corpus import CORPUS
from tests.fuzzing.judge import judge
from tests.fuzzing.seeds import seeds
from tests.fuzzing.targets import TARGETS


@pytest.mark.parametrize("name", sorted(TARGETS))
def test_every_kept_input_is_answered_or_refused(name, tmp_path):
    target = TARGETS[name]
    if target.library and importlib.util.find_spec(target.library) is None:
        pytest.skip(f"needs {target.library}")
    for path in sorted((CORPUS / name).glob("*")):
        finding = judge(target, path.read_bytes(), tmp_path)
        assert finding is None or finding.where == "time", (path.name, finding)


@pytest.mark.parametrize("name", sorted(TARGETS))
def test_the_first_inputs_are_read(name, tmp_path):
    target = TARGETS[name]
    if target.library and importlib.util.find_spec(target.library) is None:
        pytest.skip(f"needs {target.library}")
    for content in seeds(name):
        path = tmp_path / target.name
        path.write_bytes(target.written(content))
        if name == "stack":
            # Its slices are not there.
            with pytest.raises(target.allowed):
                target.read(path)
        else:
            assert target.read(path) is not None


def test_the_corpus_is_small_and_of_known_targets():
    assert {path.name for path in CORPUS.iterdir()} <= set(TARGETS)
    assert sum(path.stat().st_size for path in CORPUS.rglob("*") if path.is_file()) < 700_000


@pytest.mark.slow
def test_a_fault_is_a_finding(tmp_path):
    from tests.fuzzing.targets import Target

    def broken(path):
        raise KeyError("x")

    def greedy(path):
        return bytearray(400 << 20).count(1)

    # What a test before this one took does not hide what an input takes.
    assert bytearray(800 << 20).count(1) == 0
    assert judge(Target("a", broken), b"", tmp_path).where.startswith("KeyError")
    assert judge(Target("a", greedy), b"", tmp_path).where == "memory"
