"""Readings of a sensor under objects of one kind, by what distinguishes them and by the force that presses them.

The objects are rigid plates and balls, by their curvature, or soft blocks, by their compliance; both begin at a rigid
plate. They press centrally, and the force stays the same while the driving pressure changes.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from pneutouch.arrays import Array
from pneutouch.catalogue import DesignSource
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.evaluation.reader import curve_of
from pneutouch.spec.contact import SOFTNESS, ContactTable
from pneutouch.spec.read import Changes

ObjectProperty = Literal["radius", "modulus"]
"""Property that distinguishes the objects of a table."""

NODES = {"radius": 7, "modulus": 5}
GRID, LEAST = (121, 1200), 0.03
"""Numbers of objects that press the sensor; objects and forces of the grid, and its least force over the greatest that
every reading of the least object holds: our choices. Readings between nodes are within 0.5 % of those of a press
(tests/workflows/test_discriminate.py)."""

RIGID = 1e4
"""Modulus, MPa, of a block that is as good as rigid."""

_STEPS = 10
"""Steps of a press by a block: with 28 the rises change by less than 0.6 %."""

_CENTRAL: Changes = {
    "contact.object": "plate",
    **dict.fromkeys(("contact.friction", "contact.offset_mm", "contact.tilt_deg", "contact.shear_mm"), 0.0),
    **{f"contact.{key}": getattr(ContactTable(), key) for key in ("plate_rim_mm", *SOFTNESS)},
}
"""Contact whatever that of the design is: what it says of friction and place holds for its own object."""


@dataclass(frozen=True)
class ObjectTable:
    """Readings of a sensor under objects pressed centrally (readings, objects, forces); NaN beyond the range.

    Attributes:
        pressures_kPa: Driving pressures (k,).
        objects: Curvatures, 1/mm, or compliances, 1/MPa, from 0 of a rigid plate (m,).
        forces: In equal steps of the logarithm, N (n,).
        readings: Rises at the driving pressures, MPa, and then, if they are read, the travels there, mm.
    """

    pressures_kPa: Array
    objects: Array
    forces: Array
    readings: Array

    def at(self, one: float, force: float) -> Array:
        """Readings of an object at a force; NaN beyond the range and below the forces of the table."""
        if force < self.forces[0] * (1.0 - 1e-9):
            return np.full(len(self.readings), np.nan)
        row = np.interp(one, self.objects, np.arange(len(self.objects)))
        column = np.interp(math.log(force), np.log(self.forces), np.arange(len(self.forces)))
        i, j = min(int(row), len(self.objects) - 2), min(int(column), len(self.forces) - 2)
        a, b = row - i, column - j
        here = self.readings[:, i : i + 2, j : j + 2]
        weights = np.outer([1.0 - a, a], [1.0 - b, b])
        return np.asarray(np.einsum("kij,ij->k", np.where(weights > 0.0, here, 0.0), weights))

    def reach(self, one: float) -> float:
        """Greatest force of the grid that every reading of an object holds, N."""
        row = int(np.ceil(np.interp(one, self.objects, np.arange(len(self.objects))) - 1e-9))
        held = np.isfinite(self.readings[:, row]).all(axis=0)
        return float(self.forces[np.flatnonzero(held)[-1]]) if held.any() else 0.0

    def of(self, objects: Sequence[float]) -> "ObjectTable":
        """The table of some objects only."""
        at = np.interp(objects, self.objects, np.arange(len(self.objects)))
        low = np.minimum(at.astype(int), len(self.objects) - 2)
        share = (at - low)[:, None]
        # Where the share is nothing the other row does not count, though it may be beyond the range.
        mixed = (1.0 - share) * self.readings[:, low] + share * self.readings[:, low + 1]
        rows = np.where(share > 0.0, mixed, self.readings[:, low])
        return ObjectTable(self.pressures_kPa, np.asarray(objects, dtype=float), self.forces, rows)


def object_table(
    design: str | DesignSource,
    changes: Changes | None,
    pressures_kPa: Sequence[float],
    least: float,
    grid: tuple[int, int] = GRID,
    told: ObjectProperty = "radius",
    travels: bool = False,
    thickness_mm: float | None = None,
) -> ObjectTable:
    """Press the sensor of a design by plates and balls down to the radius ``least`` (mm), or by blocks, deep or of a
    thickness, down to that modulus (MPa). Raises InputError as `evaluate` does, and where an object cannot press it."""
    from scipy.interpolate import PchipInterpolator

    count = NODES[told]
    nodes = np.linspace(0.0, 1.0 / least, count)
    keys = [_keys(told, float(node), thickness_mm) for node in nodes]
    curves = [_pressed(design, {**(changes or {}), **one}, pressures_kPa, travels) for one in keys]
    greatest, weakest = (min(float(force[-1]) for force, _ in states) for states in (curves[0], curves[-1]))
    forces = np.geomspace(LEAST * min(weakest, greatest), greatest, grid[1])
    channels = len(pressures_kPa) * (2 if travels else 1)
    known = np.full((channels, count, grid[1]), np.nan)
    for (i, states), k in itertools.product(enumerate(curves), range(channels)):
        force, reading = states[k]
        held = forces <= force[-1] * (1.0 + 1e-9)
        known[k, i, held] = PchipInterpolator(force, reading)(forces[held])
    fine = np.linspace(0.0, nodes[-1], grid[0])
    readings = np.full((channels, *grid), np.nan)
    for k, j in itertools.product(range(channels), range(grid[1])):
        # The range of the last objects ends at a smaller force than a plate's: what is known are the first nodes.
        found = count if np.isfinite(known[k, :, j]).all() else int(np.isfinite(known[k, :, j]).argmin())
        if found == 0:
            continue
        inside = fine <= nodes[found - 1] * (1.0 + 1e-9)
        row = PchipInterpolator(nodes[:found], known[k, :found, j])(fine[inside]) if found > 1 else known[k, :1, j]
        readings[k, inside, j] = row
    return ObjectTable(np.asarray(pressures_kPa, dtype=float), fine, forces, readings)


def _keys(told: ObjectProperty, node: float, thickness_mm: float | None) -> Changes:
    """Keys of a design for an object of a curvature or compliance."""
    if told == "radius":
        ball = {"contact.object": "ball", "contact.ball_radius_mm": 1.0 / node} if node else {}
        return {**_CENTRAL, **ball}
    modulus_MPa = 1.0 / node if node else RIGID
    block = {"contact.object_modulus_MPa": modulus_MPa, "contact.object_thickness_mm": thickness_mm}
    return {**_CENTRAL, **block, "indentation.steps": _STEPS}


def _pressed(
    design: str | DesignSource, changes: Changes, pressures_kPa: Sequence[float], travels: bool
) -> list[tuple[Array, Array]]:
    """Force and reading of a press at each driving pressure: the rises, and then the travels if they are read."""
    evaluation = evaluate(design, {**changes, "pneumatics.driving_pressures_kPa": sorted(pressures_kPa)}, model="solid")
    curves = [curve_of(state, evaluation.sensor) for state in evaluation.prediction.states]
    rising = [np.r_[True, np.diff(curve.force) > 0.0] for curve in curves]
    pairs = list(zip(curves, rising, strict=True))
    rises = [(curve.force[keep], curve.rise[keep]) for curve, keep in pairs]
    return rises + ([(curve.force[keep], curve.indentation[keep]) for curve, keep in pairs] if travels else [])
