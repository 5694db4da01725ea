"""Rules on moulds: each finding on a mould that has the fault, and none on one without it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from pneutouch.catalogue import Library, load_scene
from pneutouch.parts.mould import MouldAssembly, mould_of
from pneutouch.printability.rulebook import MOULD_RULES, RULES, check_mould, mould_subject
from pneutouch.printability.subject import PrintSubject
from pneutouch.printability.view import PrintView
from pneutouch.spec.read import parse_changes
from tests.conftest import ROOT

LIBRARY = Library((ROOT,))


def mould(*assignments: str) -> MouldAssembly:
    return mould_of(load_scene("cast-dome", parse_changes(assignments), LIBRARY))


def findings(rule: str, *assignments: str):
    return MOULD_RULES[rule](mould(*assignments))


def test_a_dome_that_bulges_over_its_rim_is_held_back_by_its_mould_at_the_place_named():
    points = "membrane.profile_mm=[[9.25,0],[9.25,2,2],[11.5,6,3],[8,9.5,3],[0,9.5]]"
    found = [one for one in findings("mould fit", "membrane.shape=profile", points) if one.severity == "error"]
    assert found and all("12." in one.fix for one in found)


def test_the_shipped_design_s_mould_breaks_no_rule():
    listed = check_mould(mould())
    assert [finding for finding in listed if finding.severity == "error"] == []
    # A vent narrower than the filament printer makes without a drill, and a silicone too thick to run in by itself.
    assert {finding.rule for finding in listed} == {"holes", "channels", "mould filling"}
    assert all("mould." in finding.fix or "syringe" in finding.fix for finding in listed)


@pytest.mark.parametrize("rule", [pytest.param("edges", marks=pytest.mark.slow), "mesh"])
def test_of_edges_and_meshes_a_mould_has_errors_alone(rule, monkeypatch):
    """Remarks on them stand in `mould fit`, which measures them with rays."""
    made = mould()
    (holes,) = [finding for finding in check_mould(made) if finding.rule == "holes"][:1]
    fault, remark = (replace(holes, rule=rule, severity=severity) for severity in ("error", "warning"))
    monkeypatch.setattr("pneutouch.printability.rulebook.check", lambda subject: [remark, fault, holes])
    listed = check_mould(made)
    assert listed[0] == fault and holes in listed and remark not in listed


def test_a_mould_larger_than_its_printer_is_an_error():
    made = mould()
    small = made.printer.model_copy(update={"envelope_mm": made.printer.envelope.model_copy(update={"x": 40.0})})
    items = [replace(item, printer=small) for item in mould_subject(made).items]
    view = PrintView(PrintSubject(tuple(items)))
    listed = RULES["envelope"](view)
    assert [each.body for each in listed] == ["mould-cap", "mould-base"]
    assert all("mould.cavities" in each.fix and each.severity == "error" for each in listed)


def test_little_draft_and_a_loose_cone_are_warned_of():
    assert findings("mould fit") == []
    (draft,) = findings("mould fit", "mould.draft_deg=0.5")
    assert draft.severity == "warning" and "mould.draft_deg" in draft.fix and draft.excess.measured == 0.5
    assert findings("mould fit", "mould.draft_deg=1") == []
    (loose,) = findings("mould fit", "mould.clearance_mm=0.3")
    assert "20 % of the wall" in loose.message and "mould.clearance_mm" in loose.fix


def test_a_core_turned_into_an_undercut_is_an_error():
    made = mould()
    shifted = tuple(body if body.name != "mould-core" else body.turned_over() for body in made.bodies)
    made.__dict__["bodies"] = shifted
    assert {finding.severity for finding in MOULD_RULES["mould fit"](made)} == {"error"}


def test_filling_is_judged_by_viscosity_and_pot_life():
    (note,) = findings("mould filling")
    assert note.severity == "note" and "syringe" in note.message
    assert findings("mould filling", "mould.sprue_diameter_mm=3.5") == []
    (many,) = findings("mould filling", "mould.cavities=16", "mould.sprue_diameter_mm=0.8")
    assert many.severity == "warning" and "sprue_diameter_mm" in many.fix


def test_a_silicone_that_breaks_before_it_leaves_the_core_is_an_error():
    assert findings("release") == []
    made = mould()
    material = made.scene.membrane_material
    weak = material.elongation_at_break_percent.model_copy(update={"value": 60.0})
    object.__setattr__(
        made.scene, "membrane_material", material.model_copy(update={"elongation_at_break_percent": weak})
    )
    (broken,) = MOULD_RULES["release"](made)
    assert broken.severity == "error" and broken.excess.measured == pytest.approx(100.0)
    object.__setattr__(
        made.scene, "membrane_material", material.model_copy(update={"elongation_at_break_percent": None})
    )
    (unknown,) = MOULD_RULES["release"](made)
    assert unknown.severity == "note" and "not known" in unknown.message
