"""Designs, builds and measurements side by side, in columns of one kind."""

import json
import re
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from pneutouch import __version__
from pneutouch.arrays import Array
from pneutouch.catalogue import DesignSource, Library, ResolvedDesign
from pneutouch.errors import InputError
from pneutouch.evaluation.comparison import (
    FIGURES,
    ComparedFigure,
    ComparedSensor,
    ComparedState,
    comparison,
    effects_of,
    figures_at,
    labelled,
)
from pneutouch.evaluation.evaluate import Evaluation, evaluate
from pneutouch.evaluation.result import predicted
from pneutouch.export.threemf_read import Package
from pneutouch.formats import KEY, check_format, format_of, versioned
from pneutouch.output.files import (
    MANIFEST,
    check_writable,
    digest,
    json_bytes,
    short_digest,
    with_manifest,
    write_folder,
)
from pneutouch.output.recipe import read_recipe
from pneutouch.parts import Assembly, assemble
from pneutouch.results.comparison import ComparisonRecord
from pneutouch.results.prediction import CurvePoints
from pneutouch.results.record import SENSITIVITY_KEY, STIFFNESS_KEY, plain
from pneutouch.spec.read import Changes
from pneutouch.spec.toml_text import flat
from pneutouch.workflows.compare_measured import (
    PREDICTED_NAMES,
    MeasuredColumn,
    as_written,
    interval_of,
    listed_file,
    manifest_of,
    measured_columns,
    numbers,
)

Depths = Mapping[float, Sequence[Sequence[Array]]]
"""Depths (n,) mm of a measurement by driving pressure in kPa, for each specimen and each of its runs."""

_CLOSE = 1e-6
_REMEDY = "build the design again"


@dataclass(frozen=True)
class PredictedColumn:
    """A prediction as ``predict`` prints it, the design it is of, and its origin: a design or a build."""

    document: Mapping[str, Any]
    scene: ResolvedDesign
    model: str
    clamp: str
    kind: str
    source: str
    evaluation: Evaluation | None = None
    notes: tuple[str, ...] = ()

    def sensor(self, depths: Depths) -> ComparedSensor:
        """The column as a sensor; figures of the curve are read at ``depths``, those of a measurement, if there are
        any.

        Raises InputError if a build's prediction is not as it was written."""
        with as_written(Path(self.source), "prediction.json", _REMEDY) if self.evaluation is None else nullcontext():
            states = [_state(state, self.document, depths) for state in self.document["states"]]
            inputs = self._inputs()
        return ComparedSensor(
            name=self._name(),
            kind=self.kind,
            source=self.source,
            inputs=inputs,
            resin=self.scene.membrane_material.model_dump(mode="json"),
            states=tuple(state for state, _ in states),
            notes=tuple(dict.fromkeys((*self.notes, *(note for _, note in states if note)))),
            assembly=self._assembly,
            simulated=self.scene.calibration is not None and self.scene.calibration.source.simulated,
        )

    def _inputs(self) -> dict[str, Any]:
        tables = self.scene.design.model_dump(mode="json", by_alias=True)
        del tables["document"]
        more = {"model": self.model, "clamp": self.clamp, "dead_volume_mL": self.document["dead_volume_mL"]}
        more |= self._parameters()
        return flat({**tables, "prediction": more})

    def _name(self) -> str:
        calibration = self.scene.design.calibration_name
        return self.scene.name if calibration is None else f"{self.scene.name}@{calibration}"

    def _parameters(self) -> dict[str, float]:
        """Parameters that the figures follow from: modulus, and with a calibration its modulus and wall."""
        calibration, modulus = self.scene.calibration, self.scene.membrane_material.shear_modulus_MPa
        if calibration is not None:
            return {key: calibration.value(key) for key in ("shear_modulus_MPa", "wall_thickness_mm")}
        return {} if modulus is None else {"shear_modulus_MPa": modulus.nominal}

    def _assembly(self) -> Assembly:
        return assemble(self.scene) if self.evaluation is None else self.evaluation.assembly


def of_design(evaluation: Evaluation, source: str) -> PredictedColumn:
    """Column of a design that was just evaluated."""
    model, clamp = evaluation.prediction.model, evaluation.options.clamp
    document = plain(predicted(evaluation))
    return PredictedColumn(document, evaluation.scene, model, clamp, "design", source, evaluation)


def of_build(folder: Path) -> PredictedColumn:
    """Column of a build's output folder: its recorded prediction, and the design in its recipe.

    Raises InputError if the folder is damaged."""
    manifest = manifest_of(folder)
    with as_written(folder, "prediction.json", _REMEDY):
        document = json.loads(listed_file(folder, "prediction.json", manifest))
        check_format("prediction", document, folder / "prediction.json")
        model = str(document["model"])
    with as_written(folder, MANIFEST, _REMEDY):
        made_by = str(manifest.get("versions", {}).get("pneutouch", ""))
    recipe_text = json.dumps(
        {
            KEY: format_of("recipe"),
            "name": manifest.get("name", ""),
            "version": made_by,
            "inputs": manifest.get("inputs", {}),
        }
    )
    stated = {"input-hash": str(manifest.get("input_hash", ""))}
    recipe = read_recipe(Package(folder, (), stated, recipe_text, thumbnail=False, warnings=()))
    notes = () if made_by == __version__ else (f"{folder} was built by pneutouch {made_by} (here {__version__}).",)
    clamp = recipe.options.clamp
    return PredictedColumn(document, recipe.scene, model, clamp, "build", str(folder), notes=notes)


def _state(state: Mapping[str, Any], document: Mapping[str, Any], depths: Depths) -> tuple[ComparedState, str]:
    known = state["uncertainty"].get("figures", {})
    pressure_kPa = float(state["driving_pressure_kPa"])
    stated: dict[str, Any] = {
        "limit_pressure_kPa": document["limits"]["limit_point_kPa"],
        "rated_pressure_kPa": document.get("rating", {}).get("rated_pressure_kPa"),
        "force_at_range_end_N": None if state["force_range_N"] is None else state["force_range_N"][1],
        **{figure.key: state.get(figure.key) for figure in FIGURES if figure.key in state},
    }
    figures = {key: ComparedFigure(float(value)) for key, value in stated.items() if value is not None}
    figures |= {
        key: ComparedFigure(*interval_of(entry), effects_of(state["uncertainty"], key)) for key, entry in known.items()
    }
    measured = next((at for p, at in depths.items() if abs(p - pressure_kPa) < _CLOSE), None)
    note = ""
    if measured is not None:
        read, note = _read(state, measured)
        figures = {key: value for key, value in figures.items() if key not in _OF_CURVE}
        figures |= {key: _scaled(value, known.get(key), state) for key, value in read.items()}
    curve = state["curve"]
    kept = sum(at <= state["range_end_mm"] * (1 + 1e-9) for at in curve["indentation_mm"])
    points = CurvePoints(
        tuple(numbers(curve["indentation_mm"][:kept])),
        tuple(numbers(curve["contact_force_N"][:kept])),
        tuple(numbers(curve["pressure_rise_kPa"][:kept])),
    )
    return ComparedState(pressure_kPa, figures, (points,)), note


_OF_CURVE = (
    SENSITIVITY_KEY,
    STIFFNESS_KEY,
    "force_at_range_end_N",
    "r_squared",
    "nonlinearity_percent",
    "saturation_force_N",
    "range_end_mm",
)
"""Figures that depend on the range of the curve that they are read over."""


def _read(state: Mapping[str, Any], depths: Sequence[Sequence[Array]]) -> tuple[dict[str, float], str]:
    """Figures at the depths of a measurement, by key, and a note on them; both empty if none can be read."""
    curve = state["curve"]
    drawn = curve["indentation_mm"], curve["contact_force_N"], curve["pressure_rise_kPa"]
    indentation, force, rise_kPa = map(np.array, drawn)
    read, end = figures_at(indentation, force, rise_kPa, state["range_end_mm"], depths), state["range_end_mm"]
    if not read:
        return {}, ""
    ends = [float(run[-1]) for runs in depths for run in runs]
    low, high = f"{min(ends):.2f}", f"{max(ends):.2f}"
    short = f"; the prediction ends at {end:.2f} mm" if end < max(ends) * (1 - 1e-6) else ""
    note = (
        f"At {state['driving_pressure_kPa']:g} kPa figures of predicted curves are read at the depths of each run, to "
        f"{high if low == high else f'between {low} and {high}'} mm{short}."
    )
    return {PREDICTED_NAMES.get(key, key): value for key, value in read.items()}, note


def _scaled(value: float, known: Mapping[str, Any] | None, state: Mapping[str, Any]) -> ComparedFigure:
    """A figure of a shorter range with the relative uncertainty of the whole range; None as ends if unknown."""
    if known is None or not known["value"]:
        return ComparedFigure(value)
    scale = value / known["value"]
    key = next(key for key, entry in state["uncertainty"]["figures"].items() if entry is known)
    return ComparedFigure(value, scale * known["low"], scale * known["high"], effects_of(state["uncertainty"], key))


Compared = str | DesignSource
"""Thing that may be compared: a design (name, file or source), a build's folder, or a folder of results."""

_Column: TypeAlias = PredictedColumn | MeasuredColumn

_LONGEST = 100
"""Greatest length of an output folder's name, in letters."""


@dataclass(frozen=True)
class CompareResult:
    """The columns and the whole comparison; ``evaluations`` has None for columns that were not just evaluated."""

    sensors: tuple[ComparedSensor, ...]
    evaluations: tuple[Evaluation | None, ...]
    record: ComparisonRecord

    @property
    def name(self) -> str:
        """Name of the output folder."""
        words = "-".join(_distinct([sensor.label for sensor in self.sensors]))
        if len(words) > _LONGEST:
            words = f"{words[: _LONGEST - 9]}-{digest(words.encode())[:8]}"
        return f"compare-{words}"


def _distinct(labels: Sequence[str]) -> list[str]:
    """Labels as parts of a file's name; the first label's design name is left out where others repeat it."""
    words = [re.sub(r"[^A-Za-z0-9_.@-]+", "-", label).strip("-.") for label in labels]
    first = words[0].partition("@")[0]
    parts = [words[0].replace("@", "-")]
    for label in words[1:]:
        left = [word.removeprefix(f"{first}-") for word in label.split("@") if word != first]
        parts.append("-".join(left) or first)
    return parts


def compare(
    given: Sequence[Compared],
    changes: Changes | None = None,
    *,
    library: Library | None = None,
    progress: Callable[[int, int, str], None] = lambda done, total, what: None,
    **options: Any,
) -> CompareResult:
    """Compare two or more columns; a single folder of results gives its measurements and its predictions.

    ``changes`` override fields of every design, and of every build's design, which is then predicted again; ``options``
    are those of `evaluation.evaluate`. Raises InputError if something cannot be compared.
    """
    library = library or Library.default()
    _check_given(given)
    columns: list[_Column] = []
    for k, one in enumerate(given):
        progress(k, len(given), f"evaluating {one if isinstance(one, str) else one.name}")
        columns += _columns(one, changes or {}, library, options, alone=len(given) == 1)
    if len(columns) < 2:
        raise InputError("one thing alone cannot be compared", remedy="name another design or folder")
    depths: Depths = next((c.depths for c in columns if isinstance(c, MeasuredColumn)), {})
    sensors = [c.sensor() if isinstance(c, MeasuredColumn) else c.sensor(depths) for c in columns]
    sensors = [replace(s, label=label) for s, label in zip(sensors, labelled(sensors), strict=True)]
    evaluations = tuple(None if isinstance(c, MeasuredColumn) else c.evaluation for c in columns)
    return CompareResult(tuple(sensors), evaluations, comparison(sensors))


def _check_given(given: Sequence[Compared]) -> None:
    if not given:
        raise InputError("nothing to compare", remedy="name designs or folders")
    names = [str(Path(one)) if "/" in one else one for one in given if isinstance(one, str)]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"{name} is given twice", remedy="name another design or folder")


def _columns(
    one: Compared, changes: Changes, library: Library, options: dict[str, Any], *, alone: bool
) -> list[_Column]:
    """Columns of one argument; a folder of results that stands ``alone`` gives its predictions too."""
    if isinstance(one, str) and one not in library.paths("designs") and Path(one).is_dir():
        return _of_folder(Path(one), changes, library, options, alone=alone)
    source = one if isinstance(one, str) else ""
    return [of_design(evaluate(one, changes, library=library, **options), source)]


def _of_folder(
    folder: Path, changes: Changes, library: Library, options: dict[str, Any], *, alone: bool
) -> list[_Column]:
    listed = manifest_of(folder)["files"]
    if "figures.json" in listed and "points.csv" in listed:
        return list(measured_columns(folder, predicted=alone))
    if "prediction.json" not in listed:
        raise InputError(
            "neither a build nor a characterization",
            file=folder,
            remedy="give a folder that pneutouch build or characterize wrote, or a design",
        )
    build = of_build(folder)
    if not changes:
        return [build]
    tables = build.scene.design.model_dump(mode="json", by_alias=True, exclude_none=True)
    source = DesignSource(build.scene.name, {**tables, "document": {}}, str(folder))
    again = of_design(evaluate(source, changes, library=library, **options), str(folder))
    note = f"{folder} was built without the changes given here: its design is predicted again with them."
    return [replace(again, notes=(note,))]


def write(result: CompareResult, out: Path) -> Path:
    """Write the comparison as a page, a PDF and data into a folder of ``out``; returns that folder."""
    from pneutouch.report.comparison_sheet import comparison_sheet

    folder = out / result.name
    check_writable(folder)
    document = plain(result.record)
    assemblies = {sensor.label: sensor.assembly() for sensor in result.sensors if sensor.assembly is not None}
    files = {
        "comparison.json": json_bytes(versioned("comparison", document)),
        **comparison_sheet(result.record, assemblies),
    }
    write_folder(folder, with_manifest(files, result.name, {"comparison": short_digest(document)}))
    return folder
