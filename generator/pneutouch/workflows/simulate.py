"""Simulated campaign: runs of known sensors, never measured, in a folder that reads like a measured one."""

import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.simulate.curve import ModelDeviation, PressCurves, sensor_pressure, stopped
from pneutouch.bench.simulate.rig import LEAK_SECONDS, MARK, SimulatedSpecimens, encoded, parameters
from pneutouch.bench.simulate.runs import (
    RecordSamples,
    SimulationTruth,
    aged,
    population,
    simulate_leak,
    simulate_run,
    specimen_figures,
)
from pneutouch.catalogue import DesignSource, Library, ResolvedDesign
from pneutouch.errors import InputError
from pneutouch.evaluation.gauge import reading_of
from pneutouch.evaluation.resins import SimulatedResin, pressed, resins_of
from pneutouch.formats import versioned
from pneutouch.mechanics import Sensor
from pneutouch.mechanics.models.choice import USUAL, usual_model
from pneutouch.output.files import MANIFEST, file_entry, input_hash, json_bytes, manifest, replacing
from pneutouch.results.record import plain
from pneutouch.results.simulation import CampaignTruth, ParameterValue, SimulatedPopulation, SimulatedSpecimen
from pneutouch.spec.campaign import Campaign, CampaignRun, Rig
from pneutouch.spec.options import SimulationOptions
from pneutouch.spec.read import Changes, validate
from pneutouch.spec.toml_text import assignments, toml_text
from pneutouch.units import KPA, ML
from pneutouch.workflows.simulate_inputs import (
    KINDS,
    PRESSED,
    RequestedRuns,
    as_planned,
    driving_pressures_kPa,
    label,
    named_design,
    runs_of,
    sensors_of,
)

PUSHED = np.linspace(0.0, 0.5, 11) * ML
"""Volumes of an injection run if no plan states them, mm3: 0 to 0.5 mL, our choice."""

_OPTIONS = {"rate_Hz": "rate"} | {
    key: key for key in ("specimens", "driving_pressures_kPa", "runs", "kinds", "seed", "model", "ages_days", "parquet")
}
"""Options, besides the resins, that a campaign depends on, and their keys in the hashed inputs."""

_DEVIATION = 1
"""Last part of the seed for a specimen's deviation, which separates it from that of its parameters."""

Progress = Callable[[int, int], None]


def simulate(
    design: str | DesignSource,
    out: Path,
    changes: Changes | None = None,
    options: SimulationOptions = SimulationOptions(),  # noqa: B008 - immutable
    library: Library | None = None,
    progress: Progress = lambda done, total: None,
    truth: SimulationTruth = SimulationTruth(),  # noqa: B008 - immutable
) -> Path:
    """Write ``out/<design>-campaign/``: campaign.toml, runs, truth.json, manifest; the same input, the same bytes.

    ``design`` may be the folder of a plan, whose runs are simulated. While they are made, runs are written to a hidden
    folder next to the final one. Raises InputError for what cannot be simulated.
    """
    library = library or Library.default()
    design, changes, asked = as_planned(design, changes, options, library)
    truth = truth if asked.rest_s is None else replace(truth, rest=asked.rest_s)
    subjects = resins_of(design, changes, asked.resins, truth, library)
    _check_rate(subjects[0].scene, asked.rate_Hz)
    if asked.model == USUAL:
        asked = asked.model_copy(update={"model": usual_model(subjects[0].sensor)})
    named, copied = named_design(design, library)
    name = f"{subjects[0].scene.name}-campaign"
    folder = out / name
    with replacing(folder) as fresh:
        writer = _Writer(fresh)
        _write_all((named, assignments(changes or {})), subjects, asked, writer, progress)
        for path, content in copied.items():
            writer.put(path, content)
        inputs = _inputs(subjects, asked)
        listed = dict(sorted(writer.files.items()))
        writer.put(MANIFEST, manifest(listed, name, inputs=inputs, input_hash=input_hash(inputs)))
    return folder


class _Writer:
    """Writes files into a folder, and keeps their manifest entries by name."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.files: dict[str, dict[str, Any]] = {}

    def put(self, name: str, content: bytes) -> None:
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
        self.files[name] = plain(file_entry(content))


@dataclass
class _Truth:
    """True values, by label, of the specimens simulated so far, and notes on their runs."""

    specimens: dict[str, SimulatedSpecimen] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)


def _write_all(
    named: tuple[str, list[str]],
    subjects: list[SimulatedResin],
    options: RequestedRuns,
    writer: _Writer,
    progress: Progress,
) -> None:
    runs: list[CampaignRun] = []
    populations: list[SimulatedPopulation] = []
    truth = _Truth()
    total = sum(len(sensors_of(subject.name, options)) for subject in subjects) * len(options.ages_days)
    for subject in subjects:
        for age in options.ages_days:
            populations += _populations(subject, age, options)
            for k, sensor in enumerate(sensors_of(subject.name, options)):
                for run, content in _specimen(subject, sensor, k, age, options, truth):
                    runs.append(run)
                    writer.put(run.file, content)
                progress(len(truth.specimens), total)
    scene, model = subjects[0].scene, subjects[0].truth
    campaign = Campaign(
        title=f"Simulated campaign of {scene.name}"[:120],
        lab="none: simulated by pneutouch",
        design=named[0],
        assignments=named[1],
        simulated=True,
        ambient_pressure_kPa=scene.design.pneumatics.ambient_pressure_kPa,
        rig=_rig(scene, options.rate_Hz),
        runs=runs,
    )
    writer.put("campaign.toml", campaign_toml(campaign, MARK))
    record = CampaignTruth(
        simulated=True,
        design=scene.name,
        model=options.model,
        seed=options.seed,
        rate_Hz=options.rate_Hz,
        rest_s=model.rest,
        parameters={subject.name: _parameters(subject) for subject in subjects},
        specimens=truth.specimens,
        populations=tuple(populations),
        notes=tuple(truth.notes),
    )
    writer.put("truth.json", json_bytes(versioned("truth", plain(record))))


def _rig(scene: ResolvedDesign, rate_Hz: float) -> Rig:
    """Rig for the campaign file: the paper's, with the range of the gauge that the design names, if it names one."""
    if scene.gauge is None:
        return Rig(name="simulated: the paper's instruments", rate_Hz=rate_Hz)
    reading = reading_of(scene)
    name = f"simulated: the paper's instruments with the gauge {reading.title}"
    return Rig(name=name[:120], pressure_range_kPa=reading.limit / KPA, rate_Hz=rate_Hz)


def _check_rate(scene: ResolvedDesign, rate_Hz: float) -> None:
    """Raise InputError for a sampling rate above that of the design's gauge."""
    most_Hz = reading_of(scene).rate_Hz
    if scene.gauge is not None and most_Hz is not None and rate_Hz > most_Hz:
        raise InputError(
            f"the {scene.gauge.title} gives {most_Hz:g} readings a second",
            key="rate_Hz",
            value=rate_Hz,
            remedy="give at most that",
        )


def _parameters(subject: SimulatedResin) -> dict[str, dict[str, ParameterValue]]:
    deviates = subject.truth.deviation != ModelDeviation()
    parts = ("scatter", "rig", "wall", *(["deviation"] if deviates else []))
    return {part: parameters(getattr(subject.truth, part)) for part in parts}


def campaign_toml(campaign: Campaign, comment: str) -> bytes:
    """Content of a campaign file. Raises InputError if it could not be read again.

    Columns and format are left out if nothing is stated of them; they are then found from the files."""
    open_ = {key for key in ("columns", "format") if getattr(campaign, key) == Campaign.model_fields[key].default}
    content = campaign.model_dump(mode="python", exclude_none=True, exclude=open_)
    validate(Campaign, content, "campaign.toml")
    return f"{comment}\n{toml_text(content)}".encode()


def _depth(subject: SimulatedResin, options: RequestedRuns) -> float:
    """Greatest plate travel of the requested kinds of run, mm."""
    reach = subject.sensor.dome.shape.height
    kinds = [kind for kind in options.kinds if kind in PRESSED] or ["steps"]
    return max(max(subject.truth.protocol(kind, reach, np.inf).depths) for kind in kinds)


def _pressed(subject: SimulatedResin, sensor: Sensor, options: RequestedRuns, who: str) -> PressCurves:
    driving = [p * KPA for p in driving_pressures_kPa(subject, options)]
    curves, rig = pressed(who, sensor, driving, _depth(subject, options), options.model), subject.truth.rig
    return stopped(curves, rig.force_range, rig.pressure_range)


def _populations(subject: SimulatedResin, age: float, options: RequestedRuns) -> Iterator[SimulatedPopulation]:
    nominal = _pressed(subject, aged(subject.sensor, subject.truth, age), options, subject.name)
    seeds = options.seed, _number(subject.name)
    for k, pressure_kPa in enumerate(driving_pressures_kPa(subject, options)):
        known = population(nominal, k, subject.truth, options.rate_Hz, seeds)
        about = known.figures, known.spread, known.count, known.basis
        yield SimulatedPopulation(subject.name, age, pressure_kPa, *about)


def _specimen(
    subject: SimulatedResin, name: str, k: int, age: float, options: RequestedRuns, truth: _Truth
) -> Iterator[tuple[CampaignRun, bytes]]:
    """Runs of one specimen, the resin's k-th, at one age, with their files; its true values go into ``truth``."""
    rng = np.random.default_rng([options.seed, _number(subject.name), k])
    drawn = SimulatedSpecimens.draw(subject.truth.scatter, 1, rng)
    sensor = aged(drawn.sensor(subject.sensor, 0), subject.truth, age)
    stream = np.random.default_rng([options.seed, _number(subject.name), k, _DEVIATION])
    pressed_curves = subject.truth.deviation.deviated(_pressed(subject, sensor, options, name), stream)
    pressures_kPa = driving_pressures_kPa(subject, options)
    truth.specimens[label(name, age, options)] = SimulatedSpecimen(
        resin=subject.name,
        age_days=age,
        shear_modulus_MPa=sensor.wall.hyperelastic.mu,
        pressures={
            f"{pressure_kPa:g}": {
                **specimen_figures(curve, subject.truth, sensor.dome.shape.height, options.rate_Hz),
                "range_end_mm": curve.reach,
                "range_ends_by": None if curve.ends is None else curve.ends[0],
            }
            for pressure_kPa, curve in zip(pressures_kPa, pressed_curves.curves, strict=True)
        },
        wall_thickness_mm=sensor.dome.wall_thickness,
        dead_volume_mL=sensor.gas.dead_volume / ML,
        model=pressed_curves.model,
    )
    for run in runs_of(name, subject, age, options):
        place = 0 if run.kind == "injection" else pressures_kPa.index(run.driving_pressure_kPa)
        pressure_kPa, curve = pressures_kPa[place], pressed_curves.curves[place]
        key = [_number(subject.name), k, round(1e3 * age), round(1e6 * pressure_kPa), KINDS.index(run.kind), run.run]
        rng = np.random.default_rng([options.seed, *key])
        if run.kind in PRESSED and curve.ends is not None:
            deepest = max(subject.truth.protocol(run.kind, subject.sensor.dome.shape.height, np.inf).depths)
            if deepest > curve.reach * (1 + 1e-9):
                stop = f"stops at {curve.reach:.2f} mm instead of {deepest:.2f} mm, before {curve.ends[0]}"
                truth.notes.append(f"{run.label}: {stop}")
        samples = _columns(run, subject, pressed_curves, place, options, rng)
        yield run, encoded(samples, parquet=options.parquet)


def _columns(
    run: CampaignRun,
    subject: SimulatedResin,
    pressed_curves: PressCurves,
    place: int,
    options: RequestedRuns,
    rng: "np.random.Generator",
) -> dict[str, Array]:
    """Columns of one run by name, in the units of its file."""
    truth, curve, sensor = subject.truth, pressed_curves.curves[place], pressed_curves.sensor
    if run.kind == "injection":
        gas, pushed = sensor.gas, PUSHED if run.volumes_mL is None else np.array(run.volumes_mL) * ML
        pressure = sensor_pressure(pushed, pressed_curves.inflation, gas.dead_volume, gas.ambient_pressure)
        read = pressure + truth.rig.noise(options.rate_Hz)[1] * rng.standard_normal(pushed.size)
        keep = np.isfinite(pressure)
        return {"volume_mL": pushed[keep] / ML, "pressure_kPa": truth.rig.stepped(read[keep]) / KPA}
    if run.kind == "leak":
        still = simulate_leak(curve.driving, LEAK_SECONDS, truth.rig, options.rate_Hz, rng)
        return {"time_s": still.time, "pressure_kPa": still.pressure / KPA}
    protocol = truth.protocol(run.kind, sensor.dome.shape.height, curve.reach)
    record: RecordSamples = simulate_run(
        curve, protocol, truth.rig, options.rate_Hz, rng, wall=truth.wall, scatter=truth.scatter
    )
    return {
        "time_s": record.time,
        "position_mm": record.position,
        "force_N": record.force,
        "pressure_kPa": record.pressure / KPA,
    }


def _number(name: str) -> int:
    """Number for a name, so that a resin's specimens do not depend on which other resins are simulated."""
    return zlib.crc32(name.encode())


def _inputs(subjects: list[SimulatedResin], options: RequestedRuns) -> dict[str, object]:
    first = subjects[0]
    stated = ("specimens", "runs") if options.planned else ()
    chosen = {name: getattr(options, key) for key, name in _OPTIONS.items() if key not in stated}
    planned = [
        [run.sensor, run.kind, run.driving_pressure_kPa, run.run, run.age_days, *(run.volumes_mL or ())]
        for run in options.planned
    ]
    return {
        "design": first.scene.design.model_dump(mode="json"),
        "resins": {subject.name: subject.scene.membrane_material.model_dump(mode="json") for subject in subjects},
        "options": {key: value for key, value in chosen.items() if value is not None},
        **({"planned": planned} if planned else {}),
        "parameters": plain(_parameters(first)),
        "rest": first.truth.rest,
    }
