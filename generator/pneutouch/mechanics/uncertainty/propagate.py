"""Propagation of sources by derivatives to combined uncertainties and the share of each source (JCGM 100, 5.1)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.uncertainty.contact import ContactModel, ContactShift
from pneutouch.mechanics.uncertainty.derivatives import Derivatives, derivatives
from pneutouch.mechanics.uncertainty.neighbours import joined
from pneutouch.mechanics.uncertainty.source import FIGURES, INPUTS, UncertaintySource

COVERAGE = 2.0
"""k: about 95 % where many sources of one size add up."""

_NORMAL = 3.0
"""Kurtosis of a normal distribution."""

_BENT = 0.05

_NOTHING = 1e-6
"""Relative standard uncertainties below this are rounding: the figure is exact under the sources given."""


@dataclass(frozen=True)
class Budget:
    """Uncertainties of the figures of n sensors.

    Everything is computed in natural logarithms: a figure lies between value / exp(k u) and value * exp(k u). For
    small u that is value +- k u value; for wide ones it keeps positive quantities positive.

    Attributes:
        sources: The sources, in the order of the first axis of ``variances``.
        derivatives: Figures, elasticities, nonlinearities.
        variances: Of the logarithm, by source, (sources, figures, n).
        linear: Combined standard uncertainty by the derivatives alone, (figures, n).
        shift: Of the figures from the plate's to those of another contact; None under a plate without friction.
        freedom: Effective degrees of freedom (Welch-Satterthwaite, JCGM 100, G.4.1), (figures, n).
    """

    sources: tuple[UncertaintySource, ...]
    derivatives: Derivatives
    variances: Array
    linear: Array
    freedom: Array
    shift: ContactShift | None = None

    @property
    def values(self) -> Array:
        """The figures as the atlas has them, (figures, n), in the units of `FIGURES`; NaN if it has none."""
        return np.asarray(np.exp(self.derivatives.logs))

    @property
    def standard(self) -> Array:
        """Combined standard uncertainty of the logarithm, that is relative, (figures, n); NaN without a figure."""
        combined = np.sqrt(self.variances.sum(axis=0))
        return np.where(np.isfinite(self.derivatives.logs), combined, np.nan)

    @property
    def expanded(self) -> Array:
        """Expanded uncertainty k u of the logarithm, (figures, n)."""
        return COVERAGE * self.standard

    @property
    def shares(self) -> Array:
        """Shares of the variance by source, (sources, figures, n): they sum to 1, or are 0 for an exact figure."""
        total = self.variances.sum(axis=0)
        exact = total <= _NOTHING**2
        return np.asarray(np.where(exact, 0.0, self.variances / np.where(exact, 1.0, total)))

    @property
    def nonlinear(self) -> Flags:
        """Figures whose uncertainty differs from the derivatives' alone by more than 5 %, (figures, n).

        There the response bends within the spread of an input, mostly because another event ends the range; the
        figure's distribution is not normal, and k = 2 need not cover 95 %.
        """
        combined = self.standard
        with np.errstate(invalid="ignore"):
            return np.asarray((np.abs(combined - self.linear) > _BENT * combined) & (combined > _NOTHING))

    @property
    def doubtful(self) -> Flags:
        """Sensors that within their uncertainty leave the atlas or pass their limit point, (n,)."""
        return np.asarray(self.derivatives.one_sided.any(axis=0))


def propagate(batch: SensorBatch, sources: list[UncertaintySource], contact: ContactModel | None = None) -> Budget:
    """Combine the sources of n sensors through the atlas; they are taken as independent of one another.

    Inputs that are correlated belong to one joint source.
    """
    standard, kurtosis = _by_input(batch, sources)
    shift = None
    if contact is not None:
        modulus = INPUTS.index("shear_modulus")
        shift = contact.shift(float((np.sqrt(kurtosis[modulus]) * standard[modulus].max(axis=0)).max()))
    return _combined(sources, derivatives(batch, standard, kurtosis, shift=shift), shift)


def propagate_groups(groups: Sequence[tuple[SensorBatch, list[UncertaintySource]]]) -> list[Budget]:
    """`propagate` of groups of sensors, each with its sources: one pass through the atlas, as its calls cost most."""
    batches = [batch for batch, _ in groups]
    spreads = [_by_input(batch, sources) for batch, sources in groups]
    standard, kurtosis = (np.concatenate(part, axis=-1) for part in zip(*spreads, strict=True))
    sizes = [len(batch) for batch in batches]
    slopes_of = derivatives(joined(batches), standard, kurtosis, groups=np.repeat(np.arange(len(groups)), sizes))
    return [
        _combined(sources, slopes_of.part(slice(end - size, end)), None)
        for (_, sources), size, end in zip(groups, sizes, np.cumsum(sizes), strict=True)
    ]


def _combined(sources: list[UncertaintySource], slopes_of: Derivatives, shift: ContactShift | None) -> Budget:
    by_source = variances(sources, slopes_of.slopes)
    linear = np.sqrt(variances(sources, slopes_of.local).sum(axis=0))
    freedom = np.array([source.freedom for source in sources])
    total = by_source.sum(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        effective = total**2 / (by_source**2 / freedom[:, None, None]).sum(axis=0)
    effective = np.where(np.isnan(effective), np.inf, effective)
    return Budget(tuple(sources), slopes_of, by_source, linear, effective, shift)


def variances(sources: list[UncertaintySource], slopes: Array) -> Array:
    """Variances of the logarithms of the figures, (sources, figures, n), by their slopes, (inputs, figures, n)."""
    return np.stack([source.variance(slopes) for source in sources])


def _by_input(batch: SensorBatch, sources: list[UncertaintySource]) -> tuple[Array, Array]:
    """Standard uncertainty of each input as each figure counts it (inputs, figures, n), and kurtosis (inputs, n)."""
    size = len(batch)
    second = np.zeros((len(INPUTS), len(FIGURES), size))
    every, fourth = np.zeros((len(INPUTS), size)), np.zeros((len(INPUTS), size))
    for source in sources:
        for name, standard in source.moves.items():
            i = INPUTS.index(name)
            second[i] += np.where(source.counts, standard**2, 0.0)
            every[i] += standard**2
            fourth[i] += (source.kurtosis - _NORMAL) * standard**4
    root = np.sqrt(second)
    return root, _NORMAL + fourth / np.where(every > 0, every**2, 1.0)
