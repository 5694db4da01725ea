"""Choice of the law of a material: the fewest constants whose stress is within 5 % of the measured one."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.bench.tensile.curve import TensionCurve
from pneutouch.bench.tensile.fit import LawFit, LawForm, fit_law, joined_points
from pneutouch.bench.tensile.reach import reached_stretch
from pneutouch.bench.tensile.stable import instability
from pneutouch.bench.tensile.uniaxial import tension_basis
from pneutouch.errors import InputError

MISFIT = 0.05
"""Greatest misfit of a law that is good enough."""

NEO_HOOKEAN = LawForm("neo-hookean", 1)

FORMS = (
    NEO_HOOKEAN,
    LawForm("yeoh", 2),
    LawForm("ogden", 2),
    LawForm("mooney-rivlin", 2),
    LawForm("yeoh", 3),
    LawForm("ogden", 4),
)
"""Laws in the order in which they are preferred: fewest constants first. Of as many constants Yeoh's comes first: it
depends on the first invariant alone, and what tension states of it carries over to two directions (Yeoh, Rubber Chem.
Technol. 66, 754-771, 1993); tension hardly determines the constant of the second invariant (Treloar 1975,
p. 215)."""

LAST = LawForm("ogden", 6)
"""Tried where none of `FORMS` is good enough: six constants, of which few curves determine all."""

_NEAR_BEST = 0.01
"""If no law is good enough, the one with fewest constants within this of the least misfit is taken."""

_MOST_SLACK, _SLACK_STEPS = 0.08, 81
_LEAST_SLACK = 0.002
"""A slack below this counts as none: a fifth of a per cent of the gauge length."""


@dataclass(frozen=True, slots=True)
class LawChoice:
    """The fits of all laws, the one taken and the reason.

    Attributes:
        curves: As fitted: without slack, up to the largest stretch.
        whole: The same with their points beyond the range.
        largest: Greatest stretch of the fit.
        fits: The laws that were tried, in the order of `FORMS`; Ogden's alone where none before was good enough.
        refused: Reasons why a law cannot be used, by its index in ``fits``.
        chosen: Index of the law taken.
        each: Shear modulus of the neo-Hookean law of each curve alone, MPa.
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
        return self.fits[0]

    @property
    def good(self) -> bool:
        """True if the law taken is within `MISFIT` of the data."""
        return self.law.misfit <= MISFIT


def choose_law(curves: Sequence[TensionCurve], largest: float | None = None, slack: float | None = None) -> LawChoice:
    """Fit every law to the curves and take one.

    Args:
        curves: Rising curves.
        largest: Stretch to fit up to; None: what the sensor reaches with such a modulus (`reach`), or the data's end.
        slack: Strain to take off every curve; None: found for each.

    Raises:
        InputError: No law is stable over the range, or a curve has too few points in it.
    """
    first = reached_stretch(_modulus(curves)) if largest is None else largest
    whole = tuple(curve.without_slack(_slack(curve, first) if slack is None else slack) for curve in curves)
    modulus = _modulus([curve.up_to(first) for curve in whole])
    most = min(float(curve.stretch[-1]) for curve in whole)
    largest = min(reached_stretch(modulus) if largest is None else largest, most)
    fitted = tuple(curve.up_to(largest) for curve in whole)
    fits, refused = _tried(fitted, largest)
    usable = [k for k in range(len(fits)) if k not in refused]
    if not usable:
        problem = "no law fits these data: each is unstable in the range, or has constants that they do not determine"
        raise InputError(problem, file=curves[0].file)
    each = tuple(fit_law(NEO_HOOKEAN, [curve]).constants[0] for curve in fitted)
    return LawChoice(fitted, whole, largest, tuple(fits), refused, _taken(fits, usable), each)


def _tried(curves: Sequence[TensionCurve], largest: float) -> tuple[list[LawFit], dict[int, str]]:
    """The laws in the order of `FORMS` up to the first that is good enough, at least those that are linear in their
    constants, and why some cannot be used."""
    fits: list[LawFit] = []
    refused: dict[int, str] = {}
    good = False
    for form in (*FORMS, LAST):
        if good and form.name == "ogden":
            continue
        fits.append(fit_law(form, curves))
        if (why := _refused(fits[-1], largest)) is not None:
            refused[len(fits) - 1] = why
        good = good or (why is None and fits[-1].misfit <= MISFIT)
    return fits, refused


def _taken(fits: Sequence[LawFit], usable: Sequence[int]) -> int:
    """The index of the law to take."""
    least = min(fits[k].misfit for k in usable)
    limit = max(MISFIT, least + _NEAR_BEST) if least > MISFIT else MISFIT
    return next(k for k in usable if fits[k].misfit <= limit)


def _refused(fit: LawFit, largest: float) -> str | None:
    """Reason why a fitted law cannot be taken, or None."""
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
    """Strain before the specimen carries load: that with which Yeoh's law of three terms is nearest to the data.

    Grips that slide and a specimen that straightens add to the travel of a crosshead at the beginning. The law goes
    through the origin whatever its constants, so that the first points decide. 0 where the data begin without slack.
    """
    near = curve.up_to(largest * (1.0 + _MOST_SLACK))

    def cost(slack: float) -> float:
        stretch, stress, scale = joined_points([replace(near, stretch=near.stretch / (1.0 + slack))])
        basis = tension_basis("yeoh", 3, np.maximum(stretch, 1.0)) / scale[:, None]
        constants = np.linalg.lstsq(basis, stress / scale, rcond=None)[0]
        return float(np.sum((basis @ constants - stress / scale) ** 2))

    tries = np.linspace(0.0, _MOST_SLACK, _SLACK_STEPS)
    best = float(min(tries, key=lambda slack: cost(float(slack))))
    return best if best >= _LEAST_SLACK else 0.0
