"""Warnings that a design accepts by rule and reason."""

from __future__ import annotations

import pytest

from pneutouch.catalogue import load_scene
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.printability.rulebook import MOULD_RULES, RULES
from pneutouch.spec.design import Accepted, DesignFile
from pneutouch.spec.target import Setting, Target, TargetFigures
from pneutouch.workflows.select.base import base_scene

REASON = "printed twelve, none broke"


def findings(library, **accepted):
    changes = {f"accepted.{rule}": reason for rule, reason in accepted.items()}
    return evaluate("paper-dome", changes, model="atlas", library=library).findings


def test_every_key_is_a_rule():
    assert {key.replace("_", " ") for key in Accepted.model_fields} <= RULES.keys() | MOULD_RULES.keys()


def test_an_accepted_warning_is_a_note_with_the_reason_and_others_stay(library, evaluated):
    before, after = evaluated("paper-dome", model="atlas").findings, findings(library, walls=REASON)
    warned = [one for one in before if one.severity == "warning"]
    assert "walls" in [one.rule for one in warned] and len(warned) > 1
    assert [one for one in after if one.severity == "warning"] == [one for one in warned if one.rule != "walls"]
    (note,) = [one for one in after if one.rule == "walls"]
    assert note.severity == "note" and note.message.endswith(REASON)
    assert [one.rank for one in after] == sorted(one.rank for one in after)


def test_an_error_cannot_be_accepted(library):
    changes = {"membrane.wall_thickness_mm": 0.4, "pneumatics.driving_pressures_kPa": [0.0], "accepted.walls": REASON}
    found = evaluate("paper-dome", changes, model="membrane", library=library).findings
    assert "error" in [one.severity for one in found if one.rule == "walls"]


def test_a_design_that_accepts_nothing_reads_as_before():
    assert "accepted" not in DesignFile().model_dump()
    assert DesignFile(accepted={"walls": REASON}).model_dump()["accepted"]["walls"] == REASON


def test_a_selection_on_a_base_accepts_nothing_of_it(library, tmp_path):
    """The reasons are of the base's own membrane."""
    path = tmp_path / "mine.toml"
    path.write_text(f'[accepted]\nwalls = "{REASON}"\n')
    target = Target(target=TargetFigures(sensitivity_kPa_per_N=2.0), setting=Setting(base=str(path)))
    assert load_scene(str(path), {}, library).design.accepted.walls == REASON
    assert base_scene(target, "test", library).design.accepted == Accepted()


@pytest.mark.parametrize(
    ("key", "value"), [("resins", REASON), ("driving", REASON), ("walls", ""), ("walls", "    "), ("walls", "x" * 201)]
)
def test_another_rule_or_no_reason_is_refused(library, key, value):
    with pytest.raises(InputError) as caught:
        load_scene("paper-dome", {f"accepted.{key}": value}, library)
    assert caught.value.key == f"accepted.{key}"
    # A rule that is none of the print is refused with the reason.
    assert ("driving" in caught.value.problem) == (value == REASON)
