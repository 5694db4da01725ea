"""The simulated rig: noise, drift, play and ranges of its instruments, scatter of runs, and memory of the wall.

Each parameter is declared once, with unit, default and reason, in the TOML file beside this module. The wall's memory
is a standard linear solid on the curve: each term follows q' + q/tau = share f', with f the relaxed force or pressure
rise. No Prony data of TangoPlus or its digital materials are published: shares and times are the simulator's own.
"""

import io
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.indents import RunProtocol
from pneutouch.errors import InputError
from pneutouch.mechanics.gauge_reading import GaugeReading
from pneutouch.mechanics.sensor import Sensor
from pneutouch.results.simulation import ParameterValue
from pneutouch.texture.sliding import NOISE, STEP
from pneutouch.units import GAUGE_LIMIT, KPA
from pneutouch.wording import data_of

MINUTE = 60.0

_STATED = data_of(__file__)
"""Value, unit and reason of each parameter, by name."""

_SCALES = {"kPa": KPA, "kPa/min": KPA / MINUTE, "N/min": 1.0 / MINUTE, "1/min": 1.0 / MINUTE}
"""Values inside the program of the units that parameters are stated in."""


def parameter(name: str, default: Any = None) -> Any:
    """Dataclass field in an internal unit, with the reason for its default; None: the default stated in the file."""
    stated = _STATED[name]
    if default is None:
        value = stated["value"]
        default = tuple(value) if isinstance(value, list) else value * _SCALES.get(stated.get("in"), 1.0)
    return field(default=default, metadata={"unit": stated["unit"], "reason": stated["reason"]})


def parameters(model: Any) -> dict[str, ParameterValue]:
    """Value, unit and reason of each parameter of a dataclass, by name; the value is None if it is infinite."""
    listed = {}
    for one in fields(model):
        value = getattr(model, one.name)
        value = None if value == float("inf") else value
        listed[one.name] = ParameterValue(value, one.metadata["unit"], one.metadata["reason"])
    return listed


YEAR = 365.0
"""Days in a year."""

_LEAST_WALL = 0.05
"""Least wall thickness of a specimen as a share of the nominal one."""


@dataclass(frozen=True, slots=True)
class ScatterModel:
    """Differences between specimens and between runs; internal units."""

    modulus: float = parameter("modulus")
    wall: float = parameter("wall")
    dead_volume: float = parameter("dead_volume")
    ageing: float = parameter("ageing")
    gain: float = parameter("gain")
    reset: float = parameter("reset")

    @classmethod
    def none(cls) -> "ScatterModel":
        """No scatter and no ageing."""
        return cls(modulus=0.0, wall=0.0, dead_volume=0.0, gain=0.0, reset=0.0)


@dataclass(frozen=True, slots=True)
class SimulatedSpecimens:
    """Drawn specimens, arrays (n,): factor on the modulus, deviation of the wall (mm), extra dead volume (mm3)."""

    modulus: Array
    wall: Array
    dead_volume: Array

    @classmethod
    def draw(cls, scatter: ScatterModel, count: int, rng: "np.random.Generator") -> "SimulatedSpecimens":
        """Draw ``count`` specimens."""
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
    """Factor on the modulus after ``days``: its logarithm grows linearly over the first year, then stays.

    The paper measured only at the beginning and the end of a year (Table 1); the course between is our choice."""
    return float(np.exp(scatter.ageing * min(days / YEAR, 1.0)))


def stiffened(sensor: Sensor, factor: float) -> Sensor:
    """The sensor with every modulus of its wall times ``factor``."""
    law = sensor.wall.law
    if law is not None:
        name, constants = law
        law = name, tuple(c if name == "ogden" and k % 2 else c * factor for k, c in enumerate(constants))
    return sensor.replace(shear_modulus=sensor.wall.shear_modulus * factor, law=law)


_RATE = 50.0
"""Samples per second at which the memory of a protocol is integrated."""


@dataclass(frozen=True, slots=True)
class WallMemory:
    """Wall memory: for each term its shares of force and of pressure rise, and its time constant in s."""

    force: tuple[float, ...] = parameter("force")
    rise: tuple[float, ...] = parameter("rise")
    times: tuple[float, ...] = parameter("times")

    def over(self, values: Array, shares: tuple[float, ...], step: float) -> Array:
        """Contribution of the memory, (n, ...), to relaxed values at equal ``step`` (s) along the first axis."""
        parts = [share * part for share, part in zip(shares, self.terms(values, step), strict=True)]
        return np.asarray(sum(parts, np.zeros_like(values)))

    def terms(self, values: Array, step: float) -> list[Array]:
        """Terms of the memory for a share of 1, each (n, ...); exact for values that are linear between samples."""
        from scipy.signal import lfilter

        change = np.diff(values, axis=0, prepend=values[:1])
        terms = []
        for time in self.times:
            fade = np.exp(-step / time)
            terms.append(np.asarray(lfilter([(1.0 - fade) * time / step], [1.0, -fade], change, axis=0)))
        return terms

    def held(self, protocol: RunProtocol, nodes: Array) -> tuple[Array, Array]:
        """Matrices (depths, nodes) that give the memory's contribution at the end of every hold from relaxed values at
        ``nodes``, travels (mm).

        The first is for the force, the second for the rise less its value before the plate moves in. The curve is taken
        as linear between ``nodes``."""
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
    """Weights (n, m) of the values at m nodes for linear interpolation at travels (n,)."""
    k = np.clip(np.searchsorted(nodes, travel, side="right") - 1, 0, nodes.size - 2)
    share = (travel - nodes[k]) / (nodes[k + 1] - nodes[k])
    weights = np.zeros((travel.size, nodes.size))
    rows = np.arange(travel.size)
    weights[rows, k], weights[rows, k + 1] = 1.0 - share, share
    return weights


@dataclass(frozen=True, slots=True)
class RigModel:
    """Noise, drift and play of a rig; internal units. Zero offsets are drawn once a run."""

    force_noise: float = parameter("force_noise")
    pressure_noise: float = parameter("pressure_noise", NOISE)
    pressure_step: float = parameter("pressure_step", STEP)
    cutoff: float = parameter("cutoff")
    force_range: float = parameter("force_range")
    pressure_range: float = parameter("pressure_range", GAUGE_LIMIT)
    force_drift: float = parameter("force_drift")
    temperature: float = parameter("temperature")
    leak: float = parameter("leak")
    backlash: float = parameter("backlash")
    position_noise: float = parameter("position_noise")
    missed: float = parameter("missed")
    force_zero: float = parameter("force_zero")
    pressure_zero: float = parameter("pressure_zero")
    position_zero: float = parameter("position_zero")

    @classmethod
    def perfect(cls) -> "RigModel":
        """A rig that reads the true values."""
        unlimited = dict.fromkeys(("cutoff", "force_range", "pressure_range"), np.inf)
        return cls(**{one.name: unlimited.get(one.name, 0.0) for one in fields(cls)})

    def with_gauge(self, reading: GaugeReading) -> "RigModel":
        """The rig with a gauge's noise, step and range, each where it is stated and this rig has the default."""
        paper = RigModel()
        gauge = {"pressure_noise": reading.noise, "pressure_step": reading.step, "pressure_range": reading.limit}
        changed = {
            key: value
            for key, value in gauge.items()
            if value is not None and getattr(self, key) == getattr(paper, key)
        }
        return replace(self, **changed)

    def share(self, rate: float) -> float:
        """Weight of the latest sample in the low pass at a sampling rate, Hz."""
        return float(-np.expm1(-2.0 * np.pi * self.cutoff / rate))

    def passed(self, values: Array, rate: float, start: float) -> Array:
        """Values (n,) at ``rate`` Hz after the low pass, whose output was ``start`` before the first."""
        share = self.share(rate)
        if share >= 1.0:
            return values
        from scipy.signal import lfilter

        return np.asarray(lfilter([share], [1.0, share - 1.0], values, zi=[(1.0 - share) * start])[0])

    def noise(self, rate: float) -> tuple[float, float]:
        """Standard deviations of a sample of force (N) and pressure (MPa) in the file: filtered, then rounded.

        Rounding adds step^2/12 where the noise is at least half a step (Sheppard)."""
        share = self.share(rate)
        kept = np.sqrt(share / (2.0 - share))
        pressure = np.hypot(self.pressure_noise * kept, self.pressure_step / np.sqrt(12))
        return float(self.force_noise * kept), float(pressure)

    def drift(self, driving: float) -> float:
        """Drift of the shut-in pressure, MPa/s, at a driving pressure (MPa): warming less leak."""
        return self.temperature - self.leak * driving

    def stepped(self, pressure: Array) -> Array:
        """Pressure (MPa) as the recorder writes it: in steps, within its range."""
        if self.pressure_step > 0:
            pressure = self.pressure_step * np.round(pressure / self.pressure_step)
        return np.clip(pressure, -self.pressure_range, self.pressure_range)


LEAK_SECONDS = 600.0
"""Duration of a leak run, s: our choice, as long as the relaxation run."""

MARK = "# simulated by pneutouch"
"""Comment that marks every simulated file."""

_DECIMALS = {"time_s": 6, "position_mm": 5, "force_N": 5, "pressure_kPa": 6, "volume_mL": 4}
"""Decimals of each column in a file: a hundredth of the finest noise."""


def encoded(columns: dict[str, Array], *, parquet: bool = False) -> bytes:
    """Columns (`_DECIMALS`) as CSV or parquet, marked as simulated. Raises InputError if pyarrow is missing."""
    rounded = {name: np.round(values, _DECIMALS[name]) + 0.0 for name, values in columns.items()}
    if not parquet:
        from pandas import DataFrame

        return f"{MARK}\n{DataFrame(rounded).to_csv(index=False, lineterminator=chr(10))}".encode()
    try:
        import pyarrow
        from pyarrow import parquet as files
    except ImportError:
        remedy = "pip install 'pneutouch[parquet]', or leave it out for CSV"
        raise InputError("needs pyarrow", key="parquet", remedy=remedy) from None
    table = pyarrow.table(rounded).replace_schema_metadata({"comment": MARK.removeprefix("# ")})
    target = io.BytesIO()
    files.write_table(table, target)
    return target.getvalue()
