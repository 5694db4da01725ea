"""The small tables of a characterization: points, segments, and the results of leak and injection runs."""

from collections.abc import Iterable
from typing import Any

from pneutouch.bench.injection import dead_volume_of_cap
from pneutouch.bench.record import MeasuredCurve
from pneutouch.catalogue import ResolvedDesign
from pneutouch.spec.campaign import CampaignRun
from pneutouch.tables.csv_write import csv_bytes
from pneutouch.units import KPA, ML
from pneutouch.workflows.characterize.load import CampaignData

_RUN = ("file", "sensor", "resin", "driving_pressure_kPa", "run", "age_days")


def points_csv(curves: Iterable[MeasuredCurve]) -> bytes:
    """Every loading point of every run: indentation, force, pressure rise."""
    rows = [
        [*_of(curve), f"{d:.6g}", f"{f:.6g}", f"{p / KPA:.6g}"]
        for curve in curves
        for d, f, p in zip(curve.indentation, curve.force, curve.rise, strict=True)
    ]
    return csv_bytes((*_RUN, "indentation_mm", "contact_force_N", "pressure_rise_kPa"), rows)


def segments_csv(curves: Iterable[MeasuredCurve]) -> bytes:
    """Every indentation found, with the seconds that were read; a doubtful one stands with its reason."""
    rows = []
    for curve in curves:
        for i in curve.indents:
            times = (i.contact, *i.hold, *i.read, i.release)
            rows.append(
                [
                    *_of(curve),
                    "indentation",
                    *(f"{t:.4f}" for t in times),
                    f"{i.onset:.5g}",
                    f"{i.driving / KPA:.5g}",
                    "",
                    "",
                ]
            )
        for warning in curve.warnings:
            blank = [""] * 6
            rows.append(
                [
                    *_of(curve),
                    "warning",
                    f"{warning.start:.4f}",
                    f"{warning.end:.4f}",
                    *blank,
                    warning.why,
                    "used" if warning.used else "left out",
                ]
            )
    places = ("contact_or_start_s", "hold_start_or_end_s", "hold_end_s", "read_start_s", "read_end_s", "release_s")
    head = (*_RUN, "what", *places, "onset_mm", "driving_kPa", "why", "used")
    return csv_bytes(head, rows)


def _of(curve: MeasuredCurve) -> list[Any]:
    run = curve.run
    return [run.file, run.sensor, run.resin, f"{run.driving_pressure_kPa:g}", run.run, f"{run.age_days:g}"]


InjectionRow = tuple[str, str, float, float | None, str]


def injections(loaded: CampaignData, scene: ResolvedDesign) -> tuple[tuple[InjectionRow, ...], list[tuple[str, str]]]:
    """Leak rates, and the dead volume an injection would mean in a rigid line; files that give neither, and why.

    An injection into a sensor swells the dome, so that its dead volume is an upper bound; `calibrate`
    takes the dome into account.
    """
    failures = []
    rows: list[InjectionRow] = [
        (run.sensor, f"leak, {_when(run)}", 60 * rate / KPA, 60 * error / KPA, "kPa/min")
        for run, rate, error in loaded.leaks
    ]
    ambient_kPa = scene.design.pneumatics.ambient_pressure_kPa
    for run, volume, pressure in loaded.injections:
        try:
            total = dead_volume_of_cap(volume, pressure, ambient_kPa * KPA)
        except ValueError as error:
            failures.append((run.file, f"{loaded.folder / run.file}: {error}"))
            continue
        name = f"gas volume as if rigid, {_when(run)}"
        rows.append((run.sensor, name, total.value / ML, total.spread / ML, "mL"))
    return tuple(rows), failures


def _when(run: CampaignRun) -> str:
    """Difference between runs of one sensor and kind, in words."""
    return f"{run.driving_pressure_kPa:g} kPa, run {run.run}" + (f", {run.age_days:g} d" if run.age_days else "")
