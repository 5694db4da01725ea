"""Presses beside the axis and by leaning plates: symmetry, balance, and the axisymmetric solid as a limit."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from pneutouch.arrays import hermite
from pneutouch.mechanics.harmonic.model import HarmonicModel
from pneutouch.mechanics.harmonic.press import OffAxisPath, OffAxisPress, OffAxisState
from pneutouch.mechanics.harmonic.surface import LyingObject, PlacedObject, Surface
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid.elements import Liquid
from pneutouch.mechanics.solid.indent import IndentationPath, PressSettings, indent, shut_in
from pneutouch.mechanics.solid.indenter import RigidObject, ball, cylinder, edge
from pneutouch.mechanics.solid.inflate import FreeState, first_touch, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import SolidScene
from pneutouch.mechanics.solid.object_contact import Plate
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.shape.hemisphere import Hemisphere
from tests.mechanics.solid.derivatives import assert_derivatives

RADIUS = 9.25
BALL = ball(8.0)


@cache
def _dome() -> tuple[SolidModel, FreeState]:
    solid = SolidModel(dome(Hemisphere(RADIUS, 1.5), arc=8, through=1), neo_hookean(0.27), base=RigidBase())
    return solid, state_at(solid, 0.005)


def _press(body: RigidObject | None, depth: float, steps: int = 3) -> PressSettings:
    return PressSettings(depth=depth, steps=steps, body=body)


def _central(body: RigidObject | None, depth: float) -> IndentationPath:
    return indent(*_dome(), _press(body, depth))


@cache
def _placed(body: RigidObject | None, offset: float, tilt: float, depth: float, order: int) -> OffAxisPath:
    solid, free = _dome()
    object_ = first_touch(solid, free, body, 30.0).body
    lying = body is not None and body.lying
    surface: Surface = PlacedObject(object_, offset / RADIUS, np.radians(tilt))
    surface = LyingObject(object_, offset / RADIUS) if lying else surface
    return OffAxisPress(solid, free, _press(body, depth), surface, StrainProbe(solid)).run(order)


@pytest.mark.slow
@pytest.mark.parametrize(("body", "order", "accuracy"), [(None, 0, 1e-10), (BALL, 0, 1e-9), (None, 2, 1e-8)])
def test_a_central_press_is_the_solids(body: RigidObject | None, order: int, accuracy: float) -> None:
    ours, theirs = _placed(body, 0.0, 0.0, 4.0, order), _central(body, 4.0)
    for name in ("indentation", "force", "rise", "volume", "stiffness", "slope", "stretch"):
        np.testing.assert_allclose(ours.column(name), theirs.column(name), rtol=accuracy, atol=1e-10, err_msg=name)
    assert np.abs(ours.column("sideways")).max() < 1e-8
    assert np.abs(ours.column("moment")).max() < 1e-6


@pytest.mark.parametrize(
    ("body", "offset", "tilt"),
    [(BALL, 2.0, 0.0), (None, 0.0, 6.0), (edge(3.0), 1.0, 0.0)],
    ids=["ball", "plate", "edge"],
)
def test_the_mirrored_scene_has_mirrored_forces(body: RigidObject | None, offset: float, tilt: float) -> None:
    one, other = _placed(body, offset, tilt, 2.0, 2), _placed(body, -offset, -tilt, 2.0, 2)
    for name, sign in (("force", 1.0), ("rise", 1.0), ("sideways", -1.0), ("moment", -1.0), ("contact_radius", 1.0)):
        np.testing.assert_allclose(one.column(name), sign * other.column(name), rtol=1e-7, atol=1e-9, err_msg=name)


def test_a_ball_beside_the_axis_is_pushed_away_and_a_plate_slides_off_its_high_side() -> None:
    beside = _placed(BALL, 2.0, 0.0, 2.0, 2)
    assert beside.complete
    assert beside.states[-1].sideways > 0.05 * beside.states[-1].force
    # A plate that rises with x touches the dome at negative x; without friction its force is normal to it.
    leaning = _placed(None, 0.0, 6.0, 2.0, 2).states[-1]
    assert leaning.sideways == pytest.approx(-np.tan(np.radians(6.0)) * leaning.force, rel=1e-9)
    assert leaning.moment > 0.0


def test_the_force_is_the_work_of_the_travel() -> None:
    """After the first step, in which contact begins at a point."""
    path = _placed(BALL, 2.0, 0.0, 2.0, 2)
    solid, free = _dome()
    gas = shut_in(solid, free, _press(BALL, 2.0))
    model = HarmonicModel(solid, 2)
    last = path.path[1:]

    def energy(state: OffAxisState) -> float:
        filling = gas.at(state.volume / RADIUS**3)
        assert filling is not None
        return model.local(state.positions / RADIUS).energy + filling.energy

    at, force, stiffness = (
        np.array([getattr(s, name) for s in last]) for name in ("indentation", "force", "stiffness")
    )
    grid = np.linspace(at[0], at[-1], 401)
    work = float(np.trapezoid(hermite(grid, at, force, stiffness), grid))
    stored = (energy(last[-1]) - energy(last[0])) * solid.mu * RADIUS**3
    assert stored == pytest.approx(work, rel=5e-3)


def test_derivatives_under_a_ball_and_on_the_base() -> None:
    solid, free = _dome()
    model, rng = HarmonicModel(solid, 2), np.random.default_rng(3)
    surface = PlacedObject(BALL.scaled(1.0 / RADIUS), 0.2).at(0.95)
    scene = SolidScene(model, shut_in(solid, free, _press(BALL, 1.0)), surface)
    x = model.harmonics.lifted(free.unit.x)
    # The whole wall stands too low, so that its foot is below its base, by more on one side.
    x[:, 1] -= 0.1
    x[:, 3] += 0.05 * x[:, 0]
    state = assert_derivatives(scene, x, rng, step=1e-7, rel=1e-5)
    assert state.touch is not None and (state.touch.traction > 0.0).any()
    assert state.terms[0].energy > 0.0


def test_a_cylinder_across_the_dome_pushes_straight_down_and_a_great_one_is_the_plate() -> None:
    plate = _placed(None, 0.0, 0.0, 2.0, 2).states[-1]
    apart = []
    for radius in (1e4, 1e5):
        lying = _placed(cylinder(radius), 0.0, 0.0, 2.0, 2).states[-1]
        assert abs(lying.sideways) < 1e-8 * lying.force
        assert abs(lying.moment) < 1e-7 * lying.force
        apart.append(1.0 - lying.force / plate.force)
    # The sag of the cylinder over the contact goes with its curvature.
    assert 0.0 < apart[1] < 1e-3
    assert apart[0] == pytest.approx(10.0 * apart[1], rel=0.05)


def test_a_lying_object_is_straight_along_y_and_has_the_section_of_its_body() -> None:
    section = cylinder(4.0)
    x, y = np.array([0.5, 3.0, -2.0]), np.array([0.0, -6.0, 9.0])
    under = LyingObject(section, 1.0).over(x, y)
    np.testing.assert_allclose(under.height, 4.0 - np.sqrt(16.0 - (x - 1.0) ** 2), rtol=1e-12)
    np.testing.assert_allclose(under.slope[:, 0], (x - 1.0) / np.sqrt(16.0 - (x - 1.0) ** 2), rtol=1e-12)
    assert not under.slope[:, 1].any()
    assert not under.curve[:, 1].any()
    np.testing.assert_allclose(under.curve[:, 0, 0], 16.0 / (16.0 - (x - 1.0) ** 2) ** 1.5, rtol=1e-12)


def test_a_leaning_plate_is_a_plane_and_has_its_rim() -> None:
    plate = PlacedObject(Plate(1.0, 0.5, 0.1), 0.1, np.radians(20.0))
    slope = np.tan(np.radians(20.0))
    x, y = np.array([0.1, 0.4, -0.2, 0.1]), np.array([0.0, 0.2, 0.1, 0.8])
    under = plate.over(x, y)
    np.testing.assert_allclose(under.height[:3], 1.0 + slope * (x[:3] - 0.1), rtol=1e-14)
    # The rim rises 0.3^2/(2 0.1) upright to the plate, which is 1/cos of that vertically.
    assert under.height[3] == pytest.approx(1.0 + 0.45 / np.cos(np.radians(20.0)), rel=1e-12)
    step = 1e-6
    for k, (dx, dy) in enumerate(((step, 0.0), (0.0, step))):
        up, down = plate.over(x + dx, y + dy), plate.over(x - dx, y - dy)
        np.testing.assert_allclose(under.slope[:, k], (up.height - down.height) / (2 * step), atol=1e-8)
        np.testing.assert_allclose(under.curve[:, k], (up.slope - down.slope) / (2 * step), atol=1e-7)


@pytest.mark.parametrize("base", [RigidBase(opening=9.1, flange=10.65), RigidBase(ring=10.2, ring_height=0.4)])
def test_derivatives_on_the_rounded_edges_of_a_base(base: RigidBase) -> None:
    """The whole wall stands below the plane, by more on one side: both faces meet edges and ring, which are curved."""
    mesh = dome(Hemisphere(RADIUS, 1.5), 12, 1)
    sunk = SolidModel(replace(mesh, nodes=mesh.nodes - [0.0, 2.5]), neo_hookean(0.17), base=base)
    model, rng = HarmonicModel(sunk, 1), np.random.default_rng(3)
    x = model.rest.copy()
    x[:, 3] += 0.05 * x[:, 0]
    (support,) = assert_derivatives(SolidScene(model, Liquid(2.0, 3.0), None), x, rng, step=1e-8, rel=1e-6).terms
    assert support.blocks is not None and support.blocks.any() and support.energy > 0.0
