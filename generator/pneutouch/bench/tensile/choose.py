"""Choice of a material's law, with the fewest constants within 5 % of the measured stress; and the modulus of a puck.

A law is stable over the states of a fit where the second derivatives of its energy by the logarithms of two principal
stretches are positive definite (Drucker 1964; Ogden, Non-linear Elastic Deformations, 1984, section 6.2).

Stretches that a wall reaches were measured with the solid (neo-Hookean) on paper-dome, fingertip-dome and soft-pad,
walls of 0.012 to 0.6 MPa, plate to three quarters of the inner radius, up to 0.8 of the limit point, and on every
shipped design at 0, at its rated pressure and at 0.9 of its limit point. The largest first invariant anywhere on the
faces half a wall away from the clamp is that of uniaxial tension by 1.92 at 0.17 MPa, 1.79 at 0.2 MPa and 2.09, 2.22,
2.33 and 2.39 at 0.08, 0.05, 0.025 and 0.012 MPa: in a softer wall the trapped gas hardly yields, and the wall bulges
instead. They are measured again by `reach` in ``benchmarks/materials.py``."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.statistics import neo_hookean
from pneutouch.bench.tensile.law_fit import (
    RATIOS,
    LawFit,
    LawForm,
    TensionCurve,
    difference,
    fit_law,
    invariant,
    joined_points,
    tension_basis,
)
from pneutouch.bench.tensile.read import LEAST_POINTS, MODULI, column_pairs
from pneutouch.errors import InputError
from pneutouch.mechanics.laws import Hyperelastic, hyperelastic
from pneutouch.mechanics.laws.hyperelastic import first_invariant, same_invariant
from pneutouch.mechanics.laws.strain import VALUE, Strain
from pneutouch.tables.read import layout_of, whole

_STATES, _STEP = 60, 1e-3
_POISSON_RATIO = 0.49


def instability(name: str, constants: tuple[float, ...], largest: float) -> str | None:
    """First state in which a law is unstable, in words; None for a stable law.

    The states considered have at most the first invariant of uniaxial tension at the stretch ``largest``. Raises
    InputError for constants that give no solid at all."""
    law = hyperelastic(name, constants, _POISSON_RATIO)
    most = float(first_invariant(largest))
    for kind, ratio in zip(("uniaxial tension", "pure shear", "equibiaxial tension"), RATIOS.values(), strict=True):
        logs = np.linspace(_STEP, np.log(largest), _STATES)
        logs = logs[invariant(np.exp(logs), ratio) <= most * (1.0 + 1e-9)]
        least = _least_stiffness(law, logs, ratio * logs)
        if (least <= 0.0).any():
            return f"{kind} at a stretch of {np.exp(logs[int(np.argmax(least <= 0.0))]):.2f}"
    return None


def _least_stiffness(law: Hyperelastic, first: Array, second: Array) -> Array:
    """Lesser eigenvalue, (n,), of the second derivatives of the energy by two log stretches, by finite differences."""

    def energy(one: Array, other: Array) -> Array:
        a, j = np.exp(2.0 * one) + np.exp(2.0 * other), np.exp(one + other)
        return np.asarray(law.energy(Strain(a, j, 1.0 / j)).data[VALUE])

    here = energy(first, second)
    sums = {}
    for key, (x, y) in {"xx": (1, 0), "yy": (0, 1), "xy": (1, 1)}.items():
        there = energy(first + x * _STEP, second + y * _STEP) + energy(first - x * _STEP, second - y * _STEP)
        sums[key] = (there - 2.0 * here) / _STEP**2
    across = 0.5 * (sums["xy"] - sums["xx"] - sums["yy"])
    middle, apart = 0.5 * (sums["xx"] + sums["yy"]), 0.5 * (sums["xx"] - sums["yy"])
    return np.asarray(middle - np.hypot(apart, across))


SOFT = 0.1
"""Shear modulus, MPa, below which a wall is stretched further (`REACHED_SOFT`)."""

REACHED, REACHED_SOFT = 2.0, 2.5
"""Uniaxial stretches that walls, and walls softer than `SOFT`, reach: those in the module's text, rounded up."""


def reached_stretch(shear_modulus: float) -> float:
    """Uniaxial stretch up to which the law of a wall with a given shear modulus (MPa) has to be fitted."""
    return REACHED_SOFT if shear_modulus < SOFT else REACHED


MISFIT, WORST_MISFIT = 0.05, 0.25
"""Greatest misfit of a law that counts as good, and that is taken: our choice, three times that of the worst shipped
law (0.079, Ecoflex 00-10)."""

NEO_HOOKEAN = LawForm("neo-hookean", 1)

FORMS = (
    NEO_HOOKEAN,
    LawForm("yeoh", 2),
    LawForm("ogden", 2),
    LawForm("mooney-rivlin", 2),
    LawForm("yeoh", 3),
    LawForm("ogden", 4),
)
"""Laws in the order in which they are preferred: fewest constants first. Among laws with equally many Yeoh's comes
first: it depends only on the first invariant, so that a fit in tension also holds in two directions (Yeoh, Rubber Chem.
Technol. 66, 754-771, 1993); tension hardly determines the constant of the second invariant (Treloar 1975, p. 215)."""

BIAXIAL_FORMS = (LawForm("mooney-rivlin", 2), NEO_HOOKEAN, LawForm("ogden", 4), LawForm("yeoh", 2), LawForm("yeoh", 3))
"""The order where planar or equibiaxial tests are among the data: they determine a constant of the second invariant,
on which Mooney-Rivlin's law depends, and Ogden's by its negative exponents."""

EXTRA_POINTS = 2
"""Least number of points beyond the constants of a law: with none every law fits exactly, whatever the material."""

LEAST_FITTED = 2 + EXTRA_POINTS
"""Least number of points in the range: with fewer only the neo-Hookean law is left, compared with no other."""

LAST = LawForm("ogden", 6)
"""Law tried after `FORMS`, if none is good: few curves determine all of its six constants."""

_NEAR_BEST = 0.01
"""Distance from the least misfit within which the law with the fewest constants is taken if none is good."""

_WORSE = 2.0
"""Factor by which a law may miss points left out of its fit more than those in it: our choice."""

_MOST_SLACK, _SLACK_STEPS = 0.08, 81
_LEAST_SLACK = 0.002
"""A slack below this counts as none: a fifth of a per cent of the gauge length."""


@dataclass(frozen=True, slots=True)
class LawChoice:
    """Fits of all laws, the law taken, and the reasons against others.

    Attributes:
        curves: Fitted curves: without slack, up to the largest stretch.
        whole: The same curves with the points beyond the largest stretch.
        largest: Greatest stretch of the fit.
        fits: Fits in the order of `FORMS`, or `BIAXIAL_FORMS`, and `LAST`; of tension alone, Ogden's laws are tried
            only while no other is good.
        refused: Reasons why a law cannot be used, by its index in ``fits``.
        chosen: Index in ``fits`` of the law taken.
        each: Neo-Hookean shear modulus fitted to each single curve, MPa.
    """

    curves: tuple[TensionCurve, ...]
    whole: tuple[TensionCurve, ...]
    largest: float
    fits: tuple[LawFit, ...]
    refused: dict[int, str]
    chosen: int
    each: tuple[float, ...]

    @property
    def law(self) -> LawFit:
        """The law taken."""
        return self.fits[self.chosen]

    @property
    def neo_hookean(self) -> LawFit:
        """The neo-Hookean law over the same range."""
        return next(fit for fit in self.fits if fit.form == NEO_HOOKEAN)

    @property
    def kinds(self) -> tuple[str, ...]:
        """Kinds of test among the curves, in the order of `RATIOS`."""
        return tuple(kind for kind in RATIOS if kind in {curve.kind for curve in self.curves})


def choose_law(curves: Sequence[TensionCurve], largest: float | None = None, slack: float | None = None) -> LawChoice:
    """Fit the laws to the curves and take the first good one; without one, that of fewest constants near the best fit.

    Args:
        curves: Rising curves.
        largest: Stretch to fit up to; None: what a wall of the curves' modulus reaches (`reached_stretch`), at most the
            end of the data.
        slack: Strain to take off every curve; None: found for each.

    Raises:
        InputError: No law is stable over the range, or too few points are in it."""
    first = reached_stretch(_modulus(curves)) if largest is None else largest
    whole = tuple(curve.without_slack(_slack(curve, first) if slack is None else slack) for curve in curves)
    modulus = _modulus([curve.up_to(first) for curve in whole])
    most = min(float(curve.tension[-1]) for curve in whole)
    largest = min(reached_stretch(modulus) if largest is None else largest, most)
    fitted = tuple(curve.up_to(largest) for curve in whole)
    for curve, every in zip(fitted, whole, strict=True):
        _enough(curve, every, largest)
    fits, refused = _tried(fitted, largest)
    usable = [k for k in range(len(fits)) if k not in refused]
    if not usable:
        problem = "no law fits these data: each is unstable in the range, or has constants that they do not determine"
        raise InputError(problem, file=curves[0].file)
    each = tuple(fit_law(NEO_HOOKEAN, [curve]).constants[0] for curve in fitted)
    return LawChoice(fitted, whole, largest, tuple(fits), refused, _taken(fits, usable), each)


def _enough(curve: TensionCurve, whole: TensionCurve, largest: float) -> None:
    """Raise InputError for a curve of fewer than `LEAST_FITTED` points in the range."""
    count = curve.stretch.size
    if count >= LEAST_FITTED:
        return
    problem = (
        f"{count} of {whole.stretch.size} points are in the range of the fit, up to a stretch of {largest:.3g} in "
    )
    remedy = f"at least {LEAST_FITTED}, two more than a law of two constants has: measure at closer points"
    if whole.stretch.size >= LEAST_FITTED:
        further = np.ceil(100.0 * float(whole.tension[LEAST_FITTED - 1]) * (1.0 + whole.slack)) / 100.0
        remedy += f", or give `stretch_to` {further:g}"
    raise InputError(f"{problem}tension", file=curve.file, remedy=remedy)


def _tried(curves: Sequence[TensionCurve], largest: float) -> tuple[list[LawFit], dict[int, str]]:
    """Fits of the laws in their order, and reasons against some, by index."""
    fits: list[LawFit] = []
    refused: dict[int, str] = {}
    biaxial, good = any(curve.kind != "tension" for curve in curves), False
    points = sum(curve.stretch.size for curve in curves)
    for form in (*(BIAXIAL_FORMS if biaxial else FORMS), LAST):
        if good and form.name == "ogden":
            continue
        fits.append(fit_law(form, curves))
        why = _refused(fits[-1], largest)
        if points < form.parameters + EXTRA_POINTS:
            why = f"{points} points for {form.parameters} constants; at least {form.parameters + EXTRA_POINTS}"
        elif why is None and biaxial and (off := _held_out(form, curves)) > max(MISFIT, _WORSE * fits[-1].misfit):
            why = f"off by {100 * off:.2g} % at points that were left out of its fit"
        if why is not None:
            refused[len(fits) - 1] = why
        good = good or (why is None and fits[-1].misfit <= MISFIT)
    return fits, refused


def _held_out(form: LawForm, curves: Sequence[TensionCurve]) -> float:
    """Greatest misfit of a law at every second point, fitted to the others; both halves are left out in turn."""
    halves = [[curve.at(slice(start, None, 2)) for curve in curves] for start in (0, 1)]
    off = []
    for fitted, left in (halves, halves[::-1]):
        fit = fit_law(form, fitted)
        off += [np.abs(means).max(initial=0.0) for means in (difference(fit, curve)[1] for curve in left)]
    return float(max(off))


def _taken(fits: Sequence[LawFit], usable: Sequence[int]) -> int:
    """Index of the law to take: the first of ``usable`` within `MISFIT`, or near the least misfit if none is."""
    least = min(fits[k].misfit for k in usable)
    limit = max(MISFIT, least + _NEAR_BEST) if least > MISFIT else MISFIT
    return next(k for k in usable if fits[k].misfit <= limit)


def _refused(fit: LawFit, largest: float) -> str | None:
    """Reason why a fitted law cannot be taken; None if it can."""
    if not fit.determined:
        return "the data do not determine all of its constants"
    try:
        where = instability(fit.form.name, fit.constants, largest)
    except InputError as error:
        return error.problem
    return None if where is None else f"unstable in {where}"


def _modulus(curves: Sequence[TensionCurve]) -> float:
    return fit_law(NEO_HOOKEAN, curves).constants[0]


def _slack(curve: TensionCurve, largest: float) -> float:
    """Strain before the specimen carries load: the one with which Yeoh's law of three terms is nearest to the data.

    Grips that slide and a specimen that straightens add to the travel of a crosshead at the beginning. The law goes
    through the origin whatever its constants, so that the first points decide. 0 if it is less than `_LEAST_SLACK`.
    """
    near = curve.up_to(largest * (1.0 + _MOST_SLACK))

    def cost(slack: float) -> float:
        stretch, stress, scale, ratio = joined_points([replace(near, stretch=near.stretch / (1.0 + slack))])
        basis = tension_basis("yeoh", 3, np.maximum(stretch, 1.0), ratio) / scale[:, None]
        constants = np.linalg.lstsq(basis, stress / scale, rcond=None)[0]
        return float(np.sum((basis @ constants - stress / scale) ** 2))

    tries = np.linspace(0.0, _MOST_SLACK, _SLACK_STEPS)
    best = float(min(tries, key=lambda slack: cost(float(slack))))
    return best if best >= _LEAST_SLACK else 0.0


_LEAST, _MOST = 0.05, 0.4
"""Compression over thickness: the least that a test must reach, and the greatest that is fitted."""

_ZEROS = np.linspace(0.0, 0.1, 101)
"""Candidates for the travel before the plate touches, over the thickness."""


@dataclass(frozen=True, slots=True)
class PuckSize:
    """Diameter and thickness of a puck in mm; ``bonded`` is True if its faces cannot slide on the plates."""

    diameter: float
    thickness: float
    bonded: bool = False

    @property
    def stiffening(self) -> float:
        """Apparent over true modulus: 1 + 2 S^2 with S = d / (4 t) where the faces are held (Gent and Lindley, Proc.
        Inst. Mech. Eng. 173, 111-122, 1959), 1 where they slide."""
        return 1.0 + 2.0 * (self.diameter / (4.0 * self.thickness)) ** 2 if self.bonded else 1.0


@dataclass(frozen=True, slots=True)
class PuckFit:
    """Neo-Hookean shear modulus in MPa, and ``error``, its k = 2 uncertainty from the scatter of the points.

    Attributes:
        stretch: Stretches of the fitted points, below 1, (n,).
        stress: Their nominal stress, compression negative, MPa (n,), as of a puck whose faces slide.
        misfit: Greatest relative difference of stress where the compression is above a twentieth of the thickness.
        largest: Stretch of uniaxial tension with the greatest first invariant of the test.
        zero: Travel before the plate touched, mm.
    """

    modulus: float
    error: float
    stretch: Array
    stress: Array
    misfit: float
    largest: float
    zero: float


def fit_puck(path: Path, size: PuckSize) -> PuckFit:
    """Fit the neo-Hookean law to a file of compression (mm) and force (N), both positive as the plate goes down.

    Raises InputError for a file that cannot be read, too few points, too little compression, a compression that falls,
    or units that no elastomer has.
    """
    layout = layout_of(path)
    pairs = [pair for pair in column_pairs(layout.names, layout.units, str(path)) if pair.length.kind == "travel"]
    if not pairs:
        raise InputError("no column of travel", file=path, remedy="name the columns Compression (mm), Force (N)")
    columns = whole(path, (pairs[0].length.name, pairs[0].load.name), layout)[1]
    travel, force = columns[0] * (pairs[0].length.factor or 1.0), columns[1] * (pairs[0].load.factor or 1.0)
    if (np.diff(travel) < -2e-3 * np.ptp(travel)).any():
        raise InputError("the compression falls", file=path, remedy="give the points of one loading")
    area = 0.25 * np.pi * size.diameter**2
    fits = [_fit(travel - zero * size.thickness, force / area / size.stiffening, size.thickness) for zero in _ZEROS]
    known = [(fit, float(zero)) for fit, zero in zip(fits, _ZEROS, strict=True) if fit is not None]
    if not known:
        problem = f"fewer than {LEAST_POINTS} points, or less than {100 * _LEAST:g} % of the thickness"
        raise InputError(problem, file=path, remedy="press further, to a fifth of the thickness or so")
    (modulus, error, stretch, stress, misfit), zero = min(known, key=lambda pair: pair[0][4])
    if not MODULI[0] <= modulus <= MODULI[1]:
        problem = f"force over area makes a shear modulus of {modulus:.4g} MPa; an elastomer has {MODULI[0]:g} to "
        raise InputError(f"{problem}{MODULI[1]:g} MPa", file=path, remedy="is the force in N and the travel in mm?")
    largest = float(same_invariant(first_invariant(stretch).max()))
    return PuckFit(modulus, error, stretch, stress, misfit, largest, zero * size.thickness)


def _fit(travel: Array, stress: Array, thickness: float) -> tuple[float, float, Array, Array, float] | None:
    """Modulus, twice its standard error, stretch, stress and misfit; None for too few points or too little
    compression."""
    near = (travel > 0.0) & (travel <= _MOST * thickness)
    if near.sum() < LEAST_POINTS or travel[near].max() < _LEAST * thickness:
        return None
    stretch, nominal = 1.0 - travel[near] / thickness, -stress[near]
    modulus, error = neo_hookean(stretch, nominal)
    rest = nominal - modulus * (stretch - stretch**-2)
    far = stretch < 1.0 - _LEAST
    misfit = float(np.abs(rest[far] / nominal[far]).max()) if far.any() else np.inf
    return modulus, 2.0 * error, stretch, nominal, misfit
