"""Sensors and measured curves made for the tests: the atlas's or the solid's answers with gain, zero and noise."""

from __future__ import annotations

import numpy as np

from pneutouch.bench.calibrate.fitted_atlas import injected
from pneutouch.bench.calibrate.observations import Injection, Observations
from pneutouch.bench.calibrate.parameters import parameters
from pneutouch.bench.record import MeasuredCurve
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.atlas.table import shipped
from pneutouch.mechanics.sensor import Dome, GasCircuit, IndentationProtocol, Sensor, WallMaterial
from pneutouch.shape.hemisphere import Hemisphere
from pneutouch.spec.campaign import CampaignRun
from pneutouch.units import KPA

DESIGNED = Sensor(
    Dome(Hemisphere(9.25, 1.5)),
    WallMaterial(0.17, 0.49),
    GasCircuit(ambient_pressure=0.101325, dead_volume=1000.0, gauge_limit=0.1),
    IndentationProtocol(plate_radius=15.0, depth=6.5, steps=13),
)
GAIN, FORCE_ZERO, RISE_ZERO = 0.01, 0.003, 0.02 * KPA
FORCE_NOISE, RISE_NOISE = 0.005, 0.03 * KPA


def run(pressure: float, number: int = 1) -> CampaignRun:
    return CampaignRun(
        file=f"{pressure:g}-{number}.csv", sensor="A", resin="TangoPlus", driving_pressure_kPa=pressure, run=number
    )


def disturbed(at, force, rise, pressure, number, rng, gain=GAIN) -> MeasuredCurve:
    """A run: its own gain and zero on each channel, and noise at each point; the origin stays."""
    size = at.size - 1
    force, rise = force.copy(), rise.copy()
    force[1:] = force[1:] * (1 + gain * rng.normal()) + FORCE_ZERO * rng.normal() + FORCE_NOISE * rng.normal(size=size)
    rise[1:] = rise[1:] * (1 + gain * rng.normal()) + RISE_ZERO * rng.normal() + RISE_NOISE * rng.normal(size=size)
    return MeasuredCurve(run(pressure, number), at, force, rise, pressure * KPA)


def curves(truth: Sensor, pressures, runs: int, rng, gain=GAIN, offset=0.0) -> tuple[MeasuredCurve, ...]:
    """Runs of the atlas's sensor at pressures in kPa; ``offset`` is travel that was not seen."""
    result = respond(batch_of(truth, [p * KPA for p in pressures]), truth.protocol.steps)
    return tuple(
        disturbed(np.maximum(result.indentation[i] - offset, 0.0), result.force[i], result.rise[i], p, n + 1, rng, gain)
        for i, p in enumerate(pressures)
        for n in range(runs)
    )


def softer(truth: Sensor, runs: int, gain=GAIN) -> tuple[MeasuredCurve, ...]:
    """Runs without driving pressure of a wall softer than any of the atlas, extrapolated from two that it holds."""
    walls = (truth.replace(shear_modulus=modulus, break_stretch=None) for modulus in (0.102, 0.13))
    low, high = (curves(wall, (0.0,), runs, np.random.default_rng(1), gain) for wall in walls)
    return tuple(
        MeasuredCurve(a.run, a.indentation, 2 * a.force - b.force, 2 * a.rise - b.rise, a.driving)
        for a, b in zip(low, high, strict=True)
    )


def exact(truth: Sensor, pressures) -> tuple[MeasuredCurve, ...]:
    result = respond(batch_of(truth, [p * KPA for p in pressures]), truth.protocol.steps)
    return tuple(
        MeasuredCurve(run(p), result.indentation[i], result.force[i], result.rise[i], p * KPA)
        for i, p in enumerate(pressures)
    )


def injections(truth: Sensor, volumes, runs: int, rng, gain=0.002, noise=0.03 * KPA) -> tuple[Injection, ...]:
    """Air pushed into the atlas's sensor."""
    slices = shipped().slices(np.array([truth.dome.wall_thickness / truth.dome.inner_radius]), ())
    size, mu = truth.dome.inner_radius**3, truth.wall.shear_modulus
    result, ok = injected(
        slices,
        np.zeros(1, dtype=np.intp),
        np.array([truth.gas.ambient_pressure / mu]),
        np.array([truth.gas.dead_volume / size]),
        volumes / size,
    )
    assert ok.all()
    return tuple(
        Injection(
            f"injection {n}",
            volumes,
            result[0] * mu * (1 + gain * rng.normal()) + noise * rng.normal(size=volumes.size),
        )
        for n in range(runs)
    )


def observed(*parts) -> Observations:
    return Observations(*parts)


def chosen(library, *names, priors=True, sensor=DESIGNED):
    return parameters(
        sensor,
        library.load("materials", "TangoPlus"),
        library.load("printers", "objet260-connex"),
        names,
        priors=priors,
    )


def other(**changes) -> Sensor:
    return DESIGNED.replace(**changes)
