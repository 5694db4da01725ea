"""Campaigns of simulated sensors in memory: what the rig writes of a wall that remembers, read as a lab's records are."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from pneutouch.bench.calibrate.fit import CalibrationFit, fit
from pneutouch.bench.calibrate.fitted_atlas import FLOOR, _shape
from pneutouch.bench.calibrate.observations import Observations
from pneutouch.bench.calibrate.parameters import DEAD, MODULUS, OFFSET_PRIOR, CalibrationParameters
from pneutouch.bench.curve import curve_of
from pneutouch.bench.record import MeasuredCurve
from pneutouch.bench.simulate.curve import PressCurve, press_curves
from pneutouch.bench.simulate.rig import SimulatedSpecimens
from pneutouch.bench.simulate.runs import SimulationTruth, simulate_run
from pneutouch.mechanics import Sensor
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.spec.campaign import CampaignRun, Rig
from pneutouch.units import KPA
from tests.bench.reads import blocks_of

RATE = 100.0
TRUTH = SimulationTruth(rest=10.0)
DEAD_VOLUME = 300.0


@dataclass(frozen=True)
class Trial:
    """What was measured on a specimen that is known."""

    truth: Sensor
    seen: Observations


def designed(library, resin: str) -> Sensor:
    """The paper's dome in a resin, with 0.3 mL behind it."""
    return material_sensor(library.load("materials", resin)).replace(dead_volume=DEAD_VOLUME)


def trial(
    nominal: Sensor,
    pressures: Sequence[float],
    runs: int,
    rng: np.random.Generator,
    model: str = "atlas",
    depth: float | None = None,
) -> Trial:
    """A specimen drawn around ``nominal`` and its runs at driving pressures in kPa, first contact read late or early;
    ``depth`` in mm (None: 0.75 R0)."""
    specimen = SimulatedSpecimens.draw(TRUTH.scatter, 1, rng).sensor(nominal, 0)
    depth = depth or 0.75 * nominal.dome.inner_radius
    pressed = press_curves(specimen, [p * KPA for p in pressures], depth, model)
    counted = rng.spawn(1)[0]
    curves = _runs(_deviated(pressed.curves, counted), pressures, runs, nominal, rng)
    late = OFFSET_PRIOR * counted.standard_normal()
    seen = tuple(replace(curve, indentation=curve.indentation - late) for curve in curves)
    return Trial(specimen, Observations(seen, rig=Rig(rate_Hz=RATE)))


def _deviated(curves: Sequence[PressCurve], rng: np.random.Generator) -> list[PressCurve]:
    """The curves with the least discrepancy that every interval counts (`discrepancy`): of all forces and of all rises
    one share each, and at each driving pressure a smooth one along the travel.

    Intervals hold a truth without an error that they count more often than they state.
    """
    common, deviated = rng.standard_normal(2), []
    for curve in curves:
        shape = _shape(curve.indentation / curve.indentation[-1])
        smooth = shape @ rng.standard_normal((shape.shape[1], 2))
        force, rise = np.exp(FLOOR[:2] * (common + smooth)).T
        deviated.append(replace(curve, force=curve.force * force, rise=curve.rise * rise))
    return deviated


def _runs(curves, pressures, runs: int, nominal: Sensor, rng: np.random.Generator) -> Iterator[MeasuredCurve]:
    for pressure, curve in zip(pressures, curves, strict=True):
        steps = TRUTH.protocol("steps", nominal.dome.inner_radius, curve.reach)
        for number in range(1, runs + 1):
            record = simulate_run(curve, steps, TRUTH.rig, RATE, rng, wall=TRUTH.wall, scatter=TRUTH.scatter)
            run = CampaignRun(
                file=f"{pressure:g}-{number}", sensor="A", resin="TangoPlus", driving_pressure_kPa=pressure, run=number
            )
            yield curve_of(run, blocks_of(Path(run.file), *record, rate=RATE), Rig(rate_Hz=RATE))


def held(
    one: Trial, nominal: Sensor, parameters: CalibrationParameters
) -> tuple[CalibrationFit, list[bool], list[float]]:
    """The fit to a trial, whether the intervals of modulus and dead volume hold the truth, and their half widths."""
    result = fit(one.seen, nominal, parameters)
    true = {MODULUS: float(np.log(one.truth.wall.shear_modulus)), DEAD: one.truth.gas.dead_volume}
    places = [parameters.fitted.index(k) for k in true]
    off = [abs(float(result.solution.at[place]) - value) for place, value in zip(places, true.values(), strict=True)]
    half = [float(result.half_width[place]) for place in places]
    return result, [o <= h for o, h in zip(off, half, strict=True)], half
