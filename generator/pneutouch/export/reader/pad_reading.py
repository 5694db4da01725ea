"""Force and place of what touches a pad, from the pressures of its cells, by its table. Standard library alone.

A few objects near to a reading are each fitted to it by damped steps of least squares, and what they agree on is told.
Pressures are kPa, lengths mm, forces N. A plate's parameters are its slopes along x and y and its depth; a ball's its
place x, y, the inner radius of a dome over its own, and its depth; a cylinder's the angle of its horizontal normal to
x and the place of its axis along that, then as a ball's. Kinds are counted in this order: ball, plate, cylinder.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

KINDS = ("ball", "plate", "cylinder")
STARTS = (4, 2, 4)
"""Number of each that are fitted to a reading."""
STEPS = 5
"""Most steps of a fit."""
SETTLED = 0.01
"""Decrease of the square sum of residuals in a step below which a fit ends."""
HOPELESS = 100.0
"""Square sum of residuals, over that of the best fit before it and over the number of cells, from which a fit ends
after two steps."""
MISFIT = 5.0
"""Greatest mean square of the residuals by cell, in standard deviations, of an object that explains a reading."""
SURE = 0.95
"""Probability from which a kind of object is named."""
FOLLOW = 0.01
"""Share of its distance by which the zero of a cell follows a reading without contact."""


class TouchReading(NamedTuple):
    """Contact with a pad: ``none``, ``ball``, ``plate``, ``cylinder``, ``either`` where more than one of these explain
    the reading, or ``outside`` where nothing does.

    Force and its standard uncertainty; where its line crosses the plane of the domes' tops, with the covariance;
    curvature of the object and its standard uncertainty, 1/mm. Of a plate its slopes along x and y, of a cylinder the
    angle of its axis to x from 0 to pi, with their standard uncertainties. Not a number where it is not known."""

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
    slope_x: float = math.nan
    slope_y: float = math.nan
    slope_x_uncertainty: float = math.nan
    slope_y_uncertainty: float = math.nan
    turn_rad: float = math.nan
    turn_uncertainty_rad: float = math.nan


class _Fit(NamedTuple):
    """An object fitted: its kind, its logarithmic weight, its square sum of residuals, what it tells (force, x, y, bend
    and its first two parameters), the covariance of that, and whether every cell is within its range."""

    kind: int
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
        fits, least = list[_Fit](), math.inf
        for kind, start in self._nearest(rises):
            fits.append(self._fitted(kind, start, rises, deviation, HOPELESS * max(least, len(rises))))
            least = min(least, fits[-1].square)
        return self._told(fits)

    def _nearest(self, rises: Sequence[float]) -> list[tuple[int, list[float]]]:
        """Stored objects of each kind that read most like this, with their kinds; the nearest first."""
        scaled = [math.asinh(rise / self.table["touched_kPa"]) for rise in rises]
        chosen: list[tuple[float, int, list[float]]] = []
        for kind, starts in enumerate(self.table["starts"]):
            best: list[tuple[float, int, list[float]]] = []
            for start in starts:
                pairs = zip(scaled, start["scaled_rises"], self.used, strict=True)
                best.append((sum((one - other) ** 2 for one, other, used in pairs if used), kind, start["object"]))
            chosen += sorted(best, key=lambda one: one[0])[: STARTS[kind]]
        return [one[1:] for one in sorted(chosen, key=lambda one: one[0])]

    def _fitted(
        self, kind: int, start: Sequence[float], rises: Sequence[float], deviation: float, hopeless: float
    ) -> _Fit:
        spread, size = self.table["spreads"][kind], len(start)
        at, damping, gain = list(start), 0.01, math.inf
        answer = self.answer(kind, at)
        cost = self._cost(answer, rises, deviation)
        for step in range(STEPS + 1):
            normal, slope, turned = self._normal(kind, at, answer, rises, deviation)
            for i in range(size):
                normal[i][i] += 1.0
                slope[i] += (at[i] - start[i]) / spread[i]
            if step == STEPS or (step >= 2 and cost > hopeless) or 0.0 < gain < SETTLED:
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
        bend = 0.0 if kind == 1 else at[2]
        return _Fit(kind, log_weight, cost, [*answer[1:4], bend, *at[:2]], covariance, answer[4])

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
        spread, size, middle = self.table["spreads"][kind], len(at), 0.5 * sum(self.table["bends"])
        columns: list[list[float]] = []
        turned = [[0.0] * size for _ in range(6)]
        turned[4][0], turned[5][1] = spread[:2]
        for i in range(size):
            step = 0.01 * spread[i] * (-1.0 if kind != 1 and i == 2 and at[2] > middle else 1.0)
            moved = self.answer(kind, [value + step * (i == j) for j, value in enumerate(at)])
            scale = spread[i] / step
            pairs = zip(moved[0], answer[0], self.used, strict=True)
            columns.append([scale * (one - other) / deviation if used else 0.0 for one, other, used in pairs])
            for k, (one, other) in enumerate(zip(moved[1:4], answer[1:4], strict=True)):
                turned[k][i] = scale * (one - other)
        if kind != 1:
            turned[3][2] = spread[2]
        residual = [(one - other) / deviation for one, other in zip(answer[0], rises, strict=True)]
        normal = [[sum(a * b for a, b in zip(one, other, strict=True)) for other in columns] for one in columns]
        return normal, [sum(a * b for a, b in zip(one, residual, strict=True)) for one in columns], turned

    def answer(self, kind: int, at: Sequence[float]) -> tuple[list[float], float, float, float, bool]:
        """Rises of the cells under an object, its force, where the line of that crosses the plane of the tops, and
        whether every cell is within its range."""
        table, rises, inside = self.table, [], True
        force = x = y = 0.0
        cos, sin = math.cos(at[0]), math.sin(at[0])
        for (cell_x, cell_y), gain, number in zip(self.places, table["gains"], table["table_of"], strict=True):
            cell = table["tables"][number]
            if kind != 1:
                bend = min(max(at[2], table["bends"][0]), table["bends"][1])
                to_x, to_y, height = at[0] - cell_x, at[1] - cell_y, table["top_mm"] - at[3]
                if kind == 2:
                    gap = at[1] - cos * cell_x - sin * cell_y
                    to_x, to_y = gap * cos, gap * sin
                away = math.hypot(to_x, to_y)
                size = cell["outer_mm"] + table["radius_mm"] / bend
                column = away / math.sqrt(cell["depth_mm"] * (2.0 * size - cell["depth_mm"]))
                row = (bend - cell["bends"][0]) / (cell["bends"][1] - cell["bends"][0])
            else:
                to_x, to_y, away = at[0], at[1], math.hypot(at[0], at[1])
                height = table["top_mm"] - at[2] + at[0] * cell_x + at[1] * cell_y
                row, column = 0.0, away / math.hypot(1.0, away) / table["steepest"]
                inside = inside and column <= 1.0
            if kind != 1 and column > 1.05:
                rises.append(0.0)
                continue
            pressed, sideways, moment, rise, held = _interpolated(
                cell["nodes"][kind], cell["depth_mm"], row, column, height
            )
            scale = 1.0 / max(away, 1e-12)
            across = table["top_mm"] * sideways - moment
            force += pressed
            x += pressed * cell_x + across * to_x * scale
            y += pressed * cell_y + across * to_y * scale
            rises.append(gain * rise)
            inside = inside and held
        least = max(force, 1e-12)
        return rises, force, x / least, y / least, inside and force > 0.0

    def _told(self, fits: Sequence[_Fit]) -> TouchReading:
        """The fits by their weights as one answer."""
        best = max(fits, key=lambda fit: fit.log_weight)
        weights = [math.exp(fit.log_weight - best.log_weight) for fit in fits]
        whole = sum(weights)
        weights = [weight / whole for weight in weights]
        inside = sum(weight for weight, fit in zip(weights, fits, strict=True) if fit.inside)
        if min(fit.square for fit in fits) > MISFIT * sum(self.used) or inside <= 1.0 - SURE:
            return TouchReading("outside")
        pairs = list(zip(weights, fits, strict=True))
        mean = [sum(weight * fit.told[i] for weight, fit in pairs) for i in range(4)]
        # Scatter as of a weighted sample, which of few fits is larger; at most twice as large.
        few = 1.0 / max(1.0 - sum(weight**2 for weight in weights), 0.5)
        spread = [
            [
                sum(
                    w * (fit.covariance[i][j] + few * (fit.told[i] - mean[i]) * (fit.told[j] - mean[j]))
                    for w, fit in pairs
                )
                for j in range(4)
            ]
            for i in range(4)
        ]
        sure = sum(weight for weight, fit in pairs if fit.kind == best.kind) > SURE
        radius = self.table["radius_mm"]
        bend = mean[3] / radius, math.sqrt(spread[3][3]) / radius
        place = mean[1], mean[2], spread[1][1], spread[1][2], spread[2][2]
        told = TouchReading(KINDS[best.kind] if sure else "either", mean[0], math.sqrt(spread[0][0]), *place, *bend)
        one, other = best.told[4:]
        of_one, of_other = (math.sqrt(best.covariance[i][i]) for i in (4, 5))
        if sure and best.kind == 1:
            return told._replace(slope_x=one, slope_y=other, slope_x_uncertainty=of_one, slope_y_uncertainty=of_other)
        if sure and best.kind == 2:
            return told._replace(turn_rad=(one + 0.5 * math.pi) % math.pi, turn_uncertainty_rad=of_one)
        return told


def _interpolated(
    nodes: Mapping[str, Any], depth_mm: float, row: float, column: float, height: float
) -> tuple[float, float, float, float, bool]:
    """Force, sideways force, moment and rise of a cell, linear between nodes; and whether it is in its range."""
    first, reach, values = nodes["first_mm"], nodes["reach_mm"], nodes["values"]
    corners = []
    for i, a in _ends(row, len(first)):
        corners += [(i, j, a * b) for j, b in _ends(column, len(first[0]))]
    travel = sum(w * first[i][j] for i, j, w in corners) - height
    if travel <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, True
    out = [0.0] * 4
    for k, c in _ends(travel / depth_mm, len(values[0][0])):
        for i, j, w in corners:
            for part in range(4):
                out[part] += w * c * values[i][j][k][part]
    return out[0], out[1], out[2], out[3], travel <= sum(w * reach[i][j] for i, j, w in corners)


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
