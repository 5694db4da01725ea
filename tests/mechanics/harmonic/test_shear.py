"""An object that moves sideways after pressing: what holds the wall, what slides, and the energy."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from pneutouch.arrays import Array
from pneutouch.mechanics.harmonic import friction_path
from pneutouch.mechanics.harmonic.friction_path import ENDED_BEFORE, STEPS, ShearPath, SurfaceFrictionFollower
from pneutouch.mechanics.harmonic.friction_settling import SurfaceFrictionSolver
from pneutouch.mechanics.harmonic.model import HarmonicModel
from pneutouch.mechanics.harmonic.press import OffAxisPath, OffAxisPress
from pneutouch.mechanics.harmonic.surface import LyingObject, PlacedObject
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid.continuation import descend
from pneutouch.mechanics.solid.friction_newton import SlidingResult
from pneutouch.mechanics.solid.indent import PressSettings, shut_in
from pneutouch.mechanics.solid.indenter import cylinder
from pneutouch.mechanics.solid.inflate import FreeState, first_touch, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import NewtonFailure
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.shape.hemisphere import Hemisphere

RADIUS, DEPTH, ORDER = 9.25, 2.0, 2


@cache
def _dome() -> tuple[SolidModel, FreeState]:
    solid = SolidModel(dome(Hemisphere(RADIUS, 1.5), arc=8, through=1), neo_hookean(0.27), base=RigidBase())
    return solid, state_at(solid, 0.005)


def _press_by_bar(radius: float, offset: float, friction: float, travel: float) -> OffAxisPath:
    solid, free = _dome()
    body = cylinder(radius)
    settings = PressSettings(depth=DEPTH, steps=4, body=body, friction=friction)
    surface = LyingObject(first_touch(solid, free, body, None).body, offset / RADIUS)
    return OffAxisPress(solid, free, settings, surface, StrainProbe(solid), travel).run(ORDER)


def _press(friction: float, travel: float, tilt: float = 0.0, plate: float = 30.0) -> OffAxisPress:
    solid, free = _dome()
    settings = PressSettings(depth=DEPTH, steps=4, plate_diameter=plate, friction=friction)
    surface = PlacedObject(first_touch(solid, free, None, plate).body, 0.0, np.radians(tilt))
    return OffAxisPress(solid, free, settings, surface, StrainProbe(solid), travel)


@cache
def _pressed(friction: float, travel: float, tilt: float = 0.0, plate: float = 30.0) -> OffAxisPath:
    return _press(friction, travel, tilt, plate).run(ORDER)


def _sheared(friction: float, travel: float, tilt: float = 0.0, plate: float = 30.0) -> ShearPath:
    path = _pressed(friction, travel, tilt, plate).shear
    assert path is not None
    return path


@cache
def _gripped() -> SurfaceFrictionFollower:
    """The follower at the end of a press by a plate that grips."""
    solid, free = _dome()
    press, model = _press(np.inf, 0.0), HarmonicModel(solid, ORDER)
    gas = shut_in(solid, free, PressSettings(depth=DEPTH))
    follower = SurfaceFrictionFollower(model, gas, press.surface, model.harmonics.lifted(free.unit.x), np.inf)
    for k in range(1, 5):
        assert descend(follower, press.surface.height - DEPTH / RADIUS * k / 4) is None
    return follower


@pytest.mark.slow
def test_the_shear_begins_where_the_press_ended() -> None:
    end, first = _pressed(0.3, 2.0, 6.0).states[-1], _sheared(0.3, 2.0, 6.0).states[0]
    for name in ("force", "sideways", "moment", "rise"):
        assert getattr(first, name) == pytest.approx(getattr(end, name), rel=1e-9)
    assert (first.travel, len(_sheared(0.3, 2.0, 6.0).states)) == (0.0, STEPS + 1)


@pytest.mark.parametrize("tilt", [0.0, 6.0])
def test_a_plate_that_slips_throughout_has_the_force_of_a_block_on_a_slope(tilt: float) -> None:
    """T = N tan(atan(friction) + tilt) against a plate that rises ahead, its coefficient times N where it is level."""
    path = _sheared(0.3, 2.0, tilt)
    assert path.ended is None and path.slips_from is not None and 0.2 < path.slips_from < 1.0
    share, slides = -path.column("sideways") / path.column("force"), np.tan(np.arctan(0.3) + np.radians(tilt))
    assert share[0] < 0.2 * slides and (np.diff(share) > -1e-4 * slides).all()
    np.testing.assert_allclose(share[-3:], slides, rtol=1e-3)
    assert path.states[-1].sliding == 1.0 and path.states[1].sliding < 1.0
    assert path.peak == min(s.sideways for s in path.states)


def test_with_grip_nothing_slides_and_the_plate_takes_the_dome_along() -> None:
    path = _sheared(np.inf, 1.0)
    assert path.slips_from is None and path.ended is None and path.stiffness is not None
    assert path.column("sliding").max() < 1e-3
    slope = -np.gradient(path.column("sideways"), path.column("travel"))
    np.testing.assert_allclose(slope, path.stiffness, rtol=0.05)
    # The force on the plate stands at the top of a leaning column: its moment about the base is height times force.
    height = np.diff(path.column("moment")) / np.diff(path.column("sideways"))
    assert (height > 0.3 * RADIUS).all() and (height < 1.5 * RADIUS).all()


def test_with_grip_the_slope_is_the_second_derivative_of_the_energy() -> None:
    """Of the equilibria with the plate a little to either side, all points held at their places on it."""
    follower, energies = _gripped().slid(1.0), []
    start = follower.here
    for travel in (-1e-3, 0.0, 1e-3):
        solved = follower.solve(travel)
        assert not isinstance(solved, NewtonFailure) and solved.friction is not None
        assert not solved.friction.points.sliding.any()
        energies.append((solved.state.energy, solved.force))
    (below, push), (middle, _), (above, pull) = energies
    assert (above - 2.0 * middle + below) / 1e-6 == pytest.approx(-start.stiffness, rel=1e-4)
    assert (push - pull) / 2e-3 == pytest.approx(-start.stiffness, rel=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("tilt", [0.0, 6.0])
def test_the_mirrored_travel_has_the_mirrored_force(tilt: float) -> None:
    one, other = _sheared(0.3, 2.0, tilt), _sheared(0.3, -2.0, -tilt)
    for name, sign in (("travel", -1), ("sideways", -1), ("moment", -1), ("force", 1), ("rise", 1), ("sliding", 1)):
        np.testing.assert_allclose(one.column(name), sign * other.column(name), rtol=1e-5, atol=1e-7, err_msg=name)
    assert one.peak == pytest.approx(-float(other.peak or 0.0), rel=1e-5)


def test_a_great_cylinder_shears_as_the_plate_does() -> None:
    bar, plate = _press_by_bar(1e5, 0.0, 0.3, 2.0).shear, _sheared(0.3, 2.0)
    assert bar is not None and bar.ended is None and bar.slips_from == pytest.approx(plate.slips_from, abs=0.05)
    for name in ("force", "sideways", "moment", "rise"):
        np.testing.assert_allclose(bar.column(name), plate.column(name), rtol=1e-3, atol=2e-3, err_msg=name)


@pytest.mark.slow
def test_a_bar_beside_the_axis_has_the_mirrored_force_under_the_mirrored_travel() -> None:
    one, other = _press_by_bar(6.0, 2.0, 0.3, 1.0).shear, _press_by_bar(6.0, -2.0, 0.3, -1.0).shear
    assert one is not None and other is not None and one.ended is None and one.states[-1].travel == pytest.approx(1.0)
    for name, sign in (("travel", -1), ("sideways", -1), ("moment", -1), ("force", 1), ("rise", 1)):
        np.testing.assert_allclose(one.column(name), sign * other.column(name), rtol=1e-5, atol=1e-7, err_msg=name)
    assert one.states[-1].sideways < one.states[0].sideways


def test_the_work_of_the_travel_is_stored_or_dissipated() -> None:
    solid, free = _dome()
    press, model = _press(0.3, 0.0), HarmonicModel(solid, ORDER)
    gas = shut_in(solid, free, PressSettings(depth=DEPTH))
    follower = SurfaceFrictionFollower(model, gas, press.surface, model.harmonics.lifted(free.unit.x), 0.3)
    assert descend(follower, press.surface.height - DEPTH / RADIUS) is None
    slid = follower.slid(1.0)
    for k in range(1, 31):
        assert descend(slid, 2.0 / RADIUS * k / 30) is None
    travel, force = (np.array([getattr(s, name) for s in slid.path]) for name in ("height", "force"))
    work = -float(np.trapezoid(force, travel))
    spent = sum(s.friction.dissipated for s in slid.path[1:] if s.friction is not None)
    stored = slid.path[-1].state.energy - slid.path[0].state.energy
    assert spent > 0.3 * work
    assert stored + spent == pytest.approx(work, rel=5e-3)


@pytest.mark.slow
def test_it_ends_at_the_edge_of_the_object_and_is_not_begun_after_a_press_that_ended() -> None:
    path = _sheared(0.3, 6.0, plate=12.0)
    assert path.ended is not None and "edge" in path.ended
    assert 0.0 < path.states[-1].travel < 6.0
    press = _press(0.3, 2.0)
    press._press = replace(press._press, depth=3.0 * RADIUS)
    cut = press.run(0).shear
    assert cut is not None and (cut.ended, cut.states, cut.peak) == (ENDED_BEFORE, [], None)


def test_it_needs_friction() -> None:
    with pytest.raises(ValueError, match="slides off"):
        _press(0.0, 2.0)


def test_a_path_whose_solves_fail_again_and_again_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    follower, real, longest, steps = _gripped().slid(1.0), SurfaceFrictionSolver.minimise, 6.0e-4, 24
    failed: list[float] = []

    def short_only(
        self: SurfaceFrictionSolver, x: Array, kept: Array | None = None, max_iterations: int = steps
    ) -> SlidingResult | NewtonFailure:
        if self.step.along - follower.here.height <= longest:
            return real(self, x, kept, max_iterations)
        failed.append(self.step.along)
        return NewtonFailure("no equilibrium near the guess", max_iterations)

    monkeypatch.setattr(SurfaceFrictionSolver, "minimise", short_only)
    monkeypatch.setattr(friction_path, "MOST_FAILED", 10 * steps)
    end = descend(follower, 0.05)
    assert end is not None and (end.kind, end.height) == ("lost", follower.here.height)
    assert len(failed) == 10 and end.why == "solves failed again and again, in 240 Newton steps together"
    assert follower.slid(1.0).given_up is None
