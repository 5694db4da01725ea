"""The sources of a budget through the atlas: the check of `propagate` (JCGM 101)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.figures import FIGURES, log_figures, moved
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.uncertainty.propagate import Budget, propagate
from pneutouch.mechanics.uncertainty.source import FIGURE, JOINT, UncertaintySource
from pneutouch.mechanics.uncertainty.sources import sources
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer

if TYPE_CHECKING:
    from pneutouch.mechanics.uncertainty.contact_model import ContactShift


def budget(batch: SensorBatch, material: Material, printer: Printer, **facts: Any) -> Budget:
    """The uncertainty of the figures of n sensors of one resin and printer; ``facts`` are those of `sources`."""
    return propagate(batch, sources(batch, material, printer, **facts), facts.get("contact"))


_COVERED = 0.9545
"""Share of a normal distribution within two standard deviations."""

_GRAIN = 5e-4
"""Wall ratios are rounded to this, relative: the atlas is cut once a ratio; no wall is known to a hundred times it."""


@dataclass(frozen=True)
class SampledFigures:
    """Figures of one sensor over the samples.

    Attributes:
        standard: Standard deviation of ln figure, (figures,).
        half_width: Half of the probabilistically symmetric 95.45 % interval of ln figure, (figures,).
        low: Its lower end, in the figure's unit, (figures,).
        high: Its upper end, (figures,).
        lost: Share of samples without the figure (beyond the limit point or outside the atlas), (figures,).
    """

    standard: Array
    half_width: Array
    low: Array
    high: Array
    lost: Array


def monte_carlo(
    batch: SensorBatch,
    sources: Sequence[UncertaintySource],
    row: int = 0,
    count: int = 20_000,
    seed: int = 1,
    shift: ContactShift | None = None,
) -> SampledFigures:
    """Sample the sources of sensor ``row``; the same seed gives the same samples. ``shift`` is that of the budget.

    Figures that the same sources count for are read off the same samples.
    """
    logs = np.empty((len(FIGURES), count))
    groups: dict[tuple[bool, ...], list[int]] = {}
    for figure in range(len(FIGURES)):
        through = tuple(bool(s.counts[figure, row]) for s in sources if s.acts_on != FIGURE)
        groups.setdefault(through, []).append(figure)
    for figures in groups.values():
        logs[figures] = _through_model(batch, sources, (row, count, seed), figures[0], shift)[figures]
    draw = np.random.default_rng([seed, 1])
    for source in sources:
        if source.acts_on == JOINT:
            continue
        factor = source.sample(row, count, draw)
        if source.acts_on == FIGURE:
            logs += np.where(source.counts[:, row, None], np.log(np.maximum(factor, np.finfo(float).tiny)), 0.0)
    return _summary(logs)


def _through_model(
    batch: SensorBatch,
    sources: Sequence[UncertaintySource],
    drawn: tuple[int, int, int],
    figure: int,
    shift: ContactShift | None,
) -> Array:
    """Logarithms of all figures, (figures, count), under the sources on inputs that count for one figure.

    ``drawn`` is the row of the sensor, how many samples, and their seed.
    """
    row, count, seed = drawn
    many = batch.take(np.full(count, row))
    draw = np.random.default_rng([seed, 0])
    for source in sources:
        if source.acts_on == FIGURE:
            continue
        for name, by in source.deviations(row, count, draw).items():
            if source.counts[figure, row]:
                many = moved(many, name, by)
    grain = _GRAIN * float(batch.wall_ratio[row])
    ratio = grain * np.round(many.wall_ratio / grain)
    logs = log_figures(replace(many, wall_thickness=ratio * many.inner_radius))
    if shift is None:
        return logs
    return logs + shift.row(row).at(np.log(many.shear_modulus / batch.shear_modulus[row])[:, None])[:, :, 0]


def _summary(logs: Array) -> SampledFigures:
    lost = np.isnan(logs).mean(axis=1)
    standard, low, high = (np.full(len(logs), np.nan) for _ in range(3))
    some = lost < 1.0
    standard[some] = np.nanstd(logs[some], axis=1)
    tails = [0.5 * (1.0 - _COVERED), 0.5 * (1.0 + _COVERED)]
    low[some], high[some] = np.nanquantile(logs[some], tails, axis=1)
    return SampledFigures(standard, 0.5 * (high - low), np.exp(low), np.exp(high), lost)
