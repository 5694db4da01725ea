"""One source of uncertainty: what it acts on, how far it spreads, and where its number comes from."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from pneutouch.arrays import Array, Flags

FIGURES = (
    "sensitivity_kPa_per_N",
    "limit_pressure_kPa",
    "stiffness_N_per_mm",
    "force_at_range_end_N",
    "range_end_mm",
    "apex_height_outer_mm",
)
"""The predicted figures, in the order of every array over figures."""

INPUTS = ("shear_modulus", "wall_thickness", "inner_radius", "dead_volume", "ambient_pressure", "driving_pressure")
"""What a source may act on through the model, in the order of every array over inputs; names of `SensorBatch`."""

FIGURE = "figure"
"""Acts on the predicted figure itself, as a relative error."""

SENSITIVITY = FIGURES.index("sensitivity_kPa_per_N")
DEAD = INPUTS.index("dead_volume")

Distribution = Literal["normal", "rectangular", "lognormal", "log-rectangular"]


@dataclass(frozen=True)
class UncertaintySource:
    """A named source for n sensors.

    Attributes:
        name: Short name, the key of its share.
        acts_on: One of `INPUTS`, or `FIGURE`.
        standard: Standard uncertainty (n,), relative; of the dead volume absolute, mm3, because it may be zero.
        distribution: Of the relative deviation (normal, rectangular) or of its logarithm (lognormal, log-rectangular).
        counts: Which figures of which sensors it counts for, (figures, n).
        origin: Where the number comes from.
        known: Whether it is a published or measured number; False for an assumption.
        freedom: Degrees of freedom of ``standard``; infinite for a bound or an assumption (JCGM 100, G.4.3).
    """

    name: str
    acts_on: str
    standard: Array
    distribution: Distribution
    counts: Flags
    origin: str
    known: bool
    freedom: float = np.inf

    @property
    def kurtosis(self) -> float:
        """Fourth moment over squared variance of the deviation, or of its logarithm."""
        return 1.8 if self.distribution.endswith("rectangular") else 3.0

    def sample(self, row: int, count: int, draw: np.random.Generator) -> Array:
        """Deviations of sensor ``row``, (count,): a factor, or mm3 to be added for the dead volume."""
        flat = self.distribution.endswith("rectangular")
        unit = draw.uniform(-np.sqrt(3.0), np.sqrt(3.0), count) if flat else draw.standard_normal(count)
        deviation = self.standard[row] * unit
        if self.acts_on == INPUTS[DEAD]:
            return np.asarray(deviation)
        return np.asarray(np.exp(deviation) if self.distribution.startswith("log") else 1.0 + deviation)

    def document(self, row: int) -> dict[str, Any]:
        """The source as it leaves the program, for sensor ``row``."""
        absolute = self.acts_on == INPUTS[DEAD]
        return {
            "name": self.name,
            "acts_on": self.acts_on,
            "standard_uncertainty": float(self.standard[row]) * (1e-3 if absolute else 1.0),
            "unit": "mL" if absolute else "relative",
            "distribution": self.distribution,
            "figures": [name for name, counts in zip(FIGURES, self.counts[:, row], strict=True) if counts],
            "known": self.known,
            "origin": self.origin,
        }


def counting(size: int, *, only: tuple[int, ...] = (), without: tuple[int, ...] = ()) -> Flags:
    """Which figures count, (figures, size): all, or ``only`` these, or all ``without`` these."""
    flags = np.full((len(FIGURES), size), not only)
    flags[list(only)] = True
    flags[list(without)] = False
    return flags
