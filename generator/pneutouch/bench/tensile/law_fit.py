"""Fit of a hyperelastic law to measured curves, by least squares of the relative difference of stress.

In the tests of `RATIOS` the stretches are l, l^r and l^(-1-r), and no stress acts along the third. The nominal stress
of an incompressible law along the first is 2 (l - l^(-3-2r)) (dW/dI1 + l^(2r) dW/dI2) (Treloar 1975, ch. 5)."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.mechanics.laws.hyperelastic import same_invariant

UNIAXIAL = -0.5

RATIOS = {"tension": UNIAXIAL, "planar": 0.0, "equibiaxial": 1.0}
"""Logarithm of the second principal stretch over that of the first, by the kind of test."""


@dataclass(frozen=True, slots=True)
class TensionCurve:
    """One loading: stretch (n,), rising, and nominal stress (n,) in MPa, force over the undeformed cross-section.

    Attributes:
        file: File of the curve, for messages.
        notes: Changes made to the numbers when they were read.
        slack: Strain taken off the data: that before the specimen carried load.
        facts: Entries of the file on the test, such as its machine or its speed.
        kind: Kind of test, a key of `RATIOS`."""

    stretch: Array
    stress: Array
    file: str = ""
    notes: tuple[str, ...] = ()
    slack: float = 0.0
    facts: dict[str, str] = field(default_factory=dict)
    kind: str = "tension"

    @property
    def ratio(self) -> float:
        """Logarithm of the second principal stretch over that of the first."""
        return RATIOS[self.kind]

    @property
    def tension(self) -> Array:
        """Stretches (n,) of uniaxial tension with the same first invariants."""
        return self.stretch if self.ratio == UNIAXIAL else same_invariant(invariant(self.stretch, self.ratio))

    def without_slack(self, slack: float) -> "TensionCurve":
        """The curve with its stretch counted from the onset of load at the strain ``slack``, without earlier points."""
        stretch = self.stretch / (1.0 + slack)
        kept = stretch > 1.0
        return replace(self, stretch=stretch[kept], stress=self.stress[kept], slack=slack)

    def up_to(self, largest: float) -> "TensionCurve":
        """The curve up to the first invariant of uniaxial tension at a stretch."""
        return self.at(self.tension <= largest * (1.0 + 1e-9))

    def at(self, points: Flags | slice) -> "TensionCurve":
        """The curve of some of its points alone."""
        return replace(self, stretch=self.stretch[points], stress=self.stress[points])

    def stress_at(self, stretch: float) -> float:
        """Nominal stress at a stretch, interpolated linearly between the points and from the origin, MPa."""
        return float(np.interp(stretch, [1.0, *self.stretch], [0.0, *self.stress]))


def invariant(stretch: Array, ratio: Array | float) -> Array:
    """First invariants (n,) of tests at stretches (n,)."""
    return np.asarray(stretch**2 + stretch ** (2.0 * ratio) + stretch ** (-2.0 - 2.0 * ratio))


def tension_basis(name: str, count: int, stretch: Array, ratio: Array | float = UNIAXIAL) -> Array:
    """Columns (n, count) that add up to the nominal stress when multiplied by the constants; not for Ogden's law."""
    plain, above = stretch - stretch ** (-3.0 - 2.0 * ratio), invariant(stretch, ratio) - 3.0
    if name == "neo-hookean":
        columns = [plain]
    elif name == "mooney-rivlin":
        columns = [2.0 * plain, 2.0 * plain * stretch ** (2.0 * ratio)]
    else:
        columns = [2.0 * (i + 1) * plain * above**i for i in range(count)]
    return np.stack(columns, axis=1)


def tension(name: str, constants: Sequence[float], stretch: Array, ratio: Array | float = UNIAXIAL) -> Array:
    """Nominal stress in MPa of a law by name at stretches (n,); its constants as in `mechanics.laws.LAWS`."""
    if name != "ogden":
        return np.asarray(tension_basis(name, len(constants), stretch, ratio) @ np.asarray(constants, float))
    pairs, across = zip(constants[::2], constants[1::2], strict=True), -1.0 - ratio
    return np.asarray(
        sum((2.0 * mu / alpha) * (stretch ** (alpha - 1.0) - stretch ** (across * alpha - 1.0)) for mu, alpha in pairs)
    )


FROM_STRAIN = 0.1
"""Strain above which the misfit is evaluated: below it slack, crosshead and the zero of the load cell dominate."""

WINDOW = 0.1
"""Width, in stretch, over which the differences of neighbouring points are averaged before the greatest is taken."""

_COVERAGE = 2.0

_STARTS: tuple[tuple[tuple[float, ...], ...], ...] = (
    ((2.0,), (4.0,), (8.0,)),
    ((2.0, 6.0), (1.5, 4.0), (1.0, 10.0), (2.0, -2.0)),
    ((1.5, 5.0, 12.0), (1.0, 3.0, 8.0)),
)
"""Exponents from which Ogden's law is fitted, by its number of terms; the best of the fits is kept."""

_EXPONENTS = (1.0, 25.0)
"""Bounds of Ogden's exponents. A negative one acts in biaxial states; tension hardly shows and cannot determine it."""

_NEGATIVE = -10.0
"""Least exponent where other tests than tension determine negative ones."""

_MODULI = 50.0
"""Bound of a term's modulus, as a multiple of the modulus of the whole curve."""


class LawForm(NamedTuple):
    """A law by name with its number of constants."""

    name: str
    parameters: int

    @property
    def label(self) -> str:
        """Name of the law, with its number of terms where it may have several."""
        if self.name in ("neo-hookean", "mooney-rivlin"):
            return {"neo-hookean": "neo-Hookean", "mooney-rivlin": "Mooney-Rivlin"}[self.name]
        return f"Yeoh, {self.parameters} terms" if self.name == "yeoh" else f"Ogden, {self.parameters // 2} terms"


@dataclass(frozen=True, slots=True)
class LawFit:
    """A fitted law: constants in MPa (Ogden: mu, alpha, ...) with their k = 2 uncertainties, and its misfit.

    Attributes:
        errors: Twice the standard errors of the fit. They include only the scatter of the points, not that of batches.
        misfit: Greatest magnitude of the relative difference of stress from the data, averaged over `WINDOW` against
            the load cell's noise, above the strain `FROM_STRAIN`; infinite without points there.
        worst: Greatest relative difference at a single point; infinite without points.
    """

    form: LawForm
    constants: tuple[float, ...]
    errors: tuple[float, ...]
    misfit: float
    worst: float

    @property
    def determined(self) -> bool:
        """True if the data determine every constant: none is smaller than its uncertainty."""
        return all(abs(value) > error for value, error in zip(self.constants, self.errors, strict=True))

    def stress(self, stretch: Array, kind: str = "tension") -> Array:
        """Nominal stress in MPa at stretches (n,) of a kind of test."""
        return tension(self.form.name, self.constants, stretch, RATIOS[kind])


def joined_points(curves: Sequence[TensionCurve]) -> tuple[Array, Array, Array, Array]:
    """Stretch, stress, stress that divides differences, and the kind's ratio, (n,) each.

    Differences are divided by the point's stress, at least its curve's at `FROM_STRAIN`, and so that every kind of test
    has the same weight whatever its number of points."""
    stretch, stress = (np.concatenate([getattr(curve, key) for curve in curves]) for key in ("stretch", "stress"))
    sizes = [curve.stretch.size for curve in curves]
    least, ratio = np.repeat([(curve.stress_at(1.0 + FROM_STRAIN), curve.ratio) for curve in curves], sizes, axis=0).T
    kinds, kind, counts = np.unique(ratio, return_inverse=True, return_counts=True)
    weight = np.sqrt(counts * kinds.size / ratio.size)
    return stretch, stress, np.maximum(stress, least) * weight[kind], ratio


def fit_law(form: LawForm, curves: Sequence[TensionCurve]) -> LawFit:
    """Fit a law's constants to all points of the curves, by least squares of differences relative to the stress.

    Relative differences give each part of the range the same weight; the stated misfit is relative too.
    """
    stretch, stress, scale, ratio = joined_points(curves)
    constants: Array
    if form.name == "ogden":
        constants, spread = _ogden(form.parameters // 2, stretch, stress, scale, ratio)
    else:
        basis = tension_basis(form.name, form.parameters, stretch, ratio) / scale[:, None]
        constants = np.asarray(np.linalg.lstsq(basis, stress / scale, rcond=None)[0], float)
        spread = _spread(basis, basis @ constants - stress / scale)
    fit = LawFit(form, tuple(map(float, constants)), tuple(map(float, _COVERAGE * spread)), np.inf, np.inf)
    off = [difference(fit, curve) for curve in curves]
    means, points = (np.concatenate([pair[k] for pair in off]) for k in (1, 2))
    if not points.size:
        return fit
    return replace(fit, misfit=float(np.abs(means).max()), worst=float(np.abs(points).max()))


def difference(fit: LawFit, curve: TensionCurve) -> tuple[Array, Array, Array]:
    """Stretches above `FROM_STRAIN`, a law's relative differences there, as running mean and by point; (n,) each."""
    far = curve.stretch >= 1.0 + FROM_STRAIN
    stretch, stress = curve.stretch[far], curve.stress[far]
    points = fit.stress(stretch, curve.kind) / stress - 1.0
    near = np.abs(stretch[:, None] - stretch[None, :]) <= 0.5 * WINDOW
    return stretch, np.asarray(near @ points / near.sum(axis=1)), points


def _spread(jacobian: Array, residual: Array) -> Array:
    """Standard errors of the constants from the derivatives (n, k) and the residuals (n,) of a least squares fit."""
    freedom = max(residual.size - jacobian.shape[1], 1)
    covariance = np.linalg.pinv(jacobian.T @ jacobian) * float(residual @ residual) / freedom
    return np.sqrt(np.maximum(np.diag(covariance), 0.0))


def _ogden(terms: int, stretch: Array, stress: Array, scale: Array, ratio: Array) -> tuple[Array, Array]:
    """Constants mu, alpha, ... of the best fit from several starts, and their standard errors."""
    from scipy.optimize import least_squares

    size = float(np.median(stress / np.maximum(tension_basis("neo-hookean", 1, stretch, ratio)[:, 0], 1e-9)))
    least, most = (_NEGATIVE if (ratio != UNIAXIAL).any() else _EXPONENTS[0]), _EXPONENTS[1]

    def residual(flat: Array) -> Array:
        scaled = flat.copy()
        scaled[::2] *= size
        return (tension("ogden", scaled.tolist(), stretch, ratio) - stress) / scale

    low, high = np.tile([-_MODULI, least], terms), np.tile([_MODULI, most], terms)
    fits = []
    for start in (start for start in _STARTS[terms - 1] if min(start) >= least):
        first = np.ravel([(1.0 / terms, alpha) for alpha in start])
        fits.append(least_squares(residual, first, bounds=(low, high), max_nfev=200))
    best = min(fits, key=lambda fit: float(fit.cost))
    factors = np.tile([size, 1.0], terms)
    return np.asarray(best.x) * factors, _spread(np.asarray(best.jac), np.asarray(best.fun)) * factors
