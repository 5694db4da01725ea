"""The command behind ``pneutouch calibrate``: a campaign's folder in, its calibration and files out."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pneutouch.catalogue import DesignSource, Library, load_scene, user_folder
from pneutouch.errors import InputError
from pneutouch.spec.read import parse_changes
from pneutouch.workflows.calibrate.files import prepare, save, write_calibration
from pneutouch.workflows.calibrate.fit import calibrate, observations_of
from pneutouch.workflows.characterize import Progress, answers, load_curves, sound


@dataclass(frozen=True, slots=True)
class CalibrationOptions:
    """Options of a calibration: see the command."""

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
    options: CalibrationOptions, library: Library | None = None, progress: Progress = lambda done, total: None
) -> dict[str, Any]:
    """Read, fit and write; the calibration's document with ``written`` and ``failures``. Raises InputError.

    Everything is checked before the first file is written.
    """
    library = library or Library.default()
    if options.shadow and options.save is None:
        raise InputError("goes with `save` NAME", key="shadow")
    loaded = load_curves(options.data, progress=progress)
    design = options.design or loaded.campaign.design
    if design is None:
        raise InputError("names no design", file=options.data, remedy="give `design`")
    changes = parse_changes(loaded.campaign.assignments)
    scene = load_scene(design, changes, library)
    pairs = [(curve.run.resin, curve.run.driving_pressure_kPa) for curve in loaded.curves]
    expected = answers(design, changes, pairs, "atlas", library)
    curves, refused, questions = sound(loaded, expected)
    sensor, observations, notes = observations_of(loaded.campaign, curves, loaded.injections, scene, options.sensor)
    used_files = {curve.run.file for curve in observations.curves}
    notes = [*notes, *(f"{file}: {text}" for file, text in questions if file in used_files)]
    calibration = calibrate(
        observations,
        scene,
        options.names,
        priors=options.priors,
        hold_out_kPa=options.hold_out,
        sensor=sensor,
        title=loaded.campaign.title,
        notes=notes,
    )
    saved = (
        None
        if options.save is None
        else prepare(calibration, options.save, user_folder(), library, shadow=options.shadow)
    )
    folder = write_calibration(calibration, options.out)
    written = [str(folder)]
    if saved is not None:
        save(saved)
        written += saved.paths
    failures = [list(failure) for failure in (*loaded.failures, *refused)]
    return {**calibration.document, "written": written, "failures": failures}
