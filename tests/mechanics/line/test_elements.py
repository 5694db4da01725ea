"""A duct and a volume against their limits, and against finite differences over radius and length."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import solve_banded
from scipy.special import ive, j0, j1, jn_zeros, spherical_jn

from pneutouch.errors import InputError
from pneutouch.mechanics.line.dynamics import GasLine, on_axis
from pneutouch.mechanics.line.elements import ADIABATIC, AirState, Duct, GasVolume, LineEnd, Step, second_over_zeroth

AIR = AirState(0.101325)
FREQUENCIES = st.floats(0.01, 5000.0)
DUCTS = st.builds(Duct, st.floats(0.5, 2000.0), st.floats(0.2, 5.0))


def test_air_is_that_of_the_standard_atmosphere():
    """U.S. Standard Atmosphere, 1976: 1.2250 kg/m3, 1.7894e-5 Pa s, 340.294 m/s, 2.5326e-2 W/(m K) at 288.15 K."""
    air = AirState(0.101325, 288.15)
    assert air.density == pytest.approx(1.2250e-12, rel=1e-4)
    assert air.viscosity == pytest.approx(1.7894e-11, rel=1e-4)
    assert air.sound_speed == pytest.approx(340.294e3, rel=1e-5)
    conductivity = air.viscosity * 1e6 * 3.5 * 8.31432 / 0.0289644 / air.prandtl
    assert conductivity == pytest.approx(2.5326e-2, rel=1e-4)


@pytest.mark.parametrize("given_", [(0.0, 293.15), (-1.0, 293.15), (math.nan, 293.15), (0.1, 20.0), (0.1, math.nan)])
def test_air_that_cannot_be_is_refused(given_):
    with pytest.raises(InputError):
        AirState(*given_)


def test_slow_flow_has_the_resistance_of_poiseuille_and_isothermal_gas():
    duct, s = Duct(1.0, 0.5), on_axis([1e-4])
    assert duct.impedance(s, AIR)[0].real == pytest.approx(8 * AIR.viscosity / (math.pi * 0.5**4), rel=1e-6)
    assert (duct.admittance(s, AIR) / s)[0] == pytest.approx(duct.volume / AIR.pressure, rel=1e-5)


def test_fast_flow_has_the_inertia_of_its_mass_and_adiabatic_gas():
    duct, s = Duct(1.0, 20.0), on_axis([5e3])
    area = math.pi * 20.0**2
    assert (duct.impedance(s, AIR) / s)[0] == pytest.approx(AIR.density / area, rel=3e-3)
    assert (duct.admittance(s, AIR) / s)[0] == pytest.approx(area / (ADIABATIC * AIR.pressure), rel=3e-3)


def diffused(radius: float, diffusivity: float, s: complex, points: int = 4000) -> complex:
    """Mean of u in s u - d (u'' + u'/r) = s, 0 at the wall of a tube: finite volumes over the radius."""
    step = radius / points
    faces = step * np.arange(points + 1)
    spread = diffusivity * faces / step
    spread[-1] *= 2.0
    area = 0.5 * (faces[1:] ** 2 - faces[:-1] ** 2)
    bands = np.zeros((3, points), dtype=complex)
    bands[0, 1:] = bands[2, :-1] = -spread[1:-1]
    bands[1] = s * area + spread[:-1] + spread[1:]
    u = solve_banded((1, 1), bands, s * area.astype(complex))
    return complex((u * area).sum() / area.sum())


@pytest.mark.parametrize("frequency", [0.3, 5.0, 40.0, 300.0, 2000.0])
@pytest.mark.parametrize("radius", [0.3, 1.25])
def test_the_profile_of_oscillating_flow_is_that_of_finite_differences(radius, frequency):
    """Womersley's flow: s rho u = -dp/dz + mu (u'' + u'/r), and heat the same; no Bessel function in it."""
    s, duct = on_axis([frequency]), Duct(1.0, radius)
    mean = diffused(radius, AIR.kinematic_viscosity, s[0])
    warm = diffused(radius, AIR.thermal_diffusivity, s[0])
    area = math.pi * radius**2
    assert duct.impedance(s, AIR)[0] == pytest.approx(s[0] * AIR.density / (area * mean), rel=1e-4)
    compliance = area / (ADIABATIC * AIR.pressure) * (ADIABATIC - (ADIABATIC - 1) * warm)
    assert (duct.admittance(s, AIR) / s)[0] == pytest.approx(compliance, rel=1e-4)


@pytest.mark.parametrize("frequency", [3.0, 40.0, 180.0, 700.0])
def test_the_line_is_that_of_finite_differences_over_its_length(frequency):
    """A ladder of 4000 cells with the profile of finite differences, a neck, a tube and a volume: within 1 %."""
    s = on_axis([frequency])
    pieces = [Duct(8.5, 0.5), Duct(300.0, 1.25)]
    end = GasVolume(150.0)
    got = GasLine((*pieces, end), AIR).seen(s)
    pressure, flow = 1.0 + 0j, complex((s * end.compliance(s, AIR))[0])
    for piece in reversed(pieces):
        area = math.pi * piece.radius**2
        series = s[0] * AIR.density / (area * diffused(piece.radius, AIR.kinematic_viscosity, s[0]))
        warm = diffused(piece.radius, AIR.thermal_diffusivity, s[0])
        shunt = s[0] * area / (ADIABATIC * AIR.pressure) * (ADIABATIC - (ADIABATIC - 1) * warm)
        cell = piece.length / 4000
        for _ in range(4000):
            flow += 0.5 * cell * shunt * pressure
            pressure += cell * series * flow
            flow += 0.5 * cell * shunt * pressure
    assert got.transfer[0] == pytest.approx(1.0 / pressure, rel=1e-2)
    assert got.admittance[0] == pytest.approx(flow / pressure, rel=1e-2)


@given(st.floats(-8.0, 8.0), st.floats(-0.25, 0.25))
def test_the_ratio_of_bessel_functions_is_that_of_scipy(size, turn):
    x = np.array([10.0**size * np.exp(1j * math.pi * turn)])
    known = ive(2, x) / ive(0, x) if size > -2 else x**2 / 8 / (1 + x**2 / 6)
    assert second_over_zeroth(x) == pytest.approx(known, rel=1e-9)


@given(DUCTS, FREQUENCIES, st.floats(0.05, 0.95))
def test_two_parts_of_a_duct_are_the_duct(duct, frequency, share):
    s = on_axis([frequency])
    parts = (Duct(share * duct.length, duct.radius), Duct((1 - share) * duct.length, duct.radius))
    whole, cut = GasLine((duct,), AIR).seen(s), GasLine(parts, AIR).seen(s)
    assert cut.admittance == pytest.approx(whole.admittance, rel=1e-9)
    assert cut.transfer == pytest.approx(whole.transfer, rel=1e-9, abs=1e-300)


@given(st.lists(st.one_of(DUCTS, st.builds(GasVolume, st.floats(0.1, 1e5))), max_size=5), FREQUENCIES)
def test_a_line_takes_energy_up_and_gives_none(elements, frequency):
    seen = GasLine(tuple(elements), AIR).seen(on_axis([frequency]))
    assert seen.admittance[0].real >= -1e-12 * abs(seen.admittance[0])
    assert np.isfinite(seen.transfer[0])


@given(st.lists(st.one_of(DUCTS, st.builds(GasVolume, st.floats(0.1, 1e5))), min_size=1, max_size=5))
def test_slow_changes_see_the_volume_alone(elements):
    """Boyle: a slow line is its volume over the pressure, and the gauge has the cavity's pressure."""
    line, s = GasLine(tuple(elements), AIR), on_axis([1e-7])
    seen = line.seen(s)
    assert (seen.admittance / s)[0] == pytest.approx(line.volume / AIR.pressure, rel=1e-3)
    assert seen.transfer[0] == pytest.approx(1.0, rel=1e-3)


def test_a_ball_of_gas_goes_from_isothermal_to_adiabatic():
    ball = GasVolume(1657.0)
    slow, fast = (ball.compliance(on_axis([f]), AIR)[0] * AIR.pressure / 1657.0 for f in (1e-5, 1e6))
    assert slow == pytest.approx(1.0, rel=1e-4)
    assert fast == pytest.approx(1 / ADIABATIC, rel=2e-3)
    every = np.abs(ball.compliance(on_axis(np.geomspace(1e-4, 1e4, 400)), AIR))
    assert (np.diff(every) < 0).all()


def test_the_two_forms_of_a_ball_meet():
    """Series and closed form at the argument where one takes over."""
    ball = GasVolume(4.0 / 3.0 * math.pi)
    edge = 0.05**2 * AIR.thermal_diffusivity
    below, above = (ball.compliance(np.array([edge * f + 0j]), AIR)[0] for f in (1 - 1e-6, 1 + 1e-6))
    assert above == pytest.approx(below, rel=1e-9)


@cache
def half_ball() -> tuple[np.ndarray, np.ndarray]:
    """Modes of a half ball of radius 1, 0 at its wall: odd Legendre polynomials, zeros of their Bessel functions.

    Weights, whose sum over all modes is 1, and wave numbers.
    """
    points, share = np.polynomial.legendre.leggauss(120)
    points, share = 0.5 * (points + 1), 0.5 * share
    weights, waves = [], []
    for order in range(1, 24, 2):
        grid = np.linspace(order, order + 150, 6000)
        values = spherical_jn(order, grid)
        at = np.flatnonzero(values[1:] * values[:-1] < 0)
        roots = grid[at] - values[at] * (grid[at + 1] - grid[at]) / (values[at + 1] - values[at])
        legendre = np.polynomial.legendre.Legendre.basis(order)(points)
        bessel = spherical_jn(order, np.outer(roots, points)) * points
        mean = (bessel * points) @ share * (legendre @ share)
        weights.append(3 * mean**2 / (bessel**2 @ share * (legendre**2 @ share)))
        waves.append(roots)
    return np.concatenate(weights), np.concatenate(waves)


def hemisphere(s: complex, radius: float, diffusivity: float) -> complex:
    """Isothermal share of the gas in a half ball."""
    weights, waves = half_ball()
    # The modes left out are those of the thinnest layers: there the gas is isothermal.
    assert 0.95 < weights.sum() < 1.0
    return complex(1 - (weights * s / (s + diffusivity * (waves / radius) ** 2)).sum())


@pytest.mark.parametrize("frequency", [0.05, 0.3, 1.0, 3.0, 10.0])
def test_the_gas_of_a_half_ball_is_near_that_of_its_ball(frequency):
    """The cavity's compliance, exact by modes, is that of the ball with its volume over surface within 3 %."""
    radius, s = 9.25, on_axis([frequency])
    dome = GasVolume(2 / 3 * math.pi * radius**3, 3 * math.pi * radius**2)
    exact = (1 + (ADIABATIC - 1) * hemisphere(s[0], radius, AIR.thermal_diffusivity)) / (ADIABATIC * AIR.pressure)
    assert dome.compliance(s, AIR)[0] / dome.volume == pytest.approx(exact, rel=0.03)


@given(st.floats(0.02, 1.0))
def test_the_inertia_of_a_step_is_that_of_the_modes_of_the_wide_duct(ratio):
    """A piston of the narrow radius in the wide duct, by 4000 modes (Karal): added length over the narrow radius."""
    zeros = jn_zeros(1, 4000)
    exact = 4.0 / ratio * np.sum(j1(zeros * ratio) ** 2 / (zeros**3 * j0(zeros) ** 2))
    assert Step(1.0, 1.0 / ratio).length == pytest.approx(exact, abs=0.006)
    assert Step(2.0, 2.0 * ratio).length == pytest.approx(2.0 * ratio * Step(1.0, 1.0 / ratio).length, rel=1e-9)


def test_a_step_into_a_space_is_a_flanged_end_and_moves_the_resonance_as_a_longer_neck_does():
    """Helmholtz's resonator: the neck with both its ends, as a neck that is longer by them, without losses to heat."""
    step = Step(2.0, np.inf)
    assert step.length == pytest.approx(8.0 / (3.0 * math.pi) * 2.0)
    air, s, bulb = AirState(0.1), on_axis(np.geomspace(5.0, 60.0, 40)), GasVolume(2e4)
    neck, longer = GasLine((step, Duct(10.0, 2.0), step, bulb), air), Duct(10.0 + 2.0 * step.length, 2.0)
    ends, whole = neck.seen(s), GasLine((longer, bulb), air).seen(s)
    assert np.abs(ends.transfer) == pytest.approx(np.abs(whole.transfer), rel=0.02)
    same = Step(2.0, 2.0).before(LineEnd(np.ones_like(s), np.ones_like(s)), s, air)
    assert same.transfer == pytest.approx(np.ones_like(s))
