import numpy as np
import pytest

from pneutouch.errors import InputError
from pneutouch.mechanics.laws import hyperelastic, mooney_rivlin, neo_hookean, ogden, stiffened, yeoh
from pneutouch.mechanics.laws.strain import Strain

LAWS = {
    "neo_hookean": (neo_hookean(0.17), 0.17),
    "mooney_rivlin": (mooney_rivlin(0.07, 0.015), 0.17),
    "yeoh": (yeoh(0.085, -0.01, 0.002), 0.17),
    "ogden1": (ogden(((0.17, -3.68),)), 0.17),
    "ogden3": (ogden(((0.1, 1.3), (0.05, 5.0), (0.02, -2.0))), 0.17),
}


def _points():
    rng = np.random.default_rng(3)
    f = np.eye(2)[None] + 0.4 * rng.normal(size=(60, 2, 2))
    f = f[np.linalg.det(f) > 0.2]
    f[0] = np.eye(2)  # equal stretches: where principal-stretch formulas divide by zero
    return (f**2).sum(axis=(1, 2)), np.linalg.det(f), rng.uniform(0.6, 1.8, f.shape[0])


@pytest.mark.parametrize("name", LAWS)
def test_energy_carries_the_shear_modulus_of_its_convention(name):
    material, mu = LAWS[name]
    assert material.mu == pytest.approx(mu, rel=1e-12)


@pytest.mark.parametrize("name", LAWS)
def test_jets_are_the_derivatives_of_the_energy(name):
    energy = LAWS[name][0].energy
    at = np.array(_points())
    jet = energy(Strain(*at)).data
    pairs = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
    # a may not fall below 2 j: step forward in a, backward in j, where both signs are not allowed
    step = 1e-5
    inside = at[0] - 2 * at[1] > 1e-3
    for i in range(3):
        e = np.zeros((3, 1))
        e[i] = step
        up, down = (energy(Strain(*(at[:, inside] + s * e))).data for s in (1, -1))
        assert np.allclose((up[0] - down[0]) / (2 * step), jet[1 + i, inside], rtol=1e-6, atol=1e-8)
        for row, pair in enumerate(pairs, start=4):
            if i in pair:
                other = pair[1] if pair[0] == i else pair[0]
                slope = (up[1 + other] - down[1 + other]) / (2 * step)
                assert np.allclose(slope, jet[row, inside], rtol=2e-6, atol=1e-7)


@pytest.mark.parametrize(
    ("name", "constants"),
    [
        ("neo-hookean", (0.17,)),
        ("mooney-rivlin", (0.07, 0.015)),
        ("yeoh", (0.085, -0.01, 0.002)),
        ("ogden", (0.1, 1.3, 0.05, 5.0, 0.02, -2.0)),
    ],
)
def test_a_stiffened_law_has_so_many_times_the_energy(name, constants):
    at = Strain(*_points())
    energies = [
        hyperelastic(*law, 0.49).energy(at).data for law in ((name, constants), stiffened(name, constants, 1.7))
    ]
    assert energies[1] == pytest.approx(1.7 * energies[0], rel=1e-12, abs=1e-15)


def test_one_term_ogden_with_alpha_two_is_neo_hookean():
    at = _points()
    a, b = ogden(((0.17, 2.0),)).energy(Strain(*at)).data, neo_hookean(0.17).energy(Strain(*at)).data
    assert np.allclose(a, b, rtol=1e-10, atol=1e-12)


def test_ogden_of_alpha_two_and_minus_two_is_mooney_rivlin():
    at = _points()
    a = ogden(((0.14, 2.0), (0.03, -2.0))).energy(Strain(*at)).data
    assert np.allclose(a, mooney_rivlin(0.07, 0.015).energy(Strain(*at)).data, rtol=1e-9, atol=1e-12)


def test_energies_ignore_a_change_of_volume():
    for material, _ in LAWS.values():
        a, j, h = _points()
        swollen = material.energy(Strain(1.21 * a, 1.21 * j, 1.1 * h)).data[0]
        assert np.allclose(swollen, material.energy(Strain(a, j, h)).data[0], rtol=1e-11, atol=1e-13)


def test_bad_parameters_are_refused():
    with pytest.raises((ValueError, InputError), match="shear modulus"):
        neo_hookean(-1.0)
    with pytest.raises((ValueError, InputError), match="poisson_ratio"):
        neo_hookean(0.17, 0.5)
    with pytest.raises((ValueError, InputError), match="alpha"):
        ogden(((0.1, 0.0),))
