"""Measured columns of a comparison: groups of a folder from ``characterize``, a column for each resin and age."""

import csv
import io
import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.arrays import Array, grouped
from pneutouch.errors import InputError
from pneutouch.evaluation.comparison import CURVE_KEYS, ComparedFigure, ComparedSensor, ComparedState
from pneutouch.formats import check_format
from pneutouch.output.files import MANIFEST, digest
from pneutouch.results.prediction import CurvePoints
from pneutouch.spec.files import read_bytes
from pneutouch.spec.values import is_finite

_MOST_BYTES = 100_000_000
"""Size of the largest file that is read: hundreds of times a usual one."""


def manifest_of(folder: Path) -> dict[str, Any]:
    """Manifest of an output folder. Raises InputError if there is none, or if it is damaged."""
    if not os.path.lexists(folder / MANIFEST):
        raise InputError(
            f"holds no {MANIFEST}: neither a build nor a characterization",
            file=folder,
            remedy="give a folder that pneutouch build or characterize wrote, or a design",
        )
    text = read_bytes(folder / MANIFEST, _MOST_BYTES, "manifest")
    try:
        content = json.loads(text)
        listed = content["files"]
        check_format("manifest", content, folder / MANIFEST)
        if isinstance(listed, dict) and all(isinstance(entry["sha256"], str) for entry in listed.values()):
            return dict(content)
    except (ValueError, KeyError, TypeError, RecursionError):
        pass
    raise InputError(f"its {MANIFEST} is damaged or not ours", file=folder, remedy="make the folder again")


_MISFORMED = (KeyError, ValueError, TypeError, AttributeError, IndexError, OverflowError, RecursionError, csv.Error)
"""Exceptions that content of another form raises in use: who changes a file can change its hash in the manifest."""


@contextmanager
def as_written(folder: Path, name: str, remedy: str) -> Iterator[None]:
    """Context to use a file that the program wrote: InputError replaces the exceptions that content of another form
    raises."""
    try:
        yield
    except _MISFORMED as error:
        problem = f"{name} is not as this version writes it ({type(error).__name__}: {error})"
        raise InputError(problem, file=folder, remedy=remedy) from None


def interval_of(entry: Mapping[str, Any]) -> tuple[float, float | None, float | None]:
    """Value, low and high of a figure; the last two may be None. Raises ValueError if one is no finite number."""
    value, low, high = entry["value"], entry["low"], entry["high"]
    numbers([value, *(each for each in (low, high) if each is not None)])
    if low is not None and high is not None and low > high:
        raise ValueError(f"an interval from {low} to {high}")
    return value, low, high


def numbers(values: Any) -> list[float]:
    """The values as a list. Raises ValueError if one is no finite number, TypeError if they are not iterable."""
    for value in values:
        if not is_finite(value):
            raise ValueError(f"{value!r:.40} is no finite number")
    return list(values)


def listed_file(folder: Path, name: str, manifest: dict[str, Any]) -> bytes:
    """Content of a file of an output folder. Raises InputError if it is missing or not as it was written."""
    entry = manifest["files"].get(name)
    if entry is None or not os.path.lexists(folder / name):
        raise InputError(f"holds no {name}", file=folder, remedy="make the folder again")
    content = read_bytes(folder / name, _MOST_BYTES, "file of an output folder")
    if digest(content) != entry["sha256"]:
        raise InputError("was changed after it was written", file=folder / name, remedy="make the folder again")
    return content


PREDICTED_NAMES = {"force_range_N": "force_at_range_end_N"}
"""Keys of measured figures, and the keys that predictions have for them."""


@dataclass(frozen=True)
class MeasuredColumn:
    """Groups of one resin and age, by driving pressure, and the loading points of their runs of kind steps.

    ``kind`` is "measured", or "design" for the prediction compared; ``depths``: `compare.Depths`."""

    name: str
    source: str
    states: tuple[ComparedState, ...]
    simulated: bool = False
    kind: str = "measured"
    depths: Mapping[float, list[list[Array]]] = field(default_factory=dict)

    def sensor(self) -> ComparedSensor:
        """The column as a sensor to compare."""
        return ComparedSensor(self.name, self.kind, self.source, {}, None, self.states, simulated=self.simulated)


def measured_columns(folder: Path, *, predicted: bool = False) -> list[MeasuredColumn]:
    """Columns of a folder of results; ``predicted`` adds its prediction before each measurement.

    Raises InputError if the folder is damaged or holds no group.
    """
    manifest = manifest_of(folder)
    with as_written(folder, "figures.json", "characterize the campaign again"):
        content = json.loads(listed_file(folder, "figures.json", manifest))
        check_format("figures", content, folder / "figures.json")
        curves = _curves(content, listed_file(folder, "points.csv", manifest))
        columns = _columns(content, curves, str(manifest.get("name", folder.name)), str(folder))
    if not columns:
        raise InputError(
            "holds no group of runs with figures", file=folder, remedy="see the failures on its measured datasheet"
        )
    return [column for pair in columns for column in pair if predicted or column.kind == "measured"]


def _columns(
    content: Mapping[str, Any], curves: Mapping[str, CurvePoints], name: str, source: str
) -> list[tuple[MeasuredColumn, MeasuredColumn]]:
    """Prediction and measurement of each resin and age, as columns."""
    groups = grouped(((group["resin"], group["age"]), group) for group in content["groups"])
    columns = []
    for (resin, age), members in groups.items():
        more = "" if len(groups) == 1 else f", {resin}, {age}"
        expected, seen = (
            tuple(_state(group, curves, measured=measured) for group in members) for measured in (False, True)
        )
        columns.append(
            (
                MeasuredColumn(f"{content['design']}{more}", source, expected, kind="design"),
                MeasuredColumn(
                    f"{name}{more}", source, seen, bool(content["simulated"]), depths=_depths(content, members, curves)
                ),
            )
        )
    return columns


def _depths(
    content: Mapping[str, Any], groups: list[dict[str, Any]], curves: Mapping[str, CurvePoints]
) -> dict[float, list[list[Array]]]:
    """Depths (n,) mm by driving pressure in kPa, for each specimen and each of its runs."""
    sensor_of = {run["file"]: run["sensor"] for run in content["runs"]}
    depths: dict[float, list[list[Array]]] = {}
    for group in groups:
        by_specimen: dict[str, list[Array]] = {}
        for file in group["files"]:
            if file in curves:
                by_specimen.setdefault(sensor_of[file], []).append(np.array(curves[file].indentation_mm))
        if by_specimen:
            depths[float(group["driving_pressure_kPa"])] = list(by_specimen.values())
    return depths


def _state(group: Mapping[str, Any], curves: Mapping[str, CurvePoints], *, measured: bool) -> ComparedState:
    entries = {
        PREDICTED_NAMES.get(key, key): entry if measured else entry["predicted"]
        for key, entry in group["figures"].items()
        if measured or "predicted" in entry
    }
    figures = {key: ComparedFigure(*interval_of(entry)) for key, entry in entries.items()}
    runs = tuple(curves[file] for file in group["files"] if measured and file in curves)
    return ComparedState(float(group["driving_pressure_kPa"]), figures, runs)


def _curves(content: Mapping[str, Any], points: bytes) -> dict[str, CurvePoints]:
    """Loading points of the runs of kind steps, by file."""
    stepped = {run["file"] for run in content["runs"] if run["kind"] == "steps"}
    columns: dict[str, dict[str, list[float]]] = {}
    for row in csv.DictReader(io.StringIO(points.decode(), newline="")):
        if row["file"] in stepped:
            curve = columns.setdefault(row["file"], {key: [] for key in CURVE_KEYS})
            for key in CURVE_KEYS:
                curve[key] += numbers([float(row[key])])
    return {file: CurvePoints(*(tuple(curve[key]) for key in CURVE_KEYS)) for file, curve in columns.items()}
