"""The solid on discs, caps, ellipsoids and thimbles against theory and CalculiX; the page is background/validation.md."""

from __future__ import annotations

import shutil
from dataclasses import replace

import numpy as np
import pytest
from benchmarks.scenes import PAPER
from benchmarks.shallow_shells import ShallowShell, hencky
from benchmarks.shape_calculix import row
from benchmarks.shape_references import (
    CAP_POISSON,
    bent_plate,
    far_bent_plate,
    inflated_membrane,
    pressed_cap,
    shallow_cap,
    small_strain,
    snapped_cap,
)

from pneutouch.mechanics.solid.inflate import inflate
from pneutouch.shape.round import Ellipsoid, Thimble
from pneutouch.units import KPA
from tests.mechanics.exact_membrane import flat, flat_at, flat_limit
from tests.mechanics.solid.calculix_presses import calculix_inflated, calculix_press, solid_press


def rise_of(slope: float, nu: float = CAP_POISSON) -> tuple[float, float]:
    """Rise over the wall of a cap by its lambda, and its classical pressure as p a^4/(E h^4)."""
    root = np.sqrt(3.0 * (1.0 - nu**2))
    rise = slope**2 / (4.0 * root)
    return rise, 8.0 * rise**2 / root


class TestTheReferencesThemselves:
    @pytest.mark.parametrize("nu", [0.0, 0.3, 0.49])
    def test_a_plate_that_bends_little_is_kirchhoff_s(self, nu):
        shell = ShallowShell(0.0, nu)
        state = shell.at(1e-4)
        assert state is not None
        # p a^4/(64 D), and a mean of a third of the deflection at the pole
        assert shell.pole(state) == pytest.approx(state.pressure * 12 * (1 - nu**2) / 64, rel=1e-6)
        assert shell.pole(state) == pytest.approx(3e-4, rel=1e-6)

    @pytest.mark.parametrize("nu", [0.2, 0.3, 0.4])
    def test_a_plate_that_bends_far_becomes_hencky_s_membrane(self, nu):
        shell = ShallowShell(0.0, nu, 24)
        found = [shell.pole(shell.inflated(load)) / load ** (1 / 3) / hencky(nu) - 1 for load in (1e4, 1e5, 1e6)]
        assert found[0] < found[1] < found[2] < 0.0
        assert found[2] == pytest.approx(0.0, abs=3e-3)

    def test_a_cap_of_many_bending_lengths_sinks_as_a_sphere_whose_rim_is_held(self):
        """Away from the rim the pole sinks by (1 - nu) p R^2/(2 E h), as the rim's layer narrows."""
        errors = []
        for slope in (20.0, 40.0, 80.0):
            shell = ShallowShell(rise_of(slope)[0], CAP_POISSON, 48)
            state = shell.at(-1e-6)
            assert state is not None
            errors.append(shell.pole(state) * 4 * shell.rise**2 / state.pressure * 2 / (1 - CAP_POISSON) - 1)
        assert errors[0] / errors[1] == pytest.approx(2.0, rel=0.1) and errors[1] / errors[2] == pytest.approx(
            2.0, rel=0.1
        )

    @pytest.mark.parametrize("slope", [5.0, 7.0, 10.0])
    def test_buckling_does_not_depend_on_the_points(self, slope):
        rise, classical = rise_of(slope)
        coarse, fine = (ShallowShell(rise, CAP_POISSON, points).buckling() for points in (14, 20))
        assert coarse.keys() == fine.keys()
        for n, pressure in fine.items():
            assert coarse[n] / classical == pytest.approx(pressure / classical, abs=2e-3)

    def test_caps_of_a_low_rise_have_no_waves_before_the_limit_point_and_higher_ones_have_more_and_more(self):
        """Huang 1964: the round form is lost first to waves from about lambda 5.5 on."""
        first = []
        for slope in (4.0, 5.0, 6.0, 7.0, 8.0):
            found = ShallowShell(rise_of(slope)[0], CAP_POISSON).buckling()
            first.append(min(found, key=found.__getitem__))
        assert first == [0, 0, 2, 3, 4]

    def test_the_flat_membrane_of_small_strain_is_hencky_s(self):
        pressure, height = flat(1.0005)
        # neo-Hookean and incompressible: E = 3 mu, nu = 1/2
        assert height == pytest.approx(hencky(0.5) * (pressure / 3.0) ** (1 / 3), rel=2e-3)
        assert flat_at(0.8) == pytest.approx(1.6450, abs=1e-3)
        assert flat_limit() == pytest.approx((1.879173, 1.17390), abs=1e-5)


class TestDiscs:
    @pytest.mark.parametrize(("nu", "wall", "within"), [(0.3, 0.05, 4e-3), (0.3, 0.01, 1e-3), (0.49, 0.02, 5e-3)])
    def test_small_deflection_is_that_of_a_plate_with_shear(self, nu, wall, within):
        _, sheared, freed = bent_plate(wall, nu)
        assert abs(sheared) < within and abs(freed) < within

    @pytest.mark.parametrize("nu", [0.3, 0.49])
    def test_without_the_hold_on_its_thickness_the_edge_s_error_falls_with_the_square_of_the_wall(self, nu):
        errors = [bent_plate(wall, nu)[2] for wall in (0.1, 0.05, 0.025)]
        assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)
        assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.1)

    @pytest.mark.parametrize("load", [1.0, 10.0, 100.0, 1000.0])
    def test_large_deflection_is_that_of_foeppl_and_von_karman(self, load):
        assert far_bent_plate(load, 0.3)[1] == pytest.approx(0.0, abs=4e-3)

    @pytest.mark.parametrize("nu", [0.3, 0.49])
    def test_a_thin_disc_of_small_strain_is_hencky_s_membrane(self, nu):
        assert small_strain(0.001, nu) == pytest.approx(0.0, abs=4e-3)

    def test_a_thin_disc_inflated_past_its_limit_is_the_exact_membrane(self):
        found = inflated_membrane(0.01, 96)
        assert np.abs(found["limit"]) == pytest.approx(0.0, abs=5e-3)
        assert max(abs(error) for *_, error in found["rows"]) < 5e-3


class TestCaps:
    @pytest.mark.parametrize("slope", [4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0])
    def test_an_emptied_cap_snaps_as_shallow_shell_theory_says(self, slope):
        found = snapped_cap(slope)
        assert found["waves"][0] == found["waves"][1]
        for key in ("limit", "first"):
            assert found[key][1] == pytest.approx(found[key][0], rel=5e-3)
        assert found["greatest"] < 5e-3

    def test_a_cap_with_a_low_rise_is_emptied_through_its_limit_point(self):
        solid, classical = shallow_cap(4.0)
        run = inflate(solid, to_pressure=-2.0 * classical)
        assert run.limit is not None and run.states[-1].stiffness <= 0.0

    def test_first_stiffness_under_a_ball_is_that_of_a_shallow_shell(self):
        found = pressed_cap(0.005)
        assert found.value == pytest.approx(found.sheared, rel=0.01)


calculix = pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed")
FORMS = {"ellipsoid": Ellipsoid(9.25, 1.5, 11.5), "thimble": Thimble(9.25, 1.5, 4.5, 9.25)}


@calculix
@pytest.mark.parametrize("key", FORMS)
def test_an_inflated_shape_is_calculix_s(key):
    from pneutouch.mechanics.laws import neo_hookean
    from pneutouch.mechanics.solid.inflate import state_at
    from pneutouch.mechanics.solid.mesh import dome
    from pneutouch.mechanics.solid.model import SolidModel

    sensor = replace(PAPER, dome=replace(PAPER.dome, shape=FORMS[key]))
    free = state_at(SolidModel(dome(FORMS[key]), neo_hookean(0.17, 0.49)), 20 * KPA)
    assert calculix_inflated(sensor, 20 * KPA, (24, 2)) == pytest.approx((free.inner_apex, free.volume), rel=3e-3)


@calculix
@pytest.mark.slow
@pytest.mark.parametrize("driving", [10 * KPA, 20 * KPA])
@pytest.mark.parametrize("key", FORMS)
def test_a_pressed_shape_is_calculix_s_on_the_same_cells(key, driving):
    sensor = replace(PAPER, dome=replace(PAPER.dome, shape=FORMS[key]))
    ours = solid_press(sensor, 0.0, 3.0, (24, 2), 6, driving)
    depths, forces, pressures = (ours.column(name) for name in ("indentation", "force", "pressure"))
    top = float(ours.states[0].positions[:, 1].max())
    assert calculix_press(sensor, 0.0, depths, pressures, (24, 2), top)[1:] == pytest.approx(forces[1:], rel=0.01)


@calculix
@pytest.mark.slow
def test_the_page_s_press_of_an_ellipsoid_is_within_a_hundredth():
    found = row(replace(PAPER, dome=replace(PAPER.dome, shape=FORMS["ellipsoid"])), 10 * KPA)
    assert max(map(abs, found["free"])) < 5e-3 and max(abs(error) for *_, error in found["press"]) < 0.01
