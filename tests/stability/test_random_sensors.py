"""Failure: the sensor nobody tried. Random ones must run to their depth or end in a typed event, and both must be true.

True means, checked here without the solver's word: every state balances and obeys Boyle's law; the last state of a
complete curve is stable (dense eigenvalues); `gauge_range` and `break` lie where a new study of that depth meets
them, and no curve without them passes the levels; at a `snap` a second equilibrium of less energy exists at the same
plate height.
"""

from __future__ import annotations

from collections import Counter

import pytest

from tests.stability.sensors import random_sensors, tally
from tests.stability.truth import ENDS_BRANCH, Study, breaks_there, gauge_error, other_branch


def ending(study: Study) -> str:
    """How the study ended; raises where what it says of itself is not true."""
    found, press = study.found, study.press
    assert study.unbalance() <= 1.0 and study.gas_error() < 1e-9
    kinds = [e.kind for e in found.events]
    for event in found.events:
        if event.kind == "gauge_range":
            assert abs(gauge_error(study, event)) < 1e-3
        if event.kind == "break":
            assert breaks_there(study, event)
    assert ("gauge_range" in kinds) == (max(s.pressure for s in found.path) >= press.gauge_range)
    assert ("break" in kinds) == (max(s.stretch for s in found.path) - 1.0 >= press.break_strain)
    if found.complete:
        assert len(found.states) == press.steps + 1
        assert found.states[-1].indentation == pytest.approx(press.depth, rel=1e-12)
        assert study.softest(found.states[-1]) > 0.0
        return "complete"
    last = found.events[-1].kind
    if last in ENDS_BRANCH:
        energy = other_branch(study)
        assert energy is not None and energy > 1e-3
    return last


def sweep(library, count, seed, **options) -> tuple[Counter[str], Counter[str]]:
    ends: Counter[str] = Counter()
    events: Counter[str] = Counter()
    for label, study in random_sensors(library, count, seed, **options):
        try:
            ends[ending(study)] += 1
        except AssertionError as error:
            raise AssertionError(label) from error
        events.update({e.kind for e in study.found.events})
    return ends, events


@pytest.mark.slow
def test_twenty_random_sensors(library, say):
    ends, events = sweep(library, 20, seed=40)
    say(f"20 random sensors to R0/2: {tally(ends)}; events on the way: {tally(events)}")
    assert ends == {"complete": 20}


@pytest.mark.slow
def test_five_hundred_random_sensors(library, say):
    ends, events = sweep(library, 500, seed=500)
    say(f"500 random sensors to R0/2: {tally(ends)}; events on the way: {tally(events)}")
    assert sum(ends.values()) == 500
    assert set(ends) <= {"complete", *ENDS_BRANCH, "floor"}
    assert ends["complete"] >= 495


@pytest.mark.slow
def test_two_hundred_random_sensors_pressed_into_the_snaps(library, say):
    ends, events = sweep(library, 200, seed=75, walls=(0.05, 0.5), depth=0.75)
    say(f"200 random sensors to 0.75 R0: {tally(ends)}; events on the way: {tally(events)}")
    assert sum(ends.values()) == 200
    assert ends["snap"] >= 20 and ends["lost"] <= 2
