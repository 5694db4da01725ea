"""Object and force by readings at several driving pressures: what they tell together, and what one of them tells.

A plate or a ball presses the sensor centrally by a force that stays the same while the driving pressure changes. One
reading tells a curve of forces and curvatures; at a higher driving pressure the wall is tenser and the radius of the
object matters less, so that readings at several pressures tell both (paper, introduction: several sensitivities).
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pneutouch.arrays import Array
from pneutouch.catalogue import DesignSource, ResolvedDesign, load_scene
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.evaluation.gauge import reading_of
from pneutouch.evaluation.reader import curve_of
from pneutouch.evaluation.resins import tested_kPa
from pneutouch.mechanics.gauge_reading import PAPER_NOISE
from pneutouch.results.discrimination import DiscriminationRecord, PlannedReading, ToldObject
from pneutouch.spec.options import DiscriminationOptions
from pneutouch.spec.read import Changes
from pneutouch.units import KPA

_NODES, _GRID, _COARSE = 7, (121, 1200), (81, 480)
"""Curvatures at which the sensor is pressed; curvatures and forces of the grid of a posterior, and of that by which
sets of pressures are compared. Rises between nodes are within 0.5 % of those of a press (tests/workflows)."""

_LEAST = 0.03
"""Least force of the grid, over the greatest that every reading of the smallest ball holds: our choice."""

_SHARES = (0.1, 0.3, 0.7)
"""Forces that are told, over the greatest that an object's readings hold: our choice."""

_HELD = 0.95
_DRAWS = 400
"""Draws of force and noise for the confusion of classes."""

_CENTRAL = {"contact.object": "plate"} | dict.fromkeys(
    ("contact.friction", "contact.offset_mm", "contact.tilt_deg", "contact.shear_mm"), 0.0
)
"""Contact whatever that of the design is: what it says of friction and place holds for its own object."""

_STEPS = 9
"""Driving pressures among which a plan chooses."""


@dataclass(frozen=True)
class ObjectTable:
    """Rises of a sensor under central balls and plates, MPa (pressures, curvatures, forces); NaN beyond the range.

    Attributes:
        pressures_kPa: Driving pressures (k,).
        curvatures: Of the objects, 1/mm, from 0 of a plate (m,).
        forces: In equal steps of the logarithm, N (n,).
    """

    pressures_kPa: Array
    curvatures: Array
    forces: Array
    rise: Array

    def at(self, curvature: float, force: float) -> Array:
        """Rises (k,) at a curvature and a force; NaN beyond the range and below the forces of the table."""
        if force < self.forces[0] * (1.0 - 1e-9):
            return np.full(len(self.pressures_kPa), np.nan)
        row = np.interp(curvature, self.curvatures, np.arange(len(self.curvatures)))
        column = np.interp(math.log(force), np.log(self.forces), np.arange(len(self.forces)))
        i, j = min(int(row), len(self.curvatures) - 2), min(int(column), len(self.forces) - 2)
        a, b = row - i, column - j
        here = self.rise[:, i : i + 2, j : j + 2]
        weights = np.outer([1.0 - a, a], [1.0 - b, b])
        return np.asarray(np.einsum("kij,ij->k", np.where(weights > 0.0, here, 0.0), weights))

    def reach(self, curvature: float) -> float:
        """Greatest force of the grid that every reading of an object holds, N."""
        row = int(np.ceil(np.interp(curvature, self.curvatures, np.arange(len(self.curvatures))) - 1e-9))
        held = np.isfinite(self.rise[:, row]).all(axis=0)
        return float(self.forces[np.flatnonzero(held)[-1]]) if held.any() else 0.0


def object_table(
    design: str | DesignSource,
    changes: Changes | None,
    pressures_kPa: Sequence[float],
    least_radius: float,
    grid: tuple[int, int] = _GRID,
) -> ObjectTable:
    """Press the sensor of a design by plates and balls down to a radius (mm). Raises InputError as `evaluate` does, and
    where an object cannot press it."""
    from scipy.interpolate import PchipInterpolator

    nodes = np.linspace(0.0, 1.0 / least_radius, _NODES)
    curves = [_pressed(design, changes, pressures_kPa, float(node)) for node in nodes]
    greatest, least = (min(float(force[-1]) for force, _ in states) for states in (curves[0], curves[-1]))
    forces = np.geomspace(_LEAST * min(least, greatest), greatest, grid[1])
    known = np.full((len(pressures_kPa), _NODES, grid[1]), np.nan)
    for (i, states), k in itertools.product(enumerate(curves), range(len(pressures_kPa))):
        force, rise = states[k]
        held = forces <= force[-1] * (1.0 + 1e-9)
        known[k, i, held] = PchipInterpolator(force, rise)(forces[held])
    fine = np.linspace(0.0, nodes[-1], grid[0])
    rises = np.full((len(pressures_kPa), *grid), np.nan)
    for k, j in itertools.product(range(len(pressures_kPa)), range(grid[1])):
        # A ball's range ends at a smaller force than a plate's: what is known are the first nodes.
        count = _NODES if np.isfinite(known[k, :, j]).all() else int(np.isfinite(known[k, :, j]).argmin())
        if count == 0:
            continue
        inside = fine <= nodes[count - 1] * (1.0 + 1e-9)
        row = PchipInterpolator(nodes[:count], known[k, :count, j])(fine[inside]) if count > 1 else known[k, :1, j]
        rises[k, inside, j] = row
    return ObjectTable(np.asarray(pressures_kPa, dtype=float), fine, forces, rises)


def _pressed(
    design: str | DesignSource, changes: Changes | None, pressures_kPa: Sequence[float], curvature: float
) -> list[tuple[Array, Array]]:
    """Force and rise of a press at each driving pressure."""
    ball = {"contact.object": "ball", "contact.ball_radius_mm": 1.0 / curvature} if curvature else {}
    own = {**_CENTRAL, **ball, "pneumatics.driving_pressures_kPa": sorted(pressures_kPa)}
    evaluation = evaluate(design, {**(changes or {}), **own}, model="solid")
    curves = [curve_of(state, evaluation.sensor) for state in evaluation.prediction.states]
    rising = [np.r_[True, np.diff(curve.force) > 0.0] for curve in curves]
    return [(curve.force[keep], curve.rise[keep]) for curve, keep in zip(curves, rising, strict=True)]


@dataclass(frozen=True)
class Posterior:
    """Probabilities (curvatures, forces) of the nodes of a table, by some of its readings."""

    table: ObjectTable
    noise: float
    error: float

    @cached_property
    def _deviation(self) -> Array:
        return np.asarray(np.hypot(self.noise, self.error * self.table.rise))

    @cached_property
    def _log_deviation(self) -> Array:
        return np.log(self._deviation)

    def logs(self, readings: Array) -> Array:
        """Logarithms of the likelihood of each reading (k,), MPa, at the nodes (k, m, n)."""
        misfit = (np.asarray(readings)[:, None, None] - self.table.rise) / self._deviation
        return np.asarray(-0.5 * misfit**2 - self._log_deviation)

    def of(self, readings: Array, chosen: Sequence[int]) -> Array:
        """The posterior of readings (k,), MPa, of which those numbered ``chosen`` count; all curvatures and logarithms
        of forces are as likely before."""
        return weights_of(self.logs(readings), chosen)

    def drawn(self, rises: Array, random: np.random.Generator) -> Array:
        """Readings (k,) of an object with these rises, with their errors."""
        return np.asarray(rises + np.hypot(self.noise, self.error * rises) * random.standard_normal(len(rises)))


def weights_of(logs: Array, chosen: Sequence[int]) -> Array:
    """Probabilities of nodes by the readings numbered ``chosen``, from the logarithms of each."""
    log = logs[list(chosen)].sum(axis=0)
    weights = np.where(np.isfinite(log), np.exp(log - np.nanmax(log)), 0.0)
    return np.asarray(weights / weights.sum())


def region(weights: Array) -> float:
    """Smallest share of the nodes that holds `_HELD` of a probability; of a node that is not whole, its share."""
    ordered = np.sort(weights.ravel())[::-1]
    sums = np.cumsum(ordered)
    k = int(np.searchsorted(sums, _HELD))
    before = sums[k - 1] if k else 0.0
    return float((k + (_HELD - before) / ordered[k]) / weights.size)


def interval(values: Array, weights: Array) -> tuple[float, float]:
    """Values between which `_HELD` of the probability of nodes lies, with as much beyond either; from the end of the
    values where it is greatest there, as for a plate, than which nothing is flatter."""
    sums = np.concatenate([[0.0], np.cumsum(weights)])
    edges = np.concatenate([[values[0]], 0.5 * (values[1:] + values[:-1]), [values[-1]]])
    place = int(np.argmax(weights))
    below = 0.0 if place == 0 else 1.0 - _HELD if place == len(weights) - 1 else 0.5 - 0.5 * _HELD
    low, high = (float(np.interp(share, sums, edges)) for share in (below, below + _HELD))
    return low, high


def discriminate(
    design: str | DesignSource,
    changes: Changes | None = None,
    options: DiscriminationOptions = DiscriminationOptions(),  # noqa: B008 - immutable
) -> DiscriminationRecord:
    """State how well readings at the driving pressures of ``options`` tell objects and forces. Raises InputError."""
    scene = load_scene(design, changes)
    _check(options)
    scatter = reading_of(scene).scatter
    noise = options.noise_kPa * KPA if options.noise_kPa is not None else math.sqrt(2.0) * (scatter or PAPER_NOISE)
    asked_kPa = _pressures_kPa(options, scene)
    table = object_table(design, changes, asked_kPa, options.least_radius_mm)
    posterior, readings = Posterior(table, noise, options.error_percent / 100.0), range(len(asked_kPa))
    cases = _cases(table, options)
    areas = _areas(posterior, cases, [*((k,) for k in readings), tuple(readings)])
    single = int(np.log(areas[:, :-1]).mean(axis=0).argmin())
    pairs = zip(cases, areas, strict=True)
    told = tuple(_told(posterior, case, float(row[-1] / row[single]), single) for case, row in pairs)
    plan = None if options.plan is None else _planned(design, changes, options, noise, asked_kPa)
    return DiscriminationRecord(
        design=scene.name,
        driving_pressures_kPa=tuple(asked_kPa),
        noise_kPa=noise / KPA,
        error_percent=options.error_percent,
        least_radius_mm=options.least_radius_mm,
        greatest_force_N=float(table.forces[-1]),
        told=told,
        area_ratio=float(np.exp(np.mean([math.log(one.area_ratio) for one in told]))),
        best_single_kPa=asked_kPa[single],
        classes=tuple(map(_words, _curvatures(options))),
        confusion=_confusion(posterior, _curvatures(options), tuple(readings)),
        confusion_single=_confusion(posterior, _curvatures(options), (single,)),
        plan=plan,
        assumptions=_ASSUMPTIONS,
    )


_ASSUMPTIONS = {
    "object": "rigid, without friction, on the axis; a plate, or a ball not smaller than the least radius; pressed "
    "within the range of every reading",
    "force": "the same at every driving pressure, as of a weight or of a finger that holds it",
    "errors": "of each reading independent: noise, and a share of the rise. An error that all readings share, such as "
    "that of a sensor without a calibration, moves the force by as much and is not in its interval",
    "wall": "without relaxation and hysteresis: each reading is taken as long after its press",
    "before": "every curvature, and every logarithm of the force, is as likely",
}


def _pressures_kPa(options: DiscriminationOptions, scene: ResolvedDesign) -> list[float]:
    """Driving pressures of the readings, ascending: those asked, else the design's. Raises InputError for one alone."""
    given_kPa = options.driving_pressures_kPa or tested_kPa(scene)
    if len(set(given_kPa)) < 2:
        problem = "one driving pressure tells a curve of radii and forces, not both"
        remedy = "give two or more, such as 0,12,22; two far apart tell most"
        raise InputError(problem, key="driving_pressures_kPa", value=given_kPa, remedy=remedy)
    return sorted(set(given_kPa))


def _check(options: DiscriminationOptions) -> None:
    """Raise InputError for objects that cannot be told."""
    for radius in options.classes_mm:
        if radius < options.least_radius_mm:
            problem = f"is below the least radius, {options.least_radius_mm:g} mm"
            raise InputError(problem, key="classes_mm", value=radius, remedy="lower `least_radius_mm`")


def _curvatures(options: DiscriminationOptions) -> list[float]:
    """Curvatures of the classes, a plate's first."""
    return [0.0, *sorted(1.0 / radius for radius in options.classes_mm)]


def _cases(table: ObjectTable, options: DiscriminationOptions) -> list[tuple[float, float]]:
    """Curvatures of the classes, each with forces over the range that its readings hold. Raises InputError where there
    is none."""
    reaches = [(one, table.reach(one)) for one in _curvatures(options)]
    for one, reach in reaches:
        if not all(np.isfinite(table.at(one, share * reach)).all() for share in _SHARES):
            problem = f"a {_words(one)} has no range that all driving pressures share"
            raise InputError(problem, key="classes_mm", remedy="give larger balls, or other driving pressures")
    return [(one, share * reach) for one, reach in reaches for share in _SHARES]


def _words(curvature: float) -> str:
    return f"ball {1.0 / curvature:.4g} mm" if curvature else "plate"


def _areas(posterior: Posterior, cases: Sequence[tuple[float, float]], sets: Sequence[Sequence[int]]) -> Array:
    """Shares of the nodes (cases, sets) that 95 % regions have, by readings without noise."""
    table = posterior.table
    each = (posterior.logs(table.at(*case)) for case in cases)
    return np.array([[region(weights_of(logs, chosen)) for chosen in sets] for logs in each])


def _told(posterior: Posterior, case: tuple[float, float], area_ratio: float, single: int) -> ToldObject:
    """Intervals of a curvature and a force by all readings, over those by the ``single`` one."""
    (curvature, force), table = case, posterior.table
    rises, logs = table.at(curvature, force), np.log(table.forces)
    widths = []
    for chosen in [(single,), tuple(range(len(table.pressures_kPa)))]:
        weights = posterior.of(rises, chosen)
        low, high = interval(logs, weights.sum(axis=0))
        widths.append(high - low)
    bends, mass = table.curvatures, weights
    mean = float((mass.sum(axis=0) * logs).sum()), float((mass.sum(axis=1) * bends).sum())
    spread = mass * np.outer(bends - mean[1], logs - mean[0])
    variances = (mass.sum(axis=0) * (logs - mean[0]) ** 2).sum() * (mass.sum(axis=1) * (bends - mean[1]) ** 2).sum()
    return ToldObject(
        object=_words(curvature),
        ball_radius_mm=1.0 / curvature if curvature else None,
        force_N=force,
        force_half_width_percent=100.0 * (math.exp(0.5 * widths[1]) - 1.0),
        curvature_interval_per_mm=interval(bends, weights.sum(axis=1)),
        area_ratio=area_ratio,
        force_ratio=widths[1] / widths[0],
        correlation=float(spread.sum() / math.sqrt(variances)) if variances > 0.0 else 0.0,
    )


def _confusion(posterior: Posterior, bends: Sequence[float], chosen: Sequence[int]) -> tuple[tuple[float, ...], ...]:
    """Shares of objects (rows), pressed by random forces, that are told as each class (columns): the one whose
    probability, summed over all forces, is greatest."""
    table, random = posterior.table, np.random.default_rng(0)
    at = np.interp(bends, table.curvatures, np.arange(len(table.curvatures)))
    low = np.minimum(at.astype(int), len(table.curvatures) - 2)
    share = (at - low)[:, None]
    # Where the share is nothing the other row does not count, though it may be beyond the range.
    rows = np.where(
        share > 0.0, (1.0 - share) * table.rise[:, low] + share * table.rise[:, low + 1], table.rise[:, low]
    )
    only = Posterior(
        ObjectTable(table.pressures_kPa, np.asarray(bends), table.forces, rows), posterior.noise, posterior.error
    )
    counts = np.zeros((len(bends), len(bends)))
    for i, bend in enumerate(bends):
        reach = table.reach(bend)
        least = max(_LEAST * reach, float(table.forces[0]))
        for force in np.exp(random.uniform(math.log(least), math.log(reach), _DRAWS)):
            reading = posterior.drawn(table.at(bend, float(force)), random)
            counts[i, int(only.of(reading, chosen).sum(axis=1).argmax())] += 1.0
    return tuple(tuple((row / _DRAWS).tolist()) for row in counts)


def _planned(
    design: str | DesignSource,
    changes: Changes | None,
    options: DiscriminationOptions,
    noise: float,
    asked_kPa: Sequence[float],
) -> PlannedReading:
    """The set of ``options.plan`` driving pressures, between the least and the greatest asked, whose mean region is
    smallest."""
    assert options.plan is not None
    at_kPa = np.round(np.linspace(asked_kPa[0], asked_kPa[-1], _STEPS), 6)
    table = object_table(design, changes, at_kPa.tolist(), options.least_radius_mm, _COARSE)
    posterior = Posterior(table, noise, options.error_percent / 100.0)
    cases = _cases(table, options)
    sets: list[tuple[int, ...]] = [(k,) for k in range(_STEPS)]
    sets += list(itertools.combinations_with_replacement(range(_STEPS), options.plan)) if options.plan > 1 else []
    means = np.exp(np.log(_areas(posterior, cases, sets)).mean(axis=0))
    first = 0 if options.plan == 1 else _STEPS
    best = first + int(means[first:].argmin())
    return PlannedReading(tuple(at_kPa[list(sets[best])].tolist()), float(means[best] / means[:_STEPS].min()))
