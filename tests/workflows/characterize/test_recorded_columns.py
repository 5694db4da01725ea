"""Columns of a recording that are exchanged, of another sign or in another unit: the option to type is named."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from pneutouch.errors import InputError
from pneutouch.workflows.characterize.campaign import characterize
from pneutouch.workflows.characterize.load import parse_columns
from tests.bench.recordings import READ, Recording, true_figures
from tests.workflows.characterize.test_recordings import asked, figures, read


def channels(*order, factors=(1.0, 1.0, 1.0, 1.0), ambient=0.0):
    """Spoils a recording: channels in another order, times a factor each, the pressure over vacuum."""
    return lambda s: (s + np.array([[0], [0], [0], [ambient]]))[list(order)] * np.array(factors)[:, None]


@pytest.mark.parametrize("name", ["triangular", "steps"])
@pytest.mark.parametrize(
    "spoil",
    [
        channels(0, 2, 1, 3),
        channels(0, 1, 3, 2),
        channels(0, 1, 2, 3, factors=(1, -1, 1, 1)),
        channels(0, 1, 2, 3, factors=(1, 1, -1, 1)),
        channels(0, 1, 2, 3, factors=(1, 1 / 25.4, 1, 1)),
        channels(0, 1, 2, 3, factors=(1, 1, 101.97, 1)),
        channels(0, 1, 2, 3, factors=(1, 1, 1, 10)),
        channels(0, 1, 2, 3, ambient=101.3),
    ],
)
def test_columns_named_in_a_refusal_give_the_figures_of_the_truth(name, spoil, tmp_path):
    """Position for force, force for pressure, signs, inches, grams-force, hectopascals, an absolute pressure."""
    recording = replace(READ[name], spoil=spoil)
    try:
        (failure,) = read(tmp_path, recording).failures
        message = failure.message
    except InputError as refused:
        message = str(refused)
    (text,) = re.findall(r"give `columns` (\S+?),? (?:or|of) ?", message)
    found = figures(read(tmp_path, recording, reading={"columns": parse_columns([text])}))
    keys = re.findall(r"columns\.\w+ = \{[^}]*\}", message)
    # Of an absolute pressure in a lone file the option alone is named.
    keys = keys or [f"columns.pressure = {{ name = 'pressure_kPa', unit = '{text.rpartition(':')[2]}' }}"]
    (tmp_path / "campaign.toml").write_text("\n".join([*keys, "[[runs]]", 'file = "run.csv"', 'sensor = "A1"']))
    pasted = figures(characterize(tmp_path, "paper-dome", model="atlas").figures)
    for key, value in true_figures(recording.at()).items():
        assert found[key].value == pytest.approx(value, rel=0.02), key
        assert pasted[key].value == found[key].value, key


def test_an_ambient_pressure_that_is_given_answers_the_question_on_it(tmp_path):
    recording = Recording(ambient=98.0)
    (tmp_path / "campaign.toml").write_text('[[runs]]\nfile = "run.csv"\nsensor = "A1"\n')
    reading = {"columns": parse_columns(["pressure=pressure_kPa:kPa_abs"])}
    open_question = read(tmp_path, recording, reading=reading).questions
    assert any("pneumatics.ambient_pressure_kPa`=101.325" in entry.question for entry in open_question)
    changes = {"pneumatics.ambient_pressure_kPa": 98.0}
    for data in (tmp_path / "run.csv", tmp_path):
        measured = characterize(data, "paper-dome", changes, model="atlas", reading=reading).figures
        assert not measured.questions
        assert figures(measured)["sensitivity_kPa_per_N"].value == pytest.approx(2.481, rel=0.02)


@pytest.mark.parametrize("name", ["triangular", "steps", "stairs with return"])
def test_milliseconds_under_a_heading_of_seconds_are_asked_about_with_the_unit(name, tmp_path):
    recording = replace(READ[name], spoil=channels(0, 1, 2, 3, factors=(1000, 1, 1, 1)))
    (question,) = asked(read(tmp_path, recording), "goes in at", "are the times in ms?")
    (text,) = re.findall(r"give `columns` (\S+?), or ", question)
    assert not asked(read(tmp_path, recording, reading={"columns": parse_columns([text])}), "goes in at")


@pytest.mark.parametrize("name", ["triangular", "steps"])
@pytest.mark.parametrize("compliance", [0.02, 0.05, 0.2, 0.4])
def test_a_rig_that_yields_is_asked_about_and_gives_the_truth_where_that_is_stated(name, compliance, tmp_path):
    """The travel holds that of the stage under the force; the sensitivity does not show it."""
    yields = replace(READ[name], spoil=lambda s: s + np.array([[0], [compliance], [0], [0]]) * s[2])
    (question,) = asked(read(tmp_path, yields), "rig.compliance_mm_per_N")
    told = float(re.findall(r"by ([\d.]+) mm/N", question)[0])
    assert told == pytest.approx(compliance, rel=0.1)
    (tmp_path / "campaign.toml").write_text(
        f'[rig]\ncompliance_mm_per_N = {told}\n[[runs]]\nfile = "run.csv"\nsensor = "A1"\n'
    )
    stated = characterize(tmp_path, "paper-dome", model="atlas").figures
    assert not stated.questions
    for key, value in true_figures(yields.at()).items():
        assert figures(stated)[key].value == pytest.approx(value, rel=0.02), key


def serial_days(samples, header):
    rows = (",".join([f"{46027.5 + row[0] / 86400:.9f}", *(f"{value:.5f}" for value in row[1:])]) for row in samples.T)
    return header + "\n" + "\n".join(rows) + "\n"


def test_serial_days_of_a_spreadsheet_are_read_in_the_unit_that_the_refusal_lists(tmp_path):
    sheet = Recording(header="timestamp,position_mm,force_N,pressure_kPa", write=serial_days)
    with pytest.raises(InputError, match=r"\bd\b"):
        read(tmp_path, sheet)
    found = figures(read(tmp_path, sheet, reading={"columns": parse_columns(["time=timestamp:d"])}))
    for key, value in true_figures(sheet.at()).items():
        assert found[key].value == pytest.approx(value, rel=0.02), key
    with pytest.raises(InputError, match="days"):
        read(tmp_path, sheet, reading={"columns": parse_columns(["time=timestamp:s"])})


@pytest.mark.parametrize("ambient", [98.0, 101.3])
def test_an_absolute_pressure_is_refused_with_the_unit_that_then_works(ambient, tmp_path):
    recording = Recording(ambient=ambient)
    with pytest.raises(InputError) as refused:
        read(tmp_path, recording)
    assert "pressure=pressure_kPa:kPa_abs" in refused.value.remedy
    reading = {"columns": {"pressure": {"name": "pressure_kPa", "unit": "kPa_abs"}}}
    found = figures(read(tmp_path, recording, reading=reading))
    value = true_figures(recording.at())["sensitivity_kPa_per_N"]
    assert found["sensitivity_kPa_per_N"].value == pytest.approx(value, rel=0.02)
