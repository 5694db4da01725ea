"""The command behind ``pneutouch calibrate``: a campaign's folder in, its calibration and files out."""

import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pneutouch.bench.calibrate import Observations
from pneutouch.catalogue import DesignSource, Library, load_scene, split_calibration, user_folder
from pneutouch.errors import InputError
from pneutouch.spec.design import CALIBRATION
from pneutouch.spec.read import parse_changes
from pneutouch.workflows.calibrate.files import CampaignSource, default_name, prepare, save, write_calibration
from pneutouch.workflows.calibrate.fit import Calibration, calibrate, observations_of
from pneutouch.workflows.characterize import (
    CAMPAIGN,
    CampaignData,
    Progress,
    Reading,
    answers,
    load_curves,
    read_as,
    sound,
)


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
    replace: bool
    out: Path


@dataclass(frozen=True)
class CalibrationOutcome:
    """A calibration that was written.

    Attributes:
        document: The calibration's document with ``calibration`` (its name), ``written``, ``failures`` and ``read_as``.
        calibration: The calibration itself.
        source: Where its runs are from.
        design_given: The design as a command takes it.
        assignments: What the campaign changes in it.
    """

    document: dict[str, Any]
    calibration: Calibration
    source: CampaignSource
    design_given: str
    assignments: list[str]


def run_calibration(
    options: CalibrationOptions,
    library: Library | None = None,
    progress: Progress = lambda done, total: None,
    reading: Reading | None = None,
) -> CalibrationOutcome:
    """Read, fit and write. Raises InputError; everything is checked before the first file is written."""
    library = library or Library.default()
    loaded = load_curves(options.data, progress=progress, reading=reading)
    design = options.design or loaded.campaign.design
    if design is None:
        raise InputError("names no design", file=options.data, remedy="give `design`")
    # A design that is calibrated already is fitted from its drawing again, or the prior would hold the data twice.
    changes = {**parse_changes(loaded.campaign.assignments), CALIBRATION: None}
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
    source = _source(options.data, loaded, sensor, observations)
    name = options.save or default_name(calibration)
    saved = prepare(calibration, name, user_folder(), source, replace=options.replace)
    folder = write_calibration(calibration, options.out)
    save(saved)
    failures = [list(failure) for failure in (*loaded.failures, *refused)]
    written = {"written": [str(folder), str(saved.path)], "failures": failures, "read_as": read_as(loaded.sources)}
    document = {**calibration.document, "calibration": saved.name, **written}
    return CalibrationOutcome(document, calibration, source, _named(design), loaded.campaign.assignments)


def save_calibration(outcome: CalibrationOutcome, name: str, *, replace: bool = False) -> Path:
    """Write a calibration into the user's folder under a name. Raises InputError as `prepare` and `save` do."""
    saved = prepare(outcome.calibration, name, user_folder(), outcome.source, replace=replace)
    save(saved)
    return saved.path


def _named(design: str | DesignSource) -> str:
    """The design as a command takes it, without a calibration."""
    return design.name if isinstance(design, DesignSource) else split_calibration(design, Library.default())[0]


def _source(data: Path, loaded: CampaignData, sensor: str, observations: Observations) -> CampaignSource:
    """Where the runs are from; the digest is over the campaign file and the files of the runs that were used."""
    labels = {injection.label for injection in observations.injections}
    used = [curve.run for curve in observations.curves]
    used += [run for run, _, _ in loaded.injections if run.sensor == sensor and run.label in labels]
    campaign = data / CAMPAIGN if data.is_dir() else data
    whole = hashlib.sha256()
    for path in (campaign, *(loaded.folder / name for name in sorted({run.file for run in used}))):
        with path.open("rb") as file:
            whole.update(hashlib.file_digest(file, "sha256").digest())
    ages = [run.age_days for run in used]
    given = loaded.campaign
    return CampaignSource(whole.hexdigest(), given.lab, given.simulated, sum(ages) / len(ages))
