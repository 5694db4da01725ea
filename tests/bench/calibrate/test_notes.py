"""Words of the notes of a fit."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from pneutouch.bench.calibrate import notes
from pneutouch.bench.calibrate.notes import _MOVED, _left_out, _shared, amount
from pneutouch.bench.calibrate.parameters import DEAD, FRICTION, FRICTION_PRIOR, MODULUS, OFFSET, WALL
from pneutouch.mechanics.corrected.figures import GRIPS
from pneutouch.wording import listed


@pytest.mark.parametrize(
    ("parameter", "deviation", "words"),
    [
        (MODULUS, np.log(1.05), "5 %"),
        (MODULUS, np.log(2.0), "a factor of 2"),
        (WALL, np.log(1.02), "2 %"),
        (DEAD, 300.0, "0.3 mL"),
        (OFFSET, 0.15, "0.15 mm"),
        (FRICTION, 0.25, "0.25"),
    ],
)
def test_a_deviation_is_stated_in_the_unit_of_its_parameter(parameter, deviation, words):
    assert amount(parameter, deviation) == words


def test_three_runs_are_named_and_the_others_counted():
    assert listed(["a", "b", "c"], 3) == "a, b, c"
    assert listed(["a", "b", "c", "d", "e"], 3) == "a, b, c and 2 more"


def test_before_any_run_friction_is_anything_from_none_to_grip():
    assert pytest.approx(np.linspace(0.0, GRIPS, 10_001).std(), rel=1e-3) == FRICTION_PRIOR


def test_a_gain_is_stated_to_move_what_it_moves_by_a_part_of_its_interval(monkeypatch):
    half_width = np.array([0.1, 0.02])
    fit = SimpleNamespace(parameters=SimpleNamespace(fitted=(MODULUS, WALL)), half_width=half_width)
    shifts = _MOVED * half_width * np.array([[1.1, 0.9], [-0.9, 0.9]])
    monkeypatch.setattr(notes, "gain_shifts", lambda fit: shifts)
    (said,) = _shared(fit)
    assert said.startswith("a force reading 1 % too high in all runs moves ") and said.count("+") == 1


@pytest.mark.parametrize("other", [False, True])
def test_a_limit_point_of_the_wall_that_stands_for_another_is_named_as_such(other):
    injection = SimpleNamespace(label="injection 1")
    fit = SimpleNamespace(
        observations=SimpleNamespace(curves=(), injections=(injection,), rig=None),
        left_out=(),
        points=SimpleNamespace(travel=()),
        injections_left_out=(np.array([False, True, True]),),
        contact=SimpleNamespace(other_wall=other),
    )
    (note,) = _left_out(fit)
    assert note.startswith("injection 1: 2") and ("neo-Hookean" in note) == other
