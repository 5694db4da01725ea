"""A plan in place of a design: its campaign file names the design, and every run that is simulated."""

from dataclasses import replace
from pathlib import Path

from pneutouch.catalogue import DesignSource, Library, known_design
from pneutouch.errors import InputError
from pneutouch.spec.campaign_file import CAMPAIGN, campaign_of
from pneutouch.spec.files import is_file
from pneutouch.spec.names import file_name
from pneutouch.spec.read import Changes, parse_changes
from pneutouch.workflows.simulate.options import KINDS, SimulationOptions

_STATED = ("resins", "specimens", "driving_pressures_kPa", "runs", "kinds", "ages_days")
"""Options that a plan gives."""


def as_planned(
    design: str | DesignSource, changes: Changes | None, options: SimulationOptions, library: Library
) -> tuple[str | DesignSource, Changes | None, SimulationOptions]:
    """Design, changes and options of a plan, where ``design`` is the folder of one; else as they are.

    Raises InputError for options that the plan states, and for a plan that cannot be simulated.
    """
    if isinstance(design, DesignSource) or not is_file(Path(design) / CAMPAIGN):
        return design, changes, options
    campaign, folder = campaign_of(Path(design))
    for key in _STATED:
        if getattr(options, key) != getattr(SimulationOptions(), key):
            raise InputError(f"the plan in {folder} states it", key=key, remedy="leave it out, or name the design")
    named, file = known_design(campaign, folder, library), folder / CAMPAIGN
    if named is None:
        raise InputError("names no design", file=file, key="design", remedy='write design = "..." into it')
    for place, run in enumerate(campaign.runs):
        if run.kind == "injection" and run.driving_pressure_kPa:
            remedy = "must be 0: an injection begins at ambient pressure"
            value = run.driving_pressure_kPa
            raise InputError("", file=file, key=f"runs[{place}].driving_pressure_kPa", value=value, remedy=remedy)
    _check_names([run.sensor for run in campaign.runs], file)
    planned = replace(
        options,
        planned=tuple(campaign.runs),
        resins=tuple(dict.fromkeys(run.resin for run in campaign.runs)),
        kinds=tuple(kind for kind in KINDS if any(run.kind == kind for run in campaign.runs)),
        ages_days=tuple(sorted({run.age_days for run in campaign.runs})),
    )
    return named, {**parse_changes(campaign.assignments), **(changes or {})}, planned


def _check_names(sensors: list[str], file: Path) -> None:
    """Raise InputError where two sensors would have the same files."""
    known: dict[str, str] = {}
    for sensor in sensors:
        other = known.setdefault(file_name(sensor), sensor)
        if other != sensor:
            raise InputError(f"its files would be those of sensor {other}", file=file, key="runs.sensor", value=sensor)
