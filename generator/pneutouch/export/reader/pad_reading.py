"""Force and place of what touches a pad, from the pressures of its cells, by its table. Standard library alone.

A few objects near to a reading are each fitted to it by damped steps of least squares, and what they agree on is told.
Pressures are kPa, lengths mm, forces N. A plate's parameters are its slopes along x and y and its depth; a ball's its
place x, y, the inner radius of a dome over its own, and its depth.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

STARTS = (5, 2)
"""Number of balls and of plates that are fitted to a reading."""
STEPS = 4
"""Steps of each fit."""
MISFIT = 5.0
"""Greatest mean square of the residuals by cell, in standard deviations, of an object that explains a reading."""
SURE = 0.95
"""Probability from which a kind of object is named."""
FOLLOW = 0.01
"""Share of its distance by which the zero of a cell follows a reading without contact."""


class TouchReading(NamedTuple):
    """Contact with a pad: ``none``, ``ball``, ``plate``, ``either`` or ``outside``, where nothing explains the reading.

    Force and its standard uncertainty; where its line crosses the plane of the domes' tops, with the covariance;
    curvature of the object and its standard uncertainty, 1/mm. Not a number where it is not known."""

    kind: str
    force_N: float = math.nan
    uncertainty_N: float = math.nan
    x_mm: float = math.nan
    y_mm: float = math.nan
    xx_mm2: float = math.nan
    xy_mm2: float = math.nan
    yy_mm2: float = math.nan
    curvature_per_mm: float = math.nan
    curvature_uncertainty_per_mm: float = math.nan


class _Fit(NamedTuple):
    """An object fitted: its logarithmic weight, its square sum of residuals, what it tells (force, x, y, bend), the
    covariance of that, and whether every cell is within its range."""

    log_weight: float
    square: float
    told: list[float]
    covariance: list[list[float]]
    inside: bool


class PadForceReader:
    """Reader of a pad. Call `tare` before the first contact, then `read` for each reading."""

    def __init__(self, table: Mapping[str, Any]) -> None:
        self.table = table
        self.places: list[tuple[float, float]] = table["places_mm"]
        self.zero_kPa = [math.nan] * len(self.places)
        self.used = [True] * len(self.places)

    def tare(self, readings_kPa: Sequence[Sequence[float]]) -> None:
        """Take the mean of readings without contact, each the pressures of all cells, as zero."""
        self.zero_kPa = [sum(cell) / len(readings_kPa) for cell in zip(*readings_kPa, strict=True)]

    def leave_out(self, number: int) -> None:
        """Leave out a lost cell, by its number from 1."""
        self.used[number - 1] = False

    def read(self, gauges_kPa: Sequence[float]) -> TouchReading:
        """The contact, by the pressures of all cells in the order of their numbers."""
        cells = zip(gauges_kPa, self.zero_kPa, self.used, strict=True)
        rises = [gauge - zero if used else 0.0 for gauge, zero, used in cells]
        if not all(math.isfinite(rise) for rise in rises):
            return TouchReading("outside")
        noise, most = self.table["noise_kPa"], max(rises)
        if most <= self.table["touched_kPa"]:
            self.zero_kPa = [zero + FOLLOW * rise for zero, rise in zip(self.zero_kPa, rises, strict=True)]
            return TouchReading("none", 0.0, 0.0)
        deviation = math.hypot(noise, self.table["model_error"] * most)
        fits = [
            [self._fitted(kind, start, rises, deviation) for start in self._nearest(kind, rises)] for kind in (0, 1)
        ]
        return self._told(*fits)

    def _nearest(self, kind: int, rises: Sequence[float]) -> list[list[float]]:
        """Stored objects of a kind that read most like this."""
        scaled = [math.asinh(rise / self.table["touched_kPa"]) for rise in rises]
        best: list[tuple[float, list[float]]] = []
        for start in self.table["starts"][kind]:
            pairs = zip(scaled, start["scaled_rises"], self.used, strict=True)
            best.append((sum((one - other) ** 2 for one, other, used in pairs if used), start["object"]))
        best.sort(key=lambda one: one[0])
        return [start for _, start in best[: STARTS[kind]]]

    def _fitted(self, kind: int, start: Sequence[float], rises: Sequence[float], deviation: float) -> _Fit:
        spread, size = self.table["spreads"][kind], len(start)
        at, damping = list(start), 0.01
        answer = self.answer(kind, at)
        cost = self._cost(answer, rises, deviation)
        for step in range(STEPS + 1):
            normal, slope, turned = self._normal(kind, at, answer, rises, deviation)
            for i in range(size):
                normal[i][i] += 1.0
                slope[i] += (at[i] - start[i]) / spread[i]
            if step == STEPS:
                break
            damped = [[normal[i][j] * (1.0 + damping if i == j else 1.0) for j in range(size)] for i in range(size)]
            move = solved(damped, slope)
            tried = [at[i] - spread[i] * min(max(move[i], -0.5), 0.5) for i in range(size)]
            new = self.answer(kind, tried)
            held = sum(
                ((tried[i] - start[i]) / spread[i]) ** 2 - ((at[i] - start[i]) / spread[i]) ** 2 for i in range(size)
            )
            gain = cost - (found := self._cost(new, rises, deviation)) - held
            if gain > 0.0:
                at, answer, cost, damping = tried, new, found, 0.2 * damping
            else:
                damping *= 5.0
        rows = [solved(normal, row) for row in turned]
        covariance = [[sum(a * b for a, b in zip(one, other, strict=True)) for other in rows] for one in turned]
        log_weight = (
            -0.5 * cost - sum(math.log(row[i]) for i, row in enumerate(factors(normal))) - math.log(STARTS[kind])
        )
        bend = at[2] if kind == 0 else 0.0
        return _Fit(log_weight, cost, [*answer[1:4], bend], covariance, answer[4])

    def _cost(
        self, answer: tuple[list[float], float, float, float, bool], rises: Sequence[float], deviation: float
    ) -> float:
        pairs = zip(answer[0], rises, self.used, strict=True)
        return sum(((one - other) / deviation) ** 2 for one, other, used in pairs if used)

    def _normal(
        self,
        kind: int,
        at: Sequence[float],
        answer: tuple[list[float], float, float, float, bool],
        rises: Sequence[float],
        deviation: float,
    ) -> tuple[list[list[float]], list[float], list[list[float]]]:
        """Normal matrix and slope of the square sum, parameters in their spreads, and derivatives of what is told."""
        spread, size = self.table["spreads"][kind], len(at)
        columns: list[list[float]] = []
        turned = [[0.0] * size for _ in range(4)]
        for i in range(size):
            step = 0.01 * spread[i] * (-1.0 if kind == 0 and i == 2 and at[2] > 0.5 else 1.0)
            moved = self.answer(kind, [value + step * (i == j) for j, value in enumerate(at)])
            scale = spread[i] / step
            pairs = zip(moved[0], answer[0], self.used, strict=True)
            columns.append([scale * (one - other) / deviation if used else 0.0 for one, other, used in pairs])
            for k, (one, other) in enumerate(zip(moved[1:4], answer[1:4], strict=True)):
                turned[k][i] = scale * (one - other)
        if kind == 0:
            turned[3][2] = spread[2]
        residual = [(one - other) / deviation for one, other in zip(answer[0], rises, strict=True)]
        normal = [[sum(a * b for a, b in zip(one, other, strict=True)) for other in columns] for one in columns]
        return normal, [sum(a * b for a, b in zip(one, residual, strict=True)) for one in columns], turned

    def answer(self, kind: int, at: Sequence[float]) -> tuple[list[float], float, float, float, bool]:
        """Rises of the cells under an object, its force, where the line of that crosses the plane of the tops, and
        whether every cell is within its range. ``kind`` is 0 for a ball, 1 for a plate."""
        table, rises, inside = self.table, [], True
        force = x = y = 0.0
        for (cell_x, cell_y), gain in zip(self.places, table["gains"], strict=True):
            if kind == 0:
                bend = min(max(at[2], table["bends"][0]), table["bends"][1])
                to_x, to_y, height = at[0] - cell_x, at[1] - cell_y, table["apex_mm"] - at[3]
                away = math.hypot(to_x, to_y)
                size = table["outer_mm"] + table["radius_mm"] / bend
                column = away / math.sqrt(table["depth_mm"] * (2.0 * size - table["depth_mm"]))
                row = (bend - table["bends"][0]) / (table["bends"][1] - table["bends"][0])
            else:
                to_x, to_y, away = at[0], at[1], math.hypot(at[0], at[1])
                height = table["apex_mm"] - at[2] + at[0] * cell_x + at[1] * cell_y
                row, column = 0.0, away / math.hypot(1.0, away) / table["steepest"]
                inside = inside and column <= 1.0
            if kind == 0 and column > 1.05:
                rises.append(0.0)
                continue
            pressed, sideways, moment, rise, held = self._interpolated(kind, row, column, height)
            scale = 1.0 / max(away, 1e-12)
            across = table["apex_mm"] * sideways - moment
            force += pressed
            x += pressed * cell_x + across * to_x * scale
            y += pressed * cell_y + across * to_y * scale
            rises.append(gain * rise)
            inside = inside and held
        least = max(force, 1e-12)
        return rises, force, x / least, y / least, inside and force > 0.0

    def _interpolated(
        self, kind: int, row: float, column: float, height: float
    ) -> tuple[float, float, float, float, bool]:
        """Force, sideways force, moment and rise of a cell, linear between nodes; and whether it is in its range."""
        nodes = self.table["nodes"][kind]
        first, reach, values = nodes["first_mm"], nodes["reach_mm"], nodes["values"]
        corners = []
        for i, a in _ends(row, len(first)):
            corners += [(i, j, a * b) for j, b in _ends(column, len(first[0]))]
        travel = sum(w * first[i][j] for i, j, w in corners) - height
        if travel <= 0.0:
            return 0.0, 0.0, 0.0, 0.0, True
        out = [0.0] * 4
        for k, c in _ends(travel / self.table["depth_mm"], len(values[0][0])):
            for i, j, w in corners:
                for part in range(4):
                    out[part] += w * c * values[i][j][k][part]
        return out[0], out[1], out[2], out[3], travel <= sum(w * reach[i][j] for i, j, w in corners)

    def _told(self, balls: Sequence[_Fit], plates: Sequence[_Fit]) -> TouchReading:
        """The fits by their weights as one answer."""
        fits = [*balls, *plates]
        top = max(fit.log_weight for fit in fits)
        weights = [math.exp(fit.log_weight - top) for fit in fits]
        whole = sum(weights)
        weights = [weight / whole for weight in weights]
        inside = sum(weight for weight, fit in zip(weights, fits, strict=True) if fit.inside)
        if min(fit.square for fit in fits) > MISFIT * sum(self.used) or inside <= 1.0 - SURE:
            return TouchReading("outside")
        pairs = list(zip(weights, fits, strict=True))
        mean = [sum(weight * fit.told[i] for weight, fit in pairs) for i in range(4)]
        spread = [
            [
                sum(w * (fit.covariance[i][j] + (fit.told[i] - mean[i]) * (fit.told[j] - mean[j])) for w, fit in pairs)
                for j in range(4)
            ]
            for i in range(4)
        ]
        ball = sum(weights[: len(balls)])
        kind = "ball" if ball > SURE else "plate" if ball < 1.0 - SURE else "either"
        radius = self.table["radius_mm"]
        bend = mean[3] / radius, math.sqrt(spread[3][3]) / radius
        place = mean[1], mean[2], spread[1][1], spread[1][2], spread[2][2]
        return TouchReading(kind, mean[0], math.sqrt(spread[0][0]), *place, *bend)


def _ends(share: float, count: int) -> tuple[tuple[int, float], ...]:
    """The nodes beside a share, from 0 to 1, of an axis with equal steps, and their weights."""
    place = min(max(share, 0.0), 1.0) * (count - 1)
    low = min(int(place), max(count - 2, 0))
    return (low, 1.0 - (place - low)), (min(low + 1, count - 1), place - low)


def solved(matrix: Sequence[Sequence[float]], right: Sequence[float]) -> list[float]:
    """Solution of a positive definite system, by Cholesky's factors."""
    lower, size = factors(matrix), len(right)
    out = list(right)
    for i in range(size):
        out[i] = (out[i] - sum(lower[i][k] * out[k] for k in range(i))) / lower[i][i]
    for i in reversed(range(size)):
        out[i] = (out[i] - sum(lower[k][i] * out[k] for k in range(i + 1, size))) / lower[i][i]
    return out


def factors(matrix: Sequence[Sequence[float]]) -> list[list[float]]:
    """Lower factor of Cholesky of a positive definite matrix."""
    lower = [[0.0] * len(matrix) for _ in matrix]
    for i in range(len(matrix)):
        for j in range(i + 1):
            rest = matrix[i][j] - sum(lower[i][k] * lower[j][k] for k in range(j))
            lower[i][j] = math.sqrt(rest) if i == j else rest / lower[j][j]
    return lower
