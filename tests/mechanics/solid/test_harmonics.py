"""The second variation around the axis against energies of bodies that are bent in three dimensions."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pneutouch.mechanics.laws import mooney_rivlin, neo_hookean, ogden, yeoh
from pneutouch.mechanics.laws.strain import VALUE, Strain
from pneutouch.mechanics.solid.banded import is_definite, softest
from pneutouch.mechanics.solid.elements import Regulator, cell_shapes, gauss_square, line_shapes, pressure_modes
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import SolidScene, evaluate, full_tangent
from pneutouch.mechanics.solid.object_contact import Plate
from pneutouch.mechanics.solid.second_variation import HarmonicSolid, shear_moduli
from pneutouch.shape.hemisphere import Hemisphere

LAWS = [neo_hookean(0.3), mooney_rivlin(0.1, 0.05), yeoh(0.15, 0.02, 0.003), ogden(((0.25, 1.7), (0.05, -2.0)))]


def energy_of(law, gradients):
    """The isochoric energy of deformation gradients (n, 3, 3) by their singular values."""
    stretch = np.linalg.svd(gradients, compute_uv=False)
    a, j = stretch[:, 0] ** 2 + stretch[:, 1] ** 2, stretch[:, 0] * stretch[:, 1]
    return law.energy(Strain(a, j, stretch[:, 2])).data[VALUE]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.convention)
@settings(max_examples=30, deadline=None)
@given(
    st.tuples(*[st.floats(-0.5, 0.5)] * 4), st.floats(0.6, 1.8), st.floats(-0.5, 0.5), st.sampled_from([True, False])
)
def test_shear_moduli_are_the_second_derivatives_of_the_energy(law, bend, hoop, pressure, coincide):
    plane = np.eye(2) + np.reshape(bend, (2, 2))
    if np.linalg.det(plane) < 0.2:
        plane = np.eye(2) + 0.3 * np.reshape(bend, (2, 2))
    if coincide:
        hoop = np.linalg.svd(plane, compute_uv=False)[1]
    strains = np.array([[*plane.ravel(), hoop]])
    size, places = 1e-3, ((0, 2), (1, 2), (2, 0), (2, 1))

    def moved(i, k, one, other):
        gradient = np.zeros((3, 3))
        gradient[:2, :2], gradient[2, 2] = plane, hoop
        gradient[places[i]] += one * size
        gradient[places[k]] += other * size
        return gradient

    signs = ((1, 1, 1.0), (1, -1, -1.0), (-1, 1, -1.0), (-1, -1, 1.0))
    stack = np.array([moved(i, k, a, b) for i in range(4) for k in range(4) for a, b, _ in signs])
    energy = energy_of(law, stack) + pressure * np.linalg.det(stack)
    expected = (energy.reshape(4, 4, 4) @ [s for *_, s in signs]) / (4.0 * size**2)
    found = shear_moduli(law, strains, np.array([pressure]))[0]
    assert np.abs(found - expected).max() < 2e-5 * np.abs(expected).max()


class Revolved:
    """A solid's mesh with displacements a cos(n t), b cos(n t), c sin(n t), integrated over cells and angles."""

    def __init__(self, solid, n):
        self.solid, self.n = solid, n
        self.angle = 2.0 * np.pi * np.arange(12) / 12 + 0.1
        self.points, self.weights = gauss_square(solid.scheme.gauss)

    def _lines(self, field):
        """Displacements (n_angles, n_nodes, 3) and their derivatives by the angle, in r, theta and z."""
        cos, sin = np.cos(self.n * self.angle)[:, None], np.sin(self.n * self.angle)[:, None]
        a, b, c = field.T
        here = np.stack([a * cos, c * sin, b * cos], axis=-1)
        turned = self.n * np.stack([-a * sin, c * cos, -b * sin], axis=-1)
        return here, turned

    def _positions(self, x, field):
        """Components of positions in the local frame and of their derivative by the angle, (n_angles, n_nodes, 3)."""
        here, turned = self._lines(field)
        here = here + np.stack([x[:, 0], np.zeros(len(x)), x[:, 1]], axis=-1)
        frame = np.stack([-here[..., 1], here[..., 0], np.zeros(here.shape[:2])], axis=-1)
        return here, turned + frame

    def wall(self, x, field):
        """Stored energy over mu, the volume averaged over each cell of the meridian at every angle."""
        solid, cells = self.solid, self.solid.mesh.cells
        value, local = cell_shapes(self.points, cells.shape[1])
        jacobian = np.einsum("qak,eai->eqik", local, solid.rest[cells])
        gradient = np.einsum("qak,eqki->eqai", local, np.linalg.inv(jacobian))
        radius = np.einsum("qa,ea->eq", value, solid.rest[cells][..., 0])
        measure = 2.0 * np.pi * radius * np.abs(np.linalg.det(jacobian)) * self.weights
        here, around = self._positions(x, field)
        plane = np.einsum("teai,eqak->teqik", here[:, cells], gradient)
        hoop = np.einsum("teai,qa->teqi", around[:, cells], value) / radius[None, :, :, None]
        # Rows and columns in the order r, theta, z.
        f = np.stack([plane[..., 0], hoop, plane[..., 1]], axis=-1)
        modes = pressure_modes(self.points, measure, solid.scheme.pressure)
        content = np.einsum("emq,eq,teq->tem", modes, measure, np.linalg.det(f) - 1.0)
        energy = np.einsum("eq,teq->t", measure, energy_of(solid.material, f.reshape(-1, 3, 3)).reshape(f.shape[:3]))
        bulk = 0.5 * solid.material.bulk_ratio * (content**2).sum(axis=(1, 2))
        return float((energy / solid.mu + bulk).mean())

    def volume(self, x, field):
        """Cavity volume: a third of the flux of the position through wall and base."""
        edges = self.solid.mesh.inner
        point, weight = np.polynomial.legendre.leggauss(6)
        value, slope = line_shapes(point, edges.shape[1])
        here, around = self._positions(x, field)
        at = np.einsum("teai,qa->teqi", here[:, edges], value)
        along = np.einsum("teai,qa->teqi", here[:, edges], slope)
        turned = np.einsum("teai,qa->teqi", around[:, edges], value)
        flux = np.einsum("teqi,teqi,q->t", at, np.cross(turned, along), weight)
        return float(2.0 * np.pi * flux.mean() / 3.0)

    def contact(self, x, field, plate):
        """Energy of the contact with a plate whose underside depends on the distance from the axis."""
        contact = self.solid.contact
        at = np.einsum("teai,qa->teqi", self._positions(x, field)[0][:, contact.edges], contact.shape)
        gap = plate.underside(np.hypot(at[..., 0], at[..., 1]))[0] - at[..., 2]
        return float(0.5 * contact.stiffness * (contact.weight * np.minimum(gap, 0.0) ** 2).sum(axis=(1, 2)).mean())


def second(energy, field, size=1e-4):
    """Second derivative of an energy along a field, doubled: the form of n waves is over half the circle."""
    change = [energy(share * size * field) for share in (-2, -1, 0, 1, 2)]
    return 2.0 * float(np.dot([-1, 16, -30, 16, -1], change)) / (12.0 * size**2)


def blocks_for(family, n):
    """The blocks of a family for n waves."""
    return family.constant + n * family.linear + n * n * family.square


def form(family, places, n, field):
    """The quadratic form of one family of blocks."""
    local = field[places].reshape(len(places), -1)
    return float(np.einsum("ei,eik,ek->", local, blocks_for(family, n), local))


@pytest.fixture(scope="module", params=range(len(LAWS)), ids=lambda k: LAWS[k].convention)
def bent(request):
    """A small dome of each law at a pressure under a plate with a rim, in no equilibrium, and a random field."""
    solid = SolidModel(dome(Hemisphere(9.25, 2.0), arc=4, through=1), LAWS[request.param])
    rng = np.random.default_rng(3)
    x = solid.rest * [1.05, 0.9] + 0.01 * rng.standard_normal(solid.rest.shape)
    x[solid.mesh.axis, 0] = 0.0
    scene = SolidScene(solid, Regulator(0.1), Plate(float(x[:, 1].max()) - 0.3, 0.2, 0.5))
    state = evaluate(scene, x)
    field = rng.standard_normal((len(x), 3))
    field[solid.mesh.axis] = 0.0
    return solid, scene, state, field


@pytest.mark.parametrize("n", [1, 2, 5])
def test_second_variation_of_the_wall_is_that_of_a_body_in_three_dimensions(bent, n):
    solid, _, state, field = bent
    body = Revolved(solid, n)
    expected = second(lambda move: body.wall(state.x, move), field, 2e-4)
    assert form(HarmonicSolid(solid).wall(state.local), solid.mesh.cells, n, field) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("n", [1, 2, 5])
def test_second_variation_of_volume_and_contact_is_that_of_a_surface_in_three_dimensions(bent, n):
    solid, scene, state, field = bent
    body = Revolved(solid, n)
    _, gas, contact = HarmonicSolid(solid).blocks(state)
    # The base does not move: no flux through it but that of the state.
    field = np.where(np.isin(np.arange(len(field)), solid.mesh.clamped)[:, None], 0.0, field)
    swell = second(lambda move: body.volume(state.x, move), field, 1e-3)
    assert form(gas, solid.mesh.inner, n, field) == pytest.approx(-0.1 * swell, rel=1e-8)
    assert state.touch.slope[state.touch.traction > 0.0].max() > 0.1
    pushed = second(lambda move: body.contact(state.x, move, scene.plate), field, 1e-5)
    assert form(contact, solid.mesh.outer, n, field) == pytest.approx(pushed, rel=1e-4)


def test_no_waves_give_the_axisymmetric_tangent(bent):
    solid, scene, state, _ = bent
    blocks = [family.constant for family in HarmonicSolid(solid).blocks(state)]
    expected = full_tangent(scene, state)
    places = (solid.mesh.cells, solid.mesh.inner, solid.mesh.outer)
    size, found = solid.size, np.zeros((solid.size + 1, solid.size + 1))
    for block, nodes in zip(blocks, places, strict=True):
        meridian = block.reshape(len(nodes), nodes.shape[1], 3, nodes.shape[1], 3)[:, :, :2, :, :2]
        at = solid.dofs[nodes].reshape(len(nodes), -1)
        np.add.at(found, (at[:, :, None], at[:, None, :]), meridian.reshape(len(nodes), at.shape[1], -1))
    band = np.array([np.pad(np.diagonal(found[:size, :size], -k), (0, k)) for k in range(expected.shape[0])])
    assert np.abs(band - expected).max() < 1e-12 * np.abs(expected).max()


def test_a_displacement_across_the_axis_costs_nothing_and_a_rotation_nothing_at_rest(bent):
    solid, _, state, _ = bent
    harmonic, (r, z) = HarmonicSolid(solid), solid.rest.T
    across = np.stack([np.ones_like(r), np.zeros_like(r), -np.ones_like(r)], axis=1)
    families = harmonic.blocks(state)
    size = np.abs(blocks_for(families[0], 1)).sum()
    for family, nodes in zip(families[:2], (solid.mesh.cells, solid.mesh.inner), strict=True):
        assert abs(form(family, nodes, 1, across)) < 1e-14 * size
    resting = evaluate(SolidScene(solid, Regulator(0.0), None), solid.rest)
    wall = harmonic.wall(resting.local)
    turned = np.stack([z, -r, -z], axis=1)[solid.mesh.cells].reshape(len(solid.mesh.cells), -1)
    assert (
        np.abs(np.einsum("eik,ek->ei", blocks_for(wall, 1), turned)).max() < 1e-13 * np.abs(blocks_for(wall, 1)).max()
    )


def test_one_wave_has_a_displacement_across_the_axis_and_more_waves_have_none():
    solid = SolidModel(dome(Hemisphere(9.25, 1.5), arc=6, through=1), neo_hookean(0.17))
    harmonic, state = HarmonicSolid(solid), state_at(solid, 0.01).unit
    together = harmonic.bands(state, (1, 2, 3))
    for n, band in together.items():
        assert np.allclose(band, harmonic.bands(state, (n,))[n], rtol=0, atol=1e-12 * np.abs(band).max())
        mode = softest(band)
        a, b, c = harmonic.expand(n, mode.vector)[solid.mesh.axis].T
        assert is_definite(band) and mode.definite and (b == 0.0).all() and (c == -a).all()
        assert (np.abs(a) > 0.05).all() if n == 1 else (a == 0.0).all()


def test_softest_mode_is_the_eigenvalue_nearest_zero():
    rng = np.random.default_rng(5)
    for shift in (0.0, 1.3):
        full = np.diag(np.arange(1.0, 41.0)) - shift * np.eye(40)
        near = 0.05 * rng.standard_normal((40, 40))
        full += np.triu(np.tril(near + near.T, 3), -3)
        band = np.array([np.pad(np.diagonal(full, -k), (0, k)) for k in range(4)])
        value, vector = np.linalg.eigh(full)
        nearest = int(np.abs(value).argmin())
        mode = softest(np.asfortranarray(band))
        assert mode.value == pytest.approx(value[nearest], rel=1e-6)
        assert abs(mode.vector @ vector[:, nearest]) == pytest.approx(1.0, abs=1e-6)
        assert mode.definite == is_definite(np.asfortranarray(band)) == (shift == 0.0)
