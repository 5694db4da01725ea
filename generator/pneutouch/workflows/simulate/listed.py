"""The runs that are simulated: those of a plan, or those that options request."""

from collections.abc import Iterator

from pneutouch.evaluation.resins import SimulatedResin
from pneutouch.spec.campaign import CampaignRun
from pneutouch.spec.names import file_name
from pneutouch.workflows.simulate.options import REPEATED, SimulationOptions


def driving_pressures_kPa(subject: SimulatedResin, options: SimulationOptions) -> list[float]:
    """Driving pressures of a resin's runs, ascending."""
    given_kPa = options.driving_pressures_kPa
    if options.planned:
        listed = [run for run in options.planned if run.resin == subject.name]
        # An injection begins at ambient pressure whatever the others are driven at.
        given_kPa = tuple({run.driving_pressure_kPa for run in listed if run.kind != "injection"}) or (0.0,)
    return sorted(subject.scene.design.pneumatics.driving_pressures_kPa if given_kPa is None else given_kPa)


def sensors_of(resin: str, options: SimulationOptions) -> list[str]:
    """Names of the specimens of a resin."""
    if options.planned:
        return list(dict.fromkeys(run.sensor for run in options.planned if run.resin == resin))
    return [f"{resin}-{k + 1}" for k in range(options.specimens)]


def runs_of(sensor: str, subject: SimulatedResin, age: float, options: SimulationOptions) -> Iterator[CampaignRun]:
    """Every run of one specimen at one age, with the file that it is written to."""
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


def label(sensor: str, age: float, options: SimulationOptions) -> str:
    """A specimen with its age, where there are several."""
    return sensor if options.ages_days == (0.0,) else f"{sensor}-{age:g}d"


def _keys(
    sensor: str, subject: SimulatedResin, age: float, options: SimulationOptions
) -> Iterator[tuple[str, float, int, list[float] | None]]:
    """Kind, driving pressure in kPa, number, and the injected volumes that a plan states, of each run."""
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
