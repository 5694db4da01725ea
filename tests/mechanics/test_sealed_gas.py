"""The gas of an untouched sensor: exact limits of a rigid cavity, Boyle's law, and the atlas's temperature note."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.predict import predict
from pneutouch.mechanics.sealed_gas import SealedGas, conductance_of_cap, leak_pressure
from pneutouch.mechanics.uncertainty.document import gas_notes
from pneutouch.spec.material import Material
from pneutouch.units import KPA

AMBIENT = 101.325 * KPA


def rigid(volume: float = 1658.0, dead: float = 500.0) -> SealedGas:
    pressures = np.linspace(0.0, 0.03, 31)
    return SealedGas(pressures, np.full(31, volume), dead, AMBIENT, volume)


def emptying(start: float, end: float) -> float:
    """Time of the exact solution in a rigid volume, times conductance over volume: dp/dt = -p (1 + p/(2 ambient))."""
    return float(np.log(start / (1 + 0.5 * start / AMBIENT)) - np.log(end / (1 + 0.5 * end / AMBIENT)))


def test_a_rigid_cavity_has_boyle_gay_lussac_and_the_leak_of_a_gas():
    gas = rigid()
    total = 1658.0 + 500.0
    assert gas.capacity == pytest.approx(np.full(31, total))
    assert gas.injected == pytest.approx(gas.pressure / AMBIENT * total)
    assert gas.by_temperature(293.15) == pytest.approx((gas.pressure + AMBIENT) / 293.15)
    seconds = gas.holding_time(2.0, 0.03, 0.015)
    assert seconds == pytest.approx(total / 2.0 * emptying(0.03, 0.015), rel=1e-6)
    assert gas.holding_time(0.0, 0.03, 0.015) == gas.holding_time(2.0, 0.03, 0.0) == np.inf


@given(
    st.floats(10.0, 5000.0), st.floats(0.0, 5000.0), st.floats(1e-4, 0.1), st.floats(1e-6, 1e-2), st.floats(0.1, 0.99)
)
def test_a_cap_and_a_rigid_sensor_of_its_volume_lose_alike(volume, dead, pressure, rate, share):
    """The conductance of a leak gives back the rate that it was taken from, and time is rate integrated."""
    conductance = conductance_of_cap(rate, pressure, volume + dead, AMBIENT)
    pressures = np.array([0.0, 0.5 * pressure, pressure])
    gas = SealedGas(pressures, np.full(3, volume), dead, AMBIENT, volume)
    assert gas.loss(conductance)[2] == pytest.approx(rate, rel=1e-9)
    seconds = gas.holding_time(conductance, pressure, share * pressure)
    of_start = pressure * (1 + 0.5 * pressure / AMBIENT)
    assert seconds == pytest.approx(of_start / rate * emptying(pressure, share * pressure), rel=1e-5)


def test_the_flow_of_a_leak_is_that_of_the_squares_of_the_absolute_pressures():
    """Against dP/dt = -G (P^2 - a^2)/(2 a V) in absolute pressures, solved by an area tangent hyperbolic."""
    gauge = np.array([1e-6, 0.02, 0.1])
    squares = ((gauge + AMBIENT) ** 2 - AMBIENT**2) / (2 * AMBIENT)
    assert leak_pressure(gauge, AMBIENT) == pytest.approx(squares, rel=1e-9)
    assert leak_pressure(1e-6, AMBIENT) == pytest.approx(1e-6, rel=1e-5)
    gas = SealedGas(np.linspace(0.0, 0.1, 11), np.full(11, 5000.0), 0.0, AMBIENT, 5000.0)
    conductance = conductance_of_cap(1e-5, 0.1, 5000.0, AMBIENT)
    start, end = (np.arctanh(AMBIENT / (AMBIENT + p)) for p in (0.1, 0.02))
    assert gas.holding_time(conductance, 0.1, 0.02) == pytest.approx(2 * (end - start) * 5000.0 / conductance, rel=1e-5)


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
