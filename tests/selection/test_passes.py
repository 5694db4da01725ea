"""What `select` saves passes `check`, fits where it is mounted, and what is rejected is named with the reason."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from pneutouch.catalogue import Library, load_scene
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.parts import assemble
from pneutouch.spec.read import parse_changes
from pneutouch.workflows.select import select as workflow
from pneutouch.workflows.select.checks import Judgement, judge, source_of
from tests.conftest import ROOT
from tests.selection.passes import LIBRARY, tally
from tests.selection.targets import FINGERTIP, answer, document

TARGETS = 24
"""Random targets of the slow run; `python -m tests.selection.passes 500` tries 500."""


@pytest.mark.slow
def test_every_design_saved_for_a_random_target_passes_the_check(capsys):
    fates, reasons = tally(range(TARGETS), builds=2)
    with capsys.disabled():
        print(f"\n{TARGETS} random targets: {dict(fates)}; rejected: {dict(reasons)}")  # noqa: T201
    assert fates["passes"] >= TARGETS // 4


@pytest.fixture(scope="module")
def fingertip():
    return answer(FINGERTIP)


@pytest.mark.slow
@pytest.mark.parametrize("written", [None, 1])
def test_rejected_designs_leave_the_answer_and_are_named(fingertip, monkeypatch, written):
    """Those ranked first are rejected here; the first that passes takes their place, and the rest is not looked at."""
    looked = []

    def reject(source, library, *, predicted):
        looked.append(predicted)
        return (
            Judgement(("walls", "connector: too thin")) if len(looked) < 3 else judge(source, library, predicted=True)
        )

    monkeypatch.setattr(workflow, "judge", reject)
    found = workflow.passing(fingertip, written, LIBRARY)
    assert looked == [True, True, True]
    assert found.answer.designs == fingertip.answer.designs[2:]
    assert [one.choice for one in found.rejected] == fingertip.answer.designs[:2]
    listed = document(found)
    assert [one["reason"] for one in listed["rejected"]] == ["connector: too thin"] * 2
    assert [one["passes_check"] for one in listed["designs"]][:2] == [True, None]


def test_the_first_design_and_the_one_to_be_saved_are_judged_as_check_does(fingertip, monkeypatch):
    """What the print rules alone looked at is not said to pass; without a name the first one is judged all the same."""
    asked = []

    def looked(source, library, *, predicted: bool):
        asked.append(predicted)
        return Judgement(None, fingertip.judged[1] if predicted else None)

    monkeypatch.setattr(workflow, "judge", looked)
    for written, expected in ((None, [True]), (2, [True, True]), (3, [True, False, True])):
        asked.clear()
        said = document(workflow.passing(fingertip, written, LIBRARY))["designs"]
        assert asked == expected
        assert [one["passes_check"] for one in said] == [
            *(True if each else None for each in expected),
            *[None] * (len(said) - len(expected)),
        ]


@pytest.mark.slow
def test_a_plate_that_digs_in_rejects_the_first_design_before_it_is_saved(fingertip, monkeypatch):
    """The print rules see no plate: only the solid's prediction does."""
    changed = replace(fingertip, changes={**fingertip.changes, "indentation.plate_diameter_mm": 4})
    first = fingertip.answer.designs[:1]
    found = workflow.passing(replace(changed, answer=replace(fingertip.answer, designs=first)), None, LIBRARY)
    assert found.answer.designs == [] and "reaches the plate's edge" in found.rejected[0].reason
    assert judge(source_of(changed.base, changed.assignments(first[0])), LIBRARY, predicted=False).reason is None


def test_the_solid_solves_a_judged_design_once(fingertip, monkeypatch):
    solved = fingertip.confirmed[0].sensitivity
    afresh = workflow._confirm(fingertip, fingertip.answer.designs[0], None)
    assert solved == pytest.approx(afresh.sensitivity, rel=1e-4)
    monkeypatch.setattr("pneutouch.mechanics.models.solid.solid_states", None)
    again = workflow._confirm(fingertip, fingertip.answer.designs[0], fingertip.judged[1])
    assert again == fingertip.confirmed[0]


def test_a_design_that_the_print_rules_break_is_rejected_with_the_rule():
    scene = load_scene("paper-dome", None, LIBRARY)
    assert judge(source_of(scene, ["connector.port=barb-4x2.5"]), LIBRARY, predicted=False).reason is None
    assert judge(source_of(scene, ["connector.port=barb-3x2"]), LIBRARY, predicted=False).reason[0] == "walls"
    rule, reason = judge(source_of(scene, ["membrane.inner_radius_mm=2.2"]), LIBRARY, predicted=False).reason
    assert rule is None and "too small for" in reason


@pytest.mark.slow
def test_a_design_for_a_finger_has_its_sleeve_and_keeps_the_footprint():
    wanted = {"sensitivity_kPa_per_N": 3.0, "driving_pressure_kPa": 10.0, "fits": "finger:20", "max_footprint_mm": 26.0}
    selection = answer(
        wanted, given={"materials": ["TangoPlus"]}, setting={"assignments": ["connector.port=thread-M5"]}
    )
    designs = document(selection)["designs"]
    assert designs
    for listed, choice in zip(designs, selection.answer.designs, strict=True):
        changes = parse_changes(selection.assignments(choice))
        assembly = assemble(load_scene(source_of(selection.base, selection.assignments(choice)), None, LIBRARY))
        assert (changes["connector.mount"], changes["connector.finger_diameter_mm"]) == ("finger-16", 20.0)
        assert changes["connector.port"] == "thread-M5"
        assert listed["footprint_mm"] <= 26.0
        # Across the port's direction the meshes are as wide as the sensor is said to be.
        wide = max(body.bounds[1][1] - body.bounds[0][1] for body in assembly.bodies)
        assert listed["footprint_mm"] == pytest.approx(wide, abs=0.02)


@pytest.mark.slow
def test_the_solid_confirms_each_design_with_the_clamping_ring_of_its_own_size():
    """The base design's ring, 11.05 mm, would stand inside a wider dome: the solid finds no equilibrium at rest."""
    wanted = {"sensitivity_kPa_per_N": 1.387, "max_diameter_mm": 65.0}
    setting = {"assignments": ["connector.seat=clamped-flange-M2"]}
    selection = answer(wanted, given={"materials": ["FLX9960"], "wall_thickness_mm": 0.8}, setting=setting)
    assert len({choice.pool.radius[0] for choice in selection.answer.designs}) > 1
    for choice in selection.answer.designs:
        drawn = assemble(load_scene(source_of(selection.base, selection.assignments(choice)), None, LIBRARY))
        base = selection.sensor_of(choice).dome.base
        assert base == sensor_of(drawn).dome.base
        assert base.ring > choice.pool.radius[0] + choice.pool.wall[0]
    assert all(np.isfinite(confirmed.sensitivity) for confirmed in selection.confirmed)


def test_a_footprint_that_nothing_keeps_is_named_as_what_to_drop():
    wanted = {"sensitivity_kPa_per_N": 3.0, "driving_pressure_kPa": 10.0, "max_footprint_mm": 12.0}
    listed = document(answer(wanted, given={"materials": ["TangoPlus"]}))
    assert not listed["met"]
    dropped = {one["requirement"]: one["attainable"] for one in listed["dropped_requirements"]}
    assert "instead of 12" in dropped["footprint"]


@pytest.mark.slow
def test_a_plate_wider_than_the_contact_goes_with_a_large_dome():
    """The default plate is 30 mm wide: on a dome of 20 mm radius its edge would dig in."""
    wanted = {"sensitivity_kPa_per_N": 0.5, "driving_pressure_kPa": 10.0}
    given = {"inner_radius_mm": 20.0, "materials": ["TangoPlus"]}
    selection = answer(wanted, given=given)
    assert parse_changes(selection.assignments(selection.answer.designs[0]))["indentation.plate_diameter_mm"] == 64
    stated = answer(wanted, given=given, setting={"assignments": ["indentation.plate_diameter_mm=30"]})
    assert not stated.answer.designs


@pytest.mark.slow
def test_names_are_tested_before_anything_is_computed(command, tmp_path):
    (tmp_path / "designs").mkdir()
    (tmp_path / "designs" / "mine.toml").write_text("")
    asked = ("select", "--sensitivity", "1.9", "--at", "12", "--material", "TangoPlus")
    done = command(*asked, "--write", "mine")
    assert done.returncode == 2 and done.stdout == ""
    assert "mine.toml: there is such a file already; give another name, or --force to replace it" in done.stderr
    done = command(*asked, "--write", "mine", "--force", "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["designs"][0]["passes_check"] is True
    assert load_scene(str(tmp_path / "designs" / "mine.toml"), None, Library((ROOT,))).design.document.title == "mine"
    assert sorted(path.name for path in (tmp_path / "designs").iterdir()) == ["mine.toml"]


@pytest.mark.slow
def test_a_build_has_the_name_that_is_given(command, tmp_path):
    done = command("build", "stiff-dome", "--name", "left-hand")
    assert done.returncode == 0, done.stderr
    folder = tmp_path / "outputs" / "left-hand"
    assert (folder / "left-hand.3mf").is_file() and not (tmp_path / "outputs" / "stiff-dome").exists()
    again = command("build", str(folder / "left-hand.3mf"), "--name", "right-hand")
    assert again.returncode == 0, again.stderr
    names = [path.relative_to(folder).as_posix() for path in folder.rglob("*")]
    other = tmp_path / "outputs" / "right-hand"
    assert sorted(name.replace("left-hand", "right-hand") for name in names) == sorted(
        path.relative_to(other).as_posix() for path in other.rglob("*")
    )
