"""The gas of an untouched sensor: exact limits of a rigid cavity, Boyle's law, and the atlas's temperature note."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.predict import predict
from pneutouch.mechanics.sealed_gas import SealedGas, conductance_of_cap
from pneutouch.mechanics.uncertainty.document import gas_notes
from pneutouch.spec.material import Material
from pneutouch.units import KPA

AMBIENT = 101.325 * KPA


def rigid(volume: float = 1658.0, dead: float = 500.0) -> SealedGas:
    pressures = np.linspace(0.0, 0.03, 31)
    return SealedGas(pressures, np.full(31, volume), dead, AMBIENT, volume)


def test_a_rigid_cavity_has_boyle_gay_lussac_and_an_exponential_leak():
    gas = rigid()
    total = 1658.0 + 500.0
    assert gas.capacity == pytest.approx(np.full(31, total))
    assert gas.injected == pytest.approx(gas.pressure / AMBIENT * total)
    assert gas.by_temperature(293.15) == pytest.approx((gas.pressure + AMBIENT) / 293.15)
    seconds = gas.holding_time(2.0, 0.03, 0.015)
    assert seconds == pytest.approx(total / 2.0 * np.log(2.0), rel=1e-9)
    assert gas.holding_time(0.0, 0.03, 0.015) == gas.holding_time(2.0, 0.03, 0.0) == np.inf


@given(
    st.floats(10.0, 5000.0), st.floats(0.0, 5000.0), st.floats(1e-4, 0.1), st.floats(1e-6, 1e-2), st.floats(0.1, 0.99)
)
def test_a_cap_and_a_rigid_sensor_of_its_volume_lose_alike(volume, dead, pressure, rate, share):
    """The conductance of a leak gives back the rate that it was taken from, and time is rate integrated."""
    conductance = conductance_of_cap(rate, pressure, volume + dead)
    pressures = np.array([0.0, 0.5 * pressure, pressure])
    gas = SealedGas(pressures, np.full(3, volume), dead, AMBIENT, volume)
    assert gas.loss(conductance)[2] == pytest.approx(rate, rel=1e-9)
    seconds = gas.holding_time(conductance, pressure, share * pressure)
    assert seconds == pytest.approx(pressure / rate * np.log(1 / share), rel=1e-9)


def test_a_wall_that_gives_way_takes_more_gas_and_shows_the_temperature_as_the_atlas_does(library):
    material = library.all("materials", Material)["TangoPlus"]
    sensor = material_sensor(material).replace(inner_radius=9.25, wall_thickness=1.5, dead_volume=800.0)
    pressures = np.linspace(0.0, 0.03, 61)
    states = predict("x", sensor, pressures.tolist(), model="atlas").states
    volumes = np.array([state.cavity_volume for state in states])
    gas = SealedGas(pressures, volumes, 800.0, sensor.gas.ambient_pressure, float(volumes[0]))
    chosen = [10, 30, 50]
    notes = gas_notes(batch_of(sensor, pressures[chosen]))
    assert gas.by_temperature(293.15)[chosen] / KPA == pytest.approx(notes.by_temperature_kPa_per_K, rel=2e-3)
    assert np.all(gas.capacity > volumes + 800.0)
    # What is injected between two states is the integral of the capacity.
    steps = np.diff(gas.pressure) * 0.5 * (gas.capacity[1:] + gas.capacity[:-1]) / sensor.gas.ambient_pressure
    assert steps.sum() == pytest.approx(gas.injected[-1], rel=2e-3)
