"""The command behind ``pneutouch calibrate``: a campaign's folder in, its calibration and files out."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pneutouch.catalogue import DesignSource, Library, load_scene
from pneutouch.errors import InputError
from pneutouch.spec.read import parse_changes
from pneutouch.workflows.calibrate.files import prepare, save, write_calibration
from pneutouch.workflows.calibrate.fit import calibrate, observations_of
from pneutouch.workflows.characterize import Progress, answers, load_curves, sound


@dataclass(frozen=True, slots=True)
class CalibrationOptions:
    """What the flags ask for: see the command."""

    data: Path
    design: str | DesignSource | None
    sensor: str | None
    names: tuple[str, ...]
    hold_out: tuple[float, ...]
    priors: bool
    save: str | None
    shadow: bool
    out: Path


def run_calibration(
    asked: CalibrationOptions, library: Library | None = None, progress: Progress = lambda done, total: None
) -> dict[str, Any]:
    """Read, fit and write; the calibration's document with ``written`` and ``failures``. Raises InputError.

    Everything is checked before the first file is written.
    """
    library = library or Library.default()
    if asked.shadow and asked.save is None:
        raise InputError("goes with `save` NAME", key="shadow")
    loaded = load_curves(asked.data, progress=progress)
    design = asked.design or loaded.campaign.design
    if design is None:
        raise InputError("names no design", file=asked.data, remedy="give `design`")
    changes = parse_changes(loaded.campaign.assignments)
    scene = load_scene(design, changes, library)
    pairs = [(curve.run.resin, curve.run.driving_pressure_kPa) for curve in loaded.curves]
    expected = answers(design, changes, pairs, "atlas", library)
    curves, refused, questions = sound(loaded, expected)
    sensor, observations, notes = observations_of(loaded.campaign, curves, loaded.injections, scene, asked.sensor)
    own = {curve.run.file for curve in observations.curves}
    notes = [*notes, *(f"{file}: {text}" for file, text in questions if file in own)]
    found = calibrate(
        observations, scene, asked.names, priors=asked.priors, hold_out_kPa=asked.hold_out, sensor=sensor,
        title=loaded.campaign.title, notes=notes,
    )  # fmt: skip
    saved = None if asked.save is None else prepare(found, asked.save, Path(), library, shadow=asked.shadow)
    folder = write_calibration(found, asked.out)
    written = [str(folder)]
    if saved is not None:
        save(saved)
        written += saved.paths
    return {
        **found.document,
        "written": written,
        "failures": [list(failure) for failure in (*loaded.failures, *refused)],
    }
