"""Simulated campaigns of sensors that deviate from every model, calibrated: what the intervals then hold."""

from __future__ import annotations

import contextlib
import json
import tomllib
from dataclasses import dataclass

import numpy as np

from pneutouch.bench.calibrate.fitted_atlas import FLOOR
from pneutouch.bench.simulate.curve import ModelDeviation
from pneutouch.bench.simulate.rig import ScatterModel
from pneutouch.bench.simulate.runs import SimulationTruth
from pneutouch.catalogue import Library
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.mechanics.models.accuracy import NUMERICAL
from pneutouch.mechanics.uncertainty.sources.calibrated import FORCE_GAUGE
from pneutouch.mechanics.uncertainty.sources.model_error import GAUGE
from pneutouch.spec.options import CalibrationOptions, SimulationOptions
from pneutouch.spec.toml_text import assignments, toml_text
from pneutouch.workflows.calibrate.calibrate import run_calibration
from pneutouch.workflows.simulate import simulate

MEASURED, UNSEEN = (0.0, 6.0, 12.0), 9.0
DESIGN, DEAD = "paper-dome", {"pneumatics.dead_volume_mL": 0.3}
RADIUS, RADIUS_ERROR = 9.25, 0.05
"""Inner radius as designed, and half of the diameter's greatest error (printprofiles), mm."""

AGEING = 0.148
"""Change of the sensitivity of TangoPlus in a year (paper, Supplement E)."""

TRUTH = SimulationTruth(
    # The prior of the modulus: four published estimates, 29 %. Of the model's error in sensitivity, 6 %: three quarters
    # of the variance common to all driving pressures, as Table S1 shows at 0 and 22 kPa, the rest by the smooth shares.
    scatter=ScatterModel(modulus=0.29),
    deviation=ModelDeviation(common=0.037, smooth=0.012),
    rest=5.0,
    specimens=20,
)


@dataclass(frozen=True)
class Interval:
    """An interval of the sensitivity, and the truth."""

    low: float
    high: float
    truth: float

    @property
    def width(self) -> float:
        return float(np.log(self.high / self.low))

    @property
    def holds(self) -> bool:
        return self.low <= self.truth <= self.high


@dataclass(frozen=True)
class Outcome:
    """Intervals before and after a calibration at one driving pressure: as now, and for a year of use."""

    before: Interval
    after: Interval
    before_year: Interval
    after_year: Interval


def campaigns(count: int, folder) -> list[dict[float, Outcome]]:
    """The first ``count`` campaigns whose resin is as stiff as the published range and the atlas begin, 0.10 MPa."""
    outcomes, seed = [], 0
    while len(outcomes) < count:
        with contextlib.suppress(InputError):
            outcomes.append(campaign(seed, folder))
        seed += 1
        assert seed < 1.2 * count
    return outcomes


def campaign(seed: int, folder) -> dict[float, Outcome]:
    """Simulate, calibrate without the runs at `UNSEEN`, and compare with the truth; ``folder`` is the user's."""
    options = SimulationOptions(
        specimens=1,
        driving_pressures_kPa=[*MEASURED, UNSEEN],
        runs=2,
        kinds=["steps"],
        rate_Hz=50.0,
        seed=seed,
        model="atlas",
    )
    radius = RADIUS + RADIUS_ERROR * np.random.default_rng([seed, 8]).uniform(-1, 1)
    place = simulate(DESIGN, folder / str(seed), {**DEAD, "membrane.inner_radius_mm": radius}, options, truth=TRUTH)
    path = place / "campaign.toml"
    content = tomllib.loads(path.read_text())
    # The specimen has a radius of its own; what is calibrated is the design.
    content["assignments"] = assignments(DEAD)
    content["runs"] = [run for run in content["runs"] if run.get("driving_pressure_kPa", 0.0) != UNSEEN]
    path.write_text(toml_text(content))
    name = f"seed-{seed}"
    fitted = ["modulus", "wall", "dead-volume", "offset"]
    run_calibration(place, None, CalibrationOptions(fit=fitted, save=name), folder / str(seed))
    (truth,) = json.loads((place / "truth.json").read_text())["specimens"].values()
    return _outcomes(name, truth["pressures"], np.random.default_rng([seed, 7]))


def _outcomes(name, truth, rng) -> dict[float, Outcome]:
    changes = {**DEAD, "pneumatics.driving_pressures_kPa": sorted((*MEASURED, UNSEEN))}
    # What the rig reads is off by its gauges; the year changes the sensor, either way.
    read = (1 + GAUGE * rng.uniform(-1, 1)) / (1 + FORCE_GAUGE * rng.uniform(-1, 1))
    year = 1 + AGEING * rng.uniform(-1, 1)
    # What the simulator has right and the budget counts: discretisation, and the least shares of force and of rise.
    other = 1 + NUMERICAL["atlas"] * rng.uniform(-1, 1)
    force, rise = np.exp(FLOOR[:2] * rng.standard_normal(2))
    other *= rise / force
    library, outcomes = Library.default(), {}
    plain, calibrated = (
        evaluate(design, changes, model="atlas", library=library).uncertainty for design in (DESIGN, f"{DESIGN}@{name}")
    )
    for pressure, old, new in zip(changes["pneumatics.driving_pressures_kPa"], plain, calibrated, strict=True):
        one, two = (entry.known["sensitivity_kPa_per_N"] for entry in (old, new))
        true = truth[f"{pressure:g}"]["sensitivity_kPa_per_N"] * other / read
        fresh = np.exp(2 * one.standard_uncertainty_relative * np.sqrt(1 - one.shares["ageing"]))
        outcomes[pressure] = Outcome(
            Interval(one.value / fresh, one.value * fresh, true),
            Interval(two.at_calibration.low, two.at_calibration.high, true),
            Interval(one.low, one.high, true * year),
            Interval(two.low, two.high, true * year),
        )
    return outcomes
