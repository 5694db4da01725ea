"""The wall with harmonics: the axisymmetric solid, exact deformations of a body in space, and derivatives."""

import numpy as np
import pytest

from pneutouch.arrays import Array
from pneutouch.mechanics.harmonic.model import HarmonicModel
from pneutouch.mechanics.laws import Hyperelastic, hyperelastic, neo_hookean
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid.banded import solve_definite
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.shape.hemisphere import Hemisphere

LAWS = {
    "neo-hookean": neo_hookean(0.27),
    "yeoh": hyperelastic("yeoh", (0.1, 0.02, 0.003), 0.49),
    "mooney-rivlin": hyperelastic("mooney-rivlin", (0.1, 0.05), 0.49),
    "ogden": hyperelastic("ogden", (0.3, 2.5, 0.05, -3.0), 0.49),
}


def _solid(law: Hyperelastic = LAWS["neo-hookean"], arc: int = 6) -> SolidModel:
    return SolidModel(dome(Hemisphere(9.25, 1.5), arc=arc, through=1), law, base=RigidBase())


def _inflated(solid: SolidModel) -> Array:
    """Some axisymmetric positions."""
    return np.where(solid.dofs < 0, solid.rest, solid.rest * [1.1, 0.92])


def _moved(model: HarmonicModel, x: Array) -> Array:
    """The same with some of every harmonic."""
    return x + model.expand(0.002 * np.random.default_rng(0).normal(size=model.size))


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_without_harmonics_it_is_the_solid(law: Hyperelastic) -> None:
    solid = _solid(law)
    model, x = HarmonicModel(solid, 0), _inflated(solid)
    ours, theirs = model.local(x), solid.local(x)
    np.testing.assert_allclose(ours.energy, theirs.energy, rtol=1e-12)
    np.testing.assert_allclose(model.forces(ours), solid.forces(theirs), atol=1e-11)
    idle = np.zeros_like(solid.cavity.hessian(x))
    stiff = [body.pattern.matrix([body.stiffness(at), idle]) for body, at in ((model, ours), (solid, theirs))]
    np.testing.assert_allclose(stiff[0], stiff[1], atol=1e-10)
    np.testing.assert_allclose(model.cavity.gradient(x)[1], solid.cavity.gradient(x)[1], atol=1e-13)
    np.testing.assert_allclose(model.cavity.hessian(x), solid.cavity.hessian(x), atol=1e-13)


@pytest.mark.parametrize("order", [1, 3])
def test_harmonics_without_amplitude_change_no_energy_and_no_volume(order: int) -> None:
    solid = _solid()
    model, x = HarmonicModel(solid, order), _inflated(solid)
    lifted = model.harmonics.lifted(x)
    assert model.local(lifted).energy == pytest.approx(solid.local(x).energy, rel=1e-12)
    assert model.cavity.volume(lifted) == pytest.approx(solid.cavity.volume(x), rel=1e-13)


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_forces_and_stiffness_are_derivatives(law: Hyperelastic) -> None:
    model = HarmonicModel(_solid(law, arc=4), 2)
    x = _moved(model, model.harmonics.lifted(_inflated(_solid(law, arc=4))))
    way = np.random.default_rng(1).normal(size=model.size)
    ahead, back = x + 1e-6 * model.expand(way), x - 1e-6 * model.expand(way)

    def gradient(at: Array) -> Array:
        volume = model.cavity.gradient(at)[1]
        return model.pattern.vector([model.forces(model.local(at)), -0.7 * volume])

    energies = [model.local(at).energy - 0.7 * model.cavity.volume(at) for at in (ahead, back)]
    assert (energies[0] - energies[1]) / 2e-6 == pytest.approx(float(gradient(x) @ way), rel=1e-6, abs=1e-6)
    band = model.pattern.matrix([model.stiffness(model.local(x)), -0.7 * model.cavity.hessian(x)])
    slope = (gradient(ahead) - gradient(back)) / 2e-6
    np.testing.assert_allclose(_times(band, way), slope, atol=1e-6 * float(np.abs(slope).max()))


def _times(band: Array, x: Array) -> Array:
    """Product of a symmetric matrix, given as its lower band, with a vector."""
    out = band[0] * x
    for k in range(1, band.shape[0]):
        out[k:] += band[k, :-k] * x[:-k]
        out[:-k] += band[k, :-k] * x[k:]
    return np.asarray(out)


def test_a_turn_of_the_deformed_wall_about_a_horizontal_axis_costs_nothing() -> None:
    """It is a sum of harmonics to the second: every strain measure must be blind to it."""
    solid = _solid(LAWS["ogden"])
    model, x = HarmonicModel(solid, 2), _inflated(solid)
    r, z, turn = x[:, 0], x[:, 1], 0.4
    turned = np.zeros((len(x), model.harmonics.columns))
    # x' = x cos + z sin, z' = z cos - x sin, in components outwards, upwards and around.
    turned[:, 0], turned[:, 1] = 0.5 * r * (np.cos(turn) + 1.0), z * np.cos(turn)
    turned[:, 2], turned[:, 3], turned[:, 4] = z * np.sin(turn), -r * np.sin(turn), -z * np.sin(turn)
    turned[:, 5], turned[:, 7] = 0.5 * r * (np.cos(turn) - 1.0), -0.5 * r * (np.cos(turn) - 1.0)
    assert model.local(turned).energy == pytest.approx(solid.local(x).energy, rel=1e-12)


def test_shear_keeps_the_volume_and_a_stretch_along_x_multiplies_it() -> None:
    solid = _solid()
    model, x = HarmonicModel(solid, 2), _inflated(solid)
    volume, r, z = solid.cavity.volume(x), x[:, 0], x[:, 1]
    sheared = model.harmonics.lifted(x)
    sheared[:, 2], sheared[:, 4] = 0.3 * z, -0.3 * z
    assert model.cavity.volume(sheared) == pytest.approx(volume, rel=1e-13)
    stretched = model.harmonics.lifted(x)
    stretched[:, 0] += 0.1 * r
    stretched[:, 5], stretched[:, 7] = 0.1 * r, -0.1 * r
    assert model.cavity.volume(stretched) == pytest.approx(1.2 * volume, rel=1e-13)


def test_the_wall_at_rest_is_stable() -> None:
    model = HarmonicModel(_solid(), 3)
    stiffness = model.stiffness(model.local(model.rest))
    band = model.pattern.matrix([stiffness, np.zeros_like(model.cavity.hessian(model.rest))])
    assert solve_definite(band, np.ones((model.size, 1))) is not None


def test_a_wall_on_its_flange_is_refused() -> None:
    from pneutouch.mechanics.solid.flange import printed_dome

    mesh = printed_dome(Hemisphere(9.25, 1.5), 3.0, 1.5, arc=8, through=1)
    with pytest.raises(ValueError, match="flange"):
        HarmonicModel(SolidModel(mesh, LAWS["neo-hookean"], base=RigidBase(flange=13.75)), 1)
