"""`characterize` and `pt.characterize` off the axis: the model without --model, and the command that comes next."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from typer.testing import CliRunner

import pneutouch as pt
from pneutouch.cli.app import app
from pneutouch.cli.characterize import _report_next
from pneutouch.errors import InputError
from pneutouch.mechanics.models.choice import USUAL
from pneutouch.workflows.characterize import campaign as characterizing

SET = ["contact.tilt_deg=10"]


@pytest.fixture
def models(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Models that the workflow was given; it goes no further."""
    given: list[str] = []

    def stopped(*_: Any, model: str, **__: Any) -> None:
        given.append(model)
        raise InputError("stopped here")

    monkeypatch.setattr(characterizing, "characterize", stopped)
    return given


def test_without_a_model_both_take_the_one_that_the_scene_needs(models: list[str]) -> None:
    CliRunner().invoke(app, ["characterize", "campaign"])
    with pytest.raises(pt.InputError, match="stopped here"):
        pt.characterize("campaign")
    CliRunner().invoke(app, ["characterize", "campaign", "--model", "atlas"])
    assert models == [USUAL, USUAL, "atlas"]


@pytest.mark.parametrize(
    ("design", "words"),
    [(None, "--set contact.tilt_deg=10 --set contact.friction=0.3"), ("mine", "--set contact.friction=0.3")],
)
def test_the_next_comparison_has_the_scene_of_the_campaign(
    design: str | None, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """A campaign's assignments are those of the design that it names, not of another one."""
    runs = [SimpleNamespace(sensor="a", kind="steps")]
    campaign = SimpleNamespace(runs=runs, assignments=SET)
    outcome: Any = SimpleNamespace(
        measured=SimpleNamespace(campaign=campaign), fitted=False, design_given=design or "paper-dome"
    )
    _report_next(outcome, Path("data"), Path("out"), design, ["contact.friction=0.3"], [])
    assert f"next: pneutouch compare {design or 'paper-dome'} out {words}\n" == capsys.readouterr().err
