"""Misfit of the model to the runs as a whole, and the test that it is a model of the sensor at all."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pneutouch.bench.calibrate.discrepancy import LARGEST
from pneutouch.bench.calibrate.fit import CalibrationFit
from pneutouch.bench.calibrate.goodness import RunResiduals

DOUBTFUL, DOUBTFUL_CHI = 0.1, 3.0
"""Misfit over full scale, and chi-squared per degree of freedom, from which a fit is doubtful: our choice. Simulated
sensors, with all errors that the intervals count, have at most 0.018 and 0.8 (36 of three resins)."""

CONTRADICTED_CHI = 10.0
"""Chi-squared per degree of freedom above which the runs contradict the model: our choice. Its covariance holds a model
discrepancy of up to `LARGEST` already, so that of a model that applies is about 1, whatever its error."""


@dataclass(frozen=True, slots=True)
class ModelMisfit:
    """Root mean square residuals of all runs over their full scale, and chi-squared per degree of freedom.

    ``shares`` are those of force, pressure rise and an injection's pressure; of a channel that was not measured 0.
    """

    shares: tuple[float, float, float]
    chi_squared: float

    @property
    def doubtful(self) -> bool:
        """True if the model describes the runs poorly."""
        return max(self.shares) > DOUBTFUL or self.chi_squared > DOUBTFUL_CHI

    @property
    def contradicted(self) -> bool:
        """True if the fitted model does not describe the sensor: it is off by more than the greatest discrepancy that a
        fit considers (`LARGEST`), or by more than that and the scatter explain."""
        return max(self.shares) > LARGEST or self.chi_squared > CONTRADICTED_CHI

    @property
    def words(self) -> str:
        """The misfit in words."""
        names = ("force", "pressure rise", "injection's pressure")
        off = ", ".join(f"{name} by {share:.1%}" for name, share in zip(names, self.shares, strict=True) if share)
        return f"{off} of full scale (root mean square), chi-squared per degree of freedom {self.chi_squared:.3g}"


def misfit(fit: CalibrationFit, runs: Sequence[RunResiduals]) -> ModelMisfit:
    """The misfit of a fit from the residuals of its runs (`goodness.residuals`)."""
    curves = [run for run in runs if run.force.size]
    injected = [run for run in runs if not run.force.size]
    shares = (
        _pooled([run.force_error for run in curves]),
        _pooled([run.rise_error for run in curves]),
        _pooled([run.rise_error for run in injected]),
    )
    return ModelMisfit(shares, fit.chi_squared / fit.freedom if fit.freedom else 0.0)


def _pooled(errors: list[float]) -> float:
    known = np.array([error for error in errors if np.isfinite(error)])
    return float(np.sqrt(np.mean(known**2))) if known.size else 0.0
