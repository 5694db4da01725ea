"""The test plan: its times, its expectations, its warnings, and a campaign file that can be read."""

from __future__ import annotations

import json
import tomllib
from dataclasses import replace

import numpy as np
import pytest

from pneutouch.bench.indents import protocol
from pneutouch.bench.simulate.curve import PressCurve
from pneutouch.errors import InputError
from pneutouch.evaluation.resins import pressed, resins_of
from pneutouch.spec.campaign import Campaign, Rig
from pneutouch.spec.options import PlanOptions
from pneutouch.spec.read import validate
from pneutouch.units import KPA, ML
from pneutouch.workflows.plan import make_plan, plated_tests, rig_of, steps_of, write_plan
from pneutouch.workflows.plan_expected import curve_warnings, injection, leak_limit, points, travel_warnings
from tests.refusals import refused

R0 = 9.25
PLATED = ("steps", "saturation", "loop", "relaxation")


@pytest.fixture(scope="module")
def subject(library):
    return resins_of("long-tube", None, (), library=library)[0]


@pytest.fixture(scope="module")
def rating(subject):
    return subject.rating


@pytest.fixture(scope="module")
def plan(library):
    return make_plan("long-tube", None, PlanOptions(specimens=2), library=library)


@pytest.fixture(scope="module")
def found(subject):
    return pressed(subject.name, subject.sensor, [0.0, 22 * KPA], 0.9 * R0, "solid")


@pytest.mark.slow
def test_runs_last_as_long_as_their_protocols_and_the_plan_as_its_runs(plan):
    runs = plan.record.runs
    for run in runs:
        assert run.duration_s == pytest.approx(sum(step.seconds for step in run.steps))
        if run.kind in PLATED:
            assert run.duration_s == pytest.approx(protocol(run.kind, R0).duration, rel=1e-12), run.file
    assert plan.record.total_s == pytest.approx(sum(run.duration_s for run in runs))
    assert [run.number for run in runs] == list(range(1, len(runs) + 1))


def test_plan_holds_the_papers_tests(plan):
    """Sections 3-B and 3-C and Supplement D: three runs at each pressure, saturation at 0 and 12, relaxation 600 s."""
    mine = [run for run in plan.record.runs if run.sensor == "TangoPlus-1"]

    def at(kind: str) -> list[tuple[float, int]]:
        return [(run.driving_pressure_kPa, run.run) for run in mine if run.kind == kind]

    assert at("steps") == [(p, n) for p in (0, 5, 12, 22) for n in (1, 2, 3)]
    assert at("saturation") == [(p, n) for p in (0, 12) for n in (1, 2, 3)]
    assert at("relaxation") == [(0, 1), (22, 1)] and at("leak") == [(22, 1)] and at("injection") == [(0, 1)]
    assert mine[0].kind == "leak" and mine[-1].kind == "relaxation"
    assert plan.record.tests["relaxation"].hold_s == 600 and plan.record.tests["saturation"].rest_s == 2


def test_steps_follow_the_plate(plan):
    """The moves of a run lead to the protocol's depths, each from the clearance and back, after a rest with reset."""
    test = protocol("steps", R0)
    steps = steps_of(test, 12.0, Rig())
    assert [s.value for s in steps if s.action == "move"] == [v for d in test.depths for v in (d, -1.0)]
    assert sum(s.action == "vent" for s in steps) == len(test.depths)
    assert {s.value for s in steps if s.action == "set_pressure"} == {12.0}
    loop = steps_of(protocol("loop", R0), 12.0, Rig())
    assert sum(s.action == "set_pressure" for s in loop) == 1 and not any(s.action in ("vent", "hold") for s in loop)
    times = np.cumsum([0.0] + [s.seconds for s in steps])
    travels = [-1.0]
    for step in steps:
        travels.append(step.value if step.action in ("move", "hold") else travels[-1])
    knots, way = test.knots()
    assert np.interp(knots + 1e-9, times, travels)[1:-1] == pytest.approx(way[1:-1], abs=1e-6)


def test_expected_values_are_the_prediction_and_end_with_it(found):
    curve = found.curves[0]
    said = points(curve, (*curve.indentation[1:-1], curve.reach + 0.2))
    assert [p.force_N for p in said[:-1]] == pytest.approx(curve.force[1:-1], rel=1e-12)
    assert [p.cavity_pressure_kPa for p in said[:-1]] == pytest.approx(curve.rise[1:-1] / KPA, rel=1e-12)
    assert said[-1].force_N is None and said[-1].cavity_pressure_kPa is None


def test_warnings_appear_exactly_where_a_range_is_passed(found, rating):
    """A range a little above the greatest expected value is silent, one a little below is not; by depth."""
    # At 22 kPa the whole travel is known; no other rule speaks of it where the sensor may be driven so far.
    rating = replace(rating, pressure=23 * KPA)
    curve, tests = found.curves[1], {"saturation": protocol("saturation", R0)}
    said = points(curve, tests["saturation"].depths)
    force, pressure = said[-1].force_N, said[-1].cavity_pressure_kPa
    first = said[0].force_N

    def rules(**rig: float) -> list[str]:
        return [w.rule for w in curve_warnings("x", rating, curve, tests, Rig(**rig))]

    assert rules() == []
    assert rules(force_range_N=force * 1.0001) == [] and rules(force_range_N=force * 0.9999) == ["force range"]
    assert rules(pressure_range_kPa=pressure * 1.0001) == []
    assert rules(pressure_range_kPa=pressure * 0.9999) == ["pressure range"]
    assert rules(force_resolution_N=first / 3 * 0.9999) == []
    assert rules(force_resolution_N=first / 3 * 1.0001) == ["force resolution"]
    middle = curve_warnings("x", rating, curve, tests, Rig(force_range_N=said[9].force_N * 0.999))[0]
    assert middle.depth_mm == said[9].depth_mm and f"stop at {said[8].depth_mm:g} mm" in middle.message


def test_every_warning_names_what_ends_it(found, rating):
    """The rig's file, another driving pressure, or the depth at which to stop."""
    steps, rig = (
        {"steps": protocol("steps", R0)},
        Rig(force_range_N=1.0, pressure_range_kPa=2.0, force_resolution_N=1.0),
    )
    warned = [w for curve in found.curves for w in curve_warnings("x", rating, curve, steps, rig)]
    warned += travel_warnings((999.0,), rig)
    assert len({w.rule for w in warned}) == 6
    for one in warned:
        assert any(word in one.message for word in ("`rig`", "`pneumatics.driving_pressures_kPa`=", "stop there")), one


def test_warning_of_the_range_end_names_where_and_why(found, rating):
    curve, steps = found.curves[0], protocol("steps", R0)
    warned = curve_warnings("x", rating, curve, {"steps": steps}, Rig())
    assert [w.rule for w in warned] == ["range end"] and "inward buckling" in warned[0].message
    assert warned[0].depth_mm == min(d for d in steps.depths if d > curve.reach)
    shallow = replace(steps, depths=tuple(d for d in steps.depths if d <= curve.reach))
    assert curve_warnings("x", rating, curve, {"steps": shallow}, Rig()) == []


def test_warning_of_the_rated_pressure_is_at_nine_tenths_of_the_lower_end_of_the_limit(found, rating):
    rated = 0.9 * rating.limit.low
    assert rated < 0.6 * found.limits.lowest
    for driving, expected in ((rated * 0.9999, []), (rated * 1.0001, ["rated pressure"])):
        curve = PressCurve(driving, *(np.linspace(0, top, 5) for top in (9.0, 20.0, 10 * KPA)))
        assert [w.rule for w in curve_warnings("x", rating, curve, {"steps": protocol("steps", R0)}, Rig())] == expected


@pytest.mark.parametrize(("driving_kPa", "raised"), [(30.0, True), (35.0, False), (45.0, False)])
def test_a_measured_modulus_is_advised_only_where_it_lets_the_pressure_be_driven(rating, driving_kPa, raised):
    assert 30 * KPA < rating.measured < 35 * KPA
    curve = PressCurve(driving_kPa * KPA, *(np.linspace(0, top, 5) for top in (9.0, 20.0, 10 * KPA)))
    (warning,) = curve_warnings("x", rating, curve, {"steps": protocol("steps", R0)}, Rig())
    assert warning.rule == "rated pressure" and ("coupons" in warning.message) == raised


def test_warning_of_the_travel_counts_the_clearance():
    assert travel_warnings((0.5, 7.0), Rig(travel_mm=8.0)) == []
    assert [w.rule for w in travel_warnings((0.5, 7.0), Rig(travel_mm=7.99))] == ["travel"]


def test_dead_volume_follows_from_the_pressure_expected_of_the_line(found, rating, subject):
    said = injection(found, rating, Rig())
    dead = 101.325 * said.line_volume_mL / said.line_pressure_kPa
    assert dead == pytest.approx(subject.sensor.gas.dead_volume / ML, rel=1e-9)
    assert said.line_pressure_kPa <= 80 < 2.5 * said.line_pressure_kPa
    for row in said.sensor:
        assert row.with_more_dead_volume_kPa < row.pressure_kPa < row.without_dead_volume_kPa
    assert said.sensor[-1].volume_mL == pytest.approx(said.sensor_volume_mL)


def test_leak_limit_takes_a_hundredth_of_the_first_rise():
    test = protocol("steps", R0)
    seconds = 4 + 2 * 1.5 / 5
    assert leak_limit(0.5, test) / 60 * seconds == pytest.approx(0.005)


def test_campaign_file_reads_back_as_it_was_planned(plan, tmp_path):
    folder = write_plan(plan, tmp_path)
    text = (folder / "campaign.toml").read_text()
    read = validate(Campaign, tomllib.loads(text), "campaign.toml")
    assert read == plan.campaign and not read.simulated
    document = json.loads((folder / "plan.json").read_text())
    assert [run.file for run in read.runs] == [run["file"] for run in document["runs"]]
    again = write_plan(plan, tmp_path / "again")
    for name in ("plan.json", "plan.md", "campaign.toml", "manifest.json"):
        assert (folder / name).read_bytes() == (again / name).read_bytes()


def test_sheet_shows_every_run_warning_and_expected_value(plan):
    sheet = plan.sheet
    for run in plan.record.runs:
        assert sheet.count(f"`{run.file.removeprefix('runs/')}`") == 1
    for warning in plan.record.warnings:
        assert warning.message in sheet
    state = plan.record.resins[0].states[0]
    known = [p for p in state.points if p.force_N is not None]
    assert all(f"| {p.force_N:.2f} | {p.pressure_rise_kPa:.2f} |" in sheet for p in known)
    assert len(known) < len(state.points) and "| – | – |" in sheet
    # Every row of a table has as many cells as its head.
    for block in sheet.split("\n\n"):
        rows = [line for line in block.splitlines() if line.startswith("|")]
        assert len({row.count("|") for row in rows}) <= 1, rows[:2]


def test_soft_sensor_is_saturated_at_no_more_than_its_driving_pressures(library):
    soft = resins_of("long-tube", {"pneumatics.driving_pressures_kPa": [0, 4]}, (), library=library)[0]
    tests = plated_tests(soft, 20.0)
    assert tests["saturation"][1] == (0.0, 4.0) and tests["relaxation"][1] == (0.0, 4.0)


@pytest.mark.slow
def test_what_the_plan_chooses_stays_below_the_rating_and_the_design_s_own_pressures_are_kept(subject, library):
    """A wall half as thick halves the rating, to below the 12 kPa of the paper's saturation test."""
    tests = plated_tests(subject, subject.rating.pressure_kPa)
    assert subject.rating.pressure_kPa == 19.7 and tests["saturation"][1] == (0.0, 12.0)
    changes = {"membrane.wall_thickness_mm": 0.8, "pneumatics.driving_pressures_kPa": [0, 20]}
    thin = make_plan("long-tube", changes, PlanOptions(specimens=1), library=library).record
    (resin,) = thin.resins
    rated = resin.rating.rated_pressure_kPa
    assert 9.0 < rated < 12.0
    saturation = max(thin.tests["saturation"].driving_pressures_kPa)
    assert rated - 0.1 < saturation <= rated
    assert resin.injection.sensor[-1].without_dead_volume_kPa <= 0.5 * rated
    own = {run.driving_pressure_kPa for run in thin.runs if run.kind == "steps"}
    assert own == {0.0, 20.0}
    assert {w.driving_pressure_kPa for w in thin.warnings if w.rule == "rated pressure"} == {20.0}


def test_a_driving_pressure_above_the_nominal_limit_is_refused_with_key_and_rating(library):
    changes = {"membrane.material": "FLX9995", "pneumatics.driving_pressures_kPa": [0, 105]}
    with pytest.raises(
        InputError, match=r"driving_pressures_kPa\[1\] = 105.*gauge range, 100\.0 kPa.*at most 90\.0 kPa"
    ):
        make_plan("paper-dome", changes, PlanOptions(specimens=1), library=library)


def test_rig_file_is_read_and_refused_with_its_name(tmp_path):
    file = tmp_path / "rig.toml"
    file.write_text("[rig]\nforce_range_N = 5.0\n")
    assert rig_of(file).force_range_N == 5.0 and rig_of(file).pressure_range_kPa == Rig().pressure_range_kPa
    file.write_text("[rig]\nforce_rnge_N = 5.0\n")
    with pytest.raises(InputError, match=r"rig\.toml.*force_range_N"):
        rig_of(file)
    file.write_text("force_range_N = 5.0\n")
    with pytest.raises(InputError, match=r"\[rig\] table"):
        rig_of(file)


def test_pressure_beyond_the_limit_point_is_the_inputs_fault(library):
    with pytest.raises(
        InputError, match=r"\[0\] = 45.*TangoPlus: 45 kPa is above the limit point, 39\.6 kPa .* at most 19\.7 kPa"
    ):
        make_plan("paper-dome", {"pneumatics.driving_pressures_kPa": [45]}, PlanOptions(specimens=1), library=library)
    with refused("resins", "TangoPlu"):
        make_plan("paper-dome", None, PlanOptions(resins=["TangoPlu"]), library=library)
