"""The driving pressure that gives a figure: what is solved is what the model predicts there."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.evaluation import evaluate
from pneutouch.results.record import plain
from pneutouch.spec.tasks import DrivingTask
from pneutouch.units import KPA, ML
from pneutouch.workflows.driving import LeakSource, driving_record, driving_schedule
from pneutouch.workflows.driving.pressures import band, reach_curves, solutions
from tests.evaluation.calibrated import DEAD, library_of, predicted

LEAK = LeakSource(0.05, 20.0, cap=True, where="a test")


@pytest.fixture(scope="module")
def curves(library):
    return reach_curves("paper-dome", {}, library=library)


@pytest.fixture(scope="module")
def schedule(library):
    tasks = [DrivingTask(name="grasp", stiffness_N_per_mm=4.2), DrivingTask(sensitivity_kPa_per_N=2.2)]
    tasks += [DrivingTask(sensitivity_kPa_per_N=2.5), DrivingTask(force_range_N=28.0)]
    return driving_schedule("paper-dome", tasks, library=library, leak=LEAK)


def test_the_model_predicts_the_required_figure_at_the_solved_pressure(schedule, library):
    grasp = schedule.answers[0].solutions[0].state.driving_pressure / KPA
    changed = {"pneumatics.driving_pressures_kPa": [grasp]}
    state = evaluate("paper-dome", changed, model="atlas", library=library).prediction.states[0]
    assert state.figures.stiffness == pytest.approx(4.2, rel=1e-5)


def test_the_band_is_where_the_interval_of_the_figure_holds_the_value(curves):
    value = 1.9
    (solution,) = solutions(curves, "sensitivity_kPa_per_N", value)
    at, ends = solution.state.driving_pressure, solution.band
    assert ends.low <= at <= ends.high
    values, widths = curves.values("sensitivity_kPa_per_N"), curves.widths("sensitivity_kPa_per_N")
    inside = np.abs(np.log(values / value)) <= widths
    pressures = curves.pressures
    assert np.all(inside == ((pressures >= ends.low) & (pressures <= ends.high)))
    assert ends.open_low == inside[0] and ends.open_high == inside[-1]


def test_a_sure_figure_has_a_narrow_band(curves, monkeypatch):
    monkeypatch.setattr(type(curves), "widths", lambda self, figure: np.full(len(self.states), 1e-3))
    (solution,) = solutions(curves, "sensitivity_kPa_per_N", 2.0)
    at = solution.state.driving_pressure
    ends = band(curves, "sensitivity_kPa_per_N", 2.0, at)
    values, k = curves.values("sensitivity_kPa_per_N"), int(np.searchsorted(curves.pressures, at))
    slope = np.gradient(values, curves.pressures)[k]
    assert ends.high - ends.low == pytest.approx(2 * 2e-3 / abs(slope), rel=0.05)
    assert not ends.open_low and not ends.open_high


def test_the_band_of_a_calibrated_sensor_is_that_on_the_day_of_its_calibration(library, tmp_path):
    """Ageing since then has most of its variance: counted in, no further run would close the band."""
    place, figure = library_of(tmp_path, library), "sensitivity_kPa_per_N"
    curves = reach_curves("paper-dome@mine", DEAD, library=place, model="atlas")
    pressure = curves.budgets[1][0]
    at = predicted(place, {**DEAD, "pneumatics.driving_pressures_kPa": [pressure / KPA]})
    known = at.uncertainty[0].known[figure]
    width = curves.widths(figure)[np.searchsorted(curves.pressures, pressure)]
    assert width == pytest.approx(np.log(known.at_calibration.high / known.value), rel=1e-3)
    assert width < 0.7 * np.log(known.high / known.value)


def test_a_curve_that_turns_has_two_solutions_and_the_lower_comes_first(library):
    curves = reach_curves("fingertip-dome", {}, library=library, model="atlas")
    stiffness = curves.values("stiffness_N_per_mm")
    top = float(np.nanmax(stiffness))
    assert 0 < int(np.nanargmax(stiffness)) < len(stiffness) - 1
    found = [one.state.driving_pressure for one in solutions(curves, "stiffness_N_per_mm", 0.985 * top)]
    assert len(found) == 2 and found[0] < found[1]
    assert solutions(curves, "stiffness_N_per_mm", 1.01 * top) == []
    assert len(solutions(curves, "stiffness_N_per_mm", 1.2 * float(stiffness[0]))) == 1


def test_what_is_not_reached_is_stated_with_a_change_that_reaches_it(schedule):
    missed = schedule.answers[2]
    assert not missed.reached and not schedule.reached and missed.gas is None
    (wall,) = (one for one in missed.changes if one.what == "membrane.wall_thickness_mm")
    assert wall.before == 1.5 and wall.after < 1.5
    assert wall.predicted == pytest.approx(2.5, rel=0.05)


def test_volumes_are_boyles_and_add_up_over_the_tasks(schedule):
    ambient, done = 101.325 * KPA, 0.0
    rest = schedule.curves.states[0].cavity_volume
    for answer in (one for one in schedule.answers if one.reached):
        state = answer.solutions[0].state
        held = (state.driving_pressure + ambient) * state.cavity_volume / ambient
        assert answer.gas.injected_mL * ML == pytest.approx(held - rest, rel=1e-9)
        done += answer.gas.moved_mL
        assert done == pytest.approx(answer.gas.injected_mL, rel=1e-9)


def test_a_leak_behind_a_cap_is_that_of_the_gas_behind_it(schedule):
    """The cap of the paper's design closes connector and tube as drawn; the sensor holds more gas and loses less."""
    assembly = schedule.curves.evaluation.assembly
    behind = assembly.internal_volume + assembly.tube_volume
    gas, answer = schedule.curves.gas, schedule.answers[0]
    k = int(np.argmin(np.abs(gas.pressure - answer.solutions[0].state.driving_pressure)))
    # The flow is that of the squares of the absolute pressures.
    squares = [(p + gas.ambient) ** 2 - gas.ambient**2 for p in (gas.pressure[k], 20.0 * KPA)]
    expected = 0.05 * behind / gas.capacity[k] * squares[0] / squares[1]
    assert answer.gas.loss_kPa_per_min == pytest.approx(expected, rel=1e-9)
    assert answer.gas.hold_s == pytest.approx(60 * answer.gas.step_kPa / answer.gas.loss_kPa_per_min, rel=0.1)


def test_the_document_has_every_task_and_nothing_that_is_no_number(schedule):
    record = driving_record(schedule)
    assert [task.reached for task in record.tasks] == [True, True, False, True]
    assert record.tasks[0].task == "grasp"
    reach = record.reach["sensitivity_kPa_per_N"]
    assert reach.low < reach.rated_low < reach.rated_high == reach.high
    assert record.tasks[1].gas.figure_by_temperature_percent_per_K < 0
    assert "nan" not in repr(plain(record)).lower().split() and "inf" not in repr(plain(record))
