"""Measured columns of a comparison: the groups of a folder that ``characterize`` wrote, one a resin and age."""

import csv
import io
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import InputError
from pneutouch.evaluation.comparison import ComparedFigure, ComparedSensor, ComparedState
from pneutouch.evaluation.comparison_record import CURVE_KEYS, CurvePoints
from pneutouch.formats import check_format
from pneutouch.workflows.compare.folder import as_written, interval_of, listed_file, manifest_of, numbers

PREDICTED_NAMES = {"force_range_N": "force_at_range_end_N"}
"""Measured figures that a prediction names otherwise."""


@dataclass(frozen=True)
class MeasuredColumn:
    """Groups of one resin and age, by driving pressure, and the loading points of their runs in steps.

    ``kind`` is "measured", or "design" for the prediction that the results were compared with.
    """

    name: str
    source: str
    states: tuple[ComparedState, ...]
    simulated: bool = False
    kind: str = "measured"
    depths: Mapping[float, list[list[Array]]] = field(default_factory=dict)

    def sensor(self) -> ComparedSensor:
        """The column."""
        return ComparedSensor(self.name, self.kind, self.source, {}, None, self.states, simulated=self.simulated)


def measured_columns(folder: Path, *, predicted: bool = False) -> list[MeasuredColumn]:
    """The columns of a folder of results; ``predicted`` adds the prediction that stands in it, before each.

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
    """The prediction and the measurement of each resin and age."""
    groups: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for group in content["groups"]:
        groups.setdefault((group["resin"], group["age"]), []).append(group)
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
    """Depths of each run of each specimen, mm, by driving pressure in kPa."""
    sensor_of = {run["file"]: run["sensor"] for run in content["runs"]}
    depths: dict[float, list[list[Array]]] = {}
    for group in groups:
        by_specimen: dict[str, list[Array]] = {}
        for file in group["files"]:
            if file in curves:
                by_specimen.setdefault(sensor_of[file], []).append(np.array(curves[file]["indentation_mm"]))
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
    """Loading points of the runs in steps, by file."""
    stepped = {run["file"] for run in content["runs"] if run["kind"] == "steps"}
    curves: dict[str, CurvePoints] = {}
    for row in csv.DictReader(io.StringIO(points.decode(), newline="")):
        if row["file"] in stepped:
            empty: CurvePoints = {"indentation_mm": [], "contact_force_N": [], "pressure_rise_kPa": []}
            curve = curves.setdefault(row["file"], empty)
            for key in CURVE_KEYS:
                curve[key] += numbers([float(row[key])])
    return curves
