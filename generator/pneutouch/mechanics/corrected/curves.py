"""Correction of the atlas's curves for friction, other objects and other walls, by a ratio from the solid.

The stand-in of a sensor has a neo-Hookean wall under a frictionless plate, which the atlas covers. The force and
pressure rise that the atlas gives for it are multiplied by the ratio of the solid's curves for sensor and stand-in, at
the same travel and driving pressure; the pressure after injected air by their ratio at the same volume. The ratio is
computed for one sensor and taken as constant nearby. With friction, the logarithm of the force ratio changes by up to
0.04 for a modulus 1.3 times as large, that of the sensitivity by up to 0.02
(`tests/mechanics/test_corrected_curves.py`): a fit takes the ratio at its own estimate.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import ComputationError
from pneutouch.mechanics.atlas.coverage import stand_in
from pneutouch.mechanics.corrected.figures import GRIPS
from pneutouch.mechanics.prediction import InflationCurve
from pneutouch.mechanics.sensor import GasCircuit, RigidBase, Sensor
from pneutouch.units import KPA

NODES = (0.0, 0.1, 0.25, 0.45, 0.7, 1.0, 1.4, GRIPS)
"""Coefficients of friction at which the solid is solved if friction is fitted."""

_STEPS = 28
_GRAIN = 0.5 * KPA
"""Driving pressures (MPa) are rounded to multiples of this for ratios, so that fewer of them are solved."""


@dataclass(frozen=True)
class ContactRatio:
    """Logarithms of force and pressure rise of a sensor over those of its stand-in under the frictionless plate.

    Attributes:
        frictions: Coefficients of friction, ascending, (q,).
        pressures: Driving pressures, MPa, ascending, (p,).
        depths: Travels, mm, ascending, (m,).
        logs: Logarithms of the ratios of force and rise, (2, q, p, m).
        ends: Travels up to which the wall is free of the ring that clamps its flange, mm, (p,); inf without a ring.
    """

    frictions: Array
    pressures: Array
    depths: Array
    logs: Array
    ends: Array

    def at(self, friction: Array, driving: Array, travel: Array) -> Array:
        """Logarithms (2, n, m) at coefficients of friction (n,), driving pressures (n,) and travels (n, m).

        Monotone cubic in the coefficient, linear in pressure and travel; constant beyond the ends.
        """
        by_friction = self._by_friction(np.clip(friction, self.frictions[0], self.frictions[-1]))
        where = np.interp(driving, self.pressures, np.arange(self.pressures.size))
        low = np.minimum(where.astype(int), max(self.pressures.size - 2, 0))
        high, share = np.minimum(low + 1, self.pressures.size - 1), (where - low)[:, None]
        n = np.arange(driving.size)
        rows = (1.0 - share) * by_friction[:, n, low] + share * by_friction[:, n, high]
        pairs = [[np.interp(x, self.depths, row) for x, row in zip(travel, part, strict=True)] for part in rows]
        return np.array(pairs).reshape(2, *travel.shape)

    def _by_friction(self, friction: Array) -> Array:
        """Logarithms (2, n, p, m) at coefficients of friction (n,)."""
        if self.frictions.size == 1:
            return np.repeat(self.logs, friction.size, axis=1)
        from scipy.interpolate import PchipInterpolator

        return np.asarray(PchipInterpolator(self.frictions, self.logs, axis=1)(friction))


_BEYOND, _FIRST = 1.05, 1e-3
"""Travel of an end that is not reached, over the last travel; least injected volume of a ratio, over the greatest."""

_RING = 0.01
"""Change of the logarithm of the force by the ring that ends the ratio: a choice. Beyond it the force doubles within a
few tenths of a millimetre, at a place that depends on every size."""


def contact_ratio(
    sensor: Sensor, frictions: tuple[float, ...], driving_pressures: Array, deepest: float
) -> ContactRatio:
    """Ratio of a sensor, without the ring around its flange, to its stand-in: with its object at coefficients of
    friction (ascending), near driving pressures (MPa) and to the travel ``deepest`` (mm).

    Raises ComputationError if the solid cannot press the sensor, also with the ring, at any of the pressures."""
    grains = np.unique(np.round(driving_pressures / _GRAIN)) * _GRAIN
    whole = sensor.replace(depth=deepest, steps=_STEPS, waves=0, gauge_limit=np.inf, break_stretch=None, friction=0.0)
    bare = whole if whole.dome.base is None else whole.replace(base=RigidBase())
    # Coefficients from GRIPS on stand for a surface that grips: nothing slips there.
    held = [bare.replace(friction=np.inf if friction >= GRIPS else friction) for friction in frictions]
    depths, pressures = np.linspace(0.0, deepest, _STEPS + 1)[1:], tuple(grains.tolist())
    under, over = _pressed(stand_in(bare), pressures), [_pressed(one, pressures) for one in held]
    count = min(len(under), *(len(presses) for presses in over))
    if not count:
        listed = ", ".join(f"{pressure / KPA:g}" for pressure in pressures)
        raise ComputationError(f"calibrate: the solid cannot press the sensor with its contact at {listed} kPa")
    logs = [[_log_ratio(presses[k], under[k], depths) for k in range(count)] for presses in over]
    ends = np.full(count, np.inf)
    if whole != bare:
        pairs = zip(_pressed(whole.replace(friction=held[0].protocol.friction), pressures), over[0], strict=False)
        ends = np.array([_parting(ringed, free, depths) for ringed, free in pairs])[:count]
        count = len(ends)
    if not count:
        raise ComputationError("calibrate: the solid cannot press the sensor onto the ring around its flange")
    return ContactRatio(
        np.array(frictions), grains[:count], depths, np.array(logs).transpose(2, 0, 1, 3)[:, :, :count], ends
    )


def _parting(ringed: Array, free: Array, depths: Array) -> float:
    """Last of the travels ``depths`` (mm) before the force with the ring differs from that without it; `_BEYOND` times
    the deepest if it does not: finite, so that ends can be interpolated between driving pressures.
    """
    apart = np.flatnonzero(np.abs(_log_ratio(ringed, free, depths)[0]) > _RING)
    return float(depths[max(apart[0] - 1, 0)]) if apart.size else _BEYOND * float(depths[-1])


def injection_ratio(sensor: Sensor, volumes: Array) -> Array:
    """Logarithm (n,) of the pressure after injected volumes (n,; mm3) over that of the `stand_in`, by the solid."""
    some = np.maximum(volumes, _FIRST * float(volumes.max()))
    return np.asarray(np.log(_after_injection(sensor, some) / _after_injection(stand_in(sensor), some)))


def _after_injection(sensor: Sensor, volumes: Array) -> Array:
    from pneutouch.mechanics.models.solid import solid_result

    return after_injection(solid_result(sensor.replace(waves=0), np.zeros(0)).inflation, sensor.gas, volumes)


def after_injection(curve: InflationCurve, gas: GasCircuit, volumes: Array) -> Array:
    """Pressures (n,; MPa) at which wall and gas are in equilibrium after injected volumes (n,; mm3 at ambient
    pressure); beyond the end of the inflation that of its end."""
    content = (curve.volume + gas.dead_volume) * (curve.pressure + gas.ambient_pressure)
    return np.asarray(np.interp(content[0] + gas.ambient_pressure * volumes, content, curve.pressure))


@lru_cache(maxsize=64)
def _pressed(sensor: Sensor, pressures: tuple[float, ...]) -> tuple[Array, ...]:
    """Travel (mm), force (N) and rise (MPa), (3, n), by the solid at each of ascending pressures (MPa), without the
    highest ones that fail; cached, because a fit and its checks need the same ones again."""
    from pneutouch.mechanics.models.solid import solid_states

    for count in range(len(pressures), 0, -1):
        try:
            states = solid_states(sensor, np.array(pressures[:count]))
        except ComputationError:
            continue
        return tuple(np.array([one.indentation, one.force, one.pressure_rise]) for one in states)
    return ()


def _log_ratio(contact: Array, plate: Array, depths: Array) -> Array:
    """Logarithms (2, m) of the ratios of force and rise of two presses at travels (m,); constant beyond the shorter."""
    at = np.minimum(depths, min(contact[0, -1], plate[0, -1]))
    over, under = (np.array([np.interp(at, one[0], row) for row in one[1:]]) for one in (contact, plate))
    return np.asarray(np.log(over / under))
