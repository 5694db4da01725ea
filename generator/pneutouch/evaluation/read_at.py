"""A predicted curve read at the depths of measured runs: a figure belongs to the range it is fitted over."""

from collections.abc import Sequence

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.figure import line_figures
from pneutouch.mechanics.response import figures

_ROUNDING, _LEAST_POINTS = 1e-9, 3


def figures_at(
    indentation: Array, force: Array, rise_kPa: Array, range_end: float, specimens: Sequence[Sequence[Array]]
) -> dict[str, float]:
    """Figures of a curve (mm, N, kPa; one length) by key of `bench.figure.FIGURES`, as measured runs would give them.

    ``specimens`` holds the depths of each run of each specimen, mm. The curve is read at every run's own depths, as far
    as its range goes, and the figures are averaged as measured ones are: over the runs, then over the specimens.
    Saturation is left out where a run does not reach it.
    """
    from scipy.interpolate import PchipInterpolator

    kept = indentation <= range_end * (1 + _ROUNDING)
    travel, first = np.unique(indentation[kept], return_index=True)
    if travel.size < _LEAST_POINTS:
        return {}
    read = PchipInterpolator(travel, np.stack([force[kept][first], rise_kPa[kept][first]], axis=1))
    averages = []
    for runs in specimens:
        inside = (np.minimum(at[at <= range_end * (1 + _ROUNDING)], travel[-1]) for at in runs)
        fitted = [figures(at, *read(at).T) for at in inside]
        each = [line_figures(one) for one in fitted if one is not None]
        if each:
            averages.append(_mean(each))
    return _mean(averages) if averages else {}


def _mean(each: Sequence[dict[str, float]]) -> dict[str, float]:
    return {key: float(np.mean([one[key] for one in each])) for key in each[0] if all(key in one for one in each)}
