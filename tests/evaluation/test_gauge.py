"""The gauge of a design: its range, its dead volume, the smallest force, and what check and sheet state of it."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.catalogue import Library, load_scene
from pneutouch.evaluation import evaluate
from pneutouch.evaluation.gauge import force_at_rise, gauge_record
from pneutouch.evaluation.result import predicted_in_full
from pneutouch.mechanics.gauge_reading import gauge_reading
from pneutouch.parts import assemble
from pneutouch.results.record import plain as data
from pneutouch.spec.gauge import Gauge
from pneutouch.units import KPA, STANDARD_ATMOSPHERE

PAPER = "smc-pse543"


def gauge(name: str) -> Gauge:
    return Library.default().load("gauges", name)


@pytest.fixture(scope="module")
def bare(evaluated):
    return evaluated("paper-dome", model="atlas")


@pytest.fixture(scope="module")
def narrow():
    return evaluate("paper-dome", {"pneumatics.gauge": "bosch-bmp390"}, model="atlas")


def test_a_sensor_without_a_gauge_is_read_by_the_papers():
    assert gauge_reading(None, STANDARD_ATMOSPHERE) == gauge_reading(gauge(PAPER), STANDARD_ATMOSPHERE)


def test_an_analog_gauge_is_read_as_often_as_the_papers_recorder_reads():
    """10 kHz (paper, Supplement C)."""
    assert gauge_reading(None, STANDARD_ATMOSPHERE).rate_Hz == gauge_reading(gauge(PAPER), STANDARD_ATMOSPHERE).rate_Hz
    assert gauge_reading(None, STANDARD_ATMOSPHERE).rate_Hz == 10_000


def test_naming_the_papers_gauge_changes_no_figure(bare):
    named = evaluate("paper-dome", {"pneumatics.gauge": PAPER}, model="atlas")
    assert named.sensor == bare.sensor
    assert data(gauge_record(named)) == {**data(gauge_record(bare)), "name": PAPER}


def test_the_smallest_force_is_three_deviations_of_a_difference_over_the_sensitivity(bare):
    step_kPa = 20 / 2**16 * 50
    scatter_kPa = math.sqrt(0.015**2 + step_kPa**2 / 12)
    record = data(gauge_record(bare))
    assert record["threshold_kPa"] == pytest.approx(3 * math.sqrt(2) * scatter_kPa, rel=1e-5)
    for one, state in zip(record["states"], bare.prediction.states, strict=True):
        slope_kPa_per_N = state.figures.sensitivity
        assert one["smallest_force_N"] == pytest.approx(record["threshold_kPa"] / slope_kPa_per_N, rel=1e-4)
        # The untouched dome gives less pressure than the fitted line.
        assert one["smallest_force_at_first_contact_N"] > one["smallest_force_N"]
        warming_K = one["warming_that_reads_as_smallest_force_K"]
        assert warming_K * one["zero_drift_kPa_per_K"] == pytest.approx(record["threshold_kPa"], rel=1e-4)


def test_without_a_stated_noise_the_smallest_force_is_not_known(narrow):
    record = data(gauge_record(narrow))
    if gauge("bosch-bmp390").noise_kPa is None:
        assert record["threshold_kPa"] is None and {s["smallest_force_N"] for s in record["states"]} == {None}
        assert record["limited_by"].startswith("not known")


def test_an_absolute_gauge_ends_the_range_at_its_own_less_the_ambient_pressure(narrow):
    assert narrow.sensor.gas.gauge_limit == pytest.approx((125 - 101.325) * KPA)
    highest = narrow.prediction.states[-1]
    assert next(event.kind for event in highest.events if event.ends_range) == "gauge range"
    top = highest.driving_pressure + float(np.interp(highest.range_end, highest.indentation, highest.pressure_rise))
    assert top == pytest.approx(narrow.sensor.gas.gauge_limit, rel=0.02)


def test_check_warns_of_a_gauge_that_the_pressed_sensor_leaves(narrow, bare):
    messages = [f.message for f in narrow.findings if f.rule == "driving"]
    assert any("passes the 23.675 kPa that the Bosch BMP390 reads" in message for message in messages)
    assert not any("reads" in f.message for f in bare.findings if f.rule == "driving")


def test_a_driving_pressure_above_the_gauge_is_an_error():
    evaluation = evaluate(
        "paper-dome", {"pneumatics.gauge": "bosch-bmp390", "pneumatics.driving_pressures_kPa": [0, 30]}, model="atlas"
    )
    found = next(f for f in evaluation.findings if f.rule == "driving" and f.severity == "error")
    assert "above the gauge range, 23.7 kPa" in found.message
    assert "1250 hPa" in found.source


def test_a_known_inner_volume_is_dead_volume(tmp_path, monkeypatch):
    folder = tmp_path / "printprofiles/gauges"
    folder.mkdir(parents=True)
    text = Library.default().paths("gauges")[PAPER].read_text(encoding="utf-8")
    kept = "\n".join(line for line in text.splitlines() if not line.startswith("inner_volume_mL"))
    volume = '\n[inner_volume_mL]\nvalue = 0.25\nsource = "measured by injection, for this test"\n'
    (folder / "ours.toml").write_text(kept + volume, encoding="utf-8")
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path))
    plain = assemble(load_scene("agilus-dome"))
    with_it = assemble(load_scene("agilus-dome", {"pneumatics.gauge": "ours"}))
    assert with_it.dead_volume - plain.dead_volume == pytest.approx(250.0)
    stated = assemble(load_scene("paper-dome", {"pneumatics.gauge": "ours"}))
    assert stated.dead_volume == 0.0


@given(power=st.floats(1.0, 2.5), scale=st.floats(0.01, 10), threshold=st.floats(1e-6, 0.9))
def test_the_force_at_a_rise_is_exact_for_a_power_law_below_the_first_point(power, scale, threshold):
    force = np.array([0.0, 1.0, 2.0, 3.0])
    rise = scale * force**power
    assert force_at_rise(force, rise, threshold * scale) == pytest.approx(threshold ** (1 / power), rel=1e-9)
    assert force_at_rise(force, rise, 2 * rise[-1]) is None


def test_the_document_of_a_prediction_holds_the_gauge_that_a_design_names(narrow, bare):
    assert data(predicted_in_full(narrow))["gauge"] == data(gauge_record(narrow))
    assert "gauge" not in data(predicted_in_full(bare))
