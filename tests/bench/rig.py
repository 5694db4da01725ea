"""Runs of a sensor that is known exactly: F = a d^n, rise = s F, on a rig with the faults of real ones."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from pneutouch.bench.indents import RunProtocol, protocol
from pneutouch.spec.campaign import CampaignRun
from pneutouch.units import KPA

HEADER = ("time_s", "position_mm", "force_N", "pressure_kPa")


@dataclass(frozen=True)
class Sensor:
    """Force law a d^n (N, mm), rise in MPa a newton, driving pressure in MPa; ``tau`` relaxes a share ``soft`` of the force."""

    stiffness: float = 0.25
    power: float = 1.5
    slope: float = 2.5 * KPA
    driving: float = 12 * KPA

    def force(self, depth):
        return self.stiffness * np.maximum(depth, 0.0) ** self.power


@dataclass(frozen=True)
class Dome(Sensor):
    """Nearly straight at first, then a hundred times as much, as the pressed solid dome is: a d exp(d / 2.4 mm)."""

    def force(self, depth):
        depth = np.maximum(depth, 0.0)
        return self.stiffness * depth * np.exp(depth / 2.4)


@dataclass(frozen=True)
class Faults:
    rate: float = 2000.0
    zero: float = 41.3
    backlash: float = 0.05
    position_noise: float = 0.003
    force_noise: float = 0.02
    force_zero: float = 0.13
    pressure_noise: float = 0.03 * KPA
    filter: float = 0.0
    missed: float = 0.0
    leak: float = 0.0


def record(kind="steps", sensor=Sensor(), faults=Faults(), what: RunProtocol | None = None, seed=0):
    """Samples (4, n) of a run: s, mm, N, MPa."""
    what = what or protocol(kind, 9.25)
    if kind == "steps" and what.rest == 30.0:
        what = what.quicker(6.0)
    rng, (knots, travels) = np.random.default_rng(seed), what.knots()
    time = np.arange(0, knots[-1] + 0.5, 1 / faults.rate)
    plate = np.interp(time, knots, travels)
    force = sensor.force(plate)
    driving = np.full(time.size, sensor.driving)
    if what.reset:
        rests = knots[:-1:4] if what.rest else np.array([])
        since = time - rests[np.searchsorted(rests, time, side="right") - 1]
        venting, filling = since < 0.3 * what.rest, (since >= 0.3 * what.rest) & (since < 0.6 * what.rest)
        driving[venting] = 0.0
        driving[filling] = sensor.driving * (1 - np.exp(-(since[filling] - 0.3 * what.rest) / 0.2))
    pressure = driving + sensor.slope * force - faults.leak * time
    if faults.filter:
        from scipy.signal import lfilter

        share = 1 - np.exp(-1 / (faults.rate * faults.filter))
        force = lfilter([share], [1, share - 1], force)
        pressure = lfilter([share], [1, share - 1], pressure - pressure[0]) + pressure[0]
    # The encoder sits on the motor: going out it moves before the plate does.
    out = np.gradient(plate) < -1e-9
    position = plate + faults.zero - np.where(out, faults.backlash, 0.0)
    samples = np.stack(
        [
            time,
            position + rng.normal(0, faults.position_noise, time.size) if faults.position_noise else position,
            force + faults.force_zero + rng.normal(0, 1, time.size) * faults.force_noise,
            pressure + rng.normal(0, 1, time.size) * faults.pressure_noise,
        ]
    )
    return samples[:, rng.random(time.size) >= faults.missed] if faults.missed else samples


def run_of(kind="steps", sensor=Sensor(), **more):
    return CampaignRun(
        file="run.csv", kind=kind, sensor="A1", resin="tango-plus", driving_pressure_kPa=sensor.driving / KPA, **more
    )


def write(path: Path, samples, header=HEADER, separator=",", before="", decimals=(6, 4, 5, 5)):
    """A CSV file in s, mm, N, kPa."""
    values = samples.copy()
    values[3] /= KPA
    line = separator.join(f"%.{count}f" for count in decimals[: len(header)]) + "\n"
    text = before + separator.join(header) + "\n" + (line * values.shape[1]) % tuple(values.T.ravel())
    path.write_text(text)
    return path


def small(kind="steps", depths=(1.0, 3.0, 5.0), sensor=Sensor(), **faults):
    """A quick run of three indentations."""
    what = replace(protocol(kind, 9.25), depths=depths, rest=4.0, hold=2.4)
    return record(kind, sensor, Faults(**{"rate": 1000.0, **faults}), what=what)
