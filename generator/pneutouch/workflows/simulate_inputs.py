"""Runs to simulate, from a plan or from options, and the design of their campaign."""

from collections.abc import Iterator
from pathlib import Path
from typing import get_args

from pydantic import Field

from pneutouch.catalogue import DesignSource, Library
from pneutouch.catalogue.listing import known_design
from pneutouch.catalogue.scene import split_calibration
from pneutouch.errors import InputError
from pneutouch.evaluation.resins import SimulatedResin, tested_kPa
from pneutouch.mechanics.models.choice import USUAL
from pneutouch.spec.campaign import CAMPAIGN, CampaignRun, PlannedKind, campaign_of
from pneutouch.spec.files import exists, read_bytes
from pneutouch.spec.options import SimulationOptions
from pneutouch.spec.read import Changes, parse_changes
from pneutouch.spec.values import file_name

KINDS: tuple[PlannedKind, ...] = get_args(PlannedKind)
PRESSED = ("steps", "saturation", "loop", "relaxation")
"""Kinds of run with a plate."""

REPEATED = ("steps", "saturation")
"""Kinds that are run as often as the user asks; others are run once."""


class RequestedRuns(SimulationOptions):
    """Options of a simulation; ``planned`` are the runs of a plan, which then states specimens and kinds."""

    model: str = USUAL
    planned: list[CampaignRun] = Field(default=[])


def driving_pressures_kPa(subject: SimulatedResin, options: RequestedRuns) -> list[float]:
    """Driving pressures of a resin's runs, ascending: the plan's, else the options', else the design's."""
    given_kPa = options.driving_pressures_kPa
    if options.planned:
        listed = [run for run in options.planned if run.resin == subject.name]
        # An injection begins at ambient pressure whatever the others are driven at.
        given_kPa = list({run.driving_pressure_kPa for run in listed if run.kind != "injection"}) or [0.0]
    return sorted(tested_kPa(subject.scene) if given_kPa is None else given_kPa)


def sensors_of(resin: str, options: RequestedRuns) -> list[str]:
    """Names of the specimens of a resin."""
    if options.planned:
        return list(dict.fromkeys(run.sensor for run in options.planned if run.resin == resin))
    return [f"{resin}-{k + 1}" for k in range(options.specimens)]


def runs_of(sensor: str, subject: SimulatedResin, age: float, options: RequestedRuns) -> Iterator[CampaignRun]:
    """Runs of one specimen at one age, with the files that they are written to."""
    suffix = "parquet" if options.parquet else "csv"
    for kind, at_kPa, number, volumes_mL in _keys(sensor, subject, age, options):
        stem = f"{file_name(label(sensor, age, options))}-{at_kPa:g}kPa-{kind}-{number}"
        yield CampaignRun(
            file=f"runs/{stem}.{suffix}",
            kind=kind,  # type: ignore[arg-type]
            sensor=sensor,
            resin=subject.name,
            driving_pressure_kPa=at_kPa,
            run=number,
            age_days=age,
            volumes_mL=volumes_mL,
        )


def label(sensor: str, age: float, options: RequestedRuns) -> str:
    """Name of a specimen, with its age unless all specimens are fresh."""
    return sensor if options.ages_days == [0.0] else f"{sensor}-{age:g}d"


def _keys(
    sensor: str, subject: SimulatedResin, age: float, options: RequestedRuns
) -> Iterator[tuple[str, float, int, list[float] | None]]:
    """Kind, driving pressure in kPa, number, and injected volumes (None unless a plan states them) of each run."""
    if options.planned:
        for run in options.planned:
            if (run.sensor, run.age_days) == (sensor, age):
                yield run.kind, run.driving_pressure_kPa, run.run, run.volumes_mL
        return
    for place, pressure_kPa in enumerate(driving_pressures_kPa(subject, options)):
        for kind in options.kinds:
            if kind == "injection" and place > 0:
                continue
            for number in range(1, (options.runs if kind in REPEATED else 1) + 1):
                yield kind, 0.0 if kind == "injection" else pressure_kPa, number, None


def named_design(design: str | DesignSource, library: Library) -> tuple[str, dict[str, bytes]]:
    """Name of the design in a campaign file; for one given by path also its copy for the campaign's folder."""
    if isinstance(design, DesignSource):
        return design.name, {}
    plain, calibration = split_calibration(design, library)
    if plain in library.paths("designs"):
        return design, {}
    path = library.design_file(plain)
    named = path.suffix == ".toml" and path.name != CAMPAIGN
    name = path.name if named else f"{path.stem}-design.toml"
    return name if calibration is None else f"{name}@{calibration}", {name: read_bytes(path)}


_STATED = ("resins", "specimens", "driving_pressures_kPa", "runs", "kinds", "ages_days")
"""Options that a plan determines."""


def as_planned(
    design: str | DesignSource, changes: Changes | None, options: SimulationOptions, library: Library
) -> tuple[str | DesignSource, Changes | None, RequestedRuns]:
    """Design, changes and options of the plan whose folder ``design`` is; else those given.

    Raises InputError for options that the plan determines, and for a plan that cannot be simulated.
    """
    if isinstance(design, DesignSource) or not exists(Path(design) / CAMPAIGN):
        return design, changes, RequestedRuns(**options.model_dump(exclude_none=True))
    campaign, folder = campaign_of(Path(design))
    usual = SimulationOptions()
    for key in _STATED:
        if getattr(options, key) != getattr(usual, key):
            raise InputError(f"the plan in {folder} states it", key=key, remedy="leave it out, or name the design")
    named, file = known_design(campaign, folder, library), folder / CAMPAIGN
    if named is None:
        raise InputError("names no design", file=file, key="design", remedy='write design = "..." into it')
    for place, run in enumerate(campaign.runs):
        if run.kind == "injection" and run.driving_pressure_kPa:
            problem, value = "must be 0: an injection begins at ambient pressure", run.driving_pressure_kPa
            raise InputError(problem, file=file, key=f"runs[{place}].driving_pressure_kPa", value=value)
    _check_names([run.sensor for run in campaign.runs], file)
    planned = RequestedRuns(
        **options.model_dump(exclude=set(_STATED), exclude_none=True),
        planned=campaign.runs,
        resins=list(dict.fromkeys(run.resin for run in campaign.runs)),
        kinds=[kind for kind in KINDS if any(run.kind == kind for run in campaign.runs)],
        ages_days=sorted({run.age_days for run in campaign.runs}),
    )
    return named, {**parse_changes(campaign.assignments), **(changes or {})}, planned


def _check_names(sensors: list[str], file: Path) -> None:
    """Raise InputError if two sensors would have the same files."""
    known: dict[str, str] = {}
    for sensor in sensors:
        other = known.setdefault(file_name(sensor), sensor)
        if other != sensor:
            raise InputError(f"its files would be those of sensor {other}", file=file, key="runs.sensor", value=sensor)
