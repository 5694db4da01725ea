"""A job of the page: a design to all its files, as ``pneutouch build`` writes them."""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from pneutouch.catalogue import Library
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.mechanics.models.choice import model_options
from pneutouch.output.files import MANIFEST
from pneutouch.results.record import plain
from pneutouch.spec.values import plain_name
from pneutouch.studio.question import Question
from pneutouch.workflows.build import STEPS, build, calibrated_name, described

STAGES = ("prediction", *STEPS)
"""The stages that a build reports, in order."""

SHEET = "datasheet.html"


@dataclass(frozen=True, slots=True)
class BuiltFiles:
    """Files of a kind, and the kind in words."""

    files: list[str]
    words: str


@dataclass(frozen=True, slots=True)
class BuiltDesign:
    """A design that was built: its files, the datasheet's path and the findings."""

    name: str
    question: Question
    groups: list[BuiltFiles]
    left_out: Mapping[str, Any]
    sheet: str
    findings: list[Mapping[str, Any]]


def build_design(
    arguments: Mapping[str, Any], folder: Path, report: Callable[[int, int, str | None], None]
) -> BuiltDesign:
    """Build the design of ``question`` into ``folder``, under ``name`` where one is given.

    Raises InputError
    naming the field, and RuleBrokenError where a rule is broken.
    """
    question, library = Question.of(arguments.get("question")), Library.default()
    source = question.source(arguments["bases"], library)
    name = arguments.get("name") or calibrated_name(source, {})
    if name is not None:
        if not isinstance(name, str):
            raise InputError("must be a text", key="name", value=name)
        source = replace(source, name=plain_name(name, key="name"))
    report(0, len(STAGES), STAGES[0])
    evaluation = evaluate(source, **model_options(None, None), library=library)
    made = build(evaluation, folder, lambda step: report(STAGES.index(step), len(STAGES), step))
    files = sorted(path.relative_to(made).as_posix() for path in made.rglob("*") if path.is_file())
    groups = described(files, made.name)
    return BuiltDesign(
        name=source.name,
        question=question,
        groups=[BuiltFiles([f"{made.name}/{each}" for each in names], words) for names, words in groups],
        left_out=json.loads((made / MANIFEST).read_text(encoding="utf-8")).get("left_out", {}),
        sheet=f"{made.name}/{SHEET}",
        findings=[plain(finding.stated) for finding in evaluation.findings],
    )
