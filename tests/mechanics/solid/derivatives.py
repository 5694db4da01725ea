"""Derivatives of a scene's energy against differences of it."""

import numpy as np
import pytest

from pneutouch.mechanics.solid.newton import evaluate, full_tangent


def dense(band):
    """The symmetric matrix (n, n) of a lower band."""
    n = band.shape[1]
    out = np.zeros((n, n))
    for k in range(band.shape[0]):
        i = np.arange(n - k)
        out[i + k, i] = out[i, i + k] = band[k, : n - k]
    return out


def assert_derivatives(scene, x, rng, *, step, rel, absolute=None):
    """Residual and tangent at positions x are the derivatives of energy and residual in a random direction; the state
    there is returned. ``rel`` and ``absolute`` are bounds of the first."""
    solid, state = scene.solid, evaluate(scene, x)
    d = rng.normal(size=solid.size)
    d /= np.linalg.norm(d)
    up, down = (evaluate(scene, x + s * step * solid.expand(d)) for s in (1, -1))
    slope = float(state.residual @ d)
    assert (up.energy - down.energy) / (2 * step) == pytest.approx(
        slope, rel=rel, abs=None if absolute is None else absolute * abs(state.energy)
    )
    k = dense(full_tangent(scene, state)) + state.filling.rate * np.outer(state.by_volume, state.by_volume)
    change = (up.residual - down.residual) / (2 * step)
    assert np.abs(k @ d - change).max() < 1e-6 * np.abs(change).max()
    return state
