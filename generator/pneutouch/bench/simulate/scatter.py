"""A parameter of the simulator: declared once, with unit, default and the reason for it.

Scatter between specimens of one resin and between runs of one specimen.

The memory of the wall: force and pressure above the relaxed curve, as a sum of decaying terms.

A standard linear solid on the curve: each term follows q' + q/tau = share f', with f the relaxed force or pressure
rise. No Prony data of TangoPlus or its digital materials are published: shares and times are the simulator's own.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.protocol import RunProtocol
from pneutouch.mechanics.sensor import Sensor
from pneutouch.results.simulation import ParameterValue
from pneutouch.units import KPA


def parameter(default: Any, unit: str, reason: str) -> Any:
    """A dataclass field in an internal unit, with the reason for its default."""
    return field(default=default, metadata={"unit": unit, "reason": reason})


def parameters(model: Any) -> dict[str, ParameterValue]:
    """Value, unit and reason of each parameter of a dataclass, by name; an infinite value is null."""
    listed = {}
    for one in fields(model):
        value = getattr(model, one.name)
        value = None if value == float("inf") else value
        listed[one.name] = ParameterValue(value, one.metadata["unit"], one.metadata["reason"])
    return listed


YEAR = 365.0
"""Days."""

_LEAST_WALL = 0.05
"""Share of the nominal wall that a specimen has at least."""


@dataclass(frozen=True, slots=True)
class ScatterModel:
    """Differences between specimens and between runs; internal units."""

    modulus: float = parameter(
        0.04,
        "ln",
        "standard deviation of the modulus' logarithm: hardness spread of the paper's Table 1 (TangoPlus 1.0 Shore A) "
        "times Gent's slope, 0.042 at Shore A 27.6",
    )
    wall: float = parameter(
        0.10, "mm", "greatest deviation of the wall, even within: accuracy of the PolyJet machine (printprofiles)"
    )
    dead_volume: float = parameter(
        20.0,
        "mm3",
        "most extra air behind a specimen, even from none: 4 mm of a 2.5 mm bore, how far a tube is pushed on; our "
        "choice",
    )
    ageing: float = parameter(
        0.0,
        "ln/year",
        "change of the modulus' logarithm in the first year; set from the resin's hardness by Gent's relation",
    )
    gain: float = parameter(
        0.002, "1", "standard deviation of a run's gain on the pressure rise: paper, Table S1, 0.0051 of 2.547 kPa/N"
    )
    reset: float = parameter(
        0.05 * KPA,
        "MPa",
        "standard deviation of the driving pressure each time it is set: our choice, a hand regulator; "
        "its effect upon the curve, under 0.1 % of the sensitivity, is left to the gain",
    )

    @classmethod
    def none(cls) -> ScatterModel:
        """No scatter at all."""
        return cls(modulus=0.0, wall=0.0, dead_volume=0.0, gain=0.0, reset=0.0)


@dataclass(frozen=True, slots=True)
class SimulatedSpecimens:
    """Specimens that were drawn, arrays (n,): factor on the modulus, deviation of the wall (mm), extra air (mm3)."""

    modulus: Array
    wall: Array
    dead_volume: Array

    @classmethod
    def draw(cls, scatter: ScatterModel, count: int, rng: np.random.Generator) -> SimulatedSpecimens:
        """``count`` specimens."""
        return cls(
            np.exp(scatter.modulus * rng.standard_normal(count)),
            scatter.wall * rng.uniform(-1.0, 1.0, count),
            scatter.dead_volume * rng.uniform(0.0, 1.0, count),
        )

    def sensor(self, nominal: Sensor, k: int, factor: float = 1.0) -> Sensor:
        """The k-th specimen of a nominal sensor, its modulus times ``factor`` for its age."""
        stiffer = stiffened(nominal, float(self.modulus[k]) * factor)
        wall = max(nominal.dome.wall_thickness + float(self.wall[k]), _LEAST_WALL * nominal.dome.wall_thickness)
        return stiffer.replace(wall_thickness=wall, dead_volume=nominal.gas.dead_volume + float(self.dead_volume[k]))


def ageing_factor(scatter: ScatterModel, days: float) -> float:
    """Factor on the modulus after ``days``: even in its logarithm over the first year, then none.

    The paper measured at the ends of a year alone (Table 1); what lies between and after is our choice.
    """
    return float(np.exp(scatter.ageing * min(days / YEAR, 1.0)))


def stiffened(sensor: Sensor, factor: float) -> Sensor:
    """The sensor with every modulus of its wall times ``factor``."""
    law = sensor.wall.law
    if law is not None:
        name, constants = law
        law = name, tuple(c if name == "ogden" and k % 2 else c * factor for k, c in enumerate(constants))
    return sensor.replace(shear_modulus=sensor.wall.shear_modulus * factor, law=law)


_ASSUMED = "the simulator's own, no data published; small, as the paper's Fig. S1 shows"

_RATE = 50.0
"""Samples a second at which the memory of a protocol is added up."""


@dataclass(frozen=True, slots=True)
class WallMemory:
    """Terms of the memory: shares of force and of pressure rise, and times in s; equally many each."""

    force: tuple[float, ...] = parameter((0.01, 0.01, 0.01), "1", _ASSUMED)
    rise: tuple[float, ...] = parameter(
        (0.002, 0.002, 0.002), "1", _ASSUMED + "; less than of the force: the air keeps it"
    )
    times: tuple[float, ...] = parameter(
        (1.0, 10.0, 100.0), "s", _ASSUMED + "; a decade apart, within a relaxation run"
    )

    def over(self, values: Array, shares: tuple[float, ...], step: float) -> Array:
        """Contribution of the memory to relaxed values (n, ...) at equal ``step`` in s along the first axis."""
        parts = [share * part for share, part in zip(shares, self.terms(values, step), strict=True)]
        return np.asarray(sum(parts, np.zeros_like(values)))

    def terms(self, values: Array, step: float) -> list[Array]:
        """Each term with share one; exact for values that go straight between samples."""
        from scipy.signal import lfilter

        change = np.diff(values, axis=0, prepend=values[:1])
        terms = []
        for time in self.times:
            fade = np.exp(-step / time)
            terms.append(np.asarray(lfilter([(1.0 - fade) * time / step], [1.0, -fade], change, axis=0)))
        return terms

    def held(self, protocol: RunProtocol, nodes: Array) -> tuple[Array, Array]:
        """Contribution of the memory at the end of every hold, as matrices (depths, nodes) on relaxed values at travels
        ``nodes``.

        The first is for the force, the second for the rise, which counts from before the plate moves in. Between the
        nodes the curve counts as straight."""
        knots, travels = protocol.knots()
        count = round(float(knots[-1]) * _RATE) + 1
        travel = np.clip(np.interp(np.arange(count) / _RATE, knots, travels), 0.0, nodes[-1])
        ends = np.minimum(np.floor(knots[3::4] * _RATE + 1e-9).astype(int), count - 1)
        begins = np.floor(knots[1::4] * _RATE + 1e-9).astype(int)
        terms = self.terms(_hats(travel, nodes), 1.0 / _RATE)
        empty = np.zeros((ends.size, nodes.size))
        force = sum((s * t[ends] for s, t in zip(self.force, terms, strict=True)), empty)
        rise = sum((s * (t[ends] - t[begins]) for s, t in zip(self.rise, terms, strict=True)), empty)
        return np.asarray(force), np.asarray(rise)


def _hats(travel: Array, nodes: Array) -> Array:
    """Weights (n, m) of values at nodes for a straight interpolation at travels (n,)."""
    k = np.clip(np.searchsorted(nodes, travel, side="right") - 1, 0, nodes.size - 2)
    share = (travel - nodes[k]) / (nodes[k + 1] - nodes[k])
    weights = np.zeros((travel.size, nodes.size))
    rows = np.arange(travel.size)
    weights[rows, k], weights[rows, k + 1] = 1.0 - share, share
    return weights
