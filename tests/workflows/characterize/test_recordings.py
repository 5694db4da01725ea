"""Recordings of any rig: figures as the truth has them, or a question, or a refusal with the remedy that then works."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from pneutouch.errors import InputError
from pneutouch.workflows.characterize.campaign import characterize
from pneutouch.workflows.characterize.load import load_curves
from tests.bench.reads import refuse
from tests.bench.recordings import CLEAR, DEEP, READ, Recording, by_hand, depths, plain, presses, true_figures, without

VARIANTS = {
    "footer",
    "hold of ten seconds",
    "milliseconds",
    "overshoot",
    "single press",
    "slow",
    "stairs without return",
    "stopped in the second press",
}
"""Recordings of which the everyday run reads others that are nearly alike."""

NAMES = {"time": "time_s", "position": "position_mm", "force": "force_N", "pressure": "pressure_kPa"}


def read(folder, recording, **options):
    path = folder / "run.csv"
    path.write_text(recording.text())
    return characterize(path, "paper-dome", model="atlas", **options).figures


def figures(measured):
    (group,) = measured.groups
    return group.figures


@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.slow) if n in VARIANTS else n for n in READ])
def test_every_figure_is_that_of_the_truth(name, tmp_path):
    recording = READ[name]
    measured = read(tmp_path, recording)
    (run,) = measured.runs
    assert (run.kind, run.kind_by_record) == (recording.kind, True)
    assert not measured.questions and not measured.failures
    found = figures(measured)
    for key, value in true_figures(recording.at()).items():
        figure = found[key]
        inside = figure.low is not None and figure.low <= value <= figure.high
        assert inside or figure.value == pytest.approx(value, rel=0.02), key
    assert found["sensitivity_kPa_per_N"].value == pytest.approx(
        found["sensitivity_kPa_per_N"].predicted.value, rel=0.02
    )


@pytest.mark.parametrize("hold", [0.1, 0.5, 1.0])
@pytest.mark.parametrize(("seconds", "count"), [(1.0, 3), (1.0, 13), (0.3, 5)])
def test_stairs_with_short_stays_are_read_to_the_deepest(hold, seconds, count, tmp_path):
    """After slow steps a short stay at the deep end looks like a slow turn."""
    stops = [*depths(count), *depths(count)[-2::-1]]
    legs = [
        (3.0, CLEAR),
        *(leg for stop in stops for leg in ((seconds, stop), (hold, stop))),
        (0.5, CLEAR),
        (2.0, CLEAR),
    ]
    measured = read(tmp_path, Recording(legs))
    assert not measured.questions
    for key, value in true_figures(depths(count)).items():
        assert figures(measured)[key].value == pytest.approx(value, rel=0.02), key


@pytest.mark.parametrize("hold", [0.2, 0.5, 1.0])
def test_a_press_with_a_short_hold_gives_the_figures_of_its_way_in(hold, tmp_path):
    measured = read(tmp_path, Recording([(2.0, CLEAR), (1.5, DEEP), (hold, DEEP), (1.5, CLEAR), (2.0, CLEAR)]))
    assert not measured.questions
    for key, value in true_figures(depths(25)).items():
        assert figures(measured)[key].value == pytest.approx(value, rel=0.02), key


def test_two_quick_steps_in_alone_are_no_delay(tmp_path):
    """The dome stiffens, so that its force is more like the travel of a later time."""
    legs = [(3.0, CLEAR), (0.1, DEEP / 2), (1.0, DEEP / 2), (0.1, DEEP), (1.0, DEEP)]
    assert not asked(read(tmp_path, Recording(legs)), "s after the")


def rounded(force, pressure=None):
    """Channels read in steps of so many N and kPa."""

    def coarse(samples):
        for row, step in ((2, force), (3, pressure)):
            samples[row] = samples[row] if step is None else np.round(samples[row] / step) * step
        return samples

    return coarse


@pytest.mark.parametrize("step", [0.1, 0.2, 0.5])
@pytest.mark.parametrize("name", ["triangular", "stairs with return"])
def test_a_force_in_coarse_steps_gives_the_stiffness_of_the_truth(name, step, tmp_path):
    """Its first step lies up to 1.5 mm inside the dome, wherever its zero falls in a step: the pressure has the contact."""
    value = true_figures(READ[name].at())["stiffness_N_per_mm"]
    for share in (0.0, 0.26, 0.7):
        measured = read(tmp_path, replace(READ[name], tare=share * step, spoil=rounded(step)))
        figure = figures(measured)["stiffness_N_per_mm"]
        assert figure.value == pytest.approx(value, rel=0.02) and figure.low <= value <= figure.high
        assert any("steps" in warning.why for warning in measured.runs[0].warnings) and not measured.questions


def test_steps_that_hide_first_contact_in_both_channels_are_asked_about_and_leave_no_interval(tmp_path):
    measured = read(tmp_path, replace(READ["steps"], spoil=rounded(0.5, 1.0)))
    assert asked(measured, "steps of 0.5 N", "1 kPa")
    figure = figures(measured)["stiffness_N_per_mm"]
    assert figure.low is None and figure.high is None


def test_a_noise_of_rounding_alone_is_that_of_the_step(tmp_path):
    found = figures(read(tmp_path, replace(READ["steps"], spoil=rounded(0.5))))
    assert found["noise_force_N"].value == pytest.approx(0.5 / np.sqrt(12), rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("noise", [0.02, 0.15])
def test_the_stiffness_of_one_run_has_an_interval_that_holds_the_truth(noise, tmp_path):
    """Its first contact is found in noise; 20 records are to hold it in most cases, and it is to shrink with the noise."""
    held, widths = 0, []
    for seed in range(20):
        figure = figures(read(tmp_path, Recording(noise=noise, seed=seed)))["stiffness_N_per_mm"]
        held += figure.low <= true_figures(READ["triangular"].at())["stiffness_N_per_mm"] <= figure.high
        widths.append((figure.high - figure.low) / figure.value)
    assert held >= 17
    assert np.median(widths) < (0.02 if noise < 0.1 else 0.1)


@pytest.mark.slow
def test_the_drift_of_one_run_has_an_interval_that_holds_the_truth(tmp_path):
    """Over a second without contact the slope of the noise is a hundred times a gauge's drift."""
    held = 0
    for seed in range(20):
        drifting = replace(READ["stairs without return"], drift=-0.005, seed=seed)
        figure = figures(read(tmp_path, drifting))["drift_pressure_kPa_per_min"]
        assert figure.interval_over == "samples"
        held += figure.low <= -0.005 <= figure.high
    assert held >= 17


def test_presses_without_a_column_of_force_are_no_leak(tmp_path):
    blind = Recording(write=lambda s, h: plain(s[[0, 3]], "time_s,pressure_kPa"))
    path = tmp_path / "run.csv"
    path.write_text(blind.text())
    assert any("up and down" in text for _, text in load_curves(path, characterize_scene()).questions)


def test_a_force_that_never_changes_is_asked_about_as_a_leak(tmp_path):
    still = Recording(write=lambda s, h: by_hand(s * np.array([[1], [1], [0], [1]]), h))
    with pytest.raises(InputError, match="leak"):
        read(tmp_path, still)


def test_a_force_whose_fit_knows_no_first_contact_has_no_interval(tmp_path):
    drifting = Recording(spoil=lambda s: s + np.array([[0], [0], [1], [0]]) * s[0] / 60)
    figure = figures(read(tmp_path, drifting))["stiffness_N_per_mm"]
    assert figure.low is None or figure.high - figure.low < figure.value


@pytest.mark.parametrize("drift", [-5.0, 2.0])
@pytest.mark.parametrize("name", ["stairs without return", "stairs with return"])
def test_a_leak_that_spoils_the_sensitivity_is_a_question(name, drift, tmp_path):
    assert asked(read(tmp_path, replace(READ[name], drift=drift)), "without contact")


def cycles(seconds):
    """Legs of three cycles of a sine."""
    travel = CLEAR + (DEEP - CLEAR) * (1 - np.cos(2 * np.pi * np.linspace(0.0, 3.0, 181))) / 2
    return [(seconds / 60, float(place)) for place in travel[1:]]


def test_a_force_that_does_not_come_back_is_a_question(tmp_path):
    def jumped(samples):
        samples[2, samples.shape[1] * 4 // 9 :] += 2.0
        return samples

    assert asked(read(tmp_path, Recording(cycles(5.0), spoil=jumped)), "no release")


def test_a_gap_at_a_turn_of_a_sine_leaves_that_cycle_out(tmp_path):
    """The slow begin of the way in is no stay, after which the deep end would be one."""
    cut = Recording(cycles(10.0), spoil=without((6184, 7684)))
    for key, value in true_figures(depths(25)).items():
        assert figures(read(tmp_path, cut))[key].value == pytest.approx(value, rel=0.02), key


@pytest.mark.parametrize("seconds", [0.8, 1.5, 4.0])
@pytest.mark.parametrize("hold", [1.0, 5.0, 20.0])
def test_a_noise_in_which_first_contact_is_lost_is_in_the_interval_or_asked_about(seconds, hold, tmp_path):
    """With 0.1 N of noise and few readings of the way in, the stiffness is off by up to 9 %."""
    legs = [(3.0, CLEAR), (seconds, DEEP), (hold, DEEP), (seconds, CLEAR), (3.0, CLEAR)]
    measured = read(tmp_path, Recording(legs, noise=0.1))
    figure, value = figures(measured)["stiffness_N_per_mm"], true_figures(depths(25))["stiffness_N_per_mm"]
    inside = figure.low is not None and figure.low <= value <= figure.high
    assert inside or figure.value == pytest.approx(value, rel=0.02) or asked(measured, "first contact is lost")


@pytest.mark.parametrize("name", ["steps", "stairs with return"])
def test_steps_that_end_where_the_force_is_clipped_are_asked_about(name, tmp_path):
    clipped = replace(READ[name], spoil=lambda s: np.vstack([s[:2], np.minimum(s[2:3], 15.0), s[3:]]))
    assert asked(read(tmp_path, clipped), "clipped", "the figures end")


@pytest.mark.parametrize("stamp", ["2026-13-05T10:00:00", "2026-02-30T10:00:00", "2026-02-20T25:00:00"])
def test_an_impossible_date_is_refused_with_its_row(stamp, tmp_path):
    def wrong(samples, header):
        rows = READ["timestamps"].text().splitlines()
        rows[7] = ",".join([stamp, *rows[7].split(",")[1:]])
        return "\n".join(rows) + "\n"

    path = tmp_path / "run.csv"
    path.write_text(Recording(write=wrong).text())
    refuse(path, "row 8: column timestamp")


AT_END = "stays at its greatest value"


def asked(measured, *words):
    return [entry.question for entry in measured.questions if all(word in entry.question for word in words)]


def test_a_force_at_the_end_of_its_channel_is_a_question_in_noise_and_refused_without(tmp_path):
    def clipped(samples, noise):
        samples[2] = np.minimum(samples[2], 10.0) + noise * np.random.default_rng(1).normal(size=samples.shape[1])
        return samples

    noisy = read(tmp_path, Recording(noise=0.0, spoil=lambda s: clipped(s, 0.02)))
    assert asked(noisy, "force", AT_END) and asked(noisy, "Sensitivity", "outside")
    with pytest.raises(InputError, match="clipped"):
        read(tmp_path, Recording(spoil=lambda s: clipped(s, 0.0)))


def test_a_tare_is_subtracted_with_a_question(tmp_path):
    measured = read(tmp_path, Recording(tare=12.0))
    assert asked(measured, "12 N before contact")
    value = true_figures(READ["triangular"].at())["sensitivity_kPa_per_N"]
    assert figures(measured)["sensitivity_kPa_per_N"].value == pytest.approx(value, rel=0.02)


@pytest.mark.parametrize("zeroed", [False, True])
@pytest.mark.parametrize("write", [None, by_hand])
def test_a_preload_is_no_driving_pressure(zeroed, write, tmp_path):
    """The plate rests where the force is 5 N; zeroed there, force alone would hide it."""
    legs = [(2.0, 4.45), *2 * [(5.0, DEEP), (5.0, 4.45), (2.0, 4.45)]]

    def at_rest(samples):
        samples = samples[:, samples[0] > 0.02]
        samples[2] -= samples[2][:400].mean() if zeroed else 0.0
        return samples

    preloaded = Recording([(1e-4, 4.45), *legs], write=write, spoil=at_rest)
    if zeroed and write is not None:
        assert asked(read(tmp_path, preloaded), "kPa before contact")
        return
    with pytest.raises(InputError, match="pressed"):
        read(tmp_path, preloaded)


def test_a_record_that_begins_in_contact_is_refused_or_asked_about(tmp_path):
    moving = Recording(presses(1), spoil=lambda s: s[:, 2500:6000])
    with pytest.raises(InputError, match="pressed"):
        read(tmp_path, moving)
    resting = [(0.1, 1.5), (2.0, 1.5), (6.0, DEEP), (6.0, 1.5), (2.0, 1.5)]
    (failure,) = read(tmp_path, Recording(resting, spoil=lambda s: s[:, 60:])).failures
    assert re.findall(r"([\d.]+) mm inside", failure.message) == ["1.5"]


def test_a_stated_kind_insists_and_is_questioned(tmp_path):
    measured = read(tmp_path, READ["triangular"], kind="steps")
    (run,) = measured.runs
    assert (run.kind, run.kind_by_record) == ("steps", False)
    assert asked(measured, "stated as a run of kind steps", "loop")


def test_the_kind_of_a_campaign_stands_in_its_file(tmp_path):
    (tmp_path / "run.csv").write_text(READ["triangular"].text())
    (tmp_path / "campaign.toml").write_text('[[runs]]\nfile = "run.csv"\nsensor = "A1"\n')
    with pytest.raises(InputError, match=r"\[\[runs\]\]") as refused:
        load_curves(tmp_path, kind="loop")
    assert refused.value.key == "kind"
    # A run without kind and resin is of the kind that it shows, and of the design's resin.
    measured = characterize(tmp_path, "paper-dome", model="atlas").figures
    assert [group.resin for group in measured.groups] == ["TangoPlus"]
    assert [entry.kind for entry in measured.runs] == ["loop"]


def test_one_recording_is_no_two_runs(tmp_path):
    text = READ["triangular"].text()
    rows = []
    for number in (1, 2):
        (tmp_path / f"{number}.csv").write_text(text)
        rows.append(f'[[runs]]\nfile = "{number}.csv"\nsensor = "A1"\nrun = {number}\n')
    (tmp_path / "campaign.toml").write_text("\n".join(rows))
    measured = characterize(tmp_path, "paper-dome", model="atlas").figures
    assert [run.file for run in measured.runs] == ["1.csv"]
    (failure,) = measured.failures
    assert failure.file == "2.csv" and "1.csv" in failure.message


def test_a_unit_that_is_wrong_is_refused_of_one_file_as_of_a_campaign(tmp_path):
    mbar = Recording(spoil=lambda s: s * np.array([[1], [1], [1], [10]]))
    assert "mbar" in read(tmp_path, mbar).failures[0].message
    reading = {"columns": {"pressure": {"name": "pressure_kPa", "unit": "mbar"}}}
    value = true_figures(mbar.at())["sensitivity_kPa_per_N"]
    assert figures(read(tmp_path, mbar, reading=reading))["sensitivity_kPa_per_N"].value == pytest.approx(
        value, rel=0.02
    )


@pytest.mark.parametrize("cell", ["", "nan"])
def test_an_empty_cell_is_refused_with_its_row_and_column_and_a_row_may_be_left_out(cell, tmp_path):
    """As told: without such rows, or with a mark before them, the figures are those of the truth."""
    rows = READ["triangular"].text().splitlines(keepends=True)
    emptied = range(500, 9000, 100)
    for at in emptied:
        rows[at] = rows[at].rpartition(",")[0] + f",{cell}\n"
    path = tmp_path / "run.csv"
    path.write_text("".join(rows))
    refuse(path, "row 501: column pressure_kPa", "delete those")
    value = true_figures(depths(25))["sensitivity_kPa_per_N"]
    for mark in ("# ", None):
        for at in emptied:
            rows[at] = "" if mark is None else mark + rows[at]
        path.write_text("".join(rows))
        measured = characterize(path, "paper-dome", model="atlas").figures
        assert not measured.questions
        assert figures(measured)["sensitivity_kPa_per_N"].value == pytest.approx(value, rel=0.02)


def test_a_leak_is_told_from_its_columns(tmp_path):
    path = tmp_path / "leak.csv"
    time = np.arange(0.0, 60.0, 0.01)
    pressure = 5.0 - 0.001 * time + np.random.default_rng(0).normal(0, 0.01, time.size)
    rows = np.column_stack([time, pressure])
    path.write_text("time_s,pressure_kPa\n" + "\n".join(f"{t:.4f},{p:.5f}" for t, p in rows) + "\n")
    loaded = load_curves(path, characterize_scene())
    ((run, rate, error),) = loaded.leaks
    assert run.kind == "leak" and abs(60e3 * rate - 0.06) < 4 * 60e3 * error + 0.01


def characterize_scene():
    from pneutouch.catalogue import Library, load_scene

    return load_scene("paper-dome", {}, Library.default())
