"""Friction off the axis: the solid as a limit, the law at every point, derivatives, symmetry and the energy."""

from functools import cache

import numpy as np
import pytest

from pneutouch.arrays import Array, hermite
from pneutouch.mechanics.harmonic.friction import lengths
from pneutouch.mechanics.harmonic.friction_path import SurfaceFrictionFollower
from pneutouch.mechanics.harmonic.model import HarmonicModel
from pneutouch.mechanics.harmonic.press import OffAxisPath, OffAxisPress
from pneutouch.mechanics.harmonic.surface import PlacedObject
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid.continuation import PlateState, descend
from pneutouch.mechanics.solid.friction_newton import HeldState, SlidingResult
from pneutouch.mechanics.solid.friction_path import FrictionFollower
from pneutouch.mechanics.solid.friction_system import ContactSystem
from pneutouch.mechanics.solid.indent import PressSettings, indent, shut_in
from pneutouch.mechanics.solid.indenter import RigidObject, ball
from pneutouch.mechanics.solid.inflate import FreeState, first_touch, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import NewtonFailure, evaluate, tangent
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.shape.hemisphere import Hemisphere

RADIUS = 9.25
BALL = ball(8.0)


@cache
def _dome() -> tuple[SolidModel, FreeState]:
    solid = SolidModel(dome(Hemisphere(RADIUS, 1.5), arc=8, through=1), neo_hookean(0.27), base=RigidBase())
    return solid, state_at(solid, 0.005)


def _settings(body: RigidObject | None, friction: float, depth: float) -> PressSettings:
    return PressSettings(depth=depth, steps=4, body=body, friction=friction)


def _press(body: RigidObject | None, offset: float, tilt: float, friction: float, depth: float) -> OffAxisPress:
    solid, free = _dome()
    surface = PlacedObject(first_touch(solid, free, body, 30.0).body, offset / RADIUS, np.radians(tilt))
    return OffAxisPress(solid, free, _settings(body, friction, depth), surface, StrainProbe(solid))


@cache
def _pressed(
    body: RigidObject | None, offset: float, tilt: float, friction: float, depth: float, order: int = 2
) -> OffAxisPath:
    return _press(body, offset, tilt, friction, depth).run(order)


@cache
def _followed(body: RigidObject | None, offset: float, tilt: float, friction: float) -> SurfaceFrictionFollower:
    """The follower of a press 2 mm deep in 16 steps, M = 2, with all its states."""
    solid, free = _dome()
    press, model = _press(body, offset, tilt, friction, 2.0), HarmonicModel(solid, 2)
    start, gas = model.harmonics.lifted(free.unit.x), shut_in(solid, free, _settings(body, friction, 2.0))
    follower = SurfaceFrictionFollower(model, gas, press.surface, start, friction)
    for k in range(1, 17):
        assert descend(follower, press.surface.height - 2.0 / RADIUS * k / 16) is None
    return follower


@pytest.mark.slow
@pytest.mark.parametrize(
    ("body", "friction", "order", "accuracy"),
    [(None, 0.3, 0, 1e-9), (BALL, 1.0, 0, 1e-9), (None, np.inf, 0, 1e-9), (None, 0.3, 4, 1e-6), (BALL, 1.0, 2, 1e-6)],
)
def test_a_central_press_with_friction_is_the_solids(
    body: RigidObject | None, friction: float, order: int, accuracy: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By the same Newton steps: other ones end within the solver's tolerance, which is ten times the least bound here."""
    monkeypatch.setattr(FrictionFollower, "_signs", lambda follower: None)
    solid, free = _dome()
    ours = _pressed(body, 0.0, 0.0, friction, 4.0, order)
    theirs = indent(solid, free, _settings(body, friction, 4.0))
    assert len(ours.path) == len(theirs.path)
    for name in ("indentation", "force", "rise", "volume", "stiffness", "slope", "stretch"):
        np.testing.assert_allclose(ours.column(name), theirs.column(name), rtol=accuracy, atol=1e-9, err_msg=name)
    assert np.abs(ours.column("sideways")).max() < 1e-7


@pytest.mark.slow
@pytest.mark.parametrize(("body", "offset", "tilt"), [(BALL, 2.0, 0.0), (None, 0.0, 6.0)], ids=["ball", "plate"])
def test_the_mirrored_scene_has_mirrored_forces(body: RigidObject | None, offset: float, tilt: float) -> None:
    one, other = _pressed(body, offset, tilt, 0.6, 2.0), _pressed(body, -offset, -tilt, 0.6, 2.0)
    for name, sign in (("force", 1.0), ("rise", 1.0), ("sideways", -1.0), ("moment", -1.0), ("contact_radius", 1.0)):
        np.testing.assert_allclose(one.column(name), sign * other.column(name), rtol=1e-6, atol=1e-8, err_msg=name)


def test_a_vanishing_coefficient_tends_to_contact_without_friction() -> None:
    with_little, without = (_pressed(None, 0.0, 6.0, friction, 2.0) for friction in (1e-10, 0.0))
    for name in ("force", "sideways", "moment", "rise"):
        np.testing.assert_allclose(with_little.column(name), without.column(name), rtol=1e-7, atol=1e-9, err_msg=name)


def test_friction_takes_from_the_sideways_force_of_a_leaning_plate() -> None:
    """Without friction the force on a plate is normal to it; the wall that is pushed down the slope is held."""
    end = _pressed(None, 0.0, 6.0, 0.6, 2.0).states[-1]
    slope = np.tan(np.radians(6.0))
    assert -slope * end.force < end.sideways < 0.5 * slope * end.force


@pytest.mark.slow
@pytest.mark.parametrize(("body", "offset", "tilt"), [(BALL, 2.0, 0.0), (None, 0.0, 6.0)], ids=["ball", "plate"])
def test_no_traction_passes_the_largest_and_both_kinds_of_points_obey_the_law(
    body: RigidObject | None, offset: float, tilt: float
) -> None:
    kinds = np.zeros(2)
    for state in _followed(body, offset, tilt, 0.6).path[1:]:
        assert state.friction is not None and state.state.touch is not None
        points, touch, stiffness = state.friction.points, state.state.touch, state.friction.stiffness
        largest = 0.6 * touch.traction * np.sqrt(1.0 + (touch.slope**2).sum(axis=-1))
        size, slid, stuck = lengths(points.traction), points.sliding, points.sticking
        assert (size <= largest * (1.0 + 1e-12)).all()
        np.testing.assert_allclose(size[slid], largest[slid], rtol=1e-12)
        # Along the slip where a point slides, and that of the spring where it sticks.
        along = (points.traction * points.slip).sum(axis=-1)
        np.testing.assert_allclose(along[slid], (size * lengths(points.slip))[slid], rtol=1e-12)
        np.testing.assert_allclose(points.traction[stuck], stiffness * points.slip[stuck], rtol=1e-12)
        across = points.traction[..., 1][slid | stuck]
        assert np.abs(across).max() > 1e-3 * largest.max()
        kinds += slid.sum(), stuck.sum()
    assert (kinds > 4).all()


def test_the_tangent_is_the_derivative_of_the_forces() -> None:
    """Under a ball off the axis, at a displacement in which points stick and slide in both directions."""
    follower, rng = _followed(BALL, 2.0, 0.0, 0.6), np.random.default_rng(5)
    here, model = follower.here, follower.here.scene.solid
    rest = follower._ahead(here.height)
    solver = follower._solver(here.height - 5e-5, rest + 3e-4 * rng.normal(size=rest.shape))
    x = here.state.x + model.expand(1e-5 * rng.normal(size=model.size))

    def held(move: Array) -> HeldState:
        state = evaluate(solver.scene, x + model.expand(move))
        assert state is not None
        return solver.hold(state)

    there, load = held(np.zeros(model.size)), rng.normal(size=model.size)
    assert there.points.sliding.sum() > 2 and there.points.sticking.sum() > 2
    linear = solver._linear(there, False)
    begun = linear.at(np.zeros_like(x))
    status = linear.status(begun)
    both, one_sided = linear.blocks(status, linear.under(status, begun))
    assert one_sided is not None
    band = tangent(solver.scene, there.state)
    system = ContactSystem(solver.sides, band, there.state, np.zeros(model.size), 0)
    step = 1e-7 * system.solve(-load / np.linalg.norm(load), both + one_sided)
    change = (held(step).residual - held(-step).residual) / 2e-7
    np.testing.assert_allclose(change, load / np.linalg.norm(load), atol=1e-4)


@pytest.mark.parametrize(("body", "offset", "tilt"), [(BALL, 2.0, 0.0), (None, 0.0, 6.0)], ids=["ball", "plate"])
def test_the_work_of_the_object_is_stored_or_dissipated(body: RigidObject | None, offset: float, tilt: float) -> None:
    """After the first half millimetre, in which contact begins at a point."""
    path = _followed(body, offset, tilt, 0.6).path[4:]
    height, force = (np.array([getattr(s, name) for s in path]) for name in ("height", "force"))
    grid = np.linspace(height[0], height[-1], 401)
    slope = np.array([s.stiffness for s in path])
    work = float(np.trapezoid(hermite(-grid, -height, force, -slope), -grid))
    spent = sum(s.friction.dissipated for s in path[1:] if s.friction is not None)
    stored = path[-1].state.energy - path[0].state.energy
    assert 0.002 * work < spent < 0.2 * work
    assert stored + spent == pytest.approx(work, rel=1e-3)


@pytest.mark.slow
def test_the_tractions_foreseen_follow_the_tangent_of_the_path() -> None:
    """They are off by the square of the step at points that stay in contact and stick."""
    follower, off = _followed(BALL, 3.0, 0.0, np.inf), []
    touching = follower.here.state.touch.traction > 0.0
    for travel in (2.0e-3, 1.0e-3):
        height = follower.here.height - travel
        foreseen, solved = follower._towards(height).foreseen, follower.solve(height)
        assert foreseen is not None and isinstance(solved, PlateState) and solved.friction is not None
        normal, points = solved.state.touch.traction, solved.friction.points
        stay = touching & (normal > 0.2 * normal.max()) & points.sticking
        assert stay.sum() > 3
        errors = [(foreseen.normal - normal)[stay], (foreseen.trial - points.traction)[stay].ravel()]
        off.append([float(np.linalg.norm(one)) for one in errors])
    assert np.array(off[0]) == pytest.approx(4.0 * np.array(off[1]), rel=0.25)


@pytest.mark.slow
def test_a_solve_that_halves_its_residual_is_not_ended_by_the_number_of_its_steps() -> None:
    follower = _followed(BALL, 3.0, 0.0, 0.3)
    height = follower.here.height - 0.03
    guess = follower._extrapolate(height)
    free = follower._towards(height).minimise(guess)
    assert isinstance(free, SlidingResult) and free.iterations > 2
    limited = follower._towards(height).minimise(guess, max_iterations=free.iterations - 1)
    assert isinstance(limited, SlidingResult) and limited.iterations == free.iterations
    assert isinstance(follower._towards(height).minimise(guess, max_iterations=0), NewtonFailure)
