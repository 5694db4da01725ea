"""Balls on bodies whose stiffness is known in closed form: Hertz's block, a thin sphere under pressure."""

import numpy as np
import pytest
from benchmarks.contact_references import TAU, hertz, point_stiffness, sheared_stiffness, sphere


def test_the_closed_form_of_the_thin_sphere_has_its_known_values():
    known = {0.0: 1.0, 0.3: 1.18351, 1.0: np.pi / 2, 2.0: 2.06590, 10.0: 5.22154, 50.0: 17.0517}
    for tau, value in known.items():
        assert point_stiffness(tau) == pytest.approx(value, rel=1e-5)


@pytest.mark.parametrize("tau", TAU)
def test_the_shear_of_the_wall_vanishes_with_the_wall(tau):
    young, nu = 2.0 * 1.499, 0.499
    errors = []
    for wall in (1e-3, 1e-4, 1e-5):
        thin = 8.0 * young * wall**2 / np.sqrt(12.0 * (1.0 - nu**2)) * point_stiffness(tau)
        errors.append(sheared_stiffness(wall, 1.0, tau, 0.2 * wall) / thin - 1.0)
    assert all(error < 0 for error in errors)
    assert errors[0] < errors[1] < errors[2] and errors[2] > -5e-4


@pytest.mark.slow
def test_a_ball_on_a_thick_block_obeys_hertz():
    errors = [hertz(contact).error for contact in (0.02, 0.01, 0.005)]
    assert abs(errors[-1]) < 0.01 and abs(errors[-2]) < 0.02
    # what is left is the block's own size: it falls with the contact over it
    assert errors[0] > 1.6 * errors[1] > 1.6**2 * errors[2] > 0


@pytest.mark.slow
@pytest.mark.parametrize("tau", [0.0, 1.0, 10.0])
def test_a_ball_on_a_pressurised_thin_sphere_meets_the_first_stiffness_of_the_shell(tau):
    thick, thin = sphere(0.01, tau), sphere(0.0025, tau)
    # the closed form, which leaves the shear of the wall out, is approached as the wall thins
    assert -0.055 < thick.value / thick.thin - 1 < thin.value / thin.thin - 1 < 0
    assert thin.value / thin.thin - 1 > -0.035
    # with the shear the wall of a hundredth is within 3 %
    assert abs(thick.value / thick.sheared - 1) < 0.03
