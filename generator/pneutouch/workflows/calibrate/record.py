"""A calibration as data: the output of ``calibrate`` and the content of ``calibration.json``."""

from typing import Any, TypedDict


class PriorRecord(TypedDict):
    """Prior of a parameter, and whether it counted."""

    counted: bool
    standard_deviation: float
    relative: bool
    source: str


class EstimateRecord(TypedDict):
    """A fitted parameter in the unit that it leaves with; without an interval where the runs give none."""

    parameter: str
    key: str
    unit: str
    value: float
    interval_95: list[float] | None
    on_bound: bool
    designed: float
    prior: PriorRecord


class CorrelationRecord(TypedDict):
    """The correlation matrix of the fitted parameters, None if unknown."""

    parameters: list[str]
    matrix: list[list[float | None]]


class GoodnessRecord(TypedDict):
    """Goodness of the fit of the model to the runs."""

    chi_squared: float
    degrees_of_freedom: int
    chi_squared_per_degree: float | None
    points_used: int
    points_left_out: int
    scatter_over_stated: dict[str, float]
    model_leaves_out_share_of_reading: dict[str, float]
    considered: list[str]
    variance_of_runs_over_points: float
    interval_from_runs: bool


class ResponseRecord(TypedDict):
    """The correction of the fitted model at a driving pressure, and its standard uncertainties."""

    driving_pressure_kPa: float
    force_factor: float
    pressure_factor: float
    sensitivity_error_relative: float
    force_error_relative: float


class MissRecord(TypedDict):
    """A stretch of travel, and the greatest mean residual in it over full scale."""

    driving_pressure_kPa: float
    channel: str
    from_mm: float
    to_mm: float
    share: float


class ResidualRecord(TypedDict):
    """Root mean square residuals of a run over full scale."""

    run: str
    driving_pressure_kPa: float | None
    force_share_of_full_scale: float | None
    pressure_share_of_full_scale: float | None


class CorrelatedRecord(TypedDict):
    """Strongly correlated parameters: see `bench.calibrate.identify.CorrelatedParameters`."""

    parameters: list[str]
    correlation: float
    standard_deviation_alone: list[float | None]
    standard_deviation_others_known: list[float | None]
    modulus_times_wall_to_the: float | None


class FurtherRecord(TypedDict):
    """A proposed test, and the 95 % intervals then expected."""

    test: str
    widest_interval_shrinks: float
    expected_half_widths: dict[str, float | None]


class HeldOutRecord(TypedDict):
    """A driving pressure that was held out; errors of the curves are shares of full scale."""

    driving_pressure_kPa: float
    sensitivity_measured_kPa_per_N: float
    sensitivity_predicted_kPa_per_N: float
    sensitivity_error: float
    force_rms_share: float
    force_greatest_share: float
    pressure_rms_share: float
    pressure_greatest_share: float
    points: int
    points_left_out: int


class FitRecord(TypedDict):
    """Record of a fit: its parameters, its data and its goodness."""

    runs: int
    injections: int
    driving_pressures_kPa: list[float]
    ambient_pressure_kPa: float
    estimates: list[EstimateRecord]
    correlation: CorrelationRecord
    fit: GoodnessRecord


class CalibrationRecord(FitRecord):
    """A calibration of a sensor."""

    design: str
    sensor: str
    campaign: str
    response: list[ResponseRecord]
    residuals: list[ResidualRecord]
    misses: list[MissRecord]
    strongly_correlated: list[CorrelatedRecord]
    unidentified: list[str]
    further_tests: list[FurtherRecord]
    held_out: list[HeldOutRecord]
    warnings: list[str]
    notes: list[str]


class OutcomeRecord(CalibrationRecord):
    """A calibration as ``calibrate`` prints it: the name it was saved by (None: not saved), and the files."""

    calibration: str | None
    written: list[str]
    failures: list[list[str]]
    read_as: list[dict[str, Any]]
