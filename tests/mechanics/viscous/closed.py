"""What linear relaxation answers to the plainest histories, in closed form."""

from __future__ import annotations

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.viscous.prony import Prony
from pneutouch.mechanics.viscous.runs import LoopRun

_SHORT = 1.0e-4
"""Ramps shorter than this share of a relaxation time are taken by their series, good to that share."""


def after_ramp(series: Prony, ramp: float, time: Array) -> Array:
    """Stress over strain, over the relaxed modulus, ``time`` s after an even ramp of ``ramp`` s; (n,)."""
    tau = np.array(series.times)
    mean = tau / ramp * -np.expm1(-ramp / tau)
    return np.asarray(1.0 + np.exp(-np.asarray(time)[..., None] / tau) @ (series.excess * mean))


def loop_energy(series: Prony, ramp: float) -> float:
    """Energy that an even ramp of ``ramp`` s to strain 1 and back leaves behind, over the relaxed modulus.

    A Maxwell element c, tau under strain t/T and back takes c tau/T^2 (2 T - tau (1 - e)(3 - e)), e = exp(-T/tau): the
    work of its stress, integrated; part of it is dissipated after the return.
    """
    share = ramp / np.array(series.times)
    gone = -np.expm1(-share)
    # The difference of a short ramp is lost in rounding; its first term is not.
    taken = np.where(share < _SHORT, 2 / 3 * share**3, 2 * share - gone * (2 + gone))
    return float((series.excess * taken / share**2).sum())


def energy_loss(turn: LoopRun) -> float | None:
    """Share of the plate's work that does not come back; None where there is no retraction."""
    if turn.force_out.size < 2:
        return None
    spent = np.trapezoid(turn.force_in, turn.indentation_in)
    return float(1.0 + np.trapezoid(turn.force_out, turn.indentation_out) / spent)
