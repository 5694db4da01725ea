"""Propagation of sources by derivatives to combined uncertainties and the share of each source (JCGM 100, 5.1).

Also the derivatives of the figures of many sensors by their inputs, local and over the inputs' whole spread.

Also the uncertainty of the limit pressure alone, without a press, so that thousands of candidates cost little.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.mechanics.atlas.figures import DEAD, FIGURES, INPUTS, log_figures, moved, neighbourhood, unit_step
from pneutouch.mechanics.atlas.press import SensorBatch
from pneutouch.mechanics.uncertainty.source import UncertaintySource
from pneutouch.mechanics.uncertainty.sources import sources
from pneutouch.mechanics.uncertainty.sources.model_error import ModelErrors
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer

if TYPE_CHECKING:
    from pneutouch.mechanics.uncertainty.contact_model import ContactModel, ContactShift
    from pneutouch.spec.calibration import SensorCalibration

STEP = 0.015
"""Relative step to each side in a central difference. For smaller steps the noise of tabulated range ends grows (the
edge of buckling is piecewise linear), for larger ones curvature, mostly where a wall lies down on its base. Half and
twice the step change a derivative of the sensitivity by less than 0.04 and the combined uncertainty by less than 2 %,
mostly by less than 0.1 % (`tests/mechanics/uncertainty/test_derivatives.py`; 0.01 and 0.02 keep neither bound)."""

_ONE_PAIR = 4.0
"""Spread in steps up to which its ends are the step too: the derivative is then over the spread, as it is to count."""

_BENT_SHARE = 0.05
"""Relative difference above which the effect over an input's whole spread replaces its local derivative."""

_WIDE = 0.5
"""Least share of an input's spread that must count for a figure, for its derivative to be replaced."""


@dataclass(frozen=True)
class Derivatives:
    """Figures of n sensors and their derivatives by the inputs.

    Attributes:
        logs: ln of the figures, (figures, n).
        elasticities: d ln figure / d ln input, (inputs, figures, n); 0 for the dead volume if there is none.
        local: Derivatives of ln figure by the change of an input as in `moved`, (inputs, figures, n).
        slopes: As ``local``, but for a bent response the root mean square change per standard uncertainty, with sign.
        one_sided: True where a sensor could not be evaluated on one side: beyond its limit point or the atlas, (inputs,
            n).
    """

    logs: Array
    elasticities: Array
    local: Array
    slopes: Array
    one_sided: Flags

    def part(self, rows: slice) -> "Derivatives":
        """Derivatives for the sensors of a slice."""
        return Derivatives(*(getattr(self, each.name)[..., rows] for each in fields(self)))


def derivatives(
    batch: SensorBatch, standard: Array, kurtosis: Array, step: float = STEP, shift: "ContactShift | None" = None
) -> Derivatives:
    """Derivatives of the figures of n sensors by a small step in every input, and over its spread.

    Args:
        batch: The sensors.
        standard: Standard uncertainties of the inputs as they count for each figure, (inputs, figures, n).
        kurtosis: Fourth moment over squared variance of each input's deviation, (inputs, n).
        step: Half of the central difference, relative.
        shift: Change of the figures from the plate to another contact.
    """
    size = len(batch)
    near, far = step * unit_step(batch), np.sqrt(kurtosis) * standard.max(axis=1)
    wide = far > _ONE_PAIR * near
    small = np.where(wide, near, np.maximum(near, far))
    inputs = range(len(INPUTS))
    moves = [(i, sign * small[i], np.arange(size)) for i in inputs for sign in (1.0, -1.0)]
    moves += [(i, sign * far[i], np.flatnonzero(wide[i])) for i in inputs for sign in (1.0, -1.0)]
    own = np.concatenate([np.arange(size), *(rows for _, _, rows in moves)])
    every = SensorBatch.join([batch, *(moved(batch.take(rows), INPUTS[i], by[rows]) for i, by, rows in moves)])
    logs = log_figures(every)
    if shift is not None:
        by = np.log(every.shear_modulus / batch.shear_modulus[own])
        logs = logs + replace(shift, nodes=shift.nodes[..., own]).at(by[None])[:, 0]
    here, *around = np.split(logs, np.cumsum([size, *(rows.size for _, _, rows in moves)])[:-1], axis=1)
    beside = np.stack(around[: 2 * len(INPUTS)]).reshape(len(INPUTS), 2, *here.shape) - here
    ends = beside * (far / small)[:, None, None]
    for k, ((i, _, rows), found) in enumerate(zip(moves, around, strict=True)):
        if k >= 2 * len(INPUTS):
            ends[i, k % 2][:, rows] = found - here[:, rows]
    return from_changes(here, (beside, small), (ends, far >= near), batch.dead_volume, standard, kurtosis)


def from_changes(
    here: Array,
    beside: tuple[Array, Array],
    ends: tuple[Array, Flags],
    dead_volume: Array,
    standard: Array,
    kurtosis: Array,
) -> Derivatives:
    """Derivatives from the changes of ln figure, (inputs, 2, figures, n), to both sides: by a step ``beside``, (inputs,
    n), and to the ``ends`` of the spread, with True where these are farther than the least step."""
    (change, step), (whole_change, wide), widest = beside, ends, standard.max(axis=1)
    local = _slope(change[:, 0], change[:, 1]) / step[:, None]
    whole, known = _over_spread(whole_change[:, 0], whole_change[:, 1], kurtosis[:, None])
    linear = np.abs(local) * widest[:, None]
    bent = (
        known & (np.abs(whole - linear) > _BENT_SHARE * linear) & (standard >= _WIDE * widest[:, None]) & (standard > 0)
    )
    sign = np.where(whole_change[:, 0] < whole_change[:, 1], -1.0, 1.0)
    slopes = np.where(bent, sign * whole / np.where(bent, widest[:, None], 1.0), local)
    scale = np.ones_like(step)
    scale[DEAD] = dead_volume
    missing = (np.isnan(whole_change).any(axis=1) & np.isfinite(here)).any(axis=1)
    return Derivatives(here, local * scale[:, None], local, slopes, missing & wide)


def _slope(up: Array, down: Array) -> Array:
    """Half the difference of the changes on both sides; one side's if the other is NaN, 0 if both are."""
    both = np.where(np.isnan(down), up, np.where(np.isnan(up), -down, 0.5 * (up - down)))
    return np.where(np.isnan(both), 0.0, both)


def _over_spread(up: Array, down: Array, kurtosis: Array) -> tuple[Array, Flags]:
    """Standard deviation of ln figure over an input's spread, from changes at both ends, and True if both are known.

    Three-point rule at sqrt(kurtosis) standard uncertainties with weights 1/(2 kurtosis), which reproduces the first
    five moments of the deviation: Gauss-Hermite for a normal, Gauss-Legendre for a rectangular distribution.
    """
    known = np.isfinite(up) & np.isfinite(down)
    high, low = np.where(known, up, 0.0), np.where(known, down, 0.0)
    weight = 0.5 / kurtosis
    return np.sqrt(np.maximum(weight * (high**2 + low**2) - (weight * (high + low)) ** 2, 0.0)), known


COVERAGE = 2.0
"""Coverage factor k: about 95 % if many sources of similar size add up."""

_NORMAL = 3.0
"""Kurtosis of a normal distribution."""

_BENT = 0.05

_NOTHING = 1e-6
"""Relative standard uncertainty below which a figure counts as exact: no source acts on it, but for rounding."""


@dataclass(frozen=True)
class Budget:
    """Uncertainties of the figures of n sensors.

    Everything is computed in natural logarithms: a figure lies between value / exp(k u) and value * exp(k u). For small
    u this is value +- k u value; for large u it keeps positive quantities positive.

    Attributes:
        sources: The sources, in the order of the first axis of ``variances``.
        derivatives: Figures and their derivatives by the inputs.
        variances: Variances of the logarithm of the figures, by source, (sources, figures, n).
        linear: Combined standard uncertainty by the local derivatives only, (figures, n).
        shift: Change of the figures from the plate to another contact; None under a frictionless plate.
        freedom: Effective degrees of freedom (Welch-Satterthwaite, JCGM 100, G.4.1), (figures, n).
    """

    sources: tuple[UncertaintySource, ...]
    derivatives: Derivatives
    variances: Array
    linear: Array
    freedom: Array
    shift: "ContactShift | None" = None

    @property
    def values(self) -> Array:
        """Figures of the atlas, (figures, n), in the units of `FIGURES`; NaN if it has none."""
        return np.asarray(np.exp(self.derivatives.logs))

    @property
    def standard(self) -> Array:
        """Combined standard uncertainty of the logarithms of the figures, (figures, n); NaN without a figure."""
        combined = np.sqrt(self.variances.sum(axis=0))
        return np.where(np.isfinite(self.derivatives.logs), combined, np.nan)

    @property
    def expanded(self) -> Array:
        """Expanded uncertainty k u of the logarithms of the figures, (figures, n)."""
        return COVERAGE * self.standard

    @property
    def shares(self) -> Array:
        """Shares (sources, figures, n) of the variance by source: their sum is 1, or 0 for an exact figure."""
        total = self.variances.sum(axis=0)
        exact = total <= _NOTHING**2
        return np.asarray(np.where(exact, 0.0, self.variances / np.where(exact, 1.0, total)))

    @property
    def nonlinear(self) -> Flags:
        """Mask (figures, n) of the figures whose uncertainty differs by more than 5 % from that by local derivatives.

        The response then bends within the spread of an input, mostly because another event ends the range; the figure's
        distribution is not normal, and k = 2 need not cover 95 %.
        """
        combined = self.standard
        with np.errstate(invalid="ignore"):
            return np.asarray((np.abs(combined - self.linear) > _BENT * combined) & (combined > _NOTHING))

    @property
    def doubtful(self) -> Flags:
        """Mask (n,) of the sensors that leave the atlas or pass their limit point within their uncertainty."""
        return np.asarray(self.derivatives.one_sided.any(axis=0))


def propagate(batch: SensorBatch, sources: list[UncertaintySource], contact: "ContactModel | None" = None) -> Budget:
    """Budget of n sensors from their sources, by the atlas; the sources are taken as mutually independent.

    Correlated inputs belong to one joint source. ``contact`` None: a frictionless plate.
    """
    standard, kurtosis = by_input(batch, sources)
    shift = None
    if contact is not None:
        modulus = INPUTS.index("shear_modulus")
        shift = contact.shift(float((np.sqrt(kurtosis[modulus]) * standard[modulus].max(axis=0)).max()))
    return combined(sources, derivatives(batch, standard, kurtosis, shift=shift), shift)


def propagate_groups(groups: Sequence[tuple[SensorBatch, list[UncertaintySource]]]) -> list[Budget]:
    """`propagate` for groups of sensors with their own sources, in one call of the atlas, because calls are costly."""
    batches = [batch for batch, _ in groups]
    spreads = [by_input(batch, sources) for batch, sources in groups]
    standard, kurtosis = (np.concatenate(part, axis=-1) for part in zip(*spreads, strict=True))
    sizes = [len(batch) for batch in batches]
    slopes_of = derivatives(SensorBatch.join(batches), standard, kurtosis)
    return [
        combined(sources, slopes_of.part(slice(end - size, end)), None)
        for (_, sources), size, end in zip(groups, sizes, np.cumsum(sizes), strict=True)
    ]


def combined(sources: list[UncertaintySource], slopes_of: Derivatives, shift: "ContactShift | None") -> Budget:
    """Budget of n sensors from their sources and derivatives; ``shift`` as in `Budget`."""
    by_source = variances(sources, slopes_of.slopes)
    linear = np.sqrt(variances(sources, slopes_of.local).sum(axis=0))
    freedom = np.array([source.freedom for source in sources])
    total = by_source.sum(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        effective = total**2 / (by_source**2 / freedom[:, None, None]).sum(axis=0)
    effective = np.where(np.isnan(effective), np.inf, effective)
    return Budget(tuple(sources), slopes_of, by_source, linear, effective, shift)


def variances(sources: list[UncertaintySource], slopes: Array) -> Array:
    """Variances (sources, figures, n) of the logarithms of the figures, from their slopes (inputs, figures, n)."""
    return np.stack([source.variance(slopes) for source in sources])


def by_input(batch: SensorBatch, sources: list[UncertaintySource]) -> tuple[Array, Array]:
    """Standard uncertainty of each input by figure (inputs, figures, n), and kurtosis (inputs, n)."""
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


LIMIT = FIGURES.index("limit_pressure_kPa")

COUPON = 0.03
"""Relative standard deviation of a modulus measured on tensile coupons of the same print: a choice."""

_RATIOS = 200
"""Number of wall ratios in the table of slopes: 1 % apart, closer than the step of the budget's derivatives."""


class LimitSpread(NamedTuple):
    """Relative standard uncertainties of the limit pressure of n sensors, (n,) each.

    standard: with the resin's modulus as it is known. measured: with the modulus measured on coupons, to `COUPON`.
    """

    standard: Array
    measured: Array


def limit_spread(
    batch: SensorBatch,
    material: Material,
    printer: Printer,
    numerical: float,
    calibration: "SensorCalibration | None" = None,
    by_ratio: Array | float | None = None,
) -> LimitSpread:
    """Uncertainty of the limit pressure, as by `document.budget`, for n sensors of one resin and printer.

    ``numerical`` is the greatest relative numerical error of the limit pressure; ``calibration``: None without one;
    ``by_ratio``: d ln pressure / d ln wall ratio of another limit.
    """
    slope = wall_slope(batch.wall_ratio) if by_ratio is None else by_ratio
    modulus = material.shear_modulus_MPa
    assert modulus is not None
    coupon = modulus.model_copy(update={"spread": COUPON * modulus.nominal})
    error = {FIGURES[LIMIT]: numerical}

    def standard(known: Material) -> Array:
        none = ModelErrors()
        return _standard(
            batch,
            sources(batch, known, printer, near_paper=False, errors=none, numerical=error, calibration=calibration),
            slope,
        )

    measured = material.model_copy(update={"shear_modulus_MPa": coupon})
    return LimitSpread(standard(material), standard(measured))


def _standard(batch: SensorBatch, source_list: list[UncertaintySource], by_ratio: Array | float) -> Array:
    """Combined standard uncertainty (n,) of ln limit pressure as in `propagate`, with slopes that are known.

    The limit pressure is the modulus times a function of the wall ratio only.
    """
    slopes = np.zeros((len(INPUTS), len(FIGURES), len(batch)))
    slopes[INPUTS.index("shear_modulus"), LIMIT] = 1.0
    slopes[INPUTS.index("wall_thickness"), LIMIT] = by_ratio
    slopes[INPUTS.index("inner_radius"), LIMIT] = -by_ratio
    return np.asarray(np.sqrt(variances(source_list, slopes)[:, LIMIT].sum(axis=0)))


def wall_slope(wall_ratio: Array) -> Array:
    """Slopes d ln limit pressure / d ln wall ratio, (n,); outside the atlas that at its edge."""
    at, slope = _slopes()
    return np.asarray(np.interp(np.log(wall_ratio), at, slope))


@cache
def _slopes() -> tuple[Array, Array]:
    """Logarithms of `_RATIOS` wall ratios, and the slopes of ln limit pressure over them."""
    walls = neighbourhood().recipe.wall_ratios
    at = np.linspace(np.log(walls[0]), np.log(walls[-1]), _RATIOS)
    # The exponential is rounded: this keeps the ends inside the table.
    pressure = neighbourhood().slices(np.clip(np.exp(at), walls[0], walls[-1]), ()).limit_pressure
    return at, np.gradient(np.log(pressure), at)
