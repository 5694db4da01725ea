"""A small simulated campaign, whole and damaged, from its files to figures beside the prediction."""

from __future__ import annotations

import json
import shutil
import tomllib

import pandas
import pytest

from pneutouch.errors import InputError
from pneutouch.spec.campaign import Campaign
from pneutouch.spec.options import SimulationOptions
from pneutouch.spec.read import parse_changes
from pneutouch.spec.toml_text import toml_text
from pneutouch.workflows.characterize import campaign as characterizing
from pneutouch.workflows.characterize.campaign import characterize
from pneutouch.workflows.simulate import simulate

ASKED = SimulationOptions(
    specimens=2,
    driving_pressures_kPa=[0.0, 22.0],
    runs=1,
    kinds=["steps", "injection", "leak"],
    model="atlas",
    rest_s=5.0,
)
FIRST = "runs/TangoPlus-1-0kPa-steps-1.csv"


@pytest.fixture(scope="module")
def made(tmp_path_factory, library):
    return simulate("paper-dome", tmp_path_factory.mktemp("made"), None, ASKED, library)


@pytest.fixture
def folder(made, tmp_path):
    return shutil.copytree(made, tmp_path / "campaign")


def run(folder, library, *assignments, **more):
    return characterize(folder, None, parse_changes(assignments), model="atlas", library=library, **more)


def rewritten(folder, change):
    """The campaign file with its content changed."""
    path = folder / "campaign.toml"
    content = tomllib.loads(path.read_text())
    change(content)
    path.write_text(toml_text(content))


def table(folder, name=FIRST):
    return pandas.read_csv(folder / name, comment="#")


def written(frame, folder, name=FIRST):
    frame.to_csv(folder / name, index=False)


def sensitivities(outcome):
    return {g.driving_pressure_kPa: g.figures["sensitivity_kPa_per_N"] for g in outcome.figures.groups}


@pytest.mark.slow
def test_a_sound_campaign_is_read_whole_and_near_its_prediction(folder, library):
    outcome = run(folder, library)
    assert not outcome.failed and not outcome.measured.questions
    for figure in sensitivities(outcome).values():
        assert abs(figure.predicted.measured_off_percent) < 8
        assert figure.low < figure.value < figure.high
    leaks = [row for row in outcome.measured.injections if row.figure.startswith("leak")]
    assert len(leaks) == 4 and all(abs(leak.value) < 0.2 for leak in leaks)


@pytest.mark.slow
def test_a_shallower_test_is_set_beside_the_prediction_over_its_own_range(folder, library):
    """S is a slope over a stated range: a sensor pressed half as deep has another."""
    whole = sensitivities(run(folder, library))[0.0]
    for name in (FIRST, FIRST.replace("-1-0", "-2-0")):
        frame = table(folder, name)
        # Eight of the fourteen indentations: the last begin after as many holds and rests.
        steps = 8 * (4.0 + 5.0) + sum(2 * (0.5 * k + 1.0) / 5.0 for k in range(1, 9))
        written(frame[frame["time_s"] <= steps], folder, name)
    half = sensitivities(run(folder, library))[0.0]
    assert half.value > 1.15 * whole.value
    assert abs(half.predicted.measured_off_percent) < 8


def test_what_changes_the_design_is_kept_in_the_campaign(tmp_path, library):
    made = simulate(
        "paper-dome",
        tmp_path,
        {"membrane.wall_thickness_mm": 2.2},
        ASKED.model_copy(update={"kinds": ["steps"], "specimens": 1, "driving_pressures_kPa": [22.0]}),
        library,
    )
    content = tomllib.loads((made / "campaign.toml").read_text())
    assert Campaign.model_validate(content).assignments == ["membrane.wall_thickness_mm=2.2"]
    for figure in sensitivities(run(made, library)).values():
        assert abs(figure.predicted.measured_off_percent) < 8


def test_one_file_that_fails_leaves_the_others(folder, library, command):
    frame = table(folder).astype({"force_N": object})
    frame.loc[100, "force_N"] = "oops"
    written(frame, folder)
    outcome = run(folder, library)
    ((file, message),) = outcome.measured.failures
    assert file == FIRST and "force_N" in message and "row 102" in message
    result = command("characterize", str(folder), "--model", "atlas", "--json", "--evidence", "none")
    assert result.returncode == 3 and FIRST in result.stderr and "Traceback" not in result.stderr
    assert json.loads(result.stdout)["failures"][0]["file"] == FIRST
    assert len(json.loads(result.stdout)["groups"]) == 2


def test_an_injection_in_absolute_pressure_fails_alone(folder, library):
    name = "runs/TangoPlus-1-0kPa-injection-1.csv"
    frame = table(folder, name)
    frame["pressure_kPa"] += 101.325
    written(frame, folder, name)
    outcome = run(folder, library)
    assert [file for file, _ in outcome.measured.failures] == [name] and len(outcome.measured.comparisons) == 2


@pytest.mark.parametrize(
    ("column", "change", "key"),
    [
        ("force_N", lambda values: values * 185, "columns.force = {"),
        pytest.param(
            "pressure_kPa", lambda values: values + 101.325, "driving_pressure_kPa = 0", marks=pytest.mark.slow
        ),
        pytest.param("pressure_kPa", lambda values: values + 22.0, "driving_pressure_kPa = 0", marks=pytest.mark.slow),
    ],
)
def test_a_run_that_contradicts_the_campaign_is_not_used(folder, library, command, column, change, key):
    frame = table(folder)
    frame[column] = change(frame[column])
    written(frame, folder)
    result = command("characterize", str(folder), "--model", "atlas", "--json", "--evidence", "none")
    assert result.returncode == 3
    document = json.loads(result.stdout)
    assert [one["file"] for one in document["failures"]] == [FIRST] and FIRST not in str(document["runs"])
    assert key in document["failures"][0]["message"]


def test_a_run_with_an_open_question_is_used_and_said_to_be(folder, library, command):
    frame = table(folder)
    frame["pressure_kPa"] += 1.5
    written(frame, folder)
    result = command("characterize", str(folder), "--model", "atlas", "--evidence", "none")
    assert result.returncode == 0
    assert "not zeroed? The run is used." in " ".join(result.stdout.split())


def test_a_leak_run_that_is_clipped_is_refused_and_one_at_another_pressure_asked_about(folder, library):
    clipped, other = (f"runs/TangoPlus-{k}-22kPa-leak-1.csv" for k in (1, 2))
    for name, pressure in ((clipped, 100.0), (other, 60.0)):
        frame = table(folder, name)
        frame["pressure_kPa"] += pressure - frame["pressure_kPa"].mean()
        frame["pressure_kPa"] = frame["pressure_kPa"].clip(upper=100.0)
        written(frame, folder, name)
    measured = run(folder, library).measured
    assert "clipped" in dict(measured.failures)[clipped] and other not in dict(measured.failures)
    assert "driving_pressure_kPa = 22" in dict(measured.questions)[other]


def test_a_wrong_sign_is_seen_where_nothing_is_predicted(folder, library):
    """Beyond the limit point there is no prediction, but a force still rises as the sensor is pressed."""

    def change(content):
        content["columns"] = {"pressure": {"name": "pressure_kPa", "unit": "kPa", "sign": -1}}
        for entry in content["runs"]:
            if entry["driving_pressure_kPa"] == 22.0:
                entry["driving_pressure_kPa"] = 60.0

    rewritten(folder, change)
    outcome = run(folder, library)
    assert not outcome.measured.comparisons
    failures = dict(outcome.measured.failures)
    for k in (1, 2):
        assert "` pressure=pressure_kPa:kPa, or" in failures[f"runs/TangoPlus-{k}-22kPa-steps-1.csv"]


def test_the_ambient_pressure_of_the_flag_is_the_injections_too(folder, library):
    low, high = (
        [
            row.value
            for row in run(folder, library, f"pneumatics.ambient_pressure_kPa={p}").measured.injections
            if "gas" in row.figure
        ]
        for p in (80.0, 101.325)
    )
    assert low == pytest.approx([value * 80.0 / 101.325 for value in high], rel=1e-6)


def test_a_single_file_of_any_name_is_a_run_of_its_design(folder, library):
    long = folder / f"{'a-very-long-name-' * 6}.csv"
    shutil.copy(folder / FIRST.replace("-0kPa", "-22kPa"), long)
    outcome = characterize(long, "paper-dome", model="atlas", library=library)
    (group,) = outcome.figures.groups
    assert group.driving_pressure_kPa == 22.0 and group.figures["sensitivity_kPa_per_N"].low is None
    with pytest.raises(InputError, match="give `design`"):
        characterize(long, library=library)


@pytest.mark.parametrize("rows", [1.0, 0.9])
def test_a_copied_run_is_asked_about_though_its_bytes_differ(rows, folder, library):
    copy, other = table(folder), FIRST.replace("-1-0kPa", "-2-0kPa")
    copy.loc[3, "force_N"] += 0.01
    written(copy[: int(rows * len(copy))], folder, other)
    questions = run(folder, library).measured.questions
    assert [file for file, asked in questions if FIRST in asked] == [other]


def test_aged_runs_are_not_set_beside_a_fresh_prediction(folder, library):
    rewritten(
        folder, lambda content: [entry.update(age_days=365.0) for entry in content["runs"] if "-2-" in entry["file"]]
    )
    outcome = run(folder, library)
    assert {b.group.key.age: bool(b.predicted) for b in outcome.measured.comparisons} == {
        "fresh": True,
        "12 months": False,
    }
    published = {row.published_change_one_year_percent for row in outcome.measured.ageing}
    assert published == {14.76}


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda c: [entry.update(resin="TangPlus") for entry in c["runs"]], "Did you mean TangoPlus"),
        (lambda c: c.update(columns={"force": {"name": "force_N", "unit": "lb"}}), "must be one of N"),
        (lambda c: c["runs"][1].update(file=c["runs"][0]["file"]), "is that of runs"),
        (
            lambda c: c["runs"][1].update(sensor="TangoPlus-1", kind="steps", driving_pressure_kPa=0.0),
            "number repetitions",
        ),
        (lambda c: c.pop("runs"), "runs: missing"),
        (lambda c: c.pop("design"), "give `design`"),
        (
            lambda c: c.update(design="paperdome"),
            r'campaign\.toml: design = "paperdome": no such design.* paper-dome\?',
        ),
        (lambda c: c["runs"][2].update(kind2="steps"), r"campaign\.toml: runs\[2\]\.kind2: unknown key"),
        (lambda c: c["runs"][2].update(kind="step"), r'campaign\.toml: runs\[2\]\.kind = "step": must be "steps"'),
        (lambda c: c["runs"][1].update(run="x"), r'campaign\.toml: runs\[1\]\.run = "x": must be a whole number'),
        (lambda c: c["runs"][1].pop("sensor"), r"campaign\.toml: runs\[1\]\.sensor: missing"),
        (lambda c: c["runs"][0].update(volumes_mL=[0.0, 1.0, 2.0]), r"campaign\.toml: runs\[0\]: volumes_mL: given"),
    ],
)
def test_a_wrong_campaign_file_says_what_is_wrong(folder, library, change, said):
    rewritten(folder, change)
    with pytest.raises(InputError, match=said):
        run(folder, library)


@pytest.mark.parametrize(("offset", "model"), [(0.0, "solid"), (3.0, "harmonic")])
def test_without_a_model_the_prediction_off_the_axis_is_the_harmonic_ones(offset, model, folder, library, monkeypatch):
    given = []
    answers = characterizing.answers

    def answered(name, changes, pairs, model, library):
        given.append((changes["contact.offset_mm"], model))
        return answers(name, {}, pairs, "atlas", library)

    monkeypatch.setattr(characterizing, "answers", answered)
    rewritten(folder, lambda content: content.update(assignments=[f"contact.offset_mm={offset:g}"]))
    outcome = characterize(folder, library=library)
    assert given == [(offset, model)] and outcome.measured.model == model


def test_the_volume_of_an_injection_stands_beside_the_one_that_a_dome_that_swells_shows(folder, library):
    """As if rigid the dome has more than its dead volume and its cavity: what is measured of it, predicted alike."""
    pushed = [row for row in run(folder, library).figures.injections if row.unit == "mL"]
    assert pushed and all(row.predicted == pytest.approx(row.value, rel=0.05) for row in pushed)
    cavity_mL = 2 / 3 * 3.1416 * 9.25**3 / 1000
    assert all(row.predicted > 1.2 * cavity_mL for row in pushed)
