"""Effects of the air on a sealed sensor: temperature, and speed of the press. Computed at the sensor's own states."""

from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.mechanics.atlas.press import AtlasPress, SensorBatch
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.line.air import ADIABATIC, REFERENCE_TEMPERATURE
from pneutouch.mechanics.response import lines
from pneutouch.mechanics.uncertainty.neighbours import neighbourhood
from pneutouch.units import KPA

_TRAVEL = 0.98
"""Share of the range compared: its end may be the last stable state, which one rounding more would lose."""

_NEWTON, _LONGEST, _CLOSE = 20, 0.05, 1.0e-10


class GasNotes(NamedTuple):
    """Effects of the air on n sensors, (n,) each; NaN if the atlas has no state.

    by_temperature_kPa_per_K: Pressure rise of the sealed, untouched sensor, kPa/K.
    force_by_temperature: The contact force that would read the same, N/K.
    wall_give: Share of the rise in a rigid cavity that the wall leaves: k_wall / (k_wall + k_gas).
    fast_over_slow: Sensitivity with adiabatic gas over that with isothermal gas, over one and the same travel.
    """

    by_temperature_kPa_per_K: Array
    force_by_temperature: Array
    wall_give: Array
    fast_over_slow: Array


def gas_notes(batch: SensorBatch, temperature: float = REFERENCE_TEMPERATURE) -> GasNotes:
    """Temperature effect at ``temperature`` (K) and gas law effect of n sensors.

    Ideal gas: dp = (p + p_a) dT/T - k_gas dV with k_gas = (p + p_a)/(V + V_d), and the wall gives dp = k_wall dV, so
    dp/dT = (p + p_a)/T * k_wall / (k_wall + k_gas). All the gas, the dead volume's too, has one temperature.
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
    fast = _sensitivity_kPa_per_N(press, travel, ADIABATIC) / _sensitivity_kPa_per_N(press, travel, 1.0)
    return GasNotes(rise_kPa_per_K, rise_kPa_per_K / response.lines.sensitivity_kPa_per_N, give, fast)


def _wall_stiffness(press: AtlasPress, k: Index) -> Array:
    """dp/dV of the free inflated wall, in mu/R0^3."""
    slices, nu = press.slices, press.free
    apex = slices.free_apex(k, nu)
    point = slices.point(k, nu, apex[:, 0])
    # Along the free curve the plate rides on the apex.
    return np.asarray(point.by_volume + point.by_height * apex[:, 1] / slices.reach(k))


def _sensitivity_kPa_per_N(press: AtlasPress, indentation: Array, exponent: float) -> Array:
    """Slope of pressure over force, kPa/N, at plate travels (n, m) in mm; NaN if one of them has no state."""
    mu, radius = press.batch.shear_modulus[:, None], press.batch.inner_radius[:, None]
    pressure, force, converged = _pressed(press, np.nan_to_num(indentation) / radius, exponent)
    rise_kPa = (pressure - press.pressure[:, None]) * mu / KPA
    lost = ~converged | np.isnan(indentation).any(axis=1)
    return np.where(lost, np.nan, lines(indentation, force * mu * radius**2, rise_kPa).sensitivity_kPa_per_N)


def _pressed(press: AtlasPress, indentation: Array, exponent: float) -> tuple[Array, Array, Flags]:
    """Pressure and force (n, m) at plate travels in R0 with constant p V^exponent, and where all were found (n,)."""
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
