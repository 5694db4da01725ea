"""Linear relaxation of a resin: a Prony series, and what it answers to the plainest histories in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.sensor import Sensor
from pneutouch.spec.material import Material

_SHORT = 1.0e-4
"""Ramps shorter than this share of a relaxation time are taken by their series, good to that share."""


@dataclass(frozen=True)
class Prony:
    """G(t)/G_0 = 1 - sum of ``shares`` (1 - exp(-t/``times``)), times in s; ``source`` names its origin."""

    shares: tuple[float, ...]
    times: tuple[float, ...]
    source: str = ""

    @property
    def relaxed_share(self) -> float:
        """Relaxed over instantaneous modulus."""
        return 1.0 - sum(self.shares)

    @property
    def excess(self) -> Array:
        """Each term over the relaxed modulus, (terms,)."""
        return np.array(self.shares) / self.relaxed_share

    def modulus(self, time: Array) -> Array:
        """Modulus after a step of strain, over the relaxed one; any shape, s."""
        decay = np.exp(-np.asarray(time)[..., None] / np.array(self.times))
        return np.asarray(1.0 + decay @ self.excess)

    def after_ramp(self, ramp: float, time: Array) -> Array:
        """Stress over strain, over the relaxed modulus, ``time`` s after an even ramp of ``ramp`` s; (n,)."""
        tau = np.array(self.times)
        mean = tau / ramp * -np.expm1(-ramp / tau)
        return np.asarray(1.0 + np.exp(-np.asarray(time)[..., None] / tau) @ (self.excess * mean))

    def loop_energy(self, ramp: float) -> float:
        """Energy that an even ramp of ``ramp`` s to strain 1 and back leaves behind, over the relaxed modulus.

        A Maxwell element c, tau under strain t/T and back takes c tau/T^2 (2 T - tau (1 - e)(3 - e)), e = exp(-T/tau): the
        work of its stress, integrated; part of it is dissipated after the return.
        """
        share = ramp / np.array(self.times)
        gone = -np.expm1(-share)
        # The difference of a short ramp is lost in rounding; its first term is not.
        taken = np.where(share < _SHORT, 2 / 3 * share**3, 2 * share - gone * (2 + gone))
        return float((self.excess * taken / share**2).sum())


def prony_series(material: Material) -> tuple[Prony, ...]:
    """The relaxation data of a resin, one series a source; empty where there are none."""
    return tuple(
        Prony(tuple(t.share for t in data.terms), tuple(t.time_s for t in data.terms), data.source)
        for data in material.relaxation
    )


def relaxed(sensor: Sensor, material: Material, series: Prony) -> Sensor:
    """A sensor with its relaxed modulus, where that of its resin's file is relaxed or instantaneous as the file states."""
    share = series.relaxed_share if material.shear_modulus_is == "instantaneous" else 1.0
    return sensor.replace(shear_modulus=share * sensor.wall.shear_modulus)
