"""How fast a design reads: the line as drawn, the gauge's rate, and the rows that people see."""

from __future__ import annotations

import pytest

from pneutouch.cli.prediction_text import dynamics_lines
from pneutouch.evaluation.dynamics import GAUGE_RATE, dynamics, free_compliance, line_of
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.results.record import plain as data


@pytest.fixture(scope="module")
def drawn(library):
    """A design whose dead volume is that of connector and tube."""
    return evaluate("agilus-dome", model="atlas", library=library)


def test_the_line_holds_the_dead_volume_of_the_prediction(drawn):
    figures = drawn.bandwidth
    line = figures.states[0].dynamics.line
    assert line.volume == pytest.approx(drawn.sensor.gas.dead_volume, rel=1e-6)
    assert figures.note is None


def test_a_greater_dead_volume_lies_behind_the_tube(library):
    one = evaluate("agilus-dome", {"pneumatics.dead_volume_mL": 5.0}, model="atlas", library=library)
    pieces, end, note = line_of(one.assembly, one.sensor)
    assert sum(piece.volume for piece in pieces) + end == pytest.approx(5000.0)
    assert end > 0 and note is None


def test_a_stated_dead_volume_below_the_line_is_noted(library):
    one = evaluate("paper-dome", model="atlas", library=library)
    assert "less than the 1.5 mL of connector and tube as drawn" in one.bandwidth.note
    assert one.bandwidth.states[0].dynamics.line.volume > 1000.0


def test_a_shorter_tube_is_quicker_in_every_figure(library):
    figures = [
        evaluate("agilus-dome", {"pneumatics.tube_length_mm": size}, model="atlas", library=library).bandwidth.states[0]
        for size in (50.0, 200.0, 1000.0)
    ]
    for of in (lambda s: s.band.resonance, lambda s: s.band.bandwidth, lambda s: 1 / s.step.delay):
        values = [of(state) for state in figures]
        assert values == sorted(values, reverse=True)


def test_every_series_of_relaxation_data_has_a_state(drawn):
    pressures = drawn.scene.design.pneumatics.driving_pressures_kPa
    document = data(dynamics(drawn.bandwidth))
    assert len(document["states"]) == 3 * len(pressures)
    assert len({state["relaxation_source"] for state in document["states"]}) == 3
    assert all(0 < state["fast_wall_over_slow"] < 1 < state["fast_gas_over_slow"] < 1.4 for state in document["states"])


def test_a_gauge_with_a_low_rate_limits_the_bandwidth(drawn):
    state = drawn.bandwidth.states[0]
    line = state.band.bandwidth
    assert state.usable(None) == (line, "line")
    assert state.usable(10 * line) == (line, "line")
    assert state.usable(line) == (0.5 * line, GAUGE_RATE)


def test_the_compliance_of_the_dome_is_the_slope_of_its_inflation(drawn):
    """Volume over pressure between two driving pressures near to one another."""
    two = evaluate("agilus-dome", {"pneumatics.driving_pressures_kPa": [4.9, 5.0, 5.1]}, model="atlas")
    low, middle, high = two.prediction.states
    secant = (high.cavity_volume - low.cavity_volume) / (high.driving_pressure - low.driving_pressure)
    assert free_compliance(two.prediction, middle) == pytest.approx(secant, rel=0.02)


def test_the_figures_are_stated_in_words(drawn):
    lines = dynamics_lines(dynamics(drawn.bandwidth))
    assert len(lines) == 3
    assert "first resonance" in lines[0] and "data A" in lines[0] and "data B" in lines[1]


def test_the_resonance_has_an_interval_until_the_gas_in_the_gauge_is_known(drawn, library):
    """The interval's lower end is the resonance of a design that states 0.15 mL in its gauge."""
    changes = {"pneumatics.gauge_volume_mL": 0.15}
    known = dynamics(evaluate("agilus-dome", changes, model="atlas", library=library).bandwidth).states[0]
    open_ = dynamics(drawn.bandwidth).states[0]
    assert known.first_resonance_low_Hz is None
    assert open_.first_resonance_low_Hz == pytest.approx(known.first_resonance_Hz, rel=0.01)
    assert open_.resonance_gain_low == pytest.approx(open_.resonance_gain / 1.5, rel=1e-4)
    measured = evaluate("agilus-dome", {"pneumatics.dead_volume_mL": 5.0}, model="atlas", library=library)
    assert dynamics(measured.bandwidth).states[0].first_resonance_low_Hz is None
