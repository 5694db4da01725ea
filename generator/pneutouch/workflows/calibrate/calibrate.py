"""Work of ``pneutouch calibrate``: read a campaign's folder, fit, and write the calibration and its files."""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from pneutouch.bench.calibrate.observations import Observations
from pneutouch.bench.calibrate.other_states import further_tests
from pneutouch.bench.calibrate.parameters import NAMES
from pneutouch.bench.record import MeasuredCurve
from pneutouch.catalogue import KINDS, DesignSource, Library, load_scene, split_calibration, user_folder
from pneutouch.catalogue.listing import known_design
from pneutouch.errors import InputError
from pneutouch.evaluation.calibrated import check_fitted
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.evaluation.resins import rating_of
from pneutouch.mechanics.atlas.coverage import is_corrected
from pneutouch.output.files import check_writable
from pneutouch.parts import assemble
from pneutouch.results.calibration import OutcomeRecord
from pneutouch.results.record import extended
from pneutouch.spec.calibration import SensorCalibration
from pneutouch.spec.campaign import CAMPAIGN, campaign_of
from pneutouch.spec.design import CALIBRATION
from pneutouch.spec.options import CalibrationOptions
from pneutouch.spec.read import parse_changes
from pneutouch.stopping import uninterrupted
from pneutouch.workflows.calibrate.calibration_files import (
    CampaignSource,
    check_place,
    check_unlike,
    default_name,
    folder_of,
    prepare,
    savable,
    save,
    write_calibration,
)
from pneutouch.workflows.calibrate.fit import FITTED_KINDS, Calibration, calibrate, chosen_sensor, observations_of
from pneutouch.workflows.characterize import (
    CampaignData,
    Progress,
    Reading,
    answers,
    load_curves,
    read_as,
    same_failures,
    sound,
    undisputed,
)


def with_further_tests(calibration: Calibration, source: CampaignSource) -> Calibration:
    """The calibration with the further tests that would reduce its uncertainty most, at no more than the rated
    pressure: the calibrated sensor's, or the design's where the fit cannot be a calibration."""
    try:
        known = KINDS["calibrations"].validate(savable(calibration, source), "calibration")
    except InputError:
        known = None
    assert known is None or isinstance(known, SensorCalibration)
    scene = replace(calibration.scene, calibration=known)
    rated = rating_of(scene, sensor_of(assemble(scene))).pressure
    return replace(calibration, further=further_tests(calibration.fit, rated))


@dataclass(frozen=True)
class CalibrationOutcome:
    """A calibration that was written.

    Attributes:
        record: Record of the calibration, as ``pneutouch calibrate`` prints it.
        calibration: The fit and all that was derived from it.
        source: Source of its runs.
        design_given: The design as a command's argument.
        assignments: Changes to the design that the campaign states."""

    record: OutcomeRecord
    calibration: Calibration
    source: CampaignSource
    design_given: str
    assignments: list[str]


def run_calibration(
    data: Path,
    design: str | DesignSource | None,
    options: CalibrationOptions,
    out: Path,
    library: Library | None = None,
    progress: Progress = lambda done, total: None,
    reading: Reading | None = None,
    root: Path | None = None,
) -> CalibrationOutcome:
    """Read, fit and write: the report of the fit into ``out``, the calibration into ``root`` (None: the user's folder).

    The places of all files are checked before the fit. If a fit cannot be a calibration, the record's ``calibration``
    is None and its last note says why; with ``options.save`` that raises InputError, as do data without a fit."""
    library = library or Library.default()
    root = user_folder() if root is None else root
    if options.save is not None:
        check_place(options.save, root)
    campaign, folder = campaign_of(data)
    design = design or known_design(campaign, folder, library)
    if design is None:
        raise InputError("names no design", file=data, remedy="give `design`")
    # A design that is calibrated already is fitted from its drawing again, or the prior would hold the data twice.
    changes = {**parse_changes(campaign.assignments), CALIBRATION: None}
    scene = load_scene(design, changes, library)
    loaded = load_curves(data, scene, progress, reading)
    sensor = chosen_sensor(loaded.campaign, options.sensor)
    check_fitted(scene, built := sensor_of(assemble(scene)))
    pairs = [(curve.run.resin, curve.run.driving_pressure_kPa) for curve in loaded.curves]
    model = "solid" if is_corrected(built) else "atlas"
    curves, refused, questions = sound(loaded, answers(design, changes, pairs, model, library))
    _check_left(data, loaded, sensor, curves, refused)
    _, observations, notes = observations_of(loaded.campaign, curves, loaded.injections, scene, sensor)
    notes += [f"{file}: {why}" for file, why in questions if any(file == one.run.file for one in observations.curves)]
    source = _source(data, loaded, sensor, observations)
    name = options.save or default_name(scene.name, sensor)
    check_writable(folder_of(scene.name, sensor, out))
    _check_free(check_place(name, root), options, source)
    calibration = calibrate(
        observations,
        scene,
        tuple(options.fit),
        priors=options.priors,
        hold_out_kPa=tuple(options.hold_out_kPa),
        sensor=sensor,
        title=loaded.campaign.title,
        notes=notes,
    )
    calibration = with_further_tests(calibration, source)
    written, unsaved = _write(calibration, data, options, out, root, name, source)
    record = extended(
        OutcomeRecord,
        calibration.record,
        notes=(*calibration.record.notes, *unsaved),
        calibration=None if unsaved else name,
        written=tuple(str(path) for path in written),
        failures=(*loaded.failures, *refused),
        read_as=read_as(undisputed(loaded.sources, refused), len(loaded.campaign.runs)),
    )
    named = design.name if isinstance(design, DesignSource) else split_calibration(design, Library.default())[0]
    return CalibrationOutcome(record, calibration, source, named, loaded.campaign.assignments)


def _check_left(
    data: Path, loaded: CampaignData, sensor: str, curves: Sequence[MeasuredCurve], refused: Sequence[tuple[str, str]]
) -> None:
    """Raise InputError, with the reasons, if the sensor has runs to fit but none of them can be used."""
    files = {run.file for run in loaded.campaign.runs if run.sensor == sensor and run.kind in FITTED_KINDS}
    left = {curve.run.file for curve in curves} | {run.file for run, _, _ in loaded.injections}
    reasons = [(file, why) for file, why in (*loaded.failures, *refused) if file in files]
    if reasons and not files & left:
        lines = [f"{named}: {why}" for named, why in same_failures(reasons)]
        raise InputError("\n".join([f"no run of sensor {sensor} can be used", *lines]), file=data)


def _check_free(path: Path, options: CalibrationOptions, source: CampaignSource) -> None:
    """Raise InputError if the file holds a calibration of other inputs; unknown parameters are left to the fit."""
    if not options.replace and set(options.fit) <= set(NAMES):
        check_unlike(path, source.digest, options.fit, options.hold_out_kPa)


def _write(
    calibration: Calibration,
    data: Path,
    options: CalibrationOptions,
    out: Path,
    root: Path,
    name: str,
    source: CampaignSource,
) -> tuple[list[Path], list[str]]:
    """Write the fit's report and the calibration together; return the paths, and a note if there is no calibration.

    Raises InputError if ``options.save`` requires a calibration; the report is written nevertheless."""
    unsaved: list[str] = []
    try:
        savable(calibration, source)
    except InputError as error:
        unsaved.append(f"no calibration was saved: {error.problem}; {error.remedy}")
        if options.save is not None:
            folder = write_calibration(calibration, out, source, unsaved)
            problem = f"{error.problem} (the fit is in {folder})"
            file = None if error.key else data
            raise InputError(problem, file=file, key=error.key, remedy=error.remedy) from None
    saved = None if unsaved else prepare(calibration, name, root, source, replace=options.replace)
    # Neither is left without the other by a stop.
    with uninterrupted():
        written = [write_calibration(calibration, out, source, unsaved)]
        if saved is not None:
            save(saved)
            written.append(saved.path)
    return written, unsaved


def save_calibration(outcome: CalibrationOutcome, name: str | None = None, *, replace: bool = False) -> Path:
    """Save under ``name`` (None: as saved before, else design and sensor). Raises InputError as `prepare` and
    `save`."""
    calibration = outcome.calibration
    name = name or outcome.record.calibration or default_name(calibration.scene.name, calibration.sensor)
    saved = prepare(calibration, name, user_folder(), outcome.source, replace=replace)
    save(saved)
    return saved.path


def _source(data: Path, loaded: CampaignData, sensor: str, observations: Observations) -> CampaignSource:
    """Source of the runs; the digest is over the campaign file and the files of the runs that were used."""
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
