"""Rigid objects on a pad: every cell answers for itself at the object's height, and the pad's answer is their sum.

A table on a flange yields at its foot. What pressed neighbours do through it is left out: less than 1 % of force
and rise. With three cells 9 mm apart (R0 2.78 mm, wall 1 mm) force and rises are within 3 %, and the centre within
0.1 mm, of CalculiX in three dimensions (docs/howto/pads.md).
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags, Indices
from pneutouch.mechanics.touch.cell import RADII, TILTS, CellAnswer, CellTable

ObjectKind = Literal["ball", "plate", "cylinder"]


class PadAnswer(NamedTuple):
    """m contacts with a pad of n cells: pressure rises and forces (m, n), MPa and N; the whole force (m,), N, and its
    centre (m, 2), mm, where its line crosses the plane of the domes' tops; True (m,) where every cell is within its
    range and one is touched."""

    rise: Array
    forces: Array
    force: Array
    centre: Array
    inside: Flags


@dataclass(frozen=True)
class PadModel:
    """Forward model of a pad: places (n, 2) of its cells, mm; the tables of cells that differ; and for each cell (n,)
    the number of its table, and its pressure rise over that of the table's cell, by its gas."""

    places: Array
    tables: tuple[CellTable, ...]
    table_of: Indices
    gain: Array

    @staticmethod
    def alike(places: Array, table: CellTable, gain: Array) -> "PadModel":
        """A pad whose cells have one table."""
        return PadModel(places, (table,), np.zeros(len(places), dtype=np.intp), gain)

    def under_balls(self, place: Array, radius: Array, depth: Array) -> PadAnswer:
        """Under balls of radii (m,) with axes at places (m, 2) and lowest points ``depth`` (m,) below the domes' tops.
        Radii beyond the tabulated ones answer as the nearest of these."""
        return self._under_round("balls", place[:, None] - self.places, radius, depth)

    def under_cylinders(self, axis: Array, radius: Array, depth: Array) -> PadAnswer:
        """Under endless lying cylinders, or bars with such an edge: of their ``axis`` (m, 2) the angle of the
        normal to x, rad, and the place along it; radii and depths as of balls."""
        normal = np.column_stack([np.cos(axis[:, 0]), np.sin(axis[:, 0])])
        away = (axis[:, 1:] - normal @ self.places.T)[..., None] * normal[:, None]
        return self._under_round("cylinders", away, radius, depth)

    def under_plates(self, lean: Array, depth: Array) -> PadAnswer:
        """Under plates whose planes rise by ``lean`` (m, 2), per mm along x and y, and that lie ``depth`` (m,) below
        the domes' tops at x = y = 0."""
        steep = np.hypot(lean[:, 0], lean[:, 1])
        sine = steep / np.hypot(1.0, steep)
        height = self.top - depth[:, None] + lean @ self.places.T
        answer = self._each(CellTable.under_plate, np.broadcast_to(sine[:, None], height.shape), height)
        towards = np.broadcast_to((lean / np.maximum(steep, 1e-12)[:, None])[:, None], (*height.shape, 2))
        inside = answer.inside & (sine <= TILTS[-1])[:, None]
        return self._sum(answer._replace(inside=inside), towards)

    @property
    def radii(self) -> tuple[float, float]:
        """Least and greatest radius of a ball or cylinder, mm, that every table covers."""
        radii = [table.radius for table in self.tables]
        return RADII[0] * max(radii), RADII[-1] * min(radii)

    @property
    def table(self) -> CellTable:
        """Table of the cell whose inner radius is the unit of curvatures."""
        return self.tables[0]

    def of_cells(self, name: str) -> Array:
        """A number of every cell (n,), by its name in the tables."""
        return np.array([getattr(table, name) for table in self.tables])[self.table_of]

    @property
    def top(self) -> float:
        """Height of the highest dome over the base plane, from which depths count."""
        return max(table.apex for table in self.tables)

    @property
    def depth(self) -> float:
        """Greatest travel of an object on one cell."""
        return max(table.depth for table in self.tables)

    @property
    def deepest(self) -> float:
        """Depth of an object beyond the range of every cell."""
        return max(self.top - table.apex + 1.6 * table.depth for table in self.tables)

    def _under_round(self, kind: str, away: Array, radius: Array, depth: Array) -> PadAnswer:
        """Under bodies with axes ``away`` (m, n, 2) from those of the cells, at the nearest point."""
        distance = np.hypot(away[..., 0], away[..., 1])
        size, height = np.clip(radius, *self.radii)[:, None], self.top - depth[:, None]
        at = np.broadcast_arrays(size, distance, height)
        answer = self._each(lambda table, *own: table.under_round(kind, *own), *at)
        return self._sum(answer, away / np.maximum(distance, 1e-12)[..., None])

    def _each(self, ask: Callable[..., CellAnswer], *at: Array) -> CellAnswer:
        """Answers (m, n) of every cell by its own table, to arrays (m, n)."""
        if len(self.tables) == 1:
            return ask(self.table, *at)
        own = [self.table_of == number for number in range(len(self.tables))]
        pairs = zip(self.tables, own, strict=True)
        answers = [ask(table, *(one[:, cells] for one in at)) for table, cells in pairs]
        back = np.argsort(np.argsort(self.table_of, kind="stable"))
        return CellAnswer(*(np.concatenate(parts, axis=1)[:, back] for parts in zip(*answers, strict=True)))

    def _sum(self, answer: CellAnswer, towards: Array) -> PadAnswer:
        force = answer.force.sum(axis=1)
        side = answer.sideways[..., None] * towards
        # Of a force at the base plane, and moments about the axes across: where its line crosses the tops' plane.
        turned = answer.moment[..., None] * towards
        moment = (answer.force[..., None] * self.places - turned).sum(axis=1)
        high = self.top * side.sum(axis=1)
        centre = (moment + high) / np.maximum(force, 1e-12)[:, None]
        inside = answer.inside.all(axis=1) & (force > 0.0)
        return PadAnswer(answer.rise * self.gain, answer.force, force, centre, inside)
