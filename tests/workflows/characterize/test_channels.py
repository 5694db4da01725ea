"""Channels of a recording that end, that repeat one another, or that are in another unit: a question or a refusal."""

from __future__ import annotations

import itertools
import re
from dataclasses import replace

import numpy as np
import pytest

from pneutouch.errors import InputError
from pneutouch.workflows.characterize.campaign import characterize
from tests.bench.recordings import READ, Recording, true_figures
from tests.workflows.characterize.test_recordings import AT_END, asked, figures, read

FORCE, PRESSURE = (2, "force", 20.0, 0.02), (3, "pressure", 45.0, 0.03)
NEAR_THE_TOP = (2, "force", 23.5, 0.02)


@pytest.mark.parametrize(
    ("name", "channel"),
    [
        *itertools.product(["triangular", "sine", "steps", "hold", "stairs with return"], [FORCE, PRESSURE]),
        *itertools.product(["triangular", "sine"], [NEAR_THE_TOP]),
    ],
)
def test_a_channel_at_its_end_is_a_question_whatever_the_noise_on_it(name, channel, tmp_path):
    row, key, end, noise = channel

    def clipped(samples):
        samples[row] = np.minimum(samples[row], end)
        samples[row] += noise * np.random.default_rng(3).normal(size=samples.shape[1])
        return samples

    measured = read(tmp_path, replace(READ[name], spoil=clipped))
    assert asked(measured, key, AT_END)


def test_a_stage_at_its_end_is_a_question(tmp_path):
    """The position stays while the force goes on to rise: neither a hold nor a relaxation."""

    def stopped(samples):
        samples[1] = np.minimum(samples[1], samples[1].min() + 0.6 * np.ptp(samples[1]))
        return samples

    assert asked(read(tmp_path, Recording(spoil=stopped)), "position", AT_END)


def test_a_force_of_coarse_steps_gives_figures(tmp_path):
    """A loading may pass from nothing to the fitted force within a block."""

    def coarse(samples):
        samples[2] = 0.5 * np.round(samples[2] / 0.5)
        return samples

    recording = replace(READ["stairs with return"], spoil=coarse)
    value = true_figures(READ["stairs with return"].at())["sensitivity_kPa_per_N"]
    assert figures(read(tmp_path, recording))["sensitivity_kPa_per_N"].value == pytest.approx(value, rel=0.03)


@pytest.mark.parametrize(("decimals", "noise"), [(2, 0.0), (3, 0.0), (5, 1e-3)])
def test_a_column_computed_from_another_is_refused_though_rounded(decimals, noise, tmp_path):
    def copied(samples):
        other = 2.5 * samples[2] + noise * np.random.default_rng(2).normal(size=samples.shape[1])
        samples[3] = np.round(other, decimals)
        return samples

    with pytest.raises(InputError, match=r"2\.5"):
        read(tmp_path, Recording(spoil=copied))


@pytest.mark.parametrize("unit", ["hPa", "MPa"])
def test_an_absolute_pressure_of_another_unit_is_refused_with_the_unit_that_then_works(unit, tmp_path):
    def absolute(samples):
        samples[3] = (samples[3] + 101.325) * {"hPa": 10.0, "MPa": 1e-3}[unit]
        return samples

    # Of hectopascals the heading says kilopascals; megapascals are stated.
    recording = Recording(spoil=absolute)
    stated = {} if unit == "hPa" else {"reading": {"columns": {"pressure": {"name": "pressure_kPa", "unit": unit}}}}
    with pytest.raises(InputError) as refused:
        read(tmp_path, recording, **stated)
    (named,) = re.findall(r"pressure=pressure_kPa:(\w+_abs)", refused.value.remedy)
    reading = {"columns": {"pressure": {"name": "pressure_kPa", "unit": named}}}
    value = true_figures(recording.at())["sensitivity_kPa_per_N"]
    found = figures(read(tmp_path, recording, reading=reading))
    assert found["sensitivity_kPa_per_N"].value == pytest.approx(value, rel=0.02)


def test_a_run_saved_again_with_fewer_decimals_is_asked_about(tmp_path):
    text = READ["triangular"].text().splitlines()
    rows = [[f"{float(cell):.4f}" for cell in line.split(",")] for line in text[1:]]
    (tmp_path / "1.csv").write_text("\n".join(text) + "\n")
    (tmp_path / "2.csv").write_text("\n".join([text[0], *map(",".join, rows)]) + "\n")
    runs = (f'[[runs]]\nfile = "{number}.csv"\nsensor = "A1"\nrun = {number}\n' for number in (1, 2))
    (tmp_path / "campaign.toml").write_text("\n".join(runs))
    measured = characterize(tmp_path, "paper-dome", model="atlas").figures
    assert [entry.file for entry in measured.questions if "1.csv" in entry.question] == ["2.csv"]
