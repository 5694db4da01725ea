"""Temperature and speed: against a direct solution of the heated gas, and in the limits of a rigid and a limp wall."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.uncertainty.document import ADIABATIC, REFERENCE_TEMPERATURE, gas_notes
from tests.mechanics.test_contact import PAPER


@pytest.mark.parametrize(("pressure", "dead"), [(0.005, 0.0), (0.012, 0.0), (0.022, 2000.0)])
def test_heating_a_sealed_cavity_by_a_kelvin(pressure, dead):
    sensor = PAPER.replace(dead_volume=dead)

    def amount(p, temperature):
        volume = float(respond(batch_of(sensor, [p])).cavity_volume[0]) + dead
        return (p + sensor.gas.ambient_pressure) * volume / temperature

    sealed = amount(pressure, REFERENCE_TEMPERATURE)
    hot, cold = (
        brentq(lambda p, t=t: amount(p, t) - sealed, 0.5 * pressure, 1.5 * pressure, xtol=1e-12)
        for t in (REFERENCE_TEMPERATURE + 0.5, REFERENCE_TEMPERATURE - 0.5)
    )
    found = gas_notes(batch_of(sensor, [pressure]))
    assert found.by_temperature_kPa_per_K[0] == pytest.approx(1e3 * (hot - cold), rel=1e-3)


def test_a_stiff_wall_shows_what_a_rigid_cavity_shows():
    found = gas_notes(batch_of(PAPER.replace(shear_modulus=50.0, depth=0.3), [0.0]))
    rigid = 1e3 * PAPER.gas.ambient_pressure / REFERENCE_TEMPERATURE
    assert found.wall_give[0] > 0.99
    assert found.by_temperature_kPa_per_K[0] == pytest.approx(rigid * found.wall_give[0])
    assert found.fast_over_slow[0] == pytest.approx(ADIABATIC, rel=0.02)


@settings(max_examples=15)
@given(st.floats(0.15, 4.0), st.floats(0.0, 0.02), st.floats(0.0, 3000.0))
def test_fast_is_never_less_sensitive_and_small_presses_stay_below_1_4(mu, pressure, dead):
    found = gas_notes(batch_of(PAPER.replace(shear_modulus=mu, dead_volume=dead, depth=1.0), [pressure]))
    assert 0.99 < found.fast_over_slow[0] < 1.02 * ADIABATIC
    assert 0.0 < found.wall_give[0] < 1.0


def test_a_softer_wall_gives_more_and_hides_the_speed():
    found = gas_notes(replace(batch_of(PAPER, [0.0] * 3), shear_modulus=np.array([0.17, 0.91, 4.0])))
    assert (np.diff(found.wall_give) > 0).all()
    assert (np.diff(found.fast_over_slow) > 0).all()
    assert found.fast_over_slow[0] < 1.02
