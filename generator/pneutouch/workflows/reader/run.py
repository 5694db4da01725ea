"""Tabulate a design's sensor, compare the table with the full model, and write it in the forms that are used."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pneutouch import __version__
from pneutouch.evaluation.evaluate import Evaluation
from pneutouch.evaluation.reader import reader_grid
from pneutouch.evaluation.reader_check import reader_difference
from pneutouch.evaluation.reader_record import reader_record
from pneutouch.export.reader.render import reader_files, sketch_note
from pneutouch.output.files import check_writable, digest, json_bytes, write_folder
from pneutouch.output.manifest import with_manifest
from pneutouch.output.recipe import BuildRecipe


@dataclass(frozen=True)
class ReaderResult:
    """A reader: the name of its folder, its document, its other files by name, and why there is no sketch."""

    name: str
    document: dict[str, Any]
    files: dict[str, bytes]
    note: str | None


def make_reader(evaluation: Evaluation) -> ReaderResult:
    """The reader of an evaluated design. Raises InputError and ComputationError as `evaluation.reader.reader_grid`."""
    grid = reader_grid(evaluation)
    record = reader_record(evaluation, grid)
    known = reader_difference(evaluation, grid, record)
    full_N = record["box"]["contact_force_N"][1]
    record["difference"] = {
        "nominal_N": known.nominal_N,
        "nominal_percent": 100.0 * known.nominal_N / full_N,
        "other_conditions_N": known.other_conditions_N,
        "other_conditions_percent": 100.0 * known.other_conditions_N / full_N,
        "states": known.states,
    }
    record["source"] = {"sha256": _source(evaluation), "version": __version__}
    calibration, gauge = evaluation.scene.design.calibration_name, evaluation.scene.gauge
    name = evaluation.scene.name if calibration is None else _calibrated(evaluation, calibration)
    return ReaderResult(f"{name}-reader", record, reader_files(record, name, gauge), sketch_note(gauge))


def _calibrated(evaluation: Evaluation, calibration: str) -> str:
    name = evaluation.scene.name
    return calibration if calibration.startswith(name) else f"{name}-{calibration}"


def _source(evaluation: Evaluation) -> str:
    """SHA-256 of all that a reader follows from: the design with all that it names, options, version."""
    return digest(json_bytes({"inputs": BuildRecipe.of(evaluation).inputs(), "version": __version__}))


def write_reader(result: ReaderResult, out: Path) -> Path:
    """Write ``out/<design>-reader/``; the same input, the same bytes. Returns that folder."""
    folder = out / result.name
    check_writable(folder)
    files = {"reader.json": json_bytes(result.document), **result.files}
    write_folder(folder, with_manifest(files, result.name, result.document["source"]))
    return folder
