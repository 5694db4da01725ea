"""Compare the things that a user names: designs, builds and measurements, in columns of one kind."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeAlias

from pneutouch import __version__
from pneutouch.catalogue import DesignSource, Library
from pneutouch.errors import InputError
from pneutouch.evaluation.comparison import ComparedSensor, comparison_document, labelled
from pneutouch.evaluation.comparison_record import ComparisonRecord
from pneutouch.evaluation.evaluate import Evaluation, evaluate
from pneutouch.formats import versioned
from pneutouch.output.files import check_writable, digest, json_bytes, write_folder
from pneutouch.output.manifest import short_digest, with_manifest
from pneutouch.parts import Assembly
from pneutouch.spec.read import Changes
from pneutouch.workflows.compare.folder import manifest_of
from pneutouch.workflows.compare.measured import MeasuredColumn, measured_columns
from pneutouch.workflows.compare.predicted import Depths, PredictedColumn, of_build, of_design

Compared = str | DesignSource
"""Things that may be compared: a design (name, file or source), a build's folder, a folder of results."""

_Column: TypeAlias = PredictedColumn | MeasuredColumn

_LONGEST = 100
"""Letters of an output folder's name."""


@dataclass(frozen=True)
class CompareResult:
    """The columns, and everything that the comparison states; ``evaluations`` are those of the designs, None else."""

    sensors: tuple[ComparedSensor, ...]
    evaluations: tuple[Evaluation | None, ...]
    document: ComparisonRecord

    @property
    def name(self) -> str:
        """Name of the output folder."""
        words = "-".join(_distinct([sensor.label for sensor in self.sensors]))
        if len(words) > _LONGEST:
            words = f"{words[: _LONGEST - 9]}-{digest(words.encode())[:8]}"
        return f"compare-{words}"


def _distinct(labels: Sequence[str]) -> list[str]:
    """Labels as parts of a file's name, without the first one's name where another repeats it."""
    plain = [re.sub(r"[^A-Za-z0-9_.@-]+", "-", label).strip("-.") for label in labels]
    first = plain[0].partition("@")[0]
    parts = [plain[0].replace("@", "-")]
    for label in plain[1:]:
        words = [word.removeprefix(f"{first}-") for word in label.split("@") if word != first]
        parts.append("-".join(words) or first)
    return parts


def compare(
    given: Sequence[Compared],
    changes: Changes | None = None,
    *,
    library: Library | None = None,
    progress: Callable[[int, int, str], None] = lambda done, total, what: None,
    **options: Any,
) -> CompareResult:
    """Set two or more columns side by side; a folder of results alone is its measurement and its prediction.

    ``changes`` are laid over every design, and over that of every build, which is then predicted again; ``options``
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
    document = comparison_document(sensors)
    document["pneutouch"] = __version__
    return CompareResult(tuple(sensors), evaluations, document)


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
    """The columns that one argument stands for."""
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
    from pneutouch.report.compared.sheet import comparison_sheet

    folder = out / result.name
    check_writable(folder)
    files = {
        "comparison.json": json_bytes(versioned("comparison", result.document)),
        **comparison_sheet(result.document, _parts(result)),
    }
    hashed = {"comparison": short_digest(result.document)}
    write_folder(folder, with_manifest(files, result.name, hashed))
    return folder


def _parts(result: CompareResult) -> dict[str, Assembly]:
    return {sensor.label: sensor.assembly() for sensor in result.sensors if sensor.assembly is not None}
