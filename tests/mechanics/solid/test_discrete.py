"""The discrete energy against its own derivatives, and the linear algebra."""

import numpy as np
import pytest

from pneutouch.mechanics.laws import neo_hookean, ogden
from pneutouch.mechanics.solid.banded import negative_pivots
from pneutouch.mechanics.solid.elements import Cavity, Gas, Liquid, TermState
from pneutouch.mechanics.solid.flange import printed_dome
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import SolidScene, evaluate, full_tangent
from pneutouch.mechanics.solid.object_contact import Plate
from pneutouch.shape.hemisphere import Hemisphere
from tests.mechanics.solid.derivatives import assert_derivatives, dense


class Springs:
    """Quartic springs on the nodes of the edges of both walls: a term of the energy whose derivatives are plain."""

    noise = 0.0

    def __init__(self, solid):
        self.solid = solid

    def at(self, x):
        mesh, faces = self.solid.mesh, self.solid.faces
        families = ((mesh.outer, faces.push), (mesh.inner, lambda blocks: faces.inner.vector([blocks])))
        energy, gradient, blocks = 0.0, 0.0, []
        for edges, gathered in families:
            place = x[edges].reshape(edges.shape[0], -1)
            energy += 0.25 * float((place**4).sum())
            gradient = gradient + gathered(place**3)
            blocks.append(3.0 * place[:, :, None] ** 2 * np.eye(place.shape[1]))
        return TermState(energy, gradient, *blocks)


@pytest.mark.parametrize("terms", [(), (Springs,)])
@pytest.mark.parametrize("order", [1, 2, 8])
@pytest.mark.parametrize("law", [neo_hookean(0.17), ogden(((0.1, 1.3), (0.07, 4.0)))])
def test_residual_and_tangent_are_derivatives_of_the_energy(order, law, terms):
    solid = SolidModel(dome(Hemisphere(9.25, 1.5), arc=8, order=order), law)
    rng = np.random.default_rng(0)
    x = solid.rest + solid.expand(2e-3 * rng.normal(size=solid.size))
    scene = SolidScene(
        solid, Gas.filled(0.1, 2.1, 0.6, 0.2), Plate(1.1, 0.3, 0.1), tuple(term(solid) for term in terms)
    )
    assert_derivatives(scene, x, rng, step=1e-7, rel=1e-5, absolute=1e-7)


def test_cavity_volume_is_exact_and_converges_to_the_hemisphere():
    mesh = dome(Hemisphere(2.0, 0.3), arc=40, order=1)
    line = mesh.nodes[np.append(mesh.inner[:, 0], mesh.inner[-1, 1])]
    r, z = line.T
    frusta = np.pi / 3 * np.diff(z) * (r[1:] ** 2 + r[1:] * r[:-1] + r[:-1] ** 2)
    assert Cavity(mesh.inner).volume(mesh.nodes) == pytest.approx(frusta.sum(), rel=1e-13)
    errors = []
    for arc in (8, 16):
        mesh = dome(Hemisphere(1.0, 0.1), arc=arc)
        errors.append(abs(Cavity(mesh.inner).volume(mesh.nodes) - 2 * np.pi / 3))
    assert errors[1] < 1e-5 and np.log2(errors[0] / errors[1]) > 3.8


def test_inertia_matches_eigenvalues():
    rng = np.random.default_rng(1)
    for shift in (-3.0, 0.0, 2.0, 9.0):
        band = rng.normal(size=(6, 47))
        band[0] += shift
        assert negative_pivots(band) == (np.linalg.eigvalsh(dense(band)) < 0).sum()


def test_inertia_of_band_plus_rank_one():
    rng = np.random.default_rng(2)
    for _ in range(50):
        band = rng.normal(size=(4, 23))
        band[0] += rng.uniform(0, 6)
        g, c = rng.normal(size=23), rng.uniform(0.1, 30)
        k = dense(band)
        denominator = 1 + c * g @ np.linalg.solve(k, g)
        predicted = negative_pivots(band) - (denominator < 0)
        assert predicted == (np.linalg.eigvalsh(k + c * np.outer(g, g)) < 0).sum()


def test_unloaded_dome_is_in_equilibrium_and_stable():
    solid = SolidModel(dome(Hemisphere(9.25, 1.5)), neo_hookean(0.17))
    v0 = solid.cavity.volume(solid.rest)
    state = evaluate(SolidScene(solid, Liquid(v0, 30.0), None), solid.rest)
    assert np.abs(state.residual).max() < 1e-12
    assert negative_pivots(full_tangent(SolidScene(solid, Liquid(v0, 30.0), None), state)) == 0


def test_bands_stay_narrow():
    assert SolidModel(dome(Hemisphere(9.25, 1.5)), neo_hookean(0.17)).pattern.width == 25
    assert SolidModel(printed_dome(Hemisphere(9.25, 1.5), 2.25, 2.25), neo_hookean(0.17)).pattern.width <= 45


def test_inverted_cells_are_refused():
    mesh = dome(Hemisphere(1.0, 0.2), arc=4)
    nodes = mesh.nodes.copy()
    nodes[mesh.cells[0, 0]], nodes[mesh.cells[0, 1]] = nodes[mesh.cells[0, 1]].copy(), nodes[mesh.cells[0, 0]].copy()
    bad = type(mesh)(**{**mesh.__dict__, "nodes": nodes})
    with pytest.raises(ValueError, match="inverted"):
        SolidModel(bad, neo_hookean(1.0))


def test_broken_boundary_lines_are_refused():
    mesh = dome(Hemisphere(1.0, 0.2), arc=4)
    with pytest.raises(ValueError, match="one line"):
        type(mesh)(**{**mesh.__dict__, "inner": mesh.inner[::-1]})
