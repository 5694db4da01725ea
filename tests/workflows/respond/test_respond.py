"""A step and a sine through the whole chain, as files and as figures."""

from __future__ import annotations

import json

import numpy as np
import pytest

import pneutouch as pt
from pneutouch.cli.respond import respond_text
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.formats import versioned
from pneutouch.results.record import plain
from pneutouch.workflows.respond import Load, frequency_Hz, load_size, run_respond
from pneutouch.workflows.responded import responded, write_respond
from tests.refusals import refused


@pytest.fixture(scope="module")
def elastic(library):
    """A sensor whose resin has no relaxation data, with 300 mm of tube."""
    return evaluate("long-tube", {"pneumatics.driving_pressures_kPa": [5.0]}, model="atlas", library=library)


@pytest.fixture(scope="module")
def relaxing(library):
    return evaluate("agilus-dome", {"pneumatics.driving_pressures_kPa": [5.0]}, model="atlas", library=library)


def test_a_step_ends_at_the_slow_reading(elastic):
    (signal,) = run_respond(elastic, Load(1.0, duration=2.0)).signals
    state = elastic.prediction.states[0]
    slow = np.interp(1.0, state.force, state.pressure_rise)
    assert signal.slow[-1] == pytest.approx(slow, rel=0.01)
    assert signal.gauge[-200:].mean() == pytest.approx(signal.slow[-1], rel=0.01)
    before = signal.time < 0.19
    assert np.abs(signal.gauge[before]).max() < 1e-3 * signal.slow[-1]


def test_a_slow_sine_is_the_slow_press(elastic):
    (signal,) = run_respond(elastic, Load(1.0, frequency=0.1, duration=40.0)).signals
    assert signal.gauge == pytest.approx(signal.slow, abs=0.03 * signal.slow.max())
    assert signal.at_frequency(0.1)[0] == pytest.approx(1.0, abs=0.02)


def test_a_quick_press_reads_more_by_the_heat_that_the_gas_keeps(elastic):
    """Between isothermal and adiabatic: above the heat exchange and well below the resonance."""
    (signal,) = run_respond(elastic, Load(0.5, frequency=10.0)).signals
    gain, lag = signal.at_frequency(10.0)
    assert 1.02 < gain < 1.05 * signal.dynamics.fast_gas
    assert abs(lag) < 10.0


def test_the_compliance_at_a_small_load_is_that_of_the_free_dome(elastic):
    """Found by a second press with more gas; at first contact it is the slope of the inflation curve."""
    small, free = (run_respond(elastic, Load(force)).signals[0].dynamics.wall_compliance for force in (0.3, 1e-3))
    assert small == pytest.approx(free, rel=0.25)


def test_a_force_creeps_where_the_wall_relaxes(relaxing):
    """The gas takes over what the wall lets go: the pressure rises for as long as the slowest term, and ends as slow."""
    signals = run_respond(relaxing, Load(1.0, duration=5.0)).signals
    assert len(signals) == 3
    for signal in signals:
        one, two, three = (signal.gauge[np.searchsorted(signal.time, t)] for t in (0.8, 2.0, 4.9))
        assert one < two < three < signal.slow[-1]


def test_a_travel_is_held_while_the_pressure_falls(relaxing):
    """At constant indentation the wall relaxes: after a quick press the pressure is above the slow one, and falls."""
    for signal in run_respond(relaxing, Load(2.0, travel=True, duration=5.0)).signals:
        late = signal.gauge[np.searchsorted(signal.time, 1.0) :]
        assert signal.dynamics.wall_compliance > 0
        assert np.isfinite(late).all()


def test_the_samples_are_those_of_the_gauge(library):
    """Its rate, its steps, its noise as a standard deviation, and the same bytes for the same seed."""
    changes = {"pneumatics.driving_pressures_kPa": [5.0], "pneumatics.gauge": "bosch-bmp390"}
    one = evaluate("long-tube", changes, model="atlas", library=library)
    gauge = one.scene.gauge
    if gauge.rate_Hz is None:
        pytest.skip("the rate of this gauge is not known")
    (signal,) = run_respond(one, Load(0.5, duration=2.0), seed=1).signals
    (again,) = run_respond(one, Load(0.5, duration=2.0), seed=1).signals
    (other,) = run_respond(one, Load(0.5, duration=2.0), seed=2).signals
    assert np.array_equal(signal.samples.reading, again.samples.reading)
    assert np.diff(signal.samples.time) == pytest.approx(1 / gauge.rate_Hz.nominal)
    if gauge.noise_kPa is not None:
        assert not np.array_equal(signal.samples.reading, other.samples.reading)
    clean = signal.driving_pressure + np.interp(signal.samples.time, signal.time, signal.gauge)
    noise = 0.0 if gauge.noise_kPa is None else 1e-3 * gauge.noise_kPa.nominal
    step = 0.0 if gauge.resolution_kPa is None else 1e-3 * gauge.resolution_kPa.nominal
    assert np.abs(signal.samples.reading - clean).max() <= 5 * noise + step


def test_the_folder_holds_what_the_document_states(elastic, tmp_path):
    run = run_respond(elastic, Load(1.0))
    record = responded(run)
    folder = write_respond(run, record, tmp_path)
    again = write_respond(run, record, tmp_path / "again")
    assert {path.name for path in folder.iterdir()} == {
        "response.json",
        "response.svg",
        "signal-1.csv",
        "manifest.json",
    }
    for path in folder.iterdir():
        assert path.read_bytes() == (again / path.name).read_bytes()
    stated = json.loads((folder / "response.json").read_text())
    assert stated == versioned("response", plain(record)) and stated["simulated"] is True
    table = np.genfromtxt(folder / "signal-1.csv", delimiter=",", names=True)
    assert table["gauge_pressure_rise_kPa"].max() == pytest.approx(
        stated["states"][0]["greatest_reading_kPa"], rel=0.02
    )
    assert table["contact_force_N"].max() == 1.0
    assert "simulated step to 1 N" in respond_text(record)


def test_python_and_the_command_give_the_same(elastic, tmp_path):
    result = pt.respond("agilus-dome", sine_Hz=5.0, peak_N=0.5, model="atlas")
    assert result["signal"] == "sine" and result["peak_N"] == 0.5
    # By the third source the resin is far stiffer at 5 Hz than at rest.
    assert all(0.02 < state["gain"] < 1.5 for state in result["states"])
    with pytest.raises(InputError):
        pt.respond("agilus-dome", sine_Hz=5.0, step_N=0.5)
    with pytest.raises(InputError):
        pt.respond("agilus-dome", step_N=0.5, step_mm=1.0)


@pytest.mark.parametrize(("text", "size"), [("2N", (2.0, False)), ("0.5 N", (0.5, False)), ("3mm", (3.0, True))])
def test_a_size_has_its_unit(text, size):
    assert load_size(text, "step") == size


@pytest.mark.parametrize("text", ["2", "N", "2kg", "", "2 N N", "nanN2"])
def test_a_size_without_one_is_refused(text):
    with refused("step"):
        load_size(text, "step")


def test_frequencies_are_read_with_and_without_their_unit():
    assert frequency_Hz("5Hz") == frequency_Hz("5") == frequency_Hz("5 Hz") == 5.0
    with refused("sine", "five"):
        frequency_Hz("five")


@pytest.mark.parametrize(
    "load",
    [
        {"peak": 0.0},
        {"peak": -1.0},
        {"peak": float("nan")},
        {"frequency": 0.0},
        {"frequency": float("inf")},
        {"duration": 0.0},
    ],
)
def test_a_load_that_cannot_be_is_refused(load):
    with pytest.raises(InputError):
        Load(**load)


def test_a_load_beyond_the_range_and_a_record_without_end_are_refused(elastic):
    with refused("step", "1000N"):
        run_respond(elastic, Load(1e3))
    with refused("duration", 100000.0):
        run_respond(elastic, Load(1.0, duration=1e5))
