"""A calibration: the output of ``calibrate`` and the content of ``calibration.json``."""

from collections.abc import Mapping
from dataclasses import dataclass

from pneutouch.results.measured import ReadFiles


@dataclass(frozen=True, slots=True)
class PriorRecord:
    """Prior of a parameter: what was known of it before the fit."""

    counted: bool
    """True if the fit used the prior."""
    standard_deviation: float
    """Standard deviation of the prior, relative or in the unit of the parameter."""
    relative: bool
    """True if the standard deviation is relative."""
    source: str
    """Source of the prior."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EstimateRecord:
    """A fitted parameter in the unit of its key."""

    parameter: str
    """The parameter in words."""
    key: str
    """Key of the parameter, which ends in its unit."""
    unit: str
    """Unit of the value."""
    value: float
    """Fitted value."""
    interval_95: tuple[float, float] | None
    """Ends of the 95 % interval; null: the runs give none."""
    on_bound: bool
    """True if the fit ended on a bound."""
    designed: float
    """Value by the design."""
    prior: PriorRecord
    """Value and standard deviation before the fit."""


@dataclass(frozen=True, slots=True)
class CorrelationRecord:
    """The correlation matrix of the fitted parameters."""

    parameters: tuple[str, ...]
    """Names of the parameters, in the order of the rows."""
    matrix: tuple[tuple[float | None, ...], ...]
    """Correlation matrix; null: not known."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GoodnessRecord:
    """Goodness of the fit of the model to the runs."""

    chi_squared: float
    """Sum of the squared residuals over their variances."""
    degrees_of_freedom: int
    """Degrees of freedom of that sum."""
    chi_squared_per_degree: float | None
    """The sum over the degrees of freedom; null: there are none."""
    points_used: int
    """Points that the fit used."""
    points_left_out: int
    """Points that the fit left out."""
    scatter_over_stated: Mapping[str, float]
    """Scatter of the readings over the stated one, by channel."""
    model_leaves_out_share_of_reading: Mapping[str, float]
    """Model discrepancy, what the model leaves out, over the reading, by channel."""
    considered: tuple[str, ...]
    """Parameters that are not fitted, whose uncertainty the fit counts."""
    variance_of_runs_over_points: float
    """Variance between runs over that between points."""
    interval_from_runs: bool
    """True if the intervals follow from the scatter of the runs."""


@dataclass(frozen=True, slots=True)
class FittedResponse:
    """The correction of the fitted model at a driving pressure, and its standard uncertainties."""

    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    force_factor: float
    """Measured force over that of the fitted model."""
    pressure_factor: float
    """Measured pressure rise over that of the fitted model."""
    sensitivity_error_relative: float
    """Standard uncertainty of the corrected sensitivity."""
    force_error_relative: float
    """Standard uncertainty of the corrected force."""


@dataclass(frozen=True, slots=True)
class MissRecord:
    """A stretch of travel, and the greatest mean residual in it over full scale."""

    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    channel: str
    """Channel of the record."""
    from_mm: float
    """Start of the stretch of travel."""
    to_mm: float
    """End of the stretch of travel."""
    share: float
    """Greatest mean residual over full scale."""


@dataclass(frozen=True, slots=True)
class ResidualRecord:
    """Root mean square residuals of a run over full scale."""

    run: str
    """Name of the run."""
    driving_pressure_kPa: float | None
    """Gauge pressure before contact; null: an injection."""
    force_share_of_full_scale: float | None
    """Root mean square residual of the force; null: an injection."""
    pressure_share_of_full_scale: float | None
    """Root mean square residual of the pressure rise; null: not known."""


@dataclass(frozen=True, slots=True)
class CorrelatedRecord:
    """Strongly correlated parameters: the runs determine a combination of them better than each one."""

    parameters: tuple[str, ...]
    """Names of the parameters."""
    correlation: float
    """Strongest correlation among them, with its sign."""
    standard_deviation_alone: tuple[float | None, ...]
    """Standard deviation of each by the runs, all of them fitted; null: infinite."""
    standard_deviation_others_known: tuple[float | None, ...]
    """Standard deviation of each if the others were known; null: infinite."""
    modulus_times_wall_to_the: float | None
    """Power of the wall in the product with the modulus that is known well; null: other parameters."""


@dataclass(frozen=True, slots=True)
class FurtherRecord:
    """A proposed test, and the 95 % intervals then expected."""

    test: str
    """The test in words."""
    widest_interval_shrinks: float
    """Factor by which the widest interval would shrink."""
    expected_half_widths: Mapping[str, float | None]
    """Half widths of the 95 % intervals then expected, by parameter."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HeldOutRecord:
    """A driving pressure that was held out; errors of the curves are shares of full scale."""

    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    sensitivity_measured_kPa_per_N: float
    """Measured sensitivity."""
    sensitivity_predicted_kPa_per_N: float
    """Sensitivity predicted without this pressure's runs."""
    sensitivity_error: float
    """Predicted over measured, less 1."""
    force_rms_share: float
    """Root mean square error of the force over full scale."""
    force_greatest_share: float
    """Greatest error of the force over full scale."""
    pressure_rms_share: float
    """Root mean square error of the pressure rise over full scale."""
    pressure_greatest_share: float
    """Greatest error of the pressure rise over full scale."""
    points: int
    """Points that were compared."""
    points_left_out: int
    """Points that the model could not compute."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibrationRecord:
    """A calibration of a sensor: its parameters, its data and its goodness."""

    design: str
    """Name of the design."""
    sensor: str
    """Name of the specimen."""
    campaign: str
    """Title of the campaign."""
    runs: int
    """Number of loading curves."""
    injections: int
    """Number of injection runs."""
    driving_pressures_kPa: tuple[float, ...]
    """Gauge pressures before contact."""
    ambient_pressure_kPa: float
    """Absolute pressure around the sensor."""
    estimates: tuple[EstimateRecord, ...]
    """Fitted parameters."""
    correlation: CorrelationRecord
    """Correlation of the fitted parameters."""
    fit: GoodnessRecord
    """Goodness of the fit."""
    response: tuple[FittedResponse, ...]
    """Corrections of the fitted model, one entry a driving pressure."""
    residuals: tuple[ResidualRecord, ...]
    """Residuals of each run."""
    misses: tuple[MissRecord, ...]
    """Stretches of travel where the fitted model deviates from the runs."""
    strongly_correlated: tuple[CorrelatedRecord, ...]
    """Parameters that the runs cannot separate."""
    unidentified: tuple[str, ...]
    """Parameters that the runs do not determine."""
    further_tests: tuple[FurtherRecord, ...]
    """Tests that would reduce the uncertainty."""
    held_out: tuple[HeldOutRecord, ...]
    """Driving pressures that were held out."""
    warnings: tuple[str, ...]
    """Reasons to doubt the calibration, in words."""
    notes: tuple[str, ...]
    """Notes in words."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OutcomeRecord(CalibrationRecord):
    """A calibration as ``calibrate`` prints it, with the files that it read and wrote."""

    calibration: str | None
    """Name under which it was saved; null: it was not saved."""
    written: tuple[str, ...]
    """Files that were written."""
    failures: tuple[tuple[str, str], ...]
    """Files that could not be used, each with the reason."""
    read_as: tuple[ReadFiles, ...]
    """Columns and formats that were found from the files themselves."""
