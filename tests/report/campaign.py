"""Campaigns made of the atlas's curves with scatter: what the measured sheet is tested with."""

from __future__ import annotations

import datetime
from pathlib import Path

import numpy as np

from pneutouch.bench.figures import RunGroup, summarize
from pneutouch.bench.record import MeasuredCurve, SuspectInterval
from pneutouch.catalogue import Library, load_scene
from pneutouch.evaluation.charts import in_resin
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.mechanics.models.atlas import MODEL
from pneutouch.mechanics.prediction import SensorState
from pneutouch.parts import assemble
from pneutouch.report.measured import CampaignReport, GroupComparison
from pneutouch.results.measured import AgeingChange, InjectionFigure, Verdict
from pneutouch.spec.campaign import Campaign, CampaignRun
from pneutouch.spec.material import Material
from pneutouch.units import KPA

RESINS = ("TangoPlus", "FLX9940", "FLX9950", "FLX9960", "FLX9970", "FLX9985", "FLX9995")
DAY = datetime.date(2026, 3, 2)
_DECAY = 0.04
"""Loss of force a decade."""


def states_of(resin: str, pressures: tuple[float, ...], library: Library) -> dict[float, SensorState]:
    """The atlas's states of the paper's dome in a resin, by kPa."""
    sensor = sensor_of(assemble(load_scene("paper-dome", library=library)))
    variant = in_resin(sensor, library.all("materials", Material)[resin])
    result, _ = MODEL.answer_one(variant, np.array(pressures) * KPA)
    return dict(zip(pressures, result.states, strict=True))


def curve_of(
    run: CampaignRun,
    state: SensorState,
    factor: float,
    rng: np.random.Generator,
    doubts: tuple[SuspectInterval, ...] = (),
) -> MeasuredCurve:
    """A run of a kind on a sensor that is ``factor`` times as stiff as predicted."""
    kept = state.indentation <= state.range_end
    depth, force, rise = state.indentation[kept], factor * state.force[kept], state.pressure_rise[kept]
    force = np.concatenate([[0.0], force[1:] + rng.normal(0, 0.05, force.size - 1)])
    rise = np.concatenate([[0.0], rise[1:] + rng.normal(0, 0.05 * KPA, rise.size - 1)])
    loop, relaxation = (), None
    if run.kind == "loop":
        up = np.linspace(0, 1, 300)
        into = np.interp(up, np.linspace(0, 1, rise.size), rise)
        by = np.interp(up, np.linspace(0, 1, force.size), force)
        out = into - 0.05 * into.max() * np.sin(np.pi * up)
        loop = tuple((by, into + k * 0.1 * KPA, by[::-1], out[::-1] + k * 0.1 * KPA) for k in range(3))
    if run.kind == "relaxation":
        time = np.linspace(0, 600, 6001)
        fall = 1 - _DECAY * np.log10(np.maximum(time, 0.1))
        relaxation = (time, force[-1] * fall + rng.normal(0, 0.01, time.size), rise[-1] * (0.4 + 0.6 * fall))
    return MeasuredCurve(
        run,
        depth,
        force,
        rise,
        (run.driving_pressure_kPa + rng.normal(0, 0.02)) * KPA,
        loop=loop,
        relaxation=relaxation,
        noise=(0.012, 0.015 * KPA),
        drift=(0.001 * KPA, 1e-4),
        warnings=doubts,
    )


def beside_of(group: RunGroup, states: dict[float, SensorState]) -> GroupComparison:
    """A group beside the atlas, with bands of 15 % and 10 %."""
    state = states.get(group.key.driving_pressure_kPa)
    if state is None or state.figures is None:
        return GroupComparison(group, group.key.resin, None, {}, {}, "beyond the limit point of this resin")
    f = state.figures
    predicted = {
        "sensitivity_kPa_per_N": (f.sensitivity, 0.85 * f.sensitivity, 1.15 * f.sensitivity),
        "stiffness_N_per_mm": (f.stiffness, 0.9 * f.stiffness, 1.1 * f.stiffness),
        "sensitivity_through_origin_kPa_per_N": (f.sensitivity_through_origin, None, None),
        "r_squared": (f.r_squared, None, None),
        "nonlinearity_percent": (100 * f.nonlinearity, None, None),
        "force_range_N": (f.force_range[1], None, None),
    }
    return GroupComparison(group, group.key.resin, state, {}, predicted)


def measured_of(
    library: Library,
    *,
    resins: tuple[str, ...] = RESINS,
    pressures: tuple[float, ...] = (0.0, 22.0),
    specimens: int = 3,
    runs: int = 3,
    kinds: tuple[str, ...] = ("steps", "saturation", "loop", "relaxation"),
    ages: tuple[float, ...] = (0.0,),
    simulated: bool = True,
    predicted: bool = True,
) -> CampaignReport:
    """A campaign of every resin at every pressure and age; ageing makes sensors a tenth stiffer."""
    rng = np.random.default_rng(7)
    curves, every = [], {}
    for resin in resins:
        every[resin] = states_of(resin, pressures, library)
        factors = 1 + rng.normal(0, 0.03, specimens)
        for kind in kinds:
            for n in range(specimens):
                for pressure in pressures:
                    for age in ages:
                        for k in range(runs if kind == "steps" else 1):
                            run = CampaignRun(
                                file=f"runs/{resin}-{n + 1}-{kind}-{pressure:g}-{age:g}-{k + 1}.csv",
                                kind=kind,
                                sensor=f"{resin}-{n + 1}",
                                resin=resin,
                                driving_pressure_kPa=pressure,
                                run=k + 1,
                                date=DAY,
                                age_days=age,
                            )
                            factor = factors[n] * (1.1 if age else 1.0)
                            curves.append(curve_of(run, every[resin][pressure], factor, rng))
    comparisons = tuple(beside_of(group, every[group.key.resin] if predicted else {}) for group in summarize(curves))
    campaign = Campaign(
        title=f"Resins under pressure: {len(resins)} at {len(pressures)}",
        lab="Test bench 3",
        design="paper-dome",
        simulated=simulated,
        runs=[curve.run for curve in curves],
    )
    return CampaignReport(
        campaign,
        load_scene("paper-dome", library=library),
        Path("campaign"),
        comparisons,
        tuple(curves),
        (),
        (),
        (),
        (),
        _ageing(resins, pressures) if len(ages) > 1 else (),
        "atlas",
        "0123456789ab",
    )


def _ageing(resins: tuple[str, ...], pressures: tuple[float, ...]):
    paper = {"TangoPlus": 14.8, "FLX9950": -17.0, "FLX9970": -34.9}
    return tuple(
        AgeingChange(resin, p, "12 months", -9.1 - k, -15.0, -3.2, paper.get(resin))
        for k, p in enumerate(pressures)
        for resin in resins
    )


VERDICTS = (
    Verdict("sensitivity at 0 kPa", "2.0 to 2.6 kPa/N", "2.31 kPa/N (2.2 to 2.4)", True),
    Verdict("sensitivity at 22 kPa", "at least 2.0 kPa/N", "1.93 kPa/N (1.8 to 2.1)", None),
    Verdict("force range", "at least 40 N", "32.4 N (31.9 to 32.9)", False),
)
INJECTIONS = (
    InjectionFigure("TangoPlus-1", "leak", 0.0213, 0.0031, "kPa/min"),
    InjectionFigure("TangoPlus-1", "dead volume", 0.512, 0.012, "mL", 0.48),
    InjectionFigure("TangoPlus-2", "cavity volume", 1.31, None, "mL"),
)
