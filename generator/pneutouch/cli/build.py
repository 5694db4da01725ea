"""``pneutouch build`` and ``pneutouch check``: a sensor, a specimen, or a 3MF that was built."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pneutouch.cli import app as cli
from pneutouch.cli.complete import parameters_of
from pneutouch.cli.terminal import bar, echo, notify, report_next, set_words

if TYPE_CHECKING:
    from pneutouch.evaluation.evaluate import Evaluation
    from pneutouch.printability import Finding
    from pneutouch.workflows.build_voxels import VoxelPlan

parameter = parameters_of(__file__)

_FLAGS = {
    "set_": "--set",
    "anywhere": "--contact-anywhere",
    **{key: f"--{key}" for key in ("calibration", "model", "tolerance", "closure", "clamp")},
}

_VOXEL_FLAGS = {"voxels": "--voxels", "voxel_mode": "--voxel-mode"}

VoxelsOption = Annotated[bool, parameter("voxels")]
VoxelModeOption = Annotated[str | None, parameter("voxel_mode")]


@cli.app.command()
def build(
    context: typer.Context,
    design: Annotated[str, parameter("design")],
    set_: cli.SetOption = None,
    calibration: cli.CalibrationOption = None,
    model: cli.ModelOption = None,
    tolerance: cli.ToleranceOption = None,
    closure: cli.ClosureOption = "variational",
    clamp: cli.ClampOption = "base",
    anywhere: cli.AnywhereOption = False,
    name: Annotated[str | None, parameter("name")] = None,
    out: cli.OutOption = Path("outputs"),
    voxels: VoxelsOption = False,
    voxel_mode: VoxelModeOption = None,
    json: cli.JsonOption = False,
) -> None:
    """Build everything: print files, prediction, datasheet. A 3MF is built again from the recipe in it."""
    stack: Path | None = None
    if (kind := _drawn_kind(design)) is not None:
        flags = {key: flag for key, flag in _FLAGS.items() if key != "set_"}
        cli.refuse_flags(context, {**flags, **_VOXEL_FLAGS}, f"a {kind}, which is drawn alone", design)
        run, steps = _BUILDS[kind]()
        with _progress(steps) as report:
            folder, findings = run(design, out, cli.changes(set_, calibration), progress=report, called=name)
    else:
        evaluation = (
            _from_3mf(design, context, name)
            if _is_3mf(design)
            else _evaluated(
                design,
                cli.changes(set_, calibration, anywhere=anywhere),
                model,
                tolerance,
                name=name or _calibrated_name(design, cli.changes(set_, calibration)),
                closure=closure,
                clamp=clamp,
            )
        )
        plan = _planned(evaluation, out, voxel_mode) if voxels or voxel_mode else None
        folder, findings = _build_sensor(evaluation, out)
        stack = None if plan is None else _write_voxels(plan, evaluation, out)
    _report(findings, folder)
    if json:
        cli.print_json({"design": folder.name, "folder": str(folder), **({"voxels": str(stack)} if stack else {})})
    else:
        echo(str(folder))
        if stack is not None:
            echo(str(stack))
        if kind is None and not _is_3mf(design):
            report_next("plan", design, *set_words(_from_ambient(set_, evaluation), calibration))


@cli.app.command()
def check(
    context: typer.Context,
    design: cli.DesignArgument,
    set_: cli.SetOption = None,
    calibration: cli.CalibrationOption = None,
    deep: Annotated[bool, parameter("deep")] = False,
    voxels: Annotated[bool, parameter("check_voxels")] = False,
    json: cli.JsonOption = False,
) -> None:
    """Check printability and mechanical limits; exit 1 where a rule is broken."""
    if (kind := _drawn_kind(design)) is not None:
        cli.refuse_flags(
            context, {**_VOXEL_FLAGS, "calibration": "--calibration"}, f"a {kind}, which is drawn alone", design
        )
        curves: tuple[Any, ...] = ()
        with bar(f"checking the {kind}"):
            findings = _CHECKS[kind]()(design, cli.changes(set_, calibration), deep=deep)
    else:
        from pneutouch.evaluation.subject import by_mixing_curve

        evaluation = _evaluated(design, cli.changes(set_, calibration))
        with bar("checking printability and limits"):
            findings = [*evaluation.findings, *(evaluation.deep_findings() if deep else [])]
            curves = by_mixing_curve(evaluation.curves)
            if voxels:
                from pneutouch.workflows.build_voxels import plan_voxels

                findings += plan_voxels(evaluation.assembly).findings
    broken = any(finding.severity == "error" for finding in findings)
    if json:
        by_curve = {"mixing_curves": curves} if curves else {}
        listed = [f.stated for f in findings]
        cli.print_json({"design": design, "passed": not broken, "findings": listed, **by_curve})
    else:
        echo("\n".join(f"{_line(one)}  [{one.source}]" for one in findings) or "no findings")
        if not broken:
            report_next("build", design, *set_words(set_, calibration), *(["--voxels"] if voxels else []))
    if broken:
        raise typer.Exit(1)


def _evaluated(
    design: str,
    changed: dict[str, Any],
    model: str | None = None,
    tolerance: str | None = None,
    *,
    name: str | None = None,
    **options: Any,
) -> Evaluation:
    from pneutouch.catalogue import DesignSource, Library
    from pneutouch.evaluation.evaluate import evaluate
    from pneutouch.mechanics.models.choice import model_options
    from pneutouch.spec.values import plain_name

    source = DesignSource.of(design, Library.default())
    source = source if name is None else replace(source, name=plain_name(name))
    return evaluate(source, changed, **model_options(model, tolerance), **options)


def _calibrated_name(design: str, changed: dict[str, Any]) -> str | None:
    """Name of the build of a calibrated sensor, different from the design's; None without calibration."""
    from pneutouch.catalogue import DesignSource, Library
    from pneutouch.workflows.build import calibrated_name

    return calibrated_name(DesignSource.of(design, Library.default()), changed)


def _drawn_kind(design: str) -> str | None:
    """Kind of a thing that is drawn alone, specimen or pad; None for a sensor."""
    from pneutouch.catalogue import Library

    if _is_3mf(design):
        return None
    library = Library.default()
    if library.specimen_file(design) is not None:
        return "specimen"
    return None if library.pad_file(design) is None else "pad"


def _is_3mf(design: str) -> bool:
    return design.lower().endswith(".3mf")


def _specimen_build() -> tuple[Callable[..., tuple[Path, list[Finding]]], Sequence[str]]:
    from pneutouch.workflows.specimen.build import STEPS, build_specimen

    return build_specimen, STEPS


def _pad_build() -> tuple[Callable[..., tuple[Path, list[Finding]]], Sequence[str]]:
    from pneutouch.workflows.pad.build_pad import STEPS, build_pad

    return build_pad, STEPS


def _specimen_check() -> Callable[..., list[Finding]]:
    from pneutouch.workflows.specimen.build import check_specimen

    return check_specimen


def _pad_check() -> Callable[..., list[Finding]]:
    from pneutouch.workflows.pad.build_pad import check_pad

    return check_pad


_BUILDS = {"specimen": _specimen_build, "pad": _pad_build}
_CHECKS = {"specimen": _specimen_check, "pad": _pad_check}


def _build_sensor(evaluation: Evaluation, out: Path) -> tuple[Path, list[Finding]]:
    from pneutouch.output.files import check_writable
    from pneutouch.workflows.build import STEPS
    from pneutouch.workflows.build import build as run

    check_writable(out / evaluation.scene.name)
    with _progress(STEPS) as report:
        folder = run(evaluation, out, report)
    return folder, evaluation.findings


def _report(findings: Sequence[Finding], folder: Path) -> None:
    """Report on stderr the findings, and the files that a build left out and why, such as STEP without CadQuery."""
    from json import loads

    from pneutouch.output.files import MANIFEST

    for finding in findings:
        notify(_line(finding))

    path = folder / MANIFEST
    manifest = loads(path.read_text(encoding="utf-8")) if path.is_file() else {}
    for name, why in manifest.get("left_out", {}).items():
        notify(f"note: {name} is not written: {why}")


def _from_ambient(set_: list[str] | None, evaluation: Evaluation) -> list[str]:
    """The assignments of a build for its campaign, which has no vacuum."""
    from pneutouch.evaluation.resins import from_ambient

    pressures_kPa = evaluation.scene.design.pneumatics.driving_pressures_kPa
    if pressures_kPa[0] >= 0.0:
        return set_ or []
    kept = from_ambient(pressures_kPa)
    return [*(text for text in set_ or () if text.partition("=")[0] != kept.partition("=")[0]), kept]


def _planned(evaluation: Evaluation, out: Path, mode: str | None) -> VoxelPlan:
    """The plan of the voxel stack; if it is not possible, it raises its error before anything is built."""
    from pneutouch.workflows.build_voxels import check_stack_folder, plan_voxels, stack_folder

    plan = plan_voxels(evaluation.assembly, mode=mode)
    plan.refuse()
    check_stack_folder(stack_folder(out, evaluation.scene.name))
    return plan


def _write_voxels(plan: VoxelPlan, evaluation: Evaluation, out: Path) -> Path:
    from pneutouch.workflows.build import input_hash
    from pneutouch.workflows.build_voxels import write_voxels

    with bar("slicing voxels") as report:
        folder, notes = write_voxels(plan, out, input_hash(evaluation), report)
    for note in notes:
        notify(f"warning: voxels: {note}")
    return folder


def _from_3mf(file: str, context: typer.Context, name: str | None) -> Evaluation:
    """Evaluate the recipe of a 3MF; notes on stderr programs and libraries that had another version then."""
    from pneutouch.export.threemf_read import read_threemf
    from pneutouch.output.recipe import evaluate_recipe, other_versions, read_recipe
    from pneutouch.spec.values import plain_name

    why = "a 3MF: its recipe fixes the design and the model; build from a design file to change them"
    cli.refuse_flags(context, _FLAGS, why, file)
    package = read_threemf(Path(file))
    recipe = read_recipe(package)
    other = other_versions(package, recipe)
    if other:
        notify(f"note: {file} was made with {', '.join(other)}: what is built may differ from it")
    if name is not None:
        recipe = replace(recipe, scene=replace(recipe.scene, name=plain_name(name)))
    return evaluate_recipe(recipe)


@contextmanager
def _progress(steps: Sequence[str]) -> Iterator[Callable[[str], None]]:
    """A bar over named steps on a terminal; one line a step elsewhere."""
    with bar("") as report:
        yield lambda step: report(steps.index(step), len(steps), step)


def _line(finding: Finding) -> str:
    """A finding as a message: its severity, rule and body, the problem and the remedy."""
    return f"{finding.severity}: {finding.rule}: {finding.body}: {finding.message}; {finding.fix}"
