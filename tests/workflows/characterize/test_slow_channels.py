"""Channels that come late or are read seldom, and a travel in steps: read where they are true, else asked or refused."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from pneutouch.errors import InputError
from tests.bench.recordings import CLEAR, DEEP, READ, Recording, by_hand, depths, presses, true_figures
from tests.workflows.characterize.test_recordings import asked, figures, read


def later(seconds):
    """The pressure delayed."""
    return lambda s: np.vstack([s[:3], np.interp(s[0] - seconds, s[0], s[3])])


@pytest.mark.parametrize("name", ["triangular", "steps", "noise"])
@pytest.mark.parametrize("seconds", [0.1, 1.0, -0.25])
def test_channels_that_lag_one_another_are_asked_about(name, seconds, tmp_path):
    lagging = replace(READ[name], spoil=later(seconds))
    words = f"pressure comes {seconds:.2g} s after" if seconds > 0 else "force comes 0.25 s after"
    assert asked(read(tmp_path, lagging), words)


def filtered(row, seconds):
    """A channel behind a low pass of the first order."""

    def late(samples):
        share = np.exp(-np.diff(samples[0], prepend=0.0) / seconds)
        values = samples[row].copy()
        for k in range(1, values.size):
            values[k] = samples[row][k] + share[k] * (values[k - 1] - samples[row][k])
        samples[row] = values
        return samples

    return late


@pytest.mark.parametrize(("row", "channel"), [(2, "force"), (3, "pressure")])
@pytest.mark.parametrize("seconds", [0.1, 0.3, 0.5])
def test_a_channel_behind_a_slow_filter_is_asked_about_by_its_time(row, channel, seconds, tmp_path):
    (question,) = asked(read(tmp_path, Recording(spoil=filtered(row, seconds))), f"the {channel} comes")
    (late, times) = map(float, re.findall(r"([\d.]+) s after .* ([\d.e]+) times slower", question)[0])
    assert late == pytest.approx(seconds, rel=0.08)
    # As told: pressed so much slower, it is right.
    legs = [(seconds * times, leg) for seconds, leg in presses(1)]
    slower = read(tmp_path, Recording(legs, spoil=filtered(row, seconds)))
    value = true_figures(depths(25))["sensitivity_kPa_per_N"]
    assert not slower.questions and figures(slower)["sensitivity_kPa_per_N"].value == pytest.approx(value, rel=0.02)


def turned(seconds):
    """Legs of three cycles of a sine."""
    share = np.linspace(0.0, 3.0, 181)
    travel = CLEAR + (DEEP - CLEAR) * (1 - np.cos(2 * np.pi * share)) / 2
    return [(seconds / 60, float(place)) for place in travel[1:]]


def late(row, seconds):
    """A channel delayed."""
    return lambda s: np.vstack([s[:row], np.interp(s[0] - seconds, s[0], s[row]), s[row + 1 :]])


TIMED = {
    "late travel": (presses(2), late(1, 0.1), "travel comes", {}),
    "late travel in steps": (READ["steps"].legs, late(1, 0.1), "travel comes", {}),
    "late travel of a sine": (turned(5.0), late(1, 0.05), "travel comes", {}),
    "one filter of both": (presses(2), lambda s: filtered(3, 0.3)(filtered(2, 0.3)(s)), "force and pressure come", {}),
    "early pressure of a sine": (turned(5.0), late(3, -0.1), "force comes", {}),
    "late pressure by hand": (presses(2), late(3, 0.05), "pressure comes", {"write": by_hand}),
}
"""Legs and delays of records whose figures the delays make wrong by more than 2 %, and the question on them."""


@pytest.mark.parametrize("name", TIMED)
def test_a_delay_that_spoils_a_figure_is_asked_about_and_goes_in_a_press_as_slow_as_told(name, tmp_path):
    legs, spoil, words, kept = TIMED[name]
    (question,) = asked(read(tmp_path, Recording(legs, spoil=spoil, **kept)), words)
    times = int(re.findall(r"press (\d+) times slower", question)[0])
    slower = read(tmp_path, Recording([(times * seconds, leg) for seconds, leg in legs], spoil=spoil, **kept))
    assert not slower.questions
    found, value = figures(slower), true_figures(depths(25))
    for key in value if not kept else ["sensitivity_kPa_per_N"]:
        assert found[key].value == pytest.approx(value[key] if not kept else 2.338, rel=0.02), key


@pytest.mark.parametrize("row", [1, 2, 3])
@pytest.mark.parametrize("seconds", [0.3, 1.0])
@pytest.mark.parametrize("legs", [[(2.0, CLEAR), (1.5, DEEP), (1.5, CLEAR), (2.0, CLEAR)], READ["steps"].legs])
def test_a_great_delay_is_told_as_one_and_goes_where_its_column_is_shifted_as_told(row, seconds, legs, tmp_path):
    """Of a quick press it makes a wrong unit, sign, driving pressure or begin inside the dome."""
    try:
        measured = read(tmp_path, Recording(legs, spoil=late(row, seconds)))
        messages = [entry.question for entry in measured.questions] + [entry.message for entry in measured.failures]
    except InputError as refused:
        messages = [str(refused)]
    (message,) = messages
    channel = ("travel", "force", "pressure")[row - 1]
    told = float(re.findall(rf"the {channel} comes ([\d.]+) s after", message)[0])
    assert told == pytest.approx(seconds, abs=0.005)
    measured = read(tmp_path, Recording(legs, spoil=lambda s: late(row, -told)(late(row, seconds)(s))))
    found, at = figures(measured), depths() if len(legs) > 4 else depths(25)
    assert not asked(measured, "s after the")
    for key, value in true_figures(at).items():
        assert found[key].value == pytest.approx(value, rel=0.02), key


def test_a_wall_that_relaxes_is_not_taken_for_a_delay(tmp_path):
    """Its force is greater on the way in than on the way out, and its pressure is not."""

    def relaxing(samples):
        slow = filtered(2, 1.0)(samples.copy())[2]
        samples[2] += 0.2 * (samples[2] - slow)
        return samples

    measured = read(tmp_path, replace(READ["triangular"], spoil=relaxing))
    assert not asked(measured, "s after the")


def refreshed(rows, seconds, apart=0.0):
    """Channels whose readings change only once in so many seconds, at moments ``apart`` seconds apart."""

    def kept(samples):
        count = round(seconds * 500)
        for k, row in enumerate(rows):
            late = round(k * apart * 500)
            places = (np.arange(samples.shape[1]) - late) // count * count + late
            samples[row] = samples[row][np.maximum(places, 0)]
        return samples

    return kept


@pytest.mark.parametrize("seconds", [0.05, 0.1, 0.25, 1 / 3, 0.5])
@pytest.mark.parametrize("row", [2, 3])
@pytest.mark.parametrize("name", ["triangular", "sine"])
def test_a_gauge_that_refreshes_slowly_gives_the_figures_of_the_truth(name, row, seconds, tmp_path):
    recording = replace(READ[name], spoil=refreshed((row,), seconds))
    measured = read(tmp_path, recording)
    assert not measured.questions and any("refresh" in warning.why for warning in measured.runs[0].warnings)
    for key, value in true_figures(recording.at()).items():
        figure = figures(measured)[key]
        inside = figure.low is not None and figure.low <= value <= figure.high
        assert inside or figure.value == pytest.approx(value, rel=0.02), key


@pytest.mark.parametrize("apart", [0.0, 0.04])
@pytest.mark.parametrize("seconds", [0.1, 0.5])
def test_two_slow_gauges_leave_the_place_of_contact_open(seconds, apart, tmp_path):
    measured = read(tmp_path, Recording(spoil=refreshed((2, 3), seconds, apart)))
    assert asked(measured, "first contact lies between") and figures(measured)["stiffness_N_per_mm"].low is None
    value = true_figures(depths(25))["sensitivity_kPa_per_N"]
    assert figures(measured)["sensitivity_kPa_per_N"].value == pytest.approx(value, rel=0.02)


@pytest.mark.parametrize("row", [2, 3])
def test_a_gauge_too_slow_for_a_press_is_asked_about(row, tmp_path):
    assert asked(read(tmp_path, replace(READ["hold"], spoil=refreshed((row,), 0.5))), "press slower")


@pytest.mark.parametrize("legs", [presses(3), turned(5.0), turned(10.0), turned(20.0)])
@pytest.mark.parametrize(("step", "zero"), [(0.1, 0.0), (0.1, 0.013), (0.05, 0.05)])
def test_a_travel_in_small_steps_gives_the_figures_of_the_truth(legs, step, zero, tmp_path):
    """The last reading of a turn stays while the plate goes on: it is no hold."""
    coarse = Recording(legs, spoil=lambda s: np.vstack([s[:1], np.round((s[1:2] + zero) / step) * step, s[2:]]))
    found = figures(read(tmp_path, coarse))
    for key, value in true_figures(depths(25)).items():
        assert found[key].value == pytest.approx(value, rel=0.02), key


def test_a_contact_between_two_steps_of_stairs_is_found_as_well_as_the_interval_says(tmp_path):
    """Before the step on which the force shows, the readings begin inside the dome and tell no shape."""
    seldom = replace(READ["stairs with return"], spoil=lambda s: refreshed((2,), 0.5)(s)[:, ::5])
    figure, value = figures(read(tmp_path, seldom))["stiffness_N_per_mm"], true_figures(depths())["stiffness_N_per_mm"]
    assert figure.low <= value <= figure.high or figure.value == pytest.approx(value, rel=0.02)


@pytest.mark.parametrize("spoil", [refreshed((1,), 0.5), lambda s: np.vstack([s[:1], np.round(2 * s[1:2]) / 2, s[2:]])])
def test_a_travel_read_seldom_or_in_great_steps_is_refused_and_goes_without_it(spoil, tmp_path):
    with pytest.raises(InputError, match="hand"):
        read(tmp_path, Recording(spoil=spoil))
    found = figures(read(tmp_path, Recording(spoil=spoil), kind="hand"))
    assert found["sensitivity_kPa_per_N"].value == pytest.approx(
        found["sensitivity_kPa_per_N"].predicted.value, rel=0.02
    )


def test_a_lag_in_which_a_slow_press_hardly_goes_on_is_not_asked_about(tmp_path):
    legs = [(4.0, CLEAR), (45.0, DEEP), (45.0, CLEAR), (2.0, CLEAR)]
    slow = Recording(legs, noise=0.005, spoil=later(0.04))
    measured = read(tmp_path, slow)
    assert not measured.questions
    found, value = figures(measured)["sensitivity_kPa_per_N"], true_figures(slow.at())["sensitivity_kPa_per_N"]
    assert found.value == pytest.approx(value, rel=0.02)
