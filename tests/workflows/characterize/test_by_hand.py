"""Presses by hand, recorded without travel: a sensitivity, or the unit, sign or zero that is then right."""

from __future__ import annotations

import re
import shlex
from dataclasses import replace

import numpy as np
import pytest

from pneutouch.errors import InputError
from pneutouch.workflows.characterize.campaign import characterize
from pneutouch.workflows.characterize.load import parse_columns
from tests.bench.recordings import CLEAR, DEEP, READ, Recording, by_hand, spiked, true_figures, truth
from tests.workflows.characterize.test_recordings import asked, figures, read


def test_a_press_by_hand_has_a_sensitivity_and_no_stiffness(tmp_path):
    measured = read(tmp_path, Recording(write=by_hand))
    (run,), found = measured.runs, figures(measured)
    assert run.kind == "hand" and not measured.questions and not run.warnings
    force = np.linspace(0.0, float(truth().at(np.array([DEEP]))[0][0]), 26)
    travel = np.interp(force, truth().force, truth().indentation)
    value = true_figures(travel[1:])["sensitivity_kPa_per_N"]
    assert found["sensitivity_kPa_per_N"].value == pytest.approx(value, rel=0.02)
    assert found["sensitivity_kPa_per_N"].predicted.value == pytest.approx(value, rel=0.02)
    assert "stiffness_N_per_mm" not in found and "hysteresis_width_percent" in found


def test_a_hand_that_trembles_or_lets_go_in_part_presses_once_or_as_often_as_it_does(tmp_path):
    held = [(2.0, CLEAR), (5.0, 6.2), *8 * [(0.4, 5.9), (0.4, 6.5)], (5.0, CLEAR), (2.0, CLEAR)]
    partly = [(2.0, CLEAR), (5.0, DEEP), (3.0, 2.0), (3.0, 6.0), (3.0, 1.0), (3.0, DEEP), (5.0, CLEAR), (2.0, CLEAR)]
    for legs in (held, partly):
        measured = read(tmp_path, Recording(legs, write=by_hand))
        (group,) = measured.groups
        assert group.driving_pressure_kPa == 0.0
        assert group.figures["force_range_N"].value == pytest.approx(24.5, rel=0.03)
        assert group.figures["sensitivity_kPa_per_N"].value == pytest.approx(2.34, rel=0.02)


def test_a_spike_in_a_press_by_hand_is_no_press(tmp_path):
    measured = read(tmp_path, Recording(write=by_hand, spoil=lambda s: spiked(s, 60.0)))
    (run,) = measured.runs
    assert figures(measured)["force_range_N"].value == pytest.approx(24.5, rel=0.03)
    assert [warning.kind for warning in run.warnings] == ["spike"]


@pytest.mark.parametrize(
    ("turn", "word"),
    [
        (lambda s: s * np.array([[1], [1], [1e3], [1]]), "in mN"),
        (lambda s: s / np.array([[1], [1], [9.80665], [1]]), "in kgf"),
        (lambda s: s / np.array([[1], [1], [1], [6.894757]]), "in psi"),
        (lambda s: s * np.array([[1], [1], [1], [10.0]]), "in hPa"),
        (lambda s: s[[0, 1, 3, 2]], "exchanged"),
        (lambda s: s * np.array([[1], [1], [1], [1e3]]), "in Pa"),
        (lambda s: s / np.array([[1], [1], [1], [0.24908891]]), "in inH2O"),
        # Each alone is far from the prediction; together they are near, along another curve.
        (lambda s: s / np.array([[1], [1], [9.80665], [6.894757]]), "in kgf and the pressure in psi"),
        (lambda s: s / np.array([[1], [1], [9.80665], [100.0]]), "in kgf and the pressure in bar"),
    ],
)
def test_a_press_by_hand_in_another_unit_or_exchanged_is_told_with_the_option_that_is_right(turn, word, tmp_path):
    wrong = Recording(write=by_hand, spoil=turn)
    measured = read(tmp_path, wrong)
    said = [entry.message for entry in measured.failures] or asked(measured, f"{word} (give")
    (option,) = re.findall(rf"{word} \(give `columns` ([^)]*)\)", said[0])
    right = read(tmp_path, wrong, reading={"columns": parse_columns(shlex.split(option))})
    assert not right.questions and not right.failures
    assert figures(right)["sensitivity_kPa_per_N"].value == pytest.approx(2.34, rel=0.02)


def test_a_gauge_that_reads_too_little_is_asked_about_once_with_what_then_is_right(tmp_path):
    low = Recording(write=by_hand, ambient=-3.0)
    (question,) = read(tmp_path, low).questions
    (zero,) = map(float, re.findall(r"with (\S+) kPa to subtract", question.question))
    right = replace(low, spoil=lambda s: s - np.array([[0.0], [0.0], [0.0], [zero]]))
    assert not read(tmp_path, right).questions


def test_a_press_by_hand_and_one_of_a_plate_are_not_averaged(tmp_path):
    for name, recording in (("a.csv", Recording(write=by_hand)), ("b.csv", READ["triangular"])):
        (tmp_path / name).write_text(recording.text())
    rows = [f'[[runs]]\nfile = "{name}.csv"\nsensor = "A1"\n' for name in "ab"]
    (tmp_path / "campaign.toml").write_text("\n".join([rows[0] + 'kind = "hand"\n', rows[1]]))
    measured = characterize(tmp_path, "paper-dome", model="atlas").figures
    assert figures(measured)["sensitivity_kPa_per_N"].runs == 1
    value = true_figures(READ["triangular"].at())["sensitivity_kPa_per_N"]
    assert figures(measured)["sensitivity_kPa_per_N"].value == pytest.approx(value, rel=0.02)


def test_a_press_by_hand_of_the_wrong_sign_is_refused_with_the_sign(tmp_path):
    upside = Recording(write=by_hand, spoil=lambda s: s * np.array([[1], [1], [-1], [1]]))
    with pytest.raises(InputError, match=r"force=-force_N"):
        read(tmp_path, upside)
    reading = {"columns": {"force": {"name": "force_N", "unit": "N", "sign": -1}}}
    assert figures(read(tmp_path, upside, reading=reading))["sensitivity_kPa_per_N"].value > 2
