"""Characterization of a campaign: its data read, reduced to figures, compared with the prediction, and written.

Also its small tables: points, segments, and the results of leak and injection runs."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from pneutouch.arrays import Array
from pneutouch.bench.figures import summarize
from pneutouch.bench.questions import outliers
from pneutouch.bench.reading import dead_volume_of_cap
from pneutouch.bench.record import MeasuredCurve, Trace
from pneutouch.bench.run_checks import check_plausible
from pneutouch.bench.simulate.curve import sensor_pressure
from pneutouch.bench.source import MeasuredFile
from pneutouch.catalogue import DesignSource, Library, ResolvedDesign, load_scene
from pneutouch.catalogue.library import example_remedy
from pneutouch.catalogue.listing import known_design
from pneutouch.errors import InputError
from pneutouch.evaluation.calibrated import check_fitted
from pneutouch.evaluation.evaluate import Evaluation, sensor_of
from pneutouch.formats import versioned
from pneutouch.mechanics.models.choice import USUAL, usual_model
from pneutouch.output.files import (
    MANIFEST,
    check_writable,
    file_digest,
    file_entry,
    input_hash,
    json_bytes,
    manifest,
    write_folder,
)
from pneutouch.parts import assemble
from pneutouch.report.measured import CampaignReport
from pneutouch.results.measured import InjectionFigure, MeasuredCampaign, ReadFiles
from pneutouch.results.record import plain
from pneutouch.spec.campaign import AS_DESIGNED, CAMPAIGN, CampaignRun, RunKind, campaign_of
from pneutouch.spec.read import Changes, parse_changes, read_toml, validate
from pneutouch.spec.target import Target
from pneutouch.spec.values import file_name
from pneutouch.tables.csv_table import csv_bytes
from pneutouch.units import KPA, ML
from pneutouch.workflows.characterize.load import CampaignData, Progress, Reading, load_curves, read_as, undisputed
from pneutouch.workflows.characterize.predicted import (
    StatePrediction,
    ageing,
    answers,
    compared,
    figures_of,
    unexpected,
    verdicts,
)

_RUN = ("file", "sensor", "resin", "driving_pressure_kPa", "run", "age_days")


def points_csv(curves: Iterable[MeasuredCurve]) -> bytes:
    """CSV of every loading point of every run: indentation, force, pressure rise; a hand's indentation is empty."""
    rows = [
        [*_of(curve), _cell(d), f"{f:.6g}", f"{p / KPA:.6g}"]
        for curve in curves
        for d, f, p in zip(curve.indentation, curve.force, curve.rise, strict=True)
    ]
    return csv_bytes((*_RUN, "indentation_mm", "contact_force_N", "pressure_rise_kPa"), rows)


def _cell(value: float, digits: int = 6) -> str:
    """A number as text; empty if it is not finite, such as the travel of a press by hand."""
    return f"{value:.{digits}g}" if math.isfinite(value) else ""


def segments_csv(curves: Iterable[MeasuredCurve]) -> bytes:
    """CSV of every indentation, with its times, and of every warning, with its time interval and reason."""
    rows = []
    for curve in curves:
        for i in curve.indents:
            times = [f"{t:.4f}" for t in (i.contact, *i.hold, *i.read, i.release)]
            rows.append([*_of(curve), "indentation", *times, _cell(i.onset, 5), f"{i.driving / KPA:.5g}", "", ""])
        for warning in curve.warnings:
            times = [f"{warning.start:.4f}", f"{warning.end:.4f}", *[""] * 6]
            rows.append([*_of(curve), "warning", *times, warning.why, "used" if warning.used else "left out"])
    places = ("contact_or_start_s", "hold_start_or_end_s", "hold_end_s", "read_start_s", "read_end_s", "release_s")
    head = (*_RUN, "what", *places, "onset_mm", "driving_kPa", "why", "used")
    return csv_bytes(head, rows)


def _of(curve: MeasuredCurve) -> list[Any]:
    run = curve.run
    return [run.file, run.sensor, run.resin, f"{run.driving_pressure_kPa:g}", run.run, f"{run.age_days:g}"]


def injections(
    loaded: CampaignData, scene: ResolvedDesign, answer_of: Mapping[tuple[str, float], StatePrediction]
) -> tuple[InjectionFigure, ...]:
    """Leak rates, and the gas volume of each injection as if the line were rigid, with the one that the predicted
    dome, which swells, shows at the same pushes; a calibration takes the dome into account."""
    rows = [
        InjectionFigure(run.sensor, f"leak, {_when(run)}", 60 * rate / KPA, 60 * error / KPA, "kPa/min")
        for run, rate, error in loaded.leaks
    ]
    ambient_kPa = scene.design.pneumatics.ambient_pressure_kPa
    for run, volume, pressure in loaded.injections:
        total, name = dead_volume_of_cap(volume, pressure, ambient_kPa * KPA), f"gas volume as if rigid, {_when(run)}"
        made = next((one.evaluation for (resin, _), one in answer_of.items() if resin == run.resin), None)
        shown = math.nan if made is None else _as_if_rigid(made, volume)
        predicted_mL = shown / ML if math.isfinite(shown) else None
        rows.append(InjectionFigure(run.sensor, name, total.value / ML, total.spread / ML, "mL", predicted_mL))
    return tuple(rows)


def _as_if_rigid(made: Evaluation, volume: Array) -> float:
    """Volume that the predicted sensor shows as if rigid, mm3; NaN if the pushes pass its limit point."""
    gas = made.sensor.gas
    pressure = sensor_pressure(volume, made.prediction.inflation, gas.dead_volume, gas.ambient_pressure)
    return dead_volume_of_cap(volume, pressure, gas.ambient_pressure).value


def _when(run: CampaignRun) -> str:
    """Text that tells runs of one sensor and kind apart: driving pressure, number and age."""
    return f"{run.driving_pressure_kPa:g} kPa, run {run.run}" + (f", {run.age_days:g} d" if run.age_days else "")


EVIDENCE = ("doubtful", "all", "none")
"""Runs whose evidence is plotted: those with warnings or questions and one of each group and kind, all, or none."""


@dataclass(frozen=True)
class CharacterizationResult:
    """Result of a characterization: the sheet's content, traces of the runs by file, name of the output folder, layouts
    of the files (`load.read_as`), design as a command takes it, and files with their columns."""

    measured: CampaignReport
    traces: Mapping[str, Trace]
    name: str
    read_as: tuple[ReadFiles, ...] = ()
    design_given: str = ""
    sources: Mapping[str, MeasuredFile] = field(default_factory=dict)

    @property
    def fitted(self) -> bool:
        """True if a sensor of the campaign can be fitted: the fit's model covers its design."""
        scene = self.measured.scene
        try:
            check_fitted(scene, sensor_of(assemble(scene)))
        except InputError:
            return False
        return True

    @cached_property
    def figures(self) -> MeasuredCampaign:
        """The figures, and how those files were read whose columns were found by their headers."""
        return figures_of(self.measured, self.read_as)

    @property
    def failed(self) -> bool:
        """True if a file is not used."""
        return bool(self.measured.failures)

    @property
    def missed(self) -> bool:
        """True if a requirement of the target was not shown to be met; False without a target."""
        return any(verdict.passed is not True for verdict in self.measured.verdicts)


def characterize(
    data: Path,
    design: str | DesignSource | None = None,
    changes: Changes | None = None,
    *,
    target: Path | None = None,
    model: str = USUAL,
    library: Library | None = None,
    progress: Progress = lambda done, total: None,
    reading: Reading | None = None,
    kind: RunKind | None = None,
) -> CharacterizationResult:
    """Read a campaign's folder or one file, and compare its figures with the prediction of its design.

    ``design`` takes precedence over the one that the campaign names; ``changes`` override fields of either, and
    ``reading`` (tables ``columns`` and ``format``) those of the campaign's tables. A single file has the ``kind``
    given, else the kind that its record shows. ``model`` USUAL is the solid, or harmonic off the axis. Raises
    InputError if nothing can be read; files that fail are listed in the result.
    """
    library = library or Library.default()
    name, named = (design, {}) if design is not None else _design_of(data, library)
    request = None if target is None else validate(Target, read_toml(target), str(target))
    given = {**named, **(changes or {})}
    scene = load_scene(name, given, library)
    loaded = load_curves(data, scene, progress, reading, kind, of_the_day="pneumatics.ambient_pressure_kPa" in given)
    if loaded.campaign.ambient_pressure_kPa is not None:
        given.setdefault("pneumatics.ambient_pressure_kPa", loaded.campaign.ambient_pressure_kPa)
    _check_resins(data, loaded, library)
    pairs = [(curve.run.resin, curve.run.driving_pressure_kPa) for curve in loaded.curves]
    scene = load_scene(name, given, library)
    if model == USUAL:
        model = usual_model(sensor_of(assemble(scene)))
    answer_of = answers(name, given, pairs, model, library)
    curves, failures, questions = sound(loaded, answer_of)
    groups = summarize(curves)
    comparisons = tuple(
        compared(group, _answer(answer_of, group.key.resin, group.key.driving_pressure_kPa)) for group in groups
    )
    measured = CampaignReport(
        campaign=loaded.campaign,
        scene=scene,
        folder=loaded.folder,
        comparisons=comparisons,
        curves=tuple(curves),
        failures=(*loaded.failures, *failures),
        questions=(*questions, *unexpected(comparisons)),
        verdicts=() if request is None else verdicts(request, groups),
        injections=injections(loaded, scene, answer_of),
        ageing=ageing(groups, library),
        model=model,
        input_hash=_hash(loaded, scene.design.model_dump(mode="json")),
    )
    return CharacterizationResult(
        measured,
        loaded.traces,
        f"{_stem(data)}-measured",
        read_as(undisputed(loaded.sources, failures), len(loaded.campaign.runs)),
        name.name if isinstance(name, DesignSource) else name,
        loaded.sources,
    )


def _design_of(data: Path, library: Library) -> tuple[str, dict[str, Any]]:
    """Name of the design that a campaign names, and the campaign's changes to it. Raises InputError if it names
    none."""
    if not (data.is_dir() or data.suffix == ".toml"):
        if not data.exists():
            raise InputError("no such file or folder", file=data, remedy=example_remedy(str(data)))
        raise InputError("a single file needs its sensor", file=data, remedy="give `design`")
    campaign, folder = campaign_of(data)
    name = known_design(campaign, folder, library)
    if name is None:
        raise InputError(
            "the campaign names no design", file=folder, remedy='give `design`, or design = "..." in its file'
        )
    return name, parse_changes(campaign.assignments)


def _check_resins(data: Path, loaded: CampaignData, library: Library) -> None:
    for place, run in enumerate(loaded.campaign.runs):
        if run.resin != AS_DESIGNED:
            library.load("materials", run.resin, file=str(data), key=f"runs[{place}].resin")


def _answer(
    predictions: Mapping[tuple[str, float], StatePrediction], resin: str, driving_pressure_kPa: float
) -> StatePrediction:
    return predictions.get((resin, driving_pressure_kPa), StatePrediction(None, 0, "not predicted"))


def sound(
    loaded: CampaignData, answer_of: Mapping[tuple[str, float], StatePrediction]
) -> tuple[list[MeasuredCurve], list[tuple[str, str]], tuple[tuple[str, str], ...]]:
    """Plausible curves; files of the others, with the reason; and questions about the plausible ones, by file."""
    kept: list[MeasuredCurve] = []
    failures: list[tuple[str, str]] = []
    questions: list[tuple[str, str]] = []
    for curve in loaded.curves:
        run = curve.run
        expected = _answer(answer_of, run.resin, run.driving_pressure_kPa).expected()
        try:
            suspect = check_plausible(curve, loaded.sources[run.file].columns, expected, loaded.folder / run.file)
            questions += [(run.file, text) for text in suspect]
            kept.append(curve)
        except InputError as error:
            failures.append((run.file, str(error)))
    questions += [(curve.run.file, why) for curve, why in outliers(kept)]
    return kept, failures, (*loaded.questions, *questions)


def _hash(loaded: CampaignData, design: Any) -> str:
    # Of a file that cannot be read there is none: it is among the failures.
    files = {run.file: file_digest(loaded.folder / run.file) for run in loaded.campaign.runs}
    return input_hash({"campaign": loaded.campaign.model_dump(mode="json"), "design": design, "files": files})


def _stem(data: Path) -> str:
    path = data.resolve()
    return file_name(path.parent.name if path.name == CAMPAIGN else path.stem if path.is_file() else path.name)


def write(outcome: CharacterizationResult, out: Path, evidence: str = "doubtful") -> Path:
    """Write the measured datasheet, figures, points, segments and evidence (one of `EVIDENCE`); return the folder."""
    from pneutouch.report.fit_charts import evidence_svg
    from pneutouch.report.measured.sheet import measured_datasheet

    folder = out / outcome.name
    check_writable(folder)
    measured = outcome.measured
    files = {
        **measured_datasheet(measured),
        "figures.json": json_bytes(versioned("figures", plain(outcome.figures))),
        "points.csv": points_csv(measured.curves),
        "segments.csv": segments_csv(measured.curves),
    }
    for curve in _shown(measured, evidence):
        number = measured.campaign.runs.index(curve.run) + 1
        path = f"evidence/{number:03d}-{file_name(Path(curve.run.file).stem)}.svg"
        files[path] = evidence_svg(curve, outcome.traces[curve.run.file], measured.campaign.simulated).encode()
    listed = {name: plain(file_entry(content)) for name, content in sorted(files.items())}
    files[MANIFEST] = manifest(listed, outcome.name, input_hash=measured.input_hash)
    return write_folder(folder, files)


def _shown(measured: CampaignReport, evidence: str) -> list[MeasuredCurve]:
    if evidence == "all":
        return list(measured.curves)
    if evidence == "none":
        return []
    first = {(b.group.key, curve.run.kind): curve for b in measured.comparisons for curve in reversed(b.group.curves)}
    doubtful = {
        curve.run.file for curve in measured.curves if any(warning.kind != "note" for warning in curve.warnings)
    }
    suspect = {file for file, _ in measured.questions}
    chosen = {curve.run.file for curve in first.values()} | doubtful | suspect
    return [curve for curve in measured.curves if curve.run.file in chosen]
