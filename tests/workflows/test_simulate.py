"""A simulated campaign: reads like a measured one, says that it is none, and repeats to the byte."""

from __future__ import annotations

import hashlib
import json
import tomllib
from dataclasses import replace

import numpy as np
import pandas
import pytest

from pneutouch.bench.indents import protocol
from pneutouch.bench.simulate.curve import press_curves
from pneutouch.bench.simulate.runs import SimulationTruth
from pneutouch.errors import InputError
from pneutouch.spec.campaign import Campaign, campaign_of, design_of
from pneutouch.spec.options import PlanOptions, SimulationOptions, options_of
from pneutouch.spec.read import validate
from pneutouch.spec.toml_text import toml_text
from pneutouch.workflows import simulate as simulation
from pneutouch.workflows.characterize.campaign import characterize
from pneutouch.workflows.plan import make_plan, write_plan
from pneutouch.workflows.simulate import simulate
from pneutouch.workflows.simulate_inputs import KINDS
from tests.refusals import refused

R0 = 9.25
ASKED = SimulationOptions(
    specimens=2,
    driving_pressures_kPa=[0.0, 22.0],
    runs=2,
    kinds=["steps", "loop", "leak", "injection"],
    rate_Hz=50.0,
    rest_s=2.0,
    model="atlas",
)
TRUTH, FEW = SimulationTruth(specimens=400), SimulationTruth(specimens=100)


def changed(options, **changes):
    return options_of(SimulationOptions, {**options.model_dump(), **changes})


@pytest.fixture(scope="module")
def folder(library, tmp_path_factory):
    return simulate("paper-dome", tmp_path_factory.mktemp("one"), None, ASKED, library, truth=TRUTH)


@pytest.fixture(scope="module")
def truth(folder):
    return json.loads((folder / "truth.json").read_text())


def test_campaign_names_every_file_and_says_that_it_is_simulated(folder):
    campaign = validate(Campaign, tomllib.loads((folder / "campaign.toml").read_text()), "campaign.toml")
    assert campaign.simulated and "simulated" in campaign.title.lower() and campaign.design == "paper-dome"
    assert {run.file for run in campaign.runs} == {f"runs/{path.name}" for path in (folder / "runs").iterdir()}
    # Steps twice, loop and leak once at each of two pressures, one injection; two specimens.
    assert len(campaign.runs) == 2 * (2 * (2 + 1 + 1) + 1)
    for run in campaign.runs:
        first, head = (folder / run.file).read_text().split("\n", 2)[:2]
        assert first == "# simulated by pneutouch"
        plated = "time_s,position_mm,force_N,pressure_kPa"
        assert head == {"leak": "time_s,pressure_kPa", "injection": "volume_mL,pressure_kPa"}.get(run.kind, plated)


def test_manifest_has_the_digest_of_every_file(folder):
    files = json.loads((folder / "manifest.json").read_text())["files"]
    there = {p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file()} - {"manifest.json"}
    assert set(files) == there
    assert all(hashlib.sha256((folder / n).read_bytes()).hexdigest() == e["sha256"] for n, e in files.items())


@pytest.mark.slow
def test_same_seed_gives_the_same_bytes_and_another_other_noise(folder, library, tmp_path):
    again = simulate("paper-dome", tmp_path / "same", None, ASKED, library, truth=TRUTH)
    for path in (p for p in folder.rglob("*") if p.is_file()):
        assert path.read_bytes() == (again / path.relative_to(folder)).read_bytes(), path.name
    small = changed(ASKED, specimens=1, runs=1, kinds=["steps"])
    name = "runs/TangoPlus-1-0kPa-steps-1.csv"
    # A run does not depend on what else is simulated.
    assert (simulate("paper-dome", tmp_path / "small", None, small, library) / name).read_bytes() == (
        folder / name
    ).read_bytes()
    other = changed(small, seed=1)
    assert (simulate("paper-dome", tmp_path / "other", None, other, library) / name).read_bytes() != (
        folder / name
    ).read_bytes()


def test_files_hold_what_the_truth_says(folder, truth):
    """Holds read by the clock give each specimen's sensitivity to the scatter of the runs' gain and the noise."""
    test = protocol("steps", R0).quicker(2.0)
    knots, _ = test.knots()
    for name, one in truth["specimens"].items():
        for pressure, figures in one["pressures"].items():
            table = pandas.read_csv(folder / f"runs/{name}-{pressure}kPa-steps-1.csv", comment="#")
            force, rise = [0.0], [0.0]
            for k in range(len(test.depths)):

                def between(column: str, a: float, b: float, t: pandas.DataFrame = table) -> float:
                    return float(t[column][(t.time_s > a) & (t.time_s < b)].mean())

                rest, held = (
                    (knots[4 * k] + 1.5, knots[4 * k + 1] - 0.05),
                    (knots[4 * k + 2] + 2, knots[4 * k + 3] - 0.05),
                )
                force.append(between("force_N", *held) - between("force_N", *rest))
                rise.append(between("pressure_kPa", *held) - between("pressure_kPa", *rest))
            slope = np.polyfit(force, rise, 1)[0]
            assert slope == pytest.approx(figures["sensitivity_kPa_per_N"], rel=4 * 0.002)
            assert force[-1] == pytest.approx(figures["force_range_N"], rel=0.005)


def test_truth_of_populations_covers_its_specimens(truth):
    for row in truth["populations"]:
        figures = row["figures"]
        assert figures["part_to_part_kPa_per_N"] == pytest.approx(row["spread"]["sensitivity_kPa_per_N"])
        assert figures["repeatability_kPa_per_N"] == pytest.approx(0.002 * figures["sensitivity_kPa_per_N"])
        mine = [s["pressures"][f"{row['driving_pressure_kPa']:g}"] for s in truth["specimens"].values()]
        for one in mine:
            away = one["sensitivity_kPa_per_N"] - figures["sensitivity_kPa_per_N"]
            assert abs(away) < 4 * row["spread"]["sensitivity_kPa_per_N"]
    wall = truth["parameters"]["TangoPlus"]["scatter"]["wall"]
    assert wall["value"] == 0.1 and wall["unit"] == "mm"


def test_age_stiffens_the_same_specimen_as_its_hardness_says(library, tmp_path):
    asked = changed(ASKED, specimens=1, driving_pressures_kPa=[0.0], kinds=["loop"], ages_days=[0.0, 365.0])
    found = json.loads((simulate("paper-dome", tmp_path, None, asked, library) / "truth.json").read_text())
    new, old = (found["specimens"][f"TangoPlus-1-{age}d"] for age in (0, 365))
    ageing = found["parameters"]["TangoPlus"]["scatter"]["ageing"]["value"]
    # Shore A 27.6 to 29.5 (paper, Table 1).
    assert old["shear_modulus_MPa"] / new["shear_modulus_MPa"] == pytest.approx(np.exp(ageing)) and 0.07 < ageing < 0.09
    assert old["wall_thickness_mm"] == new["wall_thickness_mm"]


def test_parquet_holds_the_same_numbers_and_the_label(folder, library, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    there = simulate("paper-dome", tmp_path, None, changed(ASKED, specimens=1, parquet=True, kinds=["loop"]), library)
    table = parquet.read_table(there / "runs/TangoPlus-1-22kPa-loop-1.parquet")
    csv = pandas.read_csv(folder / "runs/TangoPlus-1-22kPa-loop-1.csv", comment="#")
    assert table.schema.metadata[b"comment"] == b"simulated by pneutouch"
    assert np.array_equal(table.to_pandas().to_numpy(), csv.to_numpy())


def test_a_press_ends_where_the_rig_stops_and_is_read_to_there(library, tmp_path):
    """This resin takes twice the range of the rig's force sensor at the protocol's depth."""
    asked = changed(
        ASKED, kinds=["steps", "loop"], driving_pressures_kPa=[0.0], specimens=1, runs=1, resins=["FLX9970"]
    )
    folder = simulate("paper-dome", tmp_path, None, asked, library, truth=FEW)
    truth = json.loads((folder / "truth.json").read_text())
    (specimen,) = truth["specimens"].values()
    (known,) = specimen["pressures"].values()
    assert "rig" in known["range_ends_by"] and len(truth["notes"]) == 2
    measured = characterize(folder, "paper-dome", model="atlas").figures
    assert not measured.failures and not measured.questions
    for key in ("sensitivity_kPa_per_N", "stiffness_N_per_mm", "force_range_N"):
        assert measured.groups[0].figures[key].value == pytest.approx(known[key], rel=0.02), key
    assert known["force_range_N"] < 36.0 < 40.0


@pytest.mark.slow
def test_what_stops_short_is_said(library, tmp_path):
    asked = changed(
        ASKED,
        specimens=1,
        driving_pressures_kPa=[0.0],
        runs=1,
        kinds=["steps", "relaxation"],
        model="auto",
        rate_Hz=20.0,
    )
    found = json.loads((simulate("long-tube", tmp_path, None, asked, library) / "truth.json").read_text())
    assert len(found["notes"]) == 2 and all("stops at 6." in note and "buckling" in note for note in found["notes"])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"kinds": ["stps"]}, 'kinds[0] = "stps": must be "steps"'),
        ({"driving_pressures_kPa": [22.0, 22.0]}, "driving_pressures_kPa[1] = 22.0: every entry may appear once"),
        ({"driving_pressures_kPa": [45.0]}, "beyond the limit point"),
        ({"rate_Hz": 1.0}, "rate_Hz = 1.0: must be from 10"),
        ({"specimens": 0}, "specimens = 0: must be from 1"),
        ({"resins": ["TangoPlus", "TangoPlus"]}, "resins[1]"),
        ({"rest_s": -1.0}, "rest_s = -1"),
        ({"kinds": [*KINDS], "model": "atlas"}, 'model = "atlas"'),
    ],
)
def test_what_cannot_be_is_refused_and_leaves_nothing(change, words, library, tmp_path):
    with pytest.raises(InputError) as error:
        simulate("paper-dome", tmp_path / "out", None, changed(ASKED, **change), library)
    assert words in str(error.value)
    assert not (tmp_path / "out").exists() or not list((tmp_path / "out").iterdir())


@pytest.fixture(scope="module")
def planned(tmp_path_factory):
    """A plan of two specimens; its last one got a name of its own by hand."""
    folder, keys = tmp_path_factory.mktemp("planned"), [("leak", 12.0, 1), ("injection", 0.0, 1), ("loop", 12.0, 1)]
    keys += [("steps", pressure_kPa, number) for pressure_kPa in (0.0, 12.0) for number in (1, 2)]
    runs = [
        {"kind": kind, "driving_pressure_kPa": at, "run": n, "sensor": sensor, "file": f"{k}-{sensor[:3]}"}
        for sensor in ("TangoPlus-1", "tip 2/b")
        for k, (kind, at, n) in enumerate(keys)
    ]
    content = {"design": "paper-dome", "runs": [{"resin": "TangoPlus", **run} for run in runs]}
    (folder / "campaign.toml").write_text(toml_text(content))
    return folder


def test_a_design_that_is_not_there_names_the_plan(planned, tmp_path):
    text = (planned / "campaign.toml").read_text().replace('"paper-dome"', '"paperdome"')
    (tmp_path / "campaign.toml").write_text(text)
    with pytest.raises(InputError, match=r'campaign\.toml: design = "paperdome": no such design'):
        simulate(str(tmp_path), tmp_path / "out", None, QUICK)


QUICK = SimulationOptions(rate_Hz=20.0, rest_s=0.2, model="atlas")


@pytest.mark.slow
def test_without_a_model_a_sensor_off_the_axis_is_pressed_by_the_harmonic_one(tmp_path, monkeypatch):
    models = []

    def answered(who, sensor, driving, depth, model):
        models.append((sensor.protocol.offset, model))
        return press_curves(sensor.replace(offset=0.0), driving, depth, "atlas")

    monkeypatch.setattr(simulation, "pressed", answered)
    options = changed(QUICK, model=None, specimens=1, runs=1, kinds=["steps"])
    for offset, model in ((0.0, "solid"), (3.0, "harmonic")):
        folder = simulate("paper-dome", tmp_path, {"contact.offset_mm": offset}, options)
        assert models and {*models} == {(offset, model)}
        models.clear()
        assert json.loads((folder / "truth.json").read_text())["model"] == model


@pytest.mark.slow
def test_a_plan_is_simulated_run_by_run(planned, library, tmp_path):
    made = simulate(str(planned), tmp_path, None, QUICK, library, truth=FEW)
    there, here = (campaign_of(path)[0] for path in (planned, made))
    assert len(here.runs) == 14 == len(list((made / "runs").iterdir()))
    keys = [[(r.kind, r.sensor, r.driving_pressure_kPa, r.run) for r in one.runs] for one in (there, here)]
    assert keys[0] == keys[1] and here.simulated
    # The first specimen is that of a simulation without the plan, and so is its run.
    alone = simulate("paper-dome", tmp_path / "alone", None, changed(QUICK, kinds=["loop"], specimens=1), library)
    name = "runs/TangoPlus-1-12kPa-loop-1.csv"
    assert (made / name).read_bytes() == (alone / name).read_bytes()
    assert (made / "runs/tip 2-b-0kPa-injection-1.csv").is_file()
    assert set(json.loads((made / "truth.json").read_text())["specimens"]) == {"TangoPlus-1", "tip 2/b"}


@pytest.mark.slow
def test_the_air_that_a_plan_states_is_pushed(library, tmp_path):
    """As many rows as the plan has pushes, at its volumes, with the pressures that its sheet foretells."""
    plan = make_plan("paper-dome", None, PlanOptions(specimens=1), library=library)
    expected = plan.record.resins[0].injection.sensor
    (run,) = [run for run in plan.campaign.runs if run.kind == "injection"]
    assert run.volumes_mL == pytest.approx([row.volume_mL for row in expected])
    alone = plan.campaign.model_copy(update={"runs": [run]})
    made = simulate(str(write_plan(replace(plan, campaign=alone), tmp_path)), tmp_path, None, QUICK, library, truth=FEW)
    (written,) = campaign_of(made)[0].runs
    rows = np.loadtxt(made / written.file, delimiter=",", skiprows=2)
    assert written.volumes_mL == run.volumes_mL
    assert rows[:, 0] == pytest.approx(run.volumes_mL)
    # The specimen differs from the design by its scatter.
    assert rows[:, 1] == pytest.approx([row.pressure_kPa for row in expected], rel=0.25)


def test_volumes_are_stated_of_an_injection_alone(planned, library, tmp_path):
    content = (planned / "campaign.toml").read_text()
    folder = tmp_path / "spoilt"
    folder.mkdir()
    (folder / "campaign.toml").write_text(content.replace('kind = "leak"', 'kind = "leak"\nvolumes_mL = [1, 2, 3]', 1))
    with refused("runs[0]"):
        simulate(str(folder), tmp_path / "out", None, QUICK, library, truth=FEW)


def test_what_a_plan_states_is_not_requested_again(planned, library, tmp_path):
    with pytest.raises(InputError, match=r"the plan in .* states it") as caught:
        simulate(str(planned), tmp_path, None, changed(QUICK, runs=2), library)
    assert caught.value.key == "runs"
    content = (planned / "campaign.toml").read_text()
    for spoilt, said in (
        (content.replace("tip 2/b", "TangoPlus/1"), "those of sensor TangoPlus-1"),
        (content.replace('design = "paper-dome"\n', ""), "names no design"),
    ):
        folder = tmp_path / "spoilt"
        folder.mkdir(exist_ok=True)
        (folder / "campaign.toml").write_text(spoilt)
        with pytest.raises(InputError, match=said):
            simulate(str(folder), tmp_path / "out", None, QUICK, library, truth=FEW)
    assert not (tmp_path / "out").exists() or not list((tmp_path / "out").iterdir())


def test_a_campaign_of_a_copied_design_finds_it_in_its_own_folder(tmp_path):
    """With its calibration, and from any working folder."""
    run = {"file": "a.csv", "sensor": "A", "resin": "TangoPlus"}
    for named, found in (
        ("dome.toml", f"{tmp_path}/dome.toml"),
        ("dome.toml@mine", f"{tmp_path}/dome.toml@mine"),
        ("paper-dome@mine", "paper-dome@mine"),
    ):
        (tmp_path / "campaign.toml").write_text(toml_text({"design": named, "runs": [run]}))
        assert design_of(*campaign_of(tmp_path)) == found
    (tmp_path / "campaign.toml").write_text(toml_text({"design": "../dome.toml@mine", "runs": [run]}))
    with refused("design", "../dome.toml"):
        design_of(*campaign_of(tmp_path))
