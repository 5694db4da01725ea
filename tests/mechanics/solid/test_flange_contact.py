"""The outer wall on the free top of its own flange: the potential, and the convergence that it brings."""

import numpy as np
import pytest

from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid.elements import Liquid
from pneutouch.mechanics.solid.flange import cardinal_splines, evaluated, meeting_nodes, printed_dome, top_nodes
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import SolidScene, evaluate, full_tangent
from pneutouch.mechanics.solid.second_variation import HarmonicSolid
from pneutouch.shape.hemisphere import Hemisphere
from tests.mechanics.solid.derivatives import assert_derivatives

DEPTH = 0.75 * 9.25


def printed(arc=None, through=None, base=RigidBase(flange=13.0)):  # noqa: B008
    return SolidModel(printed_dome(Hemisphere(9.25, 1.5), 2.25, 2.25, arc, through), neo_hookean(0.17), base=base)


def test_splines_meet_their_nodes_with_steady_tangents_and_go_straight_on():
    spline = cardinal_splines(6)
    places = np.arange(6.0)
    value = evaluated(spline, places)[0]
    assert value == pytest.approx(np.eye(6), abs=1e-14)
    line = 0.3 * places - 1.0
    for place in (-0.7, 0.0, 2.4, 5.0, 6.2):
        assert evaluated(spline, np.array(place))[0] @ line == pytest.approx(0.3 * place - 1.0)
    before, after = evaluated(spline, places[1:-1] - 1e-9), evaluated(spline, places[1:-1] + 1e-9)
    assert np.abs(before[1] - after[1]).max() < 1e-7 and np.abs(before[2] - after[2]).max() < 1e-7
    size = 1e-6
    up, down = (evaluated(spline, np.array([1.3, -0.4]) + s * size) for s in (1, -1))
    middle = evaluated(spline, np.array([1.3, -0.4]))
    assert (up[0] - down[0]) / (2 * size) == pytest.approx(middle[1], abs=1e-8)
    assert (up[1] - down[1]) / (2 * size) == pytest.approx(middle[2], abs=1e-8)


def test_the_top_runs_from_the_foot_of_the_wall_to_the_rim():
    mesh = printed_dome(Hemisphere(9.25, 1.5), 2.25, 2.25)
    top = mesh.nodes[top_nodes(mesh)]
    assert (top[:, 1] == 0.0).all() and (np.diff(top[:, 0]) > 0.0).all()
    assert top[0] == pytest.approx([10.75, 0.0]) and top[-1] == pytest.approx([13.0, 0.0])
    assert top_nodes(mesh)[0] == mesh.outer[0, 0]
    assert meeting_nodes(mesh).shape[0] > 1 and meeting_nodes(dome(Hemisphere(9.25, 1.5))).shape[0] == 0


@pytest.fixture(name="pressed_in")
def _pressed_in():
    """A solid whose flange stands up into the wall, and the state there."""
    solid = printed(12, 1)
    x = solid.rest + solid.expand(1e-3 * np.random.default_rng(5).normal(size=solid.size))
    top, wall = top_nodes(solid.mesh)[1:-1], solid.mesh.outer[0, 1:]
    x[top, 1] += 0.03 * np.linspace(1.0, 0.2, top.size)
    x[wall] += [[0.03, -0.06], [0.05, -0.045]]
    scene = SolidScene(solid, Liquid(2.0, 3.0), None)
    return solid, scene, x


def test_gradient_and_tangent_are_derivatives_of_the_energy(pressed_in):
    solid, _, x = pressed_in
    term = solid.supports[1]
    here = term.at(x)
    assert here.energy > 0.0 and here.fold_blocks.any()
    rng = np.random.default_rng(0)
    d, step = rng.normal(size=solid.size), 1e-8
    up, down = (term.at(x + s * step * solid.expand(d)) for s in (1, -1))
    assert (up.energy - down.energy) / (2 * step) == pytest.approx(float(here.gradient @ d), rel=1e-6)
    band = solid.faces.fold.matrix([here.fold_blocks])
    answer = band[0] * d
    for k in range(1, band.shape[0]):
        answer[k:] += band[k, :-k] * d[:-k]
        answer[:-k] += band[k, :-k] * d[k:]
    change = (up.gradient - down.gradient) / (2 * step)
    assert np.abs(answer - change).max() < 1e-5 * np.abs(change).max()


def test_what_the_wall_puts_on_the_flange_the_flange_puts_on_the_wall(pressed_in):
    """But for the little that the spline passes on to the rim's node, which is held."""
    solid, _, x = pressed_in
    force = solid.expand(solid.supports[1].at(x).gradient)
    assert np.abs(force[:, 1]).max() > 0.0
    assert abs(force[:, 1].sum()) < 2e-3 * np.abs(force[:, 1]).max()


def test_the_tangent_of_all_terms_together_is_the_derivative_of_the_residual(pressed_in):
    _, scene, x = pressed_in
    state = assert_derivatives(scene, x, np.random.default_rng(1), step=1e-8, rel=1e-5)
    assert state.terms[1].fold_blocks.any()


def test_the_tangent_and_the_second_variation_hold_the_contact(pressed_in):
    solid, scene, x = pressed_in
    state = evaluate(scene, x)
    without = full_tangent(SolidScene(solid, Liquid(2.0, 3.0), None), evaluate(scene, solid.rest))
    assert full_tangent(scene, state).shape == without.shape
    blocks = HarmonicSolid(solid).blocks(state)[3].constant
    rows, nodes = solid.meeting.shape
    meridian = blocks.reshape(rows, nodes, 3, nodes, 3)[:, :, :2, :, :2].reshape(rows, 2 * nodes, 2 * nodes)
    assert np.array_equal(meridian, state.terms[1].fold_blocks)


@pytest.mark.slow
def test_the_printed_rim_converges_over_the_whole_depth():
    """Without the contact the wall passes through its flange, and refined meshes end before the depth."""
    found = {}
    for arc, through in ((None, None), (36, 3)):
        solid = printed(arc, through)
        run = indent(solid, state_at(solid, 0.0), PressSettings(DEPTH))
        assert run.complete
        found[arc] = run.figures().sensitivity
    assert found[None] == pytest.approx(found[36], rel=0.005)
    through = printed(base=None)
    assert found[None] < 0.96 * indent(through, state_at(through, 0.0), PressSettings(DEPTH)).figures().sensitivity
