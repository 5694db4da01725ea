"""Check of a design that was found, and the design file that it becomes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from pneutouch.catalogue import DesignSource, Library, ResolvedDesign, load_scene
from pneutouch.errors import PneutouchError
from pneutouch.evaluation.evaluate import Evaluation, PredictionOptions, evaluate_scene
from pneutouch.evaluation.subject import subject_of
from pneutouch.output.new import write_design
from pneutouch.parts import assemble
from pneutouch.printability import check
from pneutouch.selection import Candidate
from pneutouch.spec.design import DesignFile
from pneutouch.spec.read import override, parse_changes, validate
from pneutouch.spec.template import design_template


@dataclass(frozen=True)
class RejectedDesign:
    """A design that ``check`` rejects: the rule that it breaks, None if it cannot be drawn or predicted, and why."""

    choice: Candidate
    rule: str | None
    reason: str


class Judgement(NamedTuple):
    """Judgement of ``check`` on a design.

    reason: the first broken rule (None if the design cannot be drawn or predicted) and why; None if it passes.
    evaluation: the design as the solid predicts it; None if the print rules alone looked at it.
    """

    reason: tuple[str | None, str] | None
    evaluation: Evaluation | None = None


def judge(source: DesignSource, library: Library, *, predicted: bool) -> Judgement:
    """Judge a design: ``predicted`` as ``check`` does, by the solid too; else by the print rules on its bodies.

    The stability around the axis, which changes neither a finding nor a figure, is not checked.
    """
    evaluation = None
    try:
        scene = load_scene(source, {"indentation.checked_waves": 0}, library)
        if predicted:
            evaluation = evaluate_scene(scene, dict, PredictionOptions())
        findings = check(subject_of(assemble(scene))) if evaluation is None else evaluation.findings
    except PneutouchError as error:
        return Judgement((None, "; ".join(part for part in (error.problem, error.remedy) if part)))
    broken = next(((f.rule, f"{f.body}: {f.message}") for f in findings if f.severity == "error"), None)
    return Judgement(broken, evaluation)


def source_of(base: ResolvedDesign, assignments: list[str], name: str = "selected") -> DesignSource:
    """The design that assignments make of a base, before it is written."""
    return DesignSource(name, assigned(base.design, assignments, name), base.where)


def write_assigned(
    design: DesignFile, assignments: list[str], name: str, folder: Path, *, overwrite: bool = False
) -> Path:
    """Save a base with assignments as ``folder/name.toml``, over a file with ``overwrite`` alone."""
    chosen = validate(DesignFile, assigned(design, assignments, name), name)
    note = "Every key may be left out; it then takes its default."
    return write_design(
        name, folder, design_template(name, chosen.model_dump(by_alias=True), note), overwrite=overwrite
    )


def assigned(design: DesignFile, assignments: list[str], name: str) -> dict[str, Any]:
    """The tables of a design with ``table.key=value`` assignments, titled ``name``."""
    base = design.model_dump(by_alias=True)
    content = override(base, parse_changes(assignments), DesignFile)
    content["document"] = {**base["document"], "title": name}
    content["pneumatics"]["driving_pressures_kPa"] = [float(p) for p in content["pneumatics"]["driving_pressures_kPa"]]
    return content
