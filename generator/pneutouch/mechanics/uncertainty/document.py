"""Uncertainty budgets: Monte Carlo check by the atlas (JCGM 101), the record of one sensor, and texts for datasheets.

Also effects of the air on a sealed sensor at its driving pressures: of temperature, and of a fast press.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags, Index, grouped
from pneutouch.mechanics.atlas.figures import FIGURES, INPUTS, SENSITIVITY, log_figures, moved, neighbourhood
from pneutouch.mechanics.atlas.press import AtlasPress, SensorBatch
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.line.elements import ADIABATIC, REFERENCE_TEMPERATURE
from pneutouch.mechanics.prediction import SensorPrediction, SensorState
from pneutouch.mechanics.response import lines
from pneutouch.mechanics.uncertainty.propagate import COVERAGE, Budget, propagate
from pneutouch.mechanics.uncertainty.source import FIGURE, FRICTION, JOINT, PLACE, UncertaintySource
from pneutouch.mechanics.uncertainty.sources import sources
from pneutouch.mechanics.uncertainty.sources.modulus import AGEING
from pneutouch.results.record import SENSITIVITY_KEY, STIFFNESS_KEY
from pneutouch.results.uncertainty import FigureRecord, IntervalRecord, UncertaintyRecord
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer
from pneutouch.units import KPA

if TYPE_CHECKING:
    from pneutouch.mechanics.uncertainty.contact_model import ContactShift


def budget(batch: SensorBatch, material: Material, printer: Printer, **facts: Any) -> Budget:
    """Uncertainty budget of the figures of n sensors of one resin and printer; ``facts``: keywords of `sources`."""
    return propagate(batch, sources(batch, material, printer, **facts), facts.get("contact"))


_COVERED = 0.9545
"""Share of a normal distribution within two standard deviations of the mean."""

_GRAIN = 5e-4
"""Relative rounding of wall ratios, because the atlas interpolates once per ratio; no wall is known so exactly."""


@dataclass(frozen=True)
class SampledFigures:
    """Distribution of the figures of one sensor over samples of its inputs.

    Attributes:
        standard: Standard deviation of ln figure, (figures,).
        half_width: Half of the probabilistically symmetric 95.45 % interval of ln figure, (figures,).
        low: Lower end of the interval, in the figure's unit, (figures,).
        high: Upper end of the interval, in the figure's unit, (figures,).
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
    shift: "ContactShift | None" = None,
) -> SampledFigures:
    """Figures of sensor ``row`` over ``count`` samples of the sources; the same seed gives the same samples.

    ``shift`` is that of the budget, None under a plate. Figures for which the same sources count use the same samples.
    """
    logs = np.empty((len(FIGURES), count))
    through = [tuple(bool(s.counts[k, row]) for s in sources if s.acts_on != FIGURE) for k in range(len(FIGURES))]
    groups = grouped((counted, figure) for figure, counted in enumerate(through))
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
    shift: "ContactShift | None",
) -> Array:
    """Logarithms (figures, count) of all figures over samples of those sources on inputs that count for ``figure``.

    ``drawn`` holds the row of the sensor, the number of samples, and the seed.
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


_TRAVEL = 0.98
"""Share of the range used by `gas_notes`: its end may be the last stable state, which rounding can lose."""

_NEWTON, _LONGEST, _CLOSE = 20, 0.05, 1.0e-10


class GasNotes(NamedTuple):
    """Effects of the air on n sensors, (n,) each; NaN if the atlas has no state.

    by_temperature_kPa_per_K: Pressure change of the sealed, untouched sensor, kPa/K. force_by_temperature: Force that
    gives the same reading, N/K. wall_give: Pressure change over that in a rigid cavity, k_wall / (k_wall + k_gas).
    fast_over_slow: Sensitivity with adiabatic gas over that with isothermal gas, over the same travel.
    """

    by_temperature_kPa_per_K: Array
    force_by_temperature: Array
    wall_give: Array
    fast_over_slow: Array


def gas_notes(batch: SensorBatch, temperature: float = REFERENCE_TEMPERATURE) -> GasNotes:
    """Effects of a change of temperature at ``temperature`` (K), and of a fast press, on n sensors.

    Ideal gas: dp = (p + p_a) dT/T - k_gas dV with k_gas = (p + p_a)/(V + V_d), and for the wall dp = k_wall dV, so
    dp/dT = (p + p_a)/T * k_wall / (k_wall + k_gas). All the gas, with the dead volume V_d, has one temperature.
    """
    atlas = neighbourhood()
    response = respond(batch, atlas=atlas)
    good = np.isfinite(response.range_end)
    walls, k = np.unique(np.where(good, batch.wall_ratio, atlas.recipe.thickest), return_inverse=True)
    press = AtlasPress(batch, atlas.slices(walls), k)
    stiffness = _wall_stiffness(press, k)
    absolute = press.pressure + press.ambient
    gas_volume = press.volume(press.free) + press.dead
    give = np.where(good, stiffness / (stiffness + absolute / gas_volume), np.nan)
    rise_kPa_per_K = absolute * batch.shear_modulus / temperature * give / KPA
    travel = _TRAVEL * response.indentation
    fast = _sensitivity(press, travel, ADIABATIC) / _sensitivity(press, travel, 1.0)
    return GasNotes(rise_kPa_per_K, rise_kPa_per_K / response.lines.sensitivity, give, fast)


def _wall_stiffness(press: AtlasPress, k: Index) -> Array:
    """Slope dp/dV (n,) of the wall in free inflation, in mu/R0^3; ``k``: slices of the sensors."""
    slices, nu = press.slices, press.free
    apex = slices.free_apex(k, nu)
    point = slices.point(k, nu, apex[:, 0])
    # Along the free curve the plate rides on the apex.
    return np.asarray(point.by_volume + point.by_height * apex[:, 1] / slices.reach(k))


def _sensitivity(press: AtlasPress, indentation: Array, exponent: float) -> Array:
    """Sensitivities (n,), kPa/N, over plate travels (n, m; mm), p V^``exponent`` constant; NaN without all states."""
    mu, radius = press.batch.shear_modulus[:, None], press.batch.inner_radius[:, None]
    pressure, force, converged = _pressed(press, np.nan_to_num(indentation) / radius, exponent)
    rise_kPa = (pressure - press.pressure[:, None]) * mu / KPA
    lost = ~converged | np.isnan(indentation).any(axis=1)
    return np.where(lost, np.nan, lines(indentation, force * mu * radius**2, rise_kPa).sensitivity)


def _pressed(press: AtlasPress, indentation: Array, exponent: float) -> tuple[Array, Array, Flags]:
    """Pressure and force (n, m) at plate travels in R0 for constant p V^exponent, and True (n,) if all are found."""
    nu, good = press.free, np.ones(press.free.size, dtype=bool)
    start = press.volume(press.free) + press.dead
    columns = []
    for column in indentation.T:
        for _ in range(_NEWTON):
            point = press.slices.point(press.k, nu, press.apex - column)
            gas_volume = press.volume(nu) + press.dead
            gas = press.content / start * (start / gas_volume) ** exponent
            gap, slope = point.pressure + press.ambient - gas, point.by_volume + exponent * gas / gas_volume
            reached = np.abs(gap) <= _CLOSE * (1.0 + gas)
            if reached.all():
                break
            step = np.clip(-gap / np.where(slope > 0, slope, 1.0) / press.reach, -_LONGEST, _LONGEST)
            nu = np.where(reached | (slope <= 0), nu, nu + step)
        good = good & reached & (slope > 0) & point.supported & ~point.folded
        columns.append((point.pressure, point.force))
    pressure, force = (np.stack(part, axis=1) for part in zip(*columns, strict=True))
    return pressure, force, good


_FEW = 10.0
"""Number of degrees of freedom below which k = 2 covers clearly less than 95 % (JCGM 100, G.6.4)."""

_LEAST_SHARE = 5e-4

_UNCOUNTED = (
    "not in the budget, because no number is known: the model's error in figures other than the sensitivity, creep and "
    "temperature of the resin, {place}{friction}the scatter of the break strain"
)


DIGITS = 6
"""Significant digits of an uncertainty: more than are meaningful, fewer than differ between processors."""

NOTHING = 1e-9
"""Numbers below this are rounding: a range that ends at the depth has no uncertainty."""


def values_of(prediction: SensorPrediction, state: SensorState) -> dict[str, float]:
    """Values of the budget's figures by key, as the model gives them; figures that it does not give are left out."""
    peak, figures, of_contact = prediction.limits.limit_point, state.figures, {}
    if figures is not None:
        of_contact = {
            SENSITIVITY_KEY: figures.sensitivity,
            STIFFNESS_KEY: figures.stiffness,
            "force_at_range_end_N": figures.force_range[1],
        }
    return {
        **({} if peak is None else {"limit_pressure_kPa": peak / KPA}),
        **of_contact,
        "range_end_mm": state.range_end,
        "apex_height_outer_mm": state.apex_outer,
    }


def document(
    budget: Budget,
    row: int = 0,
    values: Mapping[str, float] | None = None,
    notes: tuple[str, ...] = (),
    *,
    calibrated: bool = False,
) -> UncertaintyRecord:
    """Record with figures, sources and notes of sensor ``row``.

    Args:
        budget: Result of `budget`.
        row: Index of the sensor.
        values: Figures by another model, by name, to be given with the budget's relative uncertainty; other figures are
            left out. None: the atlas's figures.
        notes: Further notes, such as those of `gas_text`.
        calibrated: True adds ``at_calibration`` to each figure: its interval without the ageing since then.

    Returns:
        The record, without figures that the atlas cannot give; without a sensitivity, the notes say why.
    """
    known = [i for i in range(len(FIGURES)) if np.isfinite(budget.standard[i, row])]
    given = values or {}
    kept = known if values is None else [i for i in known if FIGURES[i] in values]
    return UncertaintyRecord(
        coverage_factor=COVERAGE,
        figures={FIGURES[i]: _figure(budget, i, row, given.get(FIGURES[i]), calibrated) for i in kept},
        sources=tuple(d for s in budget.sources if s.counts[:, row].any() for d in s.documents(row)),
        elasticities={
            FIGURES[i]: dict(zip(INPUTS, budget.derivatives.elasticities[:, i, row].tolist(), strict=True))
            for i in kept
        },
        notes=(*_notes(budget, row), *notes),
    )


def _fresh_width(budget: Budget, figure: int, row: int) -> float:
    """Expanded uncertainty of the logarithm of a figure, without the sources of ageing."""
    kept = [source.name not in AGEING for source in budget.sources]
    return COVERAGE * float(np.sqrt(budget.variances[kept, figure, row].sum()))


def _figure(budget: Budget, figure: int, row: int, given: float | None, calibrated: bool) -> FigureRecord:
    value = float(budget.values[figure, row]) if given is None else given
    width = float(budget.expanded[figure, row])
    freedom = float(budget.freedom[figure, row])
    fresh = float(np.exp(_fresh_width(budget, figure, row)))
    return FigureRecord(
        value=value,
        expanded_uncertainty=value * float(np.sinh(width)),
        low=value * float(np.exp(-width)),
        high=value * float(np.exp(width)),
        standard_uncertainty_relative=0.5 * width,
        degrees_of_freedom=freedom if np.isfinite(freedom) else None,
        nonlinear=bool(budget.nonlinear[figure, row]),
        shares=shares(budget, FIGURES[figure], row),
        at_calibration=IntervalRecord(value / fresh, value * fresh) if calibrated else None,
    )


def shares(budget: Budget, figure: str, row: int = 0) -> dict[str, float]:
    """Shares of a figure's variance by source, greatest first, sum 1; equal names are added, tiny shares left out."""
    by_name: dict[str, float] = {}
    for source, share in zip(budget.sources, budget.shares[:, FIGURES.index(figure), row], strict=True):
        by_name[source.name] = by_name.get(source.name, 0.0) + float(share)
    kept = {name: share for name, share in by_name.items() if share > _LEAST_SHARE}
    total = sum(kept.values())
    return {name: share / total for name, share in sorted(kept.items(), key=lambda item: (-item[1], item[0]))}


def _notes(budget: Budget, row: int) -> list[str]:
    if not np.isfinite(budget.standard[SENSITIVITY, row]):
        return ["the sensor is outside the atlas or beyond its limit point: no uncertainty can be given"]
    notes = []
    bent = [name for name, flag in zip(FIGURES, budget.nonlinear[:, row], strict=True) if flag]
    if bent:
        notes.append(
            f"nonlinear within the uncertainties: {', '.join(bent)}: near the limit point, or another event ends the "
            "range. Their uncertainty is taken over the inputs' whole spread"
        )
    if budget.doubtful[row]:
        notes.append("within its uncertainties the sensor may be beyond its limit point, or leaves the atlas")
    few = [
        f"{name} ({freedom:.2g})"
        for name, freedom in zip(FIGURES, budget.freedom[:, row], strict=True)
        if freedom < _FEW
    ]
    if few:
        notes.append(f"k = {COVERAGE:g} covers less than 95 % with few degrees of freedom: {', '.join(few)}")
    counted = {source.name for source in budget.sources}
    left = {
        "place": "" if PLACE in counted else "misalignment, ",
        "friction": "" if FRICTION in counted else "friction, ",
    }
    return [*notes, _UNCOUNTED.format(**left)]


def text(budget: Budget, row: int = 0, *, calibrated: bool = False) -> str:
    """Text for a datasheet: expanded uncertainty of the sensitivity, and the quantities to measure first."""
    width = float(budget.expanded[SENSITIVITY, row])
    if not np.isfinite(width):
        return "The uncertainty of the sensitivity is not known: the sensor is outside the atlas."
    parts = shares(budget, FIGURES[SENSITIVITY], row)
    # A measurement of the sensor does not make the place of contact known.
    place = parts.pop(PLACE, None)
    first = ", then ".join(f"{name} ({share:.0%} of the variance)" for name, share in list(parts.items())[:2])
    assumed = [s.name for s in budget.sources if not s.known and s.name in parts and parts[s.name] >= 0.1]
    assumed_text = f" Assumed, not known: {', '.join(assumed)}." if assumed else ""
    if place is not None:
        assumed_text += f" An unknown place of contact has {place:.0%} of the variance."
    interval = f"{np.exp(-width) - 1:+.0%} to {np.exp(width) - 1:+.0%}"
    if calibrated:
        fresh = _fresh_width(budget, SENSITIVITY, row)
        interval += f", at the age of its calibration {np.exp(-fresh) - 1:+.1%} to {np.exp(fresh) - 1:+.1%}"
    return (
        f"Expanded uncertainty of the sensitivity (k = {COVERAGE:g}): {interval}; measure first: {first}.{assumed_text}"
    )


def gas_text(batch: SensorBatch) -> list[tuple[str, ...]]:
    """Notes on the effects of the air on n sensors, one tuple each; an empty one if the atlas has no state."""
    notes = gas_notes(batch)
    return [
        (
            f"sealed and untouched, the pressure moves by {rise:.2g} kPa/K at {REFERENCE_TEMPERATURE - 273.15:g} C, "
            f"which reads as {force:.2g} N/K; the wall leaves {give:.0%} of what a rigid cavity would show",
            f"pressed so fast that the air is adiabatic (p V^{ADIABATIC:g}) the sensitivity is {fast:.2f} times the "
            "isothermal one given here",
        )
        if np.isfinite([rise, force, give, fast]).all()
        else ()
        for rise, force, give, fast in zip(*notes, strict=True)
    ]
