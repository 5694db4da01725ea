"""A press followed in time: wall forces with memory, trapped gas, plate travel given.

Quasi-linear viscoelasticity (Fung 1993, Biomechanics, section 7.6) in two coordinates, cavity volume V and plate height
h. The elastic dome answers them with the wall pressure P(V, h) and the plate force F(V, h) of the atlas; the viscous
one with

    p = p_I + int k(t - s) dP(s),  F = int k(t - s) dF(s),  k(t) = G(t)/G_inf

from an inflated state in which everything has relaxed. At every time the volume is the one at which p is the gas's
pressure. It is exact for small strains, for the first moment (the elastic dome of the instantaneous modulus, built up
on the relaxed inflated state) and in the end (the elastic dome of the relaxed one).
"""

from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.mechanics.atlas.press import AtlasPress

_NEWTON = 10
"""Iterations of a solution: two more than for the elastic dome."""

_NO_TRAVEL = 1.0e-9


class ViscousPath(NamedTuple):
    """Paths of n domes, (n, m) each; nondimensional by the relaxed modulus.

    elastic_force, elastic_pressure: of the relaxed dome at the same volume and plate height. known: the state and all
    before it were found. folded: the wall buckled, or its gas no longer held it; what is lost otherwise lies outside
    the atlas.
    """

    nu: Array
    pressure: Array
    force: Array
    elastic_pressure: Array
    elastic_force: Array
    known: Flags
    folded: Flags


class Memory:
    """The convolution of a quantity with k(t) less 1, its history even within each step; (n, terms)."""

    def __init__(self, excess: Array, times: Array) -> None:
        self._excess, self._times = excess, times
        self._held = np.zeros((2, *excess.shape))

    def step(self, seconds: Array) -> tuple[Array, Array, Array]:
        """Over a step (n,) s: decay and weight of each term, and the sum of the weights, (n,)."""
        share = seconds[:, None] / self._times
        decay = np.exp(-share)
        with np.errstate(invalid="ignore", divide="ignore"):
            weight = self._excess * np.where(share > 0.0, -np.expm1(-share) / share, 1.0)
        return decay, weight, weight.sum(axis=1)

    def left(self, decay: Array) -> Array:
        """Remaining contribution of the past to pressure and force, (2, n)."""
        return np.asarray((self._held * decay).sum(axis=2))

    def add(self, decay: Array, weight: Array, change: Array) -> None:
        """Keep a step in which pressure and force changed, (2, n)."""
        self._held = self._held * decay + weight * change[..., None]


def follow(press: AtlasPress, excess: Array, times: Array, clock: Array, travel: Array) -> ViscousPath:
    """Follow n domes along plate travels (n, m), in R0, at times (n, m) s, both from first contact at 0.

    excess, times: Prony terms over the relaxed modulus and their times in s, (n, terms); a term of excess 0 is none.
    """
    memory = Memory(excess, times)
    nu, known = press.free, np.ones(press.free.size, dtype=bool)
    start = press.slices.point(press.k, nu, press.apex)
    before = np.stack([start.pressure, np.zeros_like(nu)])
    rate, at = np.zeros_like(nu), travel[:, 0]
    columns = [(nu, *before, *before, known, ~known)]
    for j in range(1, clock.shape[1]):
        decay, weight, stiffer = memory.step(clock[:, j] - clock[:, j - 1])
        past = memory.left(decay) - stiffer * before
        height = press.apex - travel[:, j]
        guess = nu + rate * (travel[:, j] - at)
        solved = press.solve(guess, height, 1.0 + stiffer, past[0], _NEWTON)
        point, margin = solved.point, solved.margin
        now = np.stack([point.pressure, np.where(travel[:, j] > _NO_TRAVEL, point.force, 0.0)])
        known, lost = known & solved.ok, point.folded | ~solved.converged
        rate = np.where(known, (1.0 + stiffer) * point.by_height / np.where(margin > 0, margin, 1.0) / press.reach, 0.0)
        memory.add(decay, weight, now - before)
        nu, before, at = np.where(known, solved.nu, nu), now, travel[:, j]
        columns.append((nu, *((1.0 + stiffer) * now + past), *now, known, lost))
    return ViscousPath(*(np.stack(part, axis=1) for part in zip(*columns, strict=True)))
