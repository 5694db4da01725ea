"""Coulomb friction between wall and plate: the law at every point, its derivatives, its limits and its energy."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pneutouch.mechanics.events import BREAKS_CURVE
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.continuation import PathFollower, descend
from pneutouch.mechanics.solid.elements import Gas
from pneutouch.mechanics.solid.friction import FrictionStep
from pneutouch.mechanics.solid.friction_newton import FrictionSolver
from pneutouch.mechanics.solid.friction_system import LeadingElimination, OneSidedBlocks
from pneutouch.mechanics.solid.indent import PressSettings, follower_of, indent
from pneutouch.mechanics.solid.indenter import ball
from pneutouch.mechanics.solid.inflate import first_touch, inflate, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import SolidScene, evaluate, full_tangent
from pneutouch.mechanics.solid.object_contact import Plate
from pneutouch.mechanics.solid.second_variation import HarmonicSolid
from pneutouch.shape.hemisphere import Hemisphere
from tests.mechanics.solid.derivatives import dense

DEPTH = 0.5 * 9.25


def coarse(mu=0.17, wall=1.5):
    return SolidModel(dome(Hemisphere(9.25, wall), arc=12, through=1), neo_hookean(mu))


def press(friction, mu=0.17, pressure=0.0, **options):
    solid = coarse(mu)
    return indent(solid, state_at(solid, pressure), PressSettings(DEPTH, friction=friction, **options))


def follow(friction, mu=0.17, pressure=0.0, steps=14, body=None):
    """The follower of a press by a plate or a body to `DEPTH`, with all its states."""
    solid = coarse(mu)
    free = state_at(solid, pressure)
    press = PressSettings(DEPTH, friction=friction, plate_diameter=None, body=body)
    touch = first_touch(solid, free, press.body, press.plate_diameter)
    follower, top = follower_of(solid, free, press, touch), touch.body.height
    for k in range(1, steps + 1):
        assert descend(follower, top - DEPTH / 9.25 * k / steps) is None
    return follower


@pytest.mark.parametrize("friction", [-0.1, -np.inf, np.nan])
def test_a_friction_that_is_no_coefficient_is_refused(friction):
    with pytest.raises(ValueError, match="must not be negative, or inf"):
        PressSettings(1.0, friction=friction)


def test_a_vanishing_coefficient_tends_to_the_plate_without_friction():
    without, with_little = press(0.0, pressure=0.01), press(1e-11, pressure=0.01)
    for name in ("force", "pressure", "contact_radius"):
        assert np.allclose(with_little.column(name), without.column(name), rtol=1e-8, atol=1e-9)


def test_the_largest_coefficients_tend_to_grip():
    forces = [press(f, mu=0.91, steps=28).column("force")[8:] for f in (0.3, 3.0, 300.0, np.inf)]
    off = [np.abs(one / forces[-1] - 1.0).max() for one in forces[:-1]]
    assert off[0] > 0.02 and off[1] < 0.01 and off[2] < 0.003


@pytest.mark.parametrize("friction", [0.3, 1.0])
def test_no_traction_passes_the_largest_and_both_kinds_of_points_obey_the_law(friction):
    kinds = np.zeros(2)
    for state in follow(friction, 0.91, steps=20).path[1:]:
        points, touch = state.friction.points, state.state.touch
        largest = friction * touch.traction * np.hypot(1.0, touch.slope)
        assert (np.abs(points.traction) <= largest * (1 + 1e-12)).all()
        assert np.allclose(np.abs(points.traction)[points.sliding], largest[points.sliding])
        assert ((points.sticking | points.sliding) == (touch.traction > 0.0)).all()
        kinds += points.sticking.sum(), points.sliding.sum()
    assert (kinds > 15).all()


@pytest.mark.parametrize("friction", [1.0, np.inf])
def test_sticking_points_stay_where_they_first_touched(friction):
    path = follow(friction, 0.91).path
    contact, held = path[0].scene.solid.contact, 0
    for a, b in pairwise(path[1:]):
        both = a.friction.points.sticking & b.friction.points.sticking
        radius = [contact.positions(s.state.x)[0][both] for s in (a, b)]
        # what is left is the springs' own stretch, a few thousandths of the way of free points
        assert np.abs(radius[1] - radius[0]).max(initial=0.0) < 5e-5
        held += both.sum()
    assert held > 20


def test_without_friction_those_points_move():
    solid = coarse(0.91)
    free = state_at(solid, 0.0)
    gas = Gas.filled(0.0, free.unit.volume, 0.101325 / solid.mu, 0.0)
    top = free.unit.x[solid.mesh.outer_apex, 1]
    follower = PathFollower(solid, gas, Plate(top, np.inf, 0.1), free.unit.x)
    descend(follower, top - 0.5)
    a, b = follower.path[-2:]
    both = (a.state.touch.traction > 0.0) & (b.state.touch.traction > 0.0)
    radius = [solid.contact.positions(s.state.x)[0][both] for s in (a, b)]
    assert np.abs(radius[1] - radius[0]).max() > 1e-3


@pytest.mark.parametrize(
    ("friction", "body"), [(0.3, None), (1.0, None), (np.inf, None), (0.3, ball(8.0)), (np.inf, ball(8.0))]
)
def test_the_work_is_stored_or_dissipated(friction, body):
    """Work by the cubic through force and stiffness; stored in wall, gas, plate and springs."""
    path = follow(friction, 0.91, steps=28, body=body).path[1:]
    height, force, rate = (np.array([getattr(s, n) for s in path]) for n in ("height", "force", "stiffness"))
    travel = -np.diff(height)
    work = 0.5 * travel * (force[1:] + force[:-1]) + travel**2 / 12.0 * (rate[1:] - rate[:-1])
    spent = sum(s.friction.dissipated for s in path[1:])
    stored = path[-1].state.energy - path[0].state.energy
    assert stored + spent == pytest.approx(work.sum(), rel=2e-3)
    assert spent > (0.004 if friction < 0.5 else 0.0) * stored


def test_stiffness_and_rate_of_pressure_are_those_of_the_path_that_goes_on():
    travel = -1e-4  # no step of a path is shorter; one of 1e-6 may be lost in rounding
    for friction in (0.3, 1.0, np.inf):
        follower = follow(friction, 0.91, steps=10)
        here = follower.here
        further = follower.solve(here.height + travel)
        assert (further.force - here.force) / travel == pytest.approx(here.stiffness, rel=3e-3)
        rate = (further.state.filling.pressure - here.state.filling.pressure) / travel
        assert rate == pytest.approx(here.pressure_rate, rel=3e-3)


@pytest.mark.parametrize("friction", [0.1, np.inf])
def test_the_tangent_is_the_derivative_of_the_residual(friction):
    """On a plate whose rim turns up, with points that stick and points that slide either way."""
    solid = coarse()
    rng = np.random.default_rng(0)
    x = solid.rest + solid.expand(2e-3 * rng.normal(size=solid.size))
    scene = SolidScene(solid, Gas.filled(0.1, 2.1, 0.6, 0.2), Plate(1.14, 0.02, 5.0))
    r, _ = solid.contact.positions(x)
    stiffness = 10.0 * solid.contact.stiffness
    rest = r + 1e-3 * rng.normal(size=r.shape)
    solver = FrictionSolver(scene, FrictionStep(solid.contact, scene.plate, friction, rest, stiffness), None)
    at = solver.hold(evaluate(scene, x))
    if friction < 1.0:
        assert at.points.sliding.sum() > 2 and (at.points.slip[at.points.sliding] > 0).any()
    d = rng.normal(size=solid.size)
    step = 1e-7
    up, down = (solver.hold(evaluate(scene, x + s * step * solid.expand(d))).residual for s in (1, -1))
    sign = np.where(at.points.sliding, np.sign(at.points.slip), 0.0)
    slope = at.touch.slope
    k = dense(solid.faces.outer.added(full_tangent(scene, at.state), [solver.step.stick(at.points.sticking, slope)]))
    k += at.state.filling.rate * np.outer(at.state.by_volume, at.state.by_volume)
    blocks = solver.step.slide(at.points.traction, at.touch, sign)
    move = solid.expand(d)[solid.mesh.outer].reshape(len(solid.mesh.outer), -1, 1)
    change = k @ d + solid.faces.push((blocks @ move)[..., 0])
    measured = (up - down) / (2 * step)
    assert np.abs(change - measured).max() < 5e-3 * np.abs(measured).max()
    assert np.abs(k @ d - measured).max() > (1e-2 if friction < 1.0 else 0.0) * np.abs(measured).max()


def test_systems_with_one_sided_blocks_are_solved():
    solid = coarse()
    rng = np.random.default_rng(1)
    band = full_tangent(
        SolidScene(solid, Gas.filled(0.1, 2.1, 0.6, 0.2), None),
        evaluate(SolidScene(solid, Gas.filled(0.1, 2.1, 0.6, 0.2), None), solid.rest),
    )
    blocks = rng.normal(size=(len(solid.mesh.outer), 6, 6))
    b = rng.normal(size=(solid.size, 2))
    x = OneSidedBlocks(solid).solve(band, blocks, b)
    for k in range(2):
        edges = solid.expand(x[:, k])[solid.mesh.outer].reshape(len(blocks), -1, 1)
        assert np.allclose(dense(band) @ x[:, k] + solid.faces.push((blocks @ edges)[..., 0]), b[:, k])


def test_systems_without_their_leading_unknowns_have_the_same_solution():
    solid = coarse()
    rng = np.random.default_rng(2)
    scene = SolidScene(solid, Gas.filled(0.1, 2.1, 0.6, 0.2), None)
    band = full_tangent(scene, evaluate(scene, solid.rest))
    sides, edge = OneSidedBlocks(solid), 6
    fore = LeadingElimination.of(band, sides.first_unknown(edge))
    assert 0 < fore.first == sides.first_unknown(edge)
    blocks = rng.normal(size=(len(solid.mesh.outer), 6, 6))
    blocks[:edge] = 0.0
    b = rng.normal(size=(solid.size, 2))
    half = fore.leading(b[: fore.first])
    rest = sides.solve_widened(sides.widened(fore.rest), blocks, b[fore.first :] - fore.onto_rest(half), fore.first)
    whole = np.concatenate([half - fore.leading(fore.onto_leading(rest)), rest])
    assert np.allclose(whole, sides.solve(band, blocks, b))


def test_a_singular_system_has_a_response_that_is_not_finite():
    solid = coarse()
    sides = OneSidedBlocks(solid)
    nothing = np.zeros((len(solid.mesh.outer), 6, 6))
    rows = np.eye(3, solid.size)
    found = sides.response(sides.widened(np.zeros((solid.faces.outer.width + 1, solid.size))), nothing, rows, 0)
    assert found.shape == (3, 3) and np.isnan(found).all()


def test_too_few_leading_unknowns_or_indefinite_ones_are_kept():
    solid = coarse()
    scene = SolidScene(solid, Gas.filled(0.1, 2.1, 0.6, 0.2), None)
    band = full_tangent(scene, evaluate(scene, solid.rest))
    assert LeadingElimination.of(band, 3).first == 0
    band[0, 0] = -1.0
    assert LeadingElimination.of(band, 60).first == 0


@pytest.mark.parametrize(
    ("friction", "mu", "wall", "share", "dead"), [(0.6, 2.2, 0.077, 0.28, 2000.0), (0.6, 4.0, 0.132, 0.06, 2000.0)]
)
def test_points_at_the_edge_of_the_contact_settle(friction, mu, wall, share, dead):
    """Presses in which points come and go in turn where every round goes to its end: no step fails and is cut, and none
    takes half of the Newton steps that it may."""
    solid = SolidModel(dome(Hemisphere(9.25, 9.25 * wall)), neo_hookean(mu))
    run = inflate(solid, past_limit=1.0)
    free = state_at(solid, share * run.limit.pressure, run)
    press = PressSettings(0.6 * 9.25, friction=friction, dead_volume=dead, gauge_range=np.inf)
    follower = follower_of(solid, free, press, first_touch(solid, free, None, 30.0))
    top = follower.here.height
    for k in range(1, 15):
        assert descend(follower, top - 0.6 * k / 14) is None
    assert len(follower.path) == 15
    assert max(state.iterations for state in follower.path) <= 12


def test_friction_lowers_the_sensitivity_of_a_stiff_wall_evenly():
    runs = [press(f, mu=0.91, gauge_range=np.inf) for f in (0.0, 0.1, 0.3, 0.6, 1.0, np.inf)]
    slopes = [np.polyfit(run.column("force"), run.column("rise"), 1)[0] for run in runs]
    assert (np.diff(slopes) < 0.0).all() and slopes[-1] < 0.9 * slopes[0]


def test_springs_hold_a_displacement_across_the_axis_in_all_directions_of_the_plate():
    """One wave with a = 1 and c = -1 moves all points alike: the energy of the springs of those that stick."""
    path = follow(np.inf, 0.91).path
    here, solid = path[-1].state, path[-1].scene.solid
    harmonic = HarmonicSolid(solid)
    families = [harmonic.blocks(s)[2] for s in (here, replace(here, terms=here.terms[:-1]))]
    held, bare = (family.constant + family.linear + family.square for family in families)
    across = np.tile([1.0, 0.0, -1.0], solid.mesh.outer.shape[1])
    friction = path[-1].friction
    stiffness = friction.stiffness * solid.contact.weight[friction.points.sticking].sum()
    # The form of a number of waves is twice the energy's.
    assert ((held - bare) @ across @ across).sum() == pytest.approx(2.0 * stiffness)


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.6, np.inf])
def test_steps_and_springs_hardly_matter(friction, monkeypatch):
    fine = press(friction, mu=0.91, steps=56).figures().sensitivity
    assert press(friction, mu=0.91).figures().sensitivity == pytest.approx(fine, rel=0.01)
    monkeypatch.setattr("pneutouch.mechanics.solid.friction_path.TANGENTIAL", 1.0)
    assert press(friction, mu=0.91, steps=28).figures().sensitivity == pytest.approx(fine, rel=0.005)


@settings(max_examples=6)
@given(
    friction=st.one_of(st.floats(0.0, 1.5), st.just(np.inf)),
    wall=st.floats(0.06, 0.4),
    share=st.floats(0.01, 0.8),
    dead=st.floats(0.0, 4000.0),
)
def test_every_press_ends_at_its_depth_or_by_an_event(friction, wall, share, dead):
    solid = coarse(wall=9.25 * wall)
    free = inflate(solid, past_limit=1.0)
    start = state_at(solid, share * free.limit.pressure, free)
    run = indent(solid, start, PressSettings(DEPTH, 6, friction=friction, dead_volume=dead))
    assert run.complete or run.events[-1].kind in (*BREAKS_CURVE, "floor")
    assert np.isfinite(run.column("force")).all() and run.column("penetration").max() < 1e-3 * solid.mesh.wall
