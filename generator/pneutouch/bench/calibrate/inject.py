"""Air injected into the closed sensor: the pressure at which wall and gas are in equilibrium."""

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.mechanics.atlas.table import REST_VOLUME, AtlasSlices, shipped

_NODES = 60
_NEWTON = 4
"""Nodes from which a volume is first guessed, and steps of Newton's method from there: the last is below 1e-9 of it."""


def injected(slices: AtlasSlices, k: Index, ambient: Array, dead: Array, volume: Array) -> tuple[Array, Flags]:
    """Pressures of s sensors after injected volumes (n,) and whether the atlas covers them, (s, n).

    Solves (p + pa)(V(p) + Vd) = pa (V0 + Vd + dV), V the free dome's volume, by V: the injected volume rises with it
    through the limit point, where a driven pressure would not. All nondimensional; ambient and dead (s,), by slices k.
    """
    s, n = k.size, volume.size
    content = ambient[:, None] * (REST_VOLUME + dead[:, None] + volume)
    nodes = np.linspace(0.0, shipped().recipe.highest_volume, _NODES)
    row = np.repeat(np.arange(s), _NODES)
    pressure, _ = free_pressure(slices, k[row], np.tile(nodes, s))
    total = REST_VOLUME + np.outer(slices.reach(k), nodes) + dead[:, None]
    gas = (pressure.reshape(s, _NODES) + ambient[:, None]) * total
    nu = np.array([np.interp(content[j], gas[j], nodes) for j in range(s)]).ravel()
    each = np.repeat(np.arange(s), n)
    reach, outer, extra, target = slices.reach(k[each]), ambient[each], dead[each], content.ravel()
    for _ in range(_NEWTON):
        pressure, slope = free_pressure(slices, k[each], nu)
        total = REST_VOLUME + nu * reach + extra
        nu = nu - ((pressure + outer) * total - target) / (slope * total + (pressure + outer) * reach)
        nu = np.clip(nu, 0.0, nodes[-1])
    pressure, _ = free_pressure(slices, k[each], nu)
    return pressure.reshape(s, n), np.asarray(content <= gas[:, -1:])


def free_pressure(slices: AtlasSlices, k: Index, nu: Array) -> tuple[Array, Array]:
    """Pressure of the free dome at volumes nu and its slope by nu, (n,) each."""
    apex = slices.free_apex(k, nu)
    point = slices.point(k, nu, apex[:, 0])
    # Along the free curve the plate rides on the apex.
    return point.pressure, point.by_volume * slices.reach(k) + point.by_height * apex[:, 1]
