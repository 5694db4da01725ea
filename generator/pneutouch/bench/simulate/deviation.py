"""Deviations of a simulated sensor from its model, so that a calibration does not meet the very model that it fits."""

from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.simulate.curve import PressCurve, PressCurves
from pneutouch.bench.simulate.parameter import parameter
from pneutouch.units import KPA

_WAVES = 3
"""Half waves along the travel that a smooth deviation is made of, the k-th 1/k as large: our choice."""

_TURN = 22.0 * KPA
"""Driving pressure at which the smooth share is independent of that without one: the paper's highest."""


@dataclass(frozen=True, slots=True)
class ModelDeviation:
    """Shares of force and of pressure rise by which a specimen deviates, drawn independently; none by default."""

    common: float = parameter(
        0.0, "1", "standard deviation of the share that is the same at every driving pressure and travel"
    )
    smooth: float = parameter(
        0.0, "1", "standard deviation of the share that varies along the travel and with the driving pressure"
    )

    def deviated(self, curves: PressCurves, rng: np.random.Generator) -> PressCurves:
        """The curves of one specimen with the shares that ``rng`` draws for it; as they are where nothing deviates."""
        if self == ModelDeviation():
            return curves
        common = self.common * rng.standard_normal(2)
        waves = self.smooth * rng.standard_normal((2, 2, _WAVES))
        return replace(curves, curves=tuple(_deviated(curve, common, waves) for curve in curves.curves))


def _deviated(curve: PressCurve, common: Array, waves: Array) -> PressCurve:
    """A curve with the shares of force and rise (2,) and the weights of their waves (2, 2, waves)."""
    order = np.arange(1, _WAVES + 1)
    shape = np.cos(np.pi * np.outer(curve.indentation / curve.indentation[-1], order))
    shape *= np.sqrt(2.0) / order / np.sqrt((1.0 / order**2).sum())
    turn = 0.5 * np.pi * curve.driving / _TURN
    weights = np.cos(turn) * waves[:, 0] + np.sin(turn) * waves[:, 1]
    force, rise = np.exp(common[:, None] + weights @ shape.T)
    return replace(curve, force=curve.force * force, rise=curve.rise * rise)
