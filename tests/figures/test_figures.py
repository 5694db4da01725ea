"""What every command computes, against what it computed in the reference state; the everyday run takes three commands."""

from __future__ import annotations

import pytest

from tests.figures.compare import changes, plain
from tests.figures.store import EVERYDAY, GROUPS, collect, stored
from tests.running import in_process


@pytest.mark.parametrize(
    "group", [pytest.param(name, marks=() if name in EVERYDAY else pytest.mark.slow) for name in GROUPS]
)
def test_the_figures_are_those_of_the_reference_state(group):
    found = collect(group, in_process) if group in EVERYDAY else collect(group)
    lines = list(changes(stored()[group], plain(found)))
    assert not lines, f"{len(lines)} figures differ:\n" + "\n".join(lines[:100])


def test_every_group_is_stored():
    assert stored().keys() == GROUPS.keys()


def test_only_what_the_atlas_and_the_membrane_cannot_hold_was_refused():
    refused = [run for group in stored().values() for run, document in group.items() if document["exit"] not in (0, 1)]
    graded = "predict graded-dome --model atlas", "predict graded-dome --model membrane"
    assert all(run.startswith((*graded, "predict cast-dome --model atlas")) for run in refused)
    assert len(refused) == 4
