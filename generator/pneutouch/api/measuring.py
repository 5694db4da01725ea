"""Scans, signals and campaigns: planned, simulated, read and fitted; and a material of a laboratory's own."""

from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

from pneutouch.api.design import Design, source_of
from pneutouch.api.fields import keyword_options, named_by_keyword, number_of, path_of, paths_of
from pneutouch.api.results import Result
from pneutouch.errors import InputError, shown
from pneutouch.results.record import plain
from pneutouch.spec.campaign import RunKind
from pneutouch.spec.options import CalibrationOptions, FitOptions, PlanOptions, ScanOptions, SimulationOptions

if TYPE_CHECKING:
    from pneutouch.workflows.calibrate.calibrate import CalibrationOutcome

_DATA = "give a campaign's folder, its file or that of one run"


def scan(
    specimen: str | Path,
    design: Design | str | Path,
    *,
    driving_pressures_kPa: float | Iterable[float] = (0.0, 22.0),
    preload_N: float = 0.5,
    speed_mm_per_s: float | None = None,
    control: str = "height",
    noise_kPa: float | None = None,
    seed: int = 0,
    data: str | Path | Sequence[str | Path] = (),
) -> Result:
    """Slide a sensor over a texture specimen, given by name or path, and read which pattern each state detects.

    ``speed_mm_per_s`` None: the specimen's. ``noise_kPa`` is the rms noise of a sample, None: one step of the recorder.
    ``data`` are measured signals (CSV). Raises InputError if the scan is impossible.
    """
    from pneutouch.workflows.scan import run_scan
    from pneutouch.workflows.scanned import scanned, write_scan

    options = keyword_options(ScanOptions, locals())
    with named_by_keyword():
        run = run_scan(str(specimen), source_of(design), options)
        record = scanned(run)
    return Result(f"Scan {run.name}", plain(record), partial(write_scan, run, record))


def plan(
    design: Design | str | Path, *, resins: str | Sequence[str] = (), specimens: int = 3, rig: str | Path | None = None
) -> Result:
    """Plan a measurement campaign: runs, steps, and what to expect. ``rig`` is a TOML file; None: the paper's rig."""
    from pneutouch.workflows.plan import make_plan, rig_of, write_plan

    options = keyword_options(PlanOptions, locals())
    file = None if rig is None else path_of(rig, "rig", "give the path of a TOML file")
    with named_by_keyword():
        outcome = make_plan(
            source_of(design), None, options, rig=rig_of(file), rig_name="" if file is None else file.name
        )
    return Result(f"Plan {outcome.name}", plain(outcome.record), partial(write_plan, outcome))


def simulate(
    design: Design | str | Path,
    out: str | Path = "outputs",
    *,
    resins: str | Sequence[str] = (),
    specimens: int = 3,
    driving_pressures_kPa: float | Iterable[float] | None = None,
    runs: int = 3,
    kinds: str | Sequence[str] = ("steps", "loop", "relaxation"),
    rate_Hz: float = 100.0,
    rest_s: float | None = None,
    seed: int = 0,
    ages_days: Sequence[float] = (0.0,),
    model: str | None = None,
    parquet: bool = False,
) -> Path:
    """Simulate a campaign with known truth; returns its folder, which `characterize` and `calibrate` read.

    ``model`` None: the solid, and harmonic for contact off the axis.
    """
    from pneutouch.workflows.simulate import simulate as run

    options = keyword_options(SimulationOptions, locals())
    with named_by_keyword():
        return run(source_of(design), Path(out), None, options)


RecordedColumns = Mapping[str, Mapping[str, Any]] | str | Sequence[str] | None
"""Columns of a recording, as a table or as texts ``channel=NAME:UNIT``."""


def characterize(
    data: str | Path,
    design: Design | str | Path | None = None,
    *,
    target: str | Path | None = None,
    model: str | None = None,
    evidence: str = "doubtful",
    columns: RecordedColumns = None,
    file_format: Mapping[str, Any] | None = None,
    kind: RunKind | None = None,
) -> Result:
    """Figures of measured runs (a campaign's folder, its file or one run's) compared with the predicted ones.

    ``columns`` and ``file_format`` are the tables [columns] and [format] of a campaign file, such as ``{"force":
    {"name": "Load", "unit": "N"}}`` and ``{"decimal": ","}``; ``columns`` may be texts as well, as the command takes
    them, such as ``"force=-Load:N"``; what they leave out is as the campaign gives it, else found from each file.
    ``target`` is a target file to compare with; ``evidence`` selects the runs whose evidence `Result.save` plots:
    "doubtful", "all" or "none". ``model`` None: the solid, and harmonic for contact off the axis. ``kind`` is that of a
    single run; None: found from its record. Files that cannot be read are listed under ``failures``.
    """
    from pneutouch.mechanics.models.choice import USUAL
    from pneutouch.workflows.characterize.campaign import characterize as run
    from pneutouch.workflows.characterize.campaign import write

    target_file = None if target is None else path_of(target, "target", "give the path of a target file")
    if kind is not None and kind not in get_args(RunKind):
        raise InputError(f"must be one of {', '.join(get_args(RunKind))}", key="kind", value=kind)
    with named_by_keyword():
        source = None if design is None else source_of(design)
        reading = _reading(columns, file_format)
        how: Any = {"target": target_file, "model": model or USUAL, "reading": reading, "kind": kind}
        outcome = run(path_of(data, "data", _DATA), source, **how)
    return Result(f"Measured {outcome.name}", plain(outcome.figures), partial(write, outcome, evidence=evidence))


class FittedSensor(Result):
    """A sensor that was calibrated; a design that names its calibration by `name` is predicted as this sensor.

    `name` is None if the fit cannot be a calibration, such as with a modulus on its bound; the last note says why.
    """

    def __init__(self, outcome: "CalibrationOutcome") -> None:
        super().__init__("Calibration", plain(outcome.record))
        self._outcome = outcome
        self.name: str | None = outcome.record.calibration

    def save(self, name: str | Path | None = None, *, replace: bool = False) -> Path:
        """Write the calibration into the user's folder under a name (None: its own); returns its file.

        Another calibration is replaced only with ``replace``. Raises InputError.
        """
        from pneutouch.workflows.calibrate.calibrate import save_calibration

        with named_by_keyword():
            return save_calibration(self._outcome, None if name is None else str(name), replace=replace)

    def _head(self) -> str:
        return f"Calibration {shown(self.name)}" if self.name else "Fit without a calibration"


def calibrate(
    data: str | Path,
    design: Design | str | Path | None = None,
    *,
    sensor: str | None = None,
    fit: str | Sequence[str] = ("modulus", "dead-volume", "wall", "offset"),
    hold_out_kPa: Sequence[float] = (),
    priors: bool = True,
    save: str | None = None,
    replace: bool = False,
    out: str | Path = "outputs",
    columns: RecordedColumns = None,
    file_format: Mapping[str, Any] | None = None,
) -> FittedSensor:
    """Fit the model to the runs of one sensor of a campaign; write the fit into ``out``, and the calibration.

    ``hold_out_kPa`` are driving pressures to predict from the others. The calibration goes into the user's folder under
    the name ``save`` (None: of design and sensor); it replaces another only with ``replace``. The design with it is
    ``design.replace(calibration=result.name)``. ``columns`` and ``file_format`` are as for `characterize`.
    """
    from pneutouch.workflows.calibrate.calibrate import run_calibration

    options = keyword_options(CalibrationOptions, locals())
    with named_by_keyword():
        source, campaign = None if design is None else source_of(design), path_of(data, "data", _DATA)
        reading = _reading(columns, file_format)
        return FittedSensor(run_calibration(campaign, source, options, Path(out), reading=reading))


def _reading(columns: RecordedColumns, file_format: Mapping[str, Any] | None) -> dict[str, Mapping[str, Any]]:
    from pneutouch.workflows.characterize.load import parse_columns

    given = columns or {}
    table = given if isinstance(given, Mapping) else parse_columns([given] if isinstance(given, str) else list(given))
    return {"columns": table, "format": file_format or {}}


def respond(
    design: Design | str | Path,
    *,
    step_N: float | None = None,
    step_mm: float | None = None,
    sine_Hz: float | None = None,
    peak_N: float | None = None,
    peak_mm: float | None = None,
    duration_s: float | None = None,
    seed: int = 0,
    model: str | None = None,
) -> Result:
    """Simulate a step of force or travel, or a sine from no load to a peak, through wall, gas, line and gauge.

    Without a size the load is half of the range; without ``sine_Hz`` it is a step. ``duration_s`` None: 1 s, or ten
    cycles; ``seed`` sets the gauge's noise. `Result.save` writes the signals. Raises InputError for a load beyond the
    range.
    """
    from pneutouch.evaluation.evaluate import evaluate
    from pneutouch.mechanics.models.choice import model_options
    from pneutouch.workflows.respond import Load, run_respond
    from pneutouch.workflows.responded import responded, write_respond

    sizes = {"step_N": step_N, "step_mm": step_mm, "peak_N": peak_N, "peak_mm": peak_mm}
    given = {key: value for key, size in sizes.items() if (value := number_of(size, key)) is not None}
    frequency_Hz, length_s = number_of(sine_Hz, "sine_Hz"), number_of(duration_s, "duration_s")
    wrong = [key for key in given if key.startswith("step") == (sine_Hz is not None)]
    if wrong or len(given) > 1:
        remedy = "give one of `peak_N` and `peak_mm` with `sine_Hz`, or one of `step_N` and `step_mm` without"
        raise InputError("these sizes do not go together", key=(wrong or list(given))[0], remedy=remedy)
    key, size = next(iter(given.items()), ("", None))
    with named_by_keyword():
        evaluation = evaluate(source_of(design), **model_options(model, None))
        run = run_respond(evaluation, Load(size, key.endswith("mm"), frequency_Hz, length_s), seed)
        record = responded(run)
    return Result(f"Response of {evaluation.scene.name}", plain(record), partial(write_respond, run, record))


def fit_material(
    data: str | Path | Sequence[str | Path],
    name: str,
    *,
    like: str | None = None,
    density_g_per_cm3: float | None = None,
    shore_a: Sequence[float] = (),
    gauge_length_mm: float | None = None,
    width_mm: float | None = None,
    thickness_mm: float | None = None,
    opening_mm: float | None = None,
    kinds: Sequence[str] = (),
    puck_mm: tuple[float, float] | None = None,
    bonded: bool = False,
    stretch_to: float | None = None,
    slack: float | None = None,
    lab: str | None = None,
) -> Result:
    """Fit a hyperelastic law to tests (one file a specimen) or, with ``puck_mm``, to a puck test.

    ``kinds`` are tension, planar or equibiaxial, one for each file; ``puck_mm`` is diameter and thickness. Nothing is
    written before `Result.save`: then the material file into the user's folder, plot and figures into the folder
    given. Raises InputError for data that give no law.
    """
    from pneutouch.workflows.fit_material import fit_material as run
    from pneutouch.workflows.fit_material import fit_report, write_material

    options = keyword_options(FitOptions, locals())
    with named_by_keyword():
        fitted = run(paths_of(data, "data", "give the path of a table, or a list of such paths"), options)
        report = fit_report(fitted)
    return Result(f"Material {name}", plain(report), partial(write_material, fitted, report))
