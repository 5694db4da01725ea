"""Object and force by readings at several driving pressures: what they tell together, and what one of them tells.

A plate, a ball or a soft block presses the sensor centrally by a force that stays the same while the driving pressure
changes. One reading tells a curve of forces and objects; at a higher driving pressure the wall is tenser and the object
matters less, so that readings at several pressures tell both (paper, introduction: several sensitivities).
"""

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from pneutouch.arrays import Array
from pneutouch.catalogue import DesignSource, ResolvedDesign, load_scene
from pneutouch.errors import InputError
from pneutouch.evaluation.gauge import reading_of
from pneutouch.evaluation.object_table import GRID, LEAST, ObjectProperty, ObjectTable, object_table
from pneutouch.evaluation.posterior import Posterior, interval, region, weights_of
from pneutouch.evaluation.resins import tested_kPa
from pneutouch.mechanics.gauge_reading import PAPER_NOISE
from pneutouch.results.discrimination import DiscriminationRecord, PlannedReading, ToldObject
from pneutouch.spec.options import DiscriminationOptions
from pneutouch.spec.read import Changes
from pneutouch.units import KPA

_COARSE = (81, 480)
"""Objects and forces of the grid by which sets of pressures are compared."""

_SHARES = (0.1, 0.3, 0.7)
"""Forces that are told, over the greatest that an object's readings hold: our choice."""

_DRAWS = 400
"""Draws of force and noise for the confusion of classes."""

_STEPS = 9
"""Driving pressures among which a plan chooses."""

_UNTOLD = 0.7
"""Mean share of all objects that an interval covers from which on it tells nothing: our choice."""


def discriminate(
    design: str | DesignSource,
    changes: Changes | None = None,
    options: DiscriminationOptions = DiscriminationOptions(),  # noqa: B008 - immutable
) -> DiscriminationRecord:
    """State how well readings at the driving pressures of ``options`` tell objects and forces. Raises InputError."""
    scene = load_scene(design, changes)
    told_of = _property(options)
    _check(options, told_of)
    scatter = reading_of(scene).scatter
    noise = options.noise_kPa * KPA if options.noise_kPa is not None else math.sqrt(2.0) * (scatter or PAPER_NOISE)
    asked_kPa = _pressures_kPa(options, scene)
    tabulated = partial(
        object_table,
        design,
        changes,
        least=options.least_radius_mm if told_of == "radius" else options.least_modulus_MPa,
        told=told_of,
        travels=options.travel_noise_mm is not None,
        thickness_mm=options.thickness_mm,
    )
    table, readings = tabulated(asked_kPa, grid=GRID), range(len(asked_kPa))
    posterior = Posterior(table, noise, options.error_percent / 100.0, options.travel_noise_mm or 0.0)
    classes = _classes(options, told_of)
    cases = _cases(table, classes, told_of)
    areas = _areas(posterior, cases, [*((k,) for k in readings), tuple(readings)])
    single = int(np.log(areas[:, :-1]).mean(axis=0).argmin())
    pairs = zip(cases, areas, strict=True)
    told = tuple(_told(posterior, told_of, case, float(row[-1] / row[single]), single) for case, row in pairs)
    _check_told(told, posterior, told_of)
    plan = None if options.plan is None else _planned(posterior, tabulated, options.plan, cases, told_of)
    return DiscriminationRecord(
        design=scene.name,
        driving_pressures_kPa=tuple(asked_kPa),
        noise_kPa=noise / KPA,
        error_percent=options.error_percent,
        least_radius_mm=options.least_radius_mm if told_of == "radius" else None,
        least_modulus_MPa=options.least_modulus_MPa if told_of == "modulus" else None,
        travel_noise_mm=options.travel_noise_mm,
        greatest_force_N=float(table.forces[-1]),
        told=told,
        area_ratio=float(np.exp(np.mean([math.log(one.area_ratio) for one in told]))),
        best_single_kPa=asked_kPa[single],
        classes=tuple(_words(told_of, one) for one in classes),
        confusion=_confusion(posterior, classes, tuple(readings)),
        confusion_single=_confusion(posterior, classes, (single,)),
        plan=plan,
        assumptions=_ASSUMPTIONS,
    )


_ASSUMPTIONS = {
    "object": "without friction, on the axis; a rigid plate, or a rigid ball or soft block down to the least; pressed "
    "within the range of every reading",
    "force": "the same at every driving pressure, as of a weight or of a finger that holds it",
    "errors": "of each reading independent: noise, and a share of the rise. An error that all readings share, such as "
    "that of a sensor without a calibration, moves the force by as much and is not in its interval",
    "wall": "without relaxation and hysteresis: each reading is taken as long after its press",
    "before": "every curvature, or compliance, and every logarithm of the force, is as likely",
}


def _pressures_kPa(options: DiscriminationOptions, scene: ResolvedDesign) -> list[float]:
    """Driving pressures of the readings, ascending: those asked, else the design's. Raises InputError for one alone."""
    given_kPa = options.driving_pressures_kPa or tested_kPa(scene)
    if len(set(given_kPa)) < 2:
        problem = "one driving pressure tells a curve of objects and forces, not both"
        remedy = "give two or more, such as 0,12,22; two far apart tell most"
        raise InputError(problem, key="driving_pressures_kPa", value=given_kPa, remedy=remedy)
    return sorted(set(given_kPa))


def _property(options: DiscriminationOptions) -> ObjectProperty:
    """Unknown property of the object beside its force. Raises InputError for what a cavity alone cannot tell."""
    names = set(options.unknown)
    for told_of in ("radius", "modulus"):
        if names == {told_of, "force"}:
            return told_of
    remedies = {
        "place": "a round dome reads no place; a pad of several cells tells it (`pneutouch new NAME --pad`)",
        "travel": "the travel is read by a stage, not told: give its noise as `travel_noise_mm`",
    }
    why = [text for name, text in remedies.items() if name in names]
    if {"radius", "modulus"} <= names:
        why = ["readings of one kind of object after the other: a ball's radius, or a block's modulus"]
    problem = "of one object either radius and force are told, or modulus and force"
    remedy = why[0] if why else "give radius,force or modulus,force"
    raise InputError(problem, key="unknown", value=",".join(options.unknown), remedy=remedy)


def _check(options: DiscriminationOptions, told_of: ObjectProperty) -> None:
    """Raise InputError for options of objects of the other kind, and for objects that cannot be told."""
    blocks, balls = ("moduli_MPa", "least_modulus_MPa", "thickness_mm"), ("classes_mm", "least_radius_mm")
    others, instead = (blocks, "modulus,force") if told_of == "radius" else (balls, "radius,force")
    for key in others:
        if getattr(options, key) != type(options).model_fields[key].default:
            problem = f"is of other objects: the {told_of} is told"
            raise InputError(problem, key=key, value=getattr(options, key), remedy=f"give `unknown` {instead}")
    least = {"radius": options.least_radius_mm, "modulus": options.least_modulus_MPa}[told_of]
    keys = {"radius": ("classes_mm", "least_radius_mm"), "modulus": ("moduli_MPa", "least_modulus_MPa")}[told_of]
    for value in getattr(options, keys[0]):
        if value < least:
            problem = f"is below the least {told_of}, {least:g} {keys[1].rpartition('_')[2]}"
            raise InputError(problem, key=keys[0], value=value, remedy=f"lower `{keys[1]}`")


def _check_told(told: Sequence[ToldObject], posterior: Posterior, told_of: ObjectProperty) -> None:
    """Raise InputError if the readings tell nothing of the objects."""
    intervals = [one.curvature_interval_per_mm or one.compliance_interval_per_MPa or (0.0, 0.0) for one in told]
    share = float(np.diff(intervals).mean() / posterior.table.objects[-1])
    if share > _UNTOLD:
        travel = "" if posterior.travel_noise else "; read the travel too (`travel_noise_mm`), which tells a modulus"
        raise InputError(
            f"the readings do not tell the {told_of}: in the mean its interval holds {share:.0%} of all",
            key="unknown",
            remedy=f"take driving pressures farther apart, less noise or a smaller error{travel}",
        )


def _classes(options: DiscriminationOptions, told_of: ObjectProperty) -> list[float]:
    """Curvatures or compliances of the classes, a rigid plate's first."""
    return [0.0, *sorted(1.0 / one for one in (options.classes_mm if told_of == "radius" else options.moduli_MPa))]


def _cases(table: ObjectTable, classes: Sequence[float], told_of: ObjectProperty) -> list[tuple[float, float]]:
    """The classes, each with forces over the range that its readings hold. Raises InputError where there is none."""
    reaches = [(one, table.reach(one)) for one in classes]
    for one, reach in reaches:
        if not all(np.isfinite(table.at(one, share * reach)).all() for share in _SHARES):
            problem = f"a {_words(told_of, one)} has no range that all driving pressures share"
            key = {"radius": "classes_mm", "modulus": "moduli_MPa"}[told_of]
            raise InputError(problem, key=key, remedy="give greater ones, or other driving pressures")
    return [(one, share * reach) for one, reach in reaches for share in _SHARES]


def _words(told_of: ObjectProperty, one: float) -> str:
    if not one:
        return "plate"
    return f"ball {1.0 / one:.4g} mm" if told_of == "radius" else f"block {1.0 / one:.3g} MPa"


def _areas(posterior: Posterior, cases: Sequence[tuple[float, float]], sets: Sequence[Sequence[int]]) -> Array:
    """Shares of the nodes (cases, sets) that 95 % regions have, by readings without noise."""
    table = posterior.table
    each = (posterior.logs(table.at(*case)) for case in cases)
    return np.array([[region(weights_of(logs, chosen)) for chosen in sets] for logs in each])


def _told(
    posterior: Posterior, told_of: ObjectProperty, case: tuple[float, float], area_ratio: float, single: int
) -> ToldObject:
    """Intervals of an object and a force by all readings, over those by the ``single`` one."""
    (one, force), table = case, posterior.table
    readings, logs = table.at(one, force), np.log(table.forces)
    widths = []
    for chosen in [(single,), tuple(range(len(table.pressures_kPa)))]:
        weights = posterior.of(readings, chosen)
        low, high = interval(logs, weights.sum(axis=0))
        widths.append(high - low)
    objects, mass = table.objects, weights
    mean = float((mass.sum(axis=0) * logs).sum()), float((mass.sum(axis=1) * objects).sum())
    spread = mass * np.outer(objects - mean[1], logs - mean[0])
    variances = (mass.sum(axis=0) * (logs - mean[0]) ** 2).sum() * (mass.sum(axis=1) * (objects - mean[1]) ** 2).sum()
    low, high = interval(objects, weights.sum(axis=1))
    ball = told_of == "radius"
    return ToldObject(
        object=_words(told_of, one),
        ball_radius_mm=1.0 / one if one and ball else None,
        modulus_MPa=1.0 / one if one and not ball else None,
        force_N=force,
        force_half_width_percent=100.0 * (math.exp(0.5 * widths[1]) - 1.0),
        curvature_interval_per_mm=(low, high) if ball else None,
        compliance_interval_per_MPa=None if ball else (low, high),
        area_ratio=area_ratio,
        force_ratio=widths[1] / widths[0],
        correlation=float(spread.sum() / math.sqrt(variances)) if variances > 0.0 else 0.0,
    )


def _confusion(posterior: Posterior, classes: Sequence[float], chosen: Sequence[int]) -> tuple[tuple[float, ...], ...]:
    """Shares of objects (rows), pressed by random forces, that are told as each class (columns): the one whose
    probability, summed over all forces, is greatest."""
    table, random = posterior.table, np.random.default_rng(0)
    only = replace(posterior, table=table.of(classes))
    counts = np.zeros((len(classes), len(classes)))
    for i, one in enumerate(classes):
        reach = table.reach(one)
        least = max(LEAST * reach, float(table.forces[0]))
        for force in np.exp(random.uniform(math.log(least), math.log(reach), _DRAWS)):
            reading = posterior.drawn(table.at(one, float(force)), random)
            counts[i, int(only.of(reading, chosen).sum(axis=1).argmax())] += 1.0
    return tuple(tuple((row / _DRAWS).tolist()) for row in counts)


def _planned(
    posterior: Posterior,
    tabulated: Callable[..., ObjectTable],
    count: int,
    cases: Sequence[tuple[float, float]],
    told_of: ObjectProperty,
) -> PlannedReading:
    """The set of ``count`` driving pressures, between the least and the greatest asked, whose mean region is
    smallest."""
    asked_kPa = posterior.table.pressures_kPa
    at_kPa = np.round(np.linspace(asked_kPa[0], asked_kPa[-1], _STEPS), 6)
    other = replace(posterior, table=tabulated(at_kPa.tolist(), grid=_COARSE))
    cases = _cases(other.table, sorted({one for one, _ in cases}), told_of)
    sets: list[tuple[int, ...]] = [(k,) for k in range(_STEPS)]
    sets += list(itertools.combinations_with_replacement(range(_STEPS), count)) if count > 1 else []
    means = np.exp(np.log(_areas(other, cases, sets)).mean(axis=0))
    first = 0 if count == 1 else _STEPS
    best = first + int(means[first:].argmin())
    return PlannedReading(tuple(at_kPa[list(sets[best])].tolist()), float(means[best] / means[:_STEPS].min()))
