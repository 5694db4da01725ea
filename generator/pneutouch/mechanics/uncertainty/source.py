"""Record of one source of uncertainty: the inputs or figures it acts on, its spread, and the origin of its number."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.mechanics.atlas.figures import DEAD, FIGURES, INPUTS
from pneutouch.results.uncertainty import SourceRecord

FIGURE = "figure"
"""Value of ``acts_on`` for a relative error of the predicted figure itself."""

JOINT = "parameters"
"""Value of ``acts_on`` for several inputs with correlated deviations."""

FRICTION, CORRECTION, PLACE = "friction", "contact correction", "place of contact"
"""Names of the sources of `contact_model`."""

Distribution = Literal["normal", "rectangular", "lognormal", "log-rectangular"]


@dataclass(frozen=True)
class UncertaintySource:
    """A named source of uncertainty for n sensors.

    Attributes:
        name: Short name, under which its share of the variance is given.
        acts_on: One of `INPUTS`, `FIGURE`, or `JOINT`.
        standard: Standard uncertainty (n,), relative; for the dead volume absolute, mm3, because that may be zero.
        distribution: Of the relative deviation (normal, rectangular), or of the factor's logarithm (the other two).
        counts: Figures and sensors for which the source counts, (figures, n).
        origin: Origin of the number, in words.
        known: True if it is a published or measured number; False for an assumption.
        freedom: Degrees of freedom of ``standard``; infinite for a bound or an assumption (JCGM 100, G.4.3).
        loads: For a joint source, by input: changes of that input as in `moved` by independent deviations of unit
            variance, a row of the covariance's root; rows of one length. ``standard`` then gives only the number n.
    """

    name: str
    acts_on: str
    standard: Array
    distribution: Distribution
    counts: Flags
    origin: str
    known: bool
    freedom: float = np.inf
    loads: Mapping[str, tuple[float, ...]] = field(default_factory=dict)

    @property
    def moves(self) -> dict[str, Array]:
        """Standard uncertainties (n,) by the name of the input; empty for a source that acts on the figure."""
        if self.acts_on == JOINT:
            return {name: np.full(self.standard.shape, np.linalg.norm(row)) for name, row in self.loads.items()}
        return {} if self.acts_on == FIGURE else {self.acts_on: self.standard}

    def variance(self, slopes: Array) -> Array:
        """Variances (figures, n) of the figures' logarithms by this source, from the slopes (inputs, figures, n)."""
        if self.acts_on == FIGURE:
            whole = np.broadcast_to(self.standard**2, self.counts.shape)
        elif self.acts_on == JOINT:
            rows = np.array([slopes[INPUTS.index(name)] for name in self.loads])
            whole = (np.einsum("ifn,ic->cfn", rows, np.array([*self.loads.values()])) ** 2).sum(axis=0)
        else:
            whole = (slopes[INPUTS.index(self.acts_on)] * self.standard) ** 2
        return np.where(self.counts, whole, 0.0)

    def deviations(self, row: int, count: int, draw: "np.random.Generator") -> dict[str, Array]:
        """Sampled changes (count,) by input, in the form for `moved`: logarithmic, or mm3 for the dead volume."""
        if self.acts_on == JOINT:
            rows = np.array([*self.loads.values()])
            return dict(zip(self.loads, rows @ draw.standard_normal((rows.shape[1], count)), strict=True))
        by = self.sample(row, count, draw)
        return {self.acts_on: by if self.acts_on == INPUTS[DEAD] else np.log(by)}

    @property
    def kurtosis(self) -> float:
        """Fourth moment over squared variance of the deviation, or of its logarithm."""
        return 1.8 if self.distribution.endswith("rectangular") else 3.0

    def sample(self, row: int, count: int, draw: "np.random.Generator") -> Array:
        """Sampled factors (count,) for sensor ``row``; for the dead volume mm3 to add. Not for a joint source."""
        flat = self.distribution.endswith("rectangular")
        unit = draw.uniform(-np.sqrt(3.0), np.sqrt(3.0), count) if flat else draw.standard_normal(count)
        deviation = self.standard[row] * unit
        if self.acts_on == INPUTS[DEAD]:
            return np.asarray(deviation)
        return np.asarray(np.exp(deviation) if self.distribution.startswith("log") else 1.0 + deviation)

    def documents(self, row: int) -> list[SourceRecord]:
        """Records of the source for sensor ``row``; a joint source has one record for each input."""
        if self.acts_on == FIGURE:
            return [self._document(row, FIGURE, float(self.standard[row]))]
        return [self._document(row, name, float(standard[row])) for name, standard in self.moves.items()]

    def _document(self, row: int, acts_on: str, standard: float) -> SourceRecord:
        absolute = acts_on == INPUTS[DEAD]
        return SourceRecord(
            name=self.name,
            acts_on=acts_on,
            standard_uncertainty=standard * (1e-3 if absolute else 1.0),
            unit="mL" if absolute else "relative",
            distribution=self.distribution,
            figures=tuple(name for name, counts in zip(FIGURES, self.counts[:, row], strict=True) if counts),
            known=self.known,
            origin=self.origin,
        )


def counting(size: int, *, only: tuple[int, ...] = (), without: tuple[int, ...] = ()) -> Flags:
    """Mask (figures, size) of the figures that count: those of the indices ``only`` (none: all), less ``without``."""
    flags = np.full((len(FIGURES), size), not only)
    flags[list(only)] = True
    flags[list(without)] = False
    return flags
