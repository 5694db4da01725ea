"""Curves of the paper's press over what its protocol leaves open, and an emulator from which every reading is taken.

A press that was solved deep enough answers for every step, offset of the contact, limit of force and of the gauge.
``python -m benchmarks.protocol`` solves the design (ten minutes of processor time) and writes
docs/background/protocol-curves.json, from which `benchmarks.protocol_fit` fits.
"""

from __future__ import annotations

import itertools
from concurrent.futures import ProcessPoolExecutor
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from scipy.spatial.distance import cdist
from scipy.stats import qmc

from benchmarks.paper import resins
from benchmarks.store import LIBRARY, store
from benchmarks.table_s1 import Assumptions, scene
from pneutouch.arrays import Array
from pneutouch.errors import ComputationError
from pneutouch.evaluation.table_s1 import PRESSURES
from pneutouch.mechanics.events import range_end
from pneutouch.mechanics.models.solid import curve_between, press_settings, reported_events, solid_probe
from pneutouch.mechanics.paper_sensor import PAPER_WALL, material_sensor
from pneutouch.mechanics.solid.indent import indent
from pneutouch.mechanics.solid.inflate import inflate, state_at
from pneutouch.units import GAUGE_LIMIT, KPA

RIMS = ("base plane", "as printed")
BOX = {"modulus_MPa": (0.06, 20.0), "dead_volume_mL": (0.0, 1.0), "friction": (0.0, 1.0), "wall_mm": (1.35, 1.65)}
"""What the curves are solved over; the modulus on a scale of logarithms."""

POINTS, HELD_OUT = 160, 24
"""Places of the design, and further ones on which the emulator is judged."""
STEP, NODES = 0.5, 17
"""Travel between nodes of a curve, mm, and their number: beyond three quarters of R0, for a dome that has grown."""
LAST = 13
"""Steps of 0.5 mm within three quarters of R0: they end at 6.5 mm."""
SOFTEST = 0.11
"""Least modulus of a wall of 1.5 mm, MPa: 22 kPa is 0.78 of its limit pressure. Softer domes are left out."""
DEGREES = (3, 2)
"""Of the emulator's polynomials, in all and in everything but the modulus."""
NEARER = 2.0
"""Weight of a step in the modulus's logarithm in the distance between places; the box of the others is 2 wide."""


class Press(NamedTuple):
    """A press: logarithms of force (N) and rise (kPa) at the nodes (n,), continued beyond ``end``, the travel at which
    the wall buckles (mm; NaN: it does not), and the growth of the apex by the driving pressure, mm."""

    force: Array
    rise: Array
    end: float
    growth: float


def solved(place: Array, rim: str, pressure_kPa: float) -> Press | None:
    """The press at a place (4,) of `BOX`; None beyond the limit point of the inflation."""
    modulus, volume, friction, wall = place.tolist()
    sensor = scene(material_sensor(resins(LIBRARY)[0]), Assumptions(friction, rim, volume, "depth"))
    sensor = sensor.of_modulus(modulus).replace(
        wall_thickness=wall, depth=STEP * NODES, steps=NODES, break_stretch=None
    )
    probe = solid_probe(sensor)
    try:
        free = state_at(probe.solid, pressure_kPa * KPA, inflate(probe.solid, to_pressure=pressure_kPa * KPA))
    except ComputationError:
        return None
    pressed = indent(probe.solid, free, press_settings(sensor), probe)
    end = min(range_end(reported_events(pressed.events), np.inf), pressed.path[-1].indentation)
    nodes = STEP * np.arange(1, NODES + 1)
    inside = nodes[nodes <= end]
    force, rise = curve_between(pressed.path, np.append(inside, [end - 0.1, end]))
    columns = [
        np.append(np.log(y[:-2]), np.log(y[-1]) + (nodes[inside.size :] - end) * 10.0 * np.log(y[-1] / y[-2]))
        for y in (force, rise / KPA)
    ]
    growth = free.outer_apex - sensor.dome.shape.outer_radius
    return Press(columns[0], columns[1], end if inside.size < NODES else np.nan, growth)


def places() -> Array:
    """Places of the design and then those held out, (n, 4) in `BOX`: denser towards its faces, where the defaults are."""
    shares = 0.5 - 0.5 * np.cos(np.pi * qmc.Sobol(len(BOX), seed=1).random(256)[: POINTS + HELD_OUT])
    low, high = np.array(list(BOX.values())).T
    linear = low + (high - low) * shares
    linear[:, 0] = low[0] * (high[0] / low[0]) ** shares[:, 0]
    return linear


def design() -> dict[str, Any]:
    """Every press of the design as JSON, by rim and driving pressure in the order of `places`: the nodes' logarithms of
    force and rise, end and growth."""
    jobs = list(itertools.product(RIMS, PRESSURES, places()))
    with ProcessPoolExecutor() as pool:
        found = list(pool.map(solved, *([job[k] for job in jobs] for k in (2, 0, 1)), chunksize=4))
    rows = [None if one is None else [*map(_short, [*one.force, *one.rise, one.end, one.growth])] for one in found]
    count = POINTS + HELD_OUT
    return {
        rim: {f"{p:g}": rows[(2 * i + k) * count :][:count] for k, p in enumerate(PRESSURES)}
        for i, rim in enumerate(RIMS)
    }


def _short(value: float) -> float | None:
    return None if np.isnan(value) else round(float(value), 5)


class Emulator:
    """Presses between those of the design: polynomials over the modulus of the wall (its logarithm), dead volume,
    friction and wall, for the logarithms of force and rise at every node, of the end beyond 5 mm and of the growth, and
    what they leave over spread by distance (linear kernel)."""

    def __init__(self, known: dict[str, Any]) -> None:
        self.known = known
        powers = itertools.product(*[range(DEGREES[0] + 1)] * len(BOX))
        self.powers = np.array([p for p in powers if sum(p) <= DEGREES[0] and sum(p[1:]) <= DEGREES[1]])
        at = places()
        self.places = at[:POINTS][at[:POINTS, 0] * at[:POINTS, 3] / PAPER_WALL >= SOFTEST]

    @cached_property
    def weights(self) -> dict[tuple[str, float], Array]:
        """Coefficients (n_terms + n_places, 2 `NODES` + 2) of each rim and driving pressure."""
        at = places()
        rows = (np.arange(len(at)) < POINTS) & (at[:, 0] * at[:, 3] / PAPER_WALL >= SOFTEST)
        terms = self.basis(self.places)
        smooth, near, found = terms[:, : len(self.powers)], terms[:, len(self.powers) :], {}
        for rim, pressure in itertools.product(RIMS, PRESSURES):
            table = self.table(rim, pressure)[rows]
            known = np.isfinite(table)
            columns = [
                np.linalg.lstsq(smooth[k], y[k], rcond=None)[0]
                for k, y in zip(known.T, table.T, strict=True)
                if k.any()
            ]
            trend = np.stack(columns, axis=1)
            left = np.where(known, table, np.nan)[:, : trend.shape[1]] - smooth @ trend
            found[rim, pressure] = np.concatenate([trend, np.linalg.solve(near, np.nan_to_num(left))])
        return found

    def table(self, rim: str, pressure: float) -> Array:
        """What is emulated, at every place: NaN where there is no press, no end, or no growth."""
        none = [np.nan] * (2 * NODES + 2)
        rows = np.array([row or none for row in self.known[rim][f"{pressure:g}"]], dtype=np.float64)
        with np.errstate(invalid="ignore", divide="ignore"):
            rows[:, -2] = np.log(rows[:, -2] - 5.0)
            rows[:, -1] = np.where(pressure > 0.0, np.log(np.maximum(rows[:, -1], 1e-9)), np.nan)
        return rows

    def basis(self, at: Array) -> Array:
        """Chebyshev polynomials at places (n, 4), and distances to those of the design: (n, n_terms + n_places)."""
        here, there = self._scaled(at), self._scaled(self.places)
        each = [chebvander(here[:, k], DEGREES[0]) for k in range(len(BOX))]
        smooth = np.prod([v[:, self.powers[:, k]] for k, v in enumerate(each)], axis=0)
        stretch = np.array([NEARER * 0.5 * np.log(BOX["modulus_MPa"][1] / SOFTEST), 1.0, 1.0, 1.0])
        return np.concatenate([smooth, -cdist(here * stretch, there * stretch)], axis=1)

    def _scaled(self, at: Array) -> Array:
        """Places from -1 to 1, the modulus from the softest wall on."""
        low, high = np.array(list(BOX.values())).T
        share = (at - low) / (high - low)
        share[:, 0] = np.log(at[:, 0] / SOFTEST) / np.log(high[0] / SOFTEST)
        return 2.0 * share - 1.0

    def presses(self, basis: Array, printed: Array, pressure: float) -> Array:
        """Emulated table on a basis, between the two rims: ``printed`` (n,) is the share of the printed clamp."""
        if not printed.any():
            return basis @ self.weights[RIMS[0], pressure]
        plane, clamp = (basis @ self.weights[rim, pressure] for rim in RIMS)
        return plane + printed[:, None] * (clamp - plane)


class Reading(NamedTuple):
    """A rig's reading of presses, (n,) each: force up to which it presses (N), travel before contact (mm), share of the
    dome's growth that it counts as travel, and force that it reads over that of the relaxed wall."""

    limit: Array
    offset: Array
    grown: Array
    hold: Array


def sensitivities(table: Array, pressure: float, rig: Reading) -> Array:
    """Slopes of rise over force, kPa/N, of presses (n, 2 `NODES` + 1 or 2) read every 0.5 mm up to 6.5 mm of travel, the
    gauge's range, the force of the rig or the buckling, whichever comes first."""
    grown = rig.grown * np.exp(table[:, 2 * NODES + 1]) if pressure else 0.0
    at = np.arange(LAST + 1) + ((grown - rig.offset) / STEP)[:, None]
    at = np.clip(at, 0.0, NODES)
    first = np.clip(at.astype(int) - 1, 0, NODES - 3)
    t = at - first
    cubic = (
        -(t - 1) * (t - 2) * (t - 3) / 6,
        t * (t - 2) * (t - 3) / 2,
        -t * (t - 1) * (t - 3) / 2,
        t * (t - 1) * (t - 2) / 6,
    )
    columns = []
    for k in (0, 1):
        nodes = np.pad(np.exp(table[:, k * NODES : (k + 1) * NODES]), ((0, 0), (1, 0)))
        columns.append(sum(w * np.take_along_axis(nodes, first + j, axis=1) for j, w in enumerate(cubic)))
    force, rise = columns[0] * rig.hold[:, None], columns[1]
    end = np.nan_to_num(5.0 + np.exp(table[:, 2 * NODES]), nan=np.inf)
    inside = (STEP * at <= end[:, None]) & (rise + pressure <= GAUGE_LIMIT / KPA) & (force <= rig.limit[:, None])
    weight = np.logical_and.accumulate(inside, axis=1).astype(float)
    count = np.maximum(weight.sum(axis=1), 1.0)
    middle = (weight * force).sum(axis=1) / count
    spread = weight * (force - middle[:, None])
    with np.errstate(invalid="ignore", divide="ignore"):
        slopes: Array = (spread * rise).sum(axis=1) / (spread * force).sum(axis=1)
    return slopes


def held_out(emulator: Emulator) -> Array:
    """Relative errors of the emulated sensitivities at the places held out, without and with 0.3 mm before contact."""
    at = places()
    rows = np.arange(len(at)) >= POINTS
    rows &= at[:, 0] * at[:, 3] / PAPER_WALL >= SOFTEST
    off = []
    for (i, rim), pressure, offset in itertools.product(enumerate(RIMS), PRESSURES, (0.0, 0.3)):
        full = np.ones(rows.sum())
        rig = Reading(np.inf * full, offset * full, 0.0 * full, full)
        true = sensitivities(emulator.table(rim, pressure)[rows], pressure, rig)
        off.append(
            sensitivities(emulator.presses(emulator.basis(at[rows]), i * full, pressure), pressure, rig) / true - 1.0
        )
    return np.concatenate(off)


if __name__ == "__main__":
    store("protocol-curves", design(), None)
