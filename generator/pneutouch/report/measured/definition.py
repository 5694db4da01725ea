"""Meaning of each figure, in one line; formulas and sources are in docs/howto/measuring.md."""

from pneutouch.bench.figure import FIGURES

WHERE = "Formulas, units and sources: docs/howto/measuring.md, section Definitions."

LINES = {
    "sensitivity_kPa_per_N": "Slope of the least-squares line of pressure rise over force, with intercept, over a run.",
    "sensitivity_through_origin_kPa_per_N": "Slope of the least-squares line through the origin.",
    "r_squared": "Share of the variance of the rise that the line with intercept explains.",
    "nonlinearity_percent": "Greatest distance from that line over the full-scale rise.",
    "repeatability_kPa_per_N": "Standard deviation of the sensitivity between runs of a specimen, pooled.",
    "part_to_part_kPa_per_N": "Standard deviation of the specimens' mean sensitivities.",
    "stiffness_N_per_mm": "Force at the greatest depth over that depth.",
    "force_range_N": "Greatest force of the sensitivity test, at its greatest depth.",
    "saturation_force_N": "Force at which the local slope of rise over force falls below half the fitted one.",
    "sensing_range_N": "Saturation force, or the greatest force reached where the sensor did not saturate.",
    "hysteresis_width_percent": "Greatest difference in rise between loading and unloading, over the full-scale rise.",
    "hysteresis_area_percent": "Area between loading and unloading over the area under loading.",
    "relaxation_force_percent": "Loss of force from 1 s of the hold to its end, over the force at 1 s.",
    "relaxation_force_percent_per_decade": "Slope of that loss over the decimal logarithm of time.",
    "relaxation_pressure_percent": "Loss of pressure rise from 1 s of the hold to its end, over the rise at 1 s.",
    "relaxation_pressure_percent_per_decade": "Slope of that loss over the decimal logarithm of time.",
    "drift_pressure_kPa_per_min": "Slope of the pressure over time without contact.",
    "noise_force_N": "Standard deviation of a force sample without contact, trend taken out.",
    "noise_pressure_kPa": "Standard deviation of a pressure sample without contact, trend taken out.",
    "resolution_N": "Three standard deviations of the pressure's noise over the sensitivity.",
}
"""Lines by key of `bench.figure.FIGURES`."""

TERMS = (
    (
        "95 % interval",
        "Of a mean: over specimens, Student's t; with one specimen over its runs, which does not include other "
        "specimens. Of a standard deviation: chi-square.",
    ),
    ("n", "Specimens / runs behind a value."),
    (
        "Predicted band",
        "The interval that holds the figure of a printed sensor with 95 %, as the predicted datasheet states it.",
    ),
    ("Difference", "Measured less predicted, in percent of the predicted."),
    (
        "Overlap",
        "Whether the measured interval and the predicted band share a value; a measured value without an interval "
        "counts as itself. Empty where the prediction has no band.",
    ),
    ("Full scale", "Difference of the greatest and the least pressure rise of the run."),
)
"""Further words of the tables."""


def rows() -> list[list[str]]:
    """Name with unit, and meaning: of every figure, then of the tables' other words."""
    named = [[f"{f.name}, {f.unit}" if f.unit else f.name, LINES[f.key]] for f in FIGURES]
    return [*named, *([what, meaning] for what, meaning in TERMS)]
