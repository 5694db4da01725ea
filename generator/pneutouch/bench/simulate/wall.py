"""The memory of the wall: force and pressure above the relaxed curve, as a sum of decaying terms.

A standard linear solid on the curve: each term follows q' + q/tau = share f', with f the relaxed force or pressure
rise. No Prony data of TangoPlus or its digital materials are published: shares and times are the simulator's own."""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.protocol import RunProtocol
from pneutouch.bench.simulate.parameter import parameter

_ASSUMED = "the simulator's own, no data published; small, as the paper's Fig. S1 shows"

_RATE = 50.0
"""Samples a second at which the memory of a protocol is added up."""


@dataclass(frozen=True, slots=True)
class WallMemory:
    """Terms of the memory: shares of force and of pressure rise, and times in s; equally many each."""

    force: tuple[float, ...] = parameter((0.01, 0.01, 0.01), "1", _ASSUMED)
    rise: tuple[float, ...] = parameter(
        (0.002, 0.002, 0.002), "1", _ASSUMED + "; less than of the force: the air keeps it"
    )
    times: tuple[float, ...] = parameter(
        (1.0, 10.0, 100.0), "s", _ASSUMED + "; a decade apart, within a relaxation run"
    )

    def over(self, values: Array, shares: tuple[float, ...], step: float) -> Array:
        """Contribution of the memory to relaxed values (n, ...) at equal ``step`` in s along the first axis."""
        parts = [share * part for share, part in zip(shares, self.terms(values, step), strict=True)]
        return np.asarray(sum(parts, np.zeros_like(values)))

    def terms(self, values: Array, step: float) -> list[Array]:
        """Each term with share one; exact for values that go straight between samples."""
        from scipy.signal import lfilter

        change = np.diff(values, axis=0, prepend=values[:1])
        terms = []
        for time in self.times:
            fade = np.exp(-step / time)
            terms.append(np.asarray(lfilter([(1.0 - fade) * time / step], [1.0, -fade], change, axis=0)))
        return terms

    def held(self, protocol: RunProtocol, nodes: Array) -> tuple[Array, Array]:
        """Contribution of the memory at the end of every hold, as matrices (depths, nodes) on relaxed values at travels
        ``nodes``.

        The first is for the force, the second for the rise, which counts from before the plate moves in. Between the
        nodes the curve counts as straight."""
        knots, travels = protocol.knots()
        count = round(float(knots[-1]) * _RATE) + 1
        travel = np.clip(np.interp(np.arange(count) / _RATE, knots, travels), 0.0, nodes[-1])
        ends = np.minimum(np.floor(knots[3::4] * _RATE + 1e-9).astype(int), count - 1)
        begins = np.floor(knots[1::4] * _RATE + 1e-9).astype(int)
        terms = self.terms(_hats(travel, nodes), 1.0 / _RATE)
        empty = np.zeros((ends.size, nodes.size))
        force = sum((s * t[ends] for s, t in zip(self.force, terms, strict=True)), empty)
        rise = sum((s * (t[ends] - t[begins]) for s, t in zip(self.rise, terms, strict=True)), empty)
        return np.asarray(force), np.asarray(rise)


def _hats(travel: Array, nodes: Array) -> Array:
    """Weights (n, m) of values at nodes for a straight interpolation at travels (n,)."""
    k = np.clip(np.searchsorted(nodes, travel, side="right") - 1, 0, nodes.size - 2)
    share = (travel - nodes[k]) / (nodes[k + 1] - nodes[k])
    weights = np.zeros((travel.size, nodes.size))
    rows = np.arange(travel.size)
    weights[rows, k], weights[rows, k + 1] = 1.0 - share, share
    return weights
