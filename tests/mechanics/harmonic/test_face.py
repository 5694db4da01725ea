"""The pressed outer wall as it is drawn: its contact forces, areas, pressures and positions."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from pneutouch.arrays import Array
from pneutouch.mechanics.harmonic.fields import Harmonics
from pneutouch.mechanics.harmonic.object_contact import PressedFace, face_areas, pressed_face
from pneutouch.mechanics.harmonic.press import OffAxisPath, OffAxisPress
from pneutouch.mechanics.harmonic.surface import LyingObject, PlacedObject, ProfiledObject
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.sensor import ResponseCorrection, RigidBase
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.indenter import RigidObject, ball, edge
from pneutouch.mechanics.solid.inflate import FreeState, first_touch, state_at
from pneutouch.mechanics.solid.mesh import END, START, dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.shape.hemisphere import Hemisphere

RADIUS, DEPTH = 9.25, 3.0
SCENES: dict[str, tuple[RigidObject | None, float, float]] = {
    "ball beside the axis": (ball(8.0), 2.0, 0.0),
    "leaning plate": (None, 0.0, 6.0),
    "edge beside the axis": (edge(8.0), 2.0, 0.0),
}


@cache
def _dome() -> tuple[SolidModel, FreeState]:
    solid = SolidModel(dome(Hemisphere(RADIUS, 1.5), arc=8, through=1), neo_hookean(0.27), base=RigidBase())
    return solid, state_at(solid, 0.005)


@cache
def _pressed(scene: str, order: int = 2, friction: float = 0.0, travel: float = 0.0) -> tuple[OffAxisPath, PressedFace]:
    solid, free = _dome()
    body, offset, tilt = SCENES.get(scene, (None, 0.0, 0.0))
    touched = first_touch(solid, free, body, 30.0).body
    surface: ProfiledObject = PlacedObject(touched, offset / RADIUS, np.radians(tilt))
    if body is not None and body.lying:
        surface = LyingObject(touched, offset / RADIUS)
    settings = PressSettings(depth=DEPTH, steps=3, body=body, friction=friction)
    press = OffAxisPress(solid, free, settings, surface, StrainProbe(solid), travel)
    path = press.run(order)
    return path, press.face(path, DEPTH)


def _triangles(points: Array) -> Array:
    """Triangles (n, 3, 3) of a grid of points that closes around the axis."""
    after = np.roll(points, -1, axis=1)
    low, up = (points[:-1], after[:-1]), (points[1:], after[1:])
    return np.concatenate(
        [np.stack([low[0], low[1], up[1]], axis=2), np.stack([low[0], up[1], up[0]], axis=2)]
    ).reshape(-1, 3, 3)


@pytest.mark.parametrize("scene", SCENES)
def test_forces_at_the_nodes_add_up_to_the_contact_force(scene: str) -> None:
    path, face = _pressed(scene)
    end = path.states[-1]
    force = face.forces.sum(axis=(0, 1))
    assert (face.indentation, face.travel) == (pytest.approx(DEPTH), 0.0)
    assert force[2] == pytest.approx(end.force, rel=1e-6)
    assert force[0] == pytest.approx(end.sideways, rel=1e-6)
    assert (face.forces[..., 2] >= 0.0).all()
    assert (face.touching <= face.areas * (1.0 + 1e-12)).all()


BESIDE = ("contact.object=ball", "contact.ball_radius_mm=6", "contact.offset_mm=3")


@pytest.mark.parametrize(
    ("scene", "model"),
    [pytest.param((), "solid", id="plate"), pytest.param(BESIDE, "harmonic", id="ball", marks=pytest.mark.slow)],
)
def test_the_drawn_pressure_integrates_to_the_contact_force(evaluated, scene: tuple[str, ...], model: str) -> None:
    """Pressure over the drawn triangles, times the height of their area: that of the drawn grid, not of the nodes."""
    face = (
        evaluated("paper-dome", "pneumatics.driving_pressures_kPa=[0]", *scene, model=model).prediction.states[0].face()
    )
    rows, angles = face.rows(), 2.0 * np.pi * np.arange(64) / 64
    corners = _triangles(face.positions(rows, angles))
    pressure = face.pressure(rows, angles)
    assert pressure.min() == 0.0
    mean = _triangles(np.repeat(pressure[..., None], 3, axis=2)).mean(axis=(1, 2))
    level = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]
    assert float(mean @ level) == pytest.approx(face.forces[..., 2].sum(), rel=0.1)


def test_areas_of_the_wall_at_rest_are_those_of_a_half_sphere() -> None:
    solid, _ = _dome()
    harmonics = Harmonics(2)
    outer = float(solid.rest[:, 0].max())
    areas = face_areas(solid, harmonics.lifted(solid.rest), harmonics)
    assert areas.sum() == pytest.approx(2.0 * np.pi * outer**2, rel=1e-5)


def test_positions_of_the_inner_wall_enclose_the_volume_of_the_cavity() -> None:
    """The same sums on the nodes of the inner wall: the volume above the base plane by the divergence theorem."""
    path, face = _pressed("ball beside the axis")
    solid, end = _dome()[0], path.states[-1]
    inner = solid.mesh.inner
    nodes = [*inner[:, [START, 2]].ravel(), inner[-1, END]]
    wall = replace(face, coefficients=end.positions[nodes])
    angles = 2.0 * np.pi * np.arange(180) / 180
    corners = _triangles(wall.positions(np.linspace(0.0, wall.edges, 12 * wall.edges + 1), angles))
    volume = float(np.einsum("ni,ni->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))) / 6.0
    assert volume == pytest.approx(end.volume, rel=1e-3)


def test_a_central_press_with_harmonics_has_the_pressure_of_the_solid() -> None:
    solid, free = _dome()
    end = indent(solid, free, PressSettings(depth=DEPTH, steps=3)).states[-1]
    plate = first_touch(solid, free, None, 30.0).body
    ours = _pressed("level plate")[1]
    theirs = pressed_face(
        solid, Harmonics(0), end.positions, PlacedObject(plate.at(plate.height - DEPTH / RADIUS)), end.indentation
    )
    assert theirs.forces.sum(axis=(0, 1))[2] == pytest.approx(end.force, rel=1e-9)
    load, area = np.linalg.norm(theirs.forces, axis=2).sum(axis=1), theirs.areas.sum(axis=1)
    np.testing.assert_allclose(np.linalg.norm(ours.forces, axis=2).sum(axis=1), load, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(ours.areas.sum(axis=1), area, rtol=1e-8)


def test_after_a_shear_the_wall_and_the_object_are_where_it_ended() -> None:
    """Friction of a level plate is level: the forces normal to it are the whole contact force."""
    path, face = _pressed("level plate", friction=0.3, travel=1.0)
    assert path.shear is not None
    last = path.shear.states[-1]
    assert face.travel == last.travel == pytest.approx(1.0)
    assert face.forces.sum(axis=(0, 1))[2] == pytest.approx(last.force, rel=1e-6)
    # A circle ends where it begins.
    assert face.lines[0][:-1, 0].mean() == pytest.approx(1.0, rel=1e-9)
    pole = face.positions(np.array([float(face.edges)]), np.zeros(1))[0, 0]
    assert 0.0 < pole[0] < 1.0


def test_lines_of_an_object_lie_on_it() -> None:
    face = _pressed("ball beside the axis")[1]
    points = np.concatenate(face.lines)
    low, high = points[:, 2].min(), points[:, 2].max()
    centre = np.array([2.0, 0.0, high - 8.0])
    np.testing.assert_allclose(np.linalg.norm(points - centre, axis=1), 8.0, rtol=1e-3)
    # The lowest circle stands a sixth of the half circle from the lowest point.
    assert high - low == pytest.approx(8.0 * (1.0 + np.cos(np.pi / 6.0)), rel=1e-3)


def test_lines_of_a_leaning_plate_lie_on_it_and_it_presses_where_it_is_lowest() -> None:
    face = _pressed("leaning plate")[1]
    place = face.positions(np.arange(face.edges + 1.0), face.harmonics.contact_angles)
    assert (face.forces[..., 2] * place[..., 0]).sum() < 0.0
    for line in face.lines[:1]:
        np.testing.assert_allclose(
            line[:, 2] - line[0, 2], np.tan(np.radians(6.0)) * (line[:, 0] - line[0, 0]), atol=1e-9
        )


def test_a_factor_of_force_is_one_of_the_contact_pressure_and_moves_nothing() -> None:
    face = _pressed("ball beside the axis")[1]
    scaled, rows, angles = face.scaled(1.3), face.rows(), np.linspace(0.0, np.pi, 5)
    np.testing.assert_allclose(scaled.forces, 1.3 * face.forces, rtol=1e-15)
    np.testing.assert_allclose(scaled.pressure(rows, angles), 1.3 * face.pressure(rows, angles), rtol=1e-12)
    np.testing.assert_array_equal(scaled.positions(rows, angles), face.positions(rows, angles))


def test_between_few_contact_angles_the_pressure_is_smoothed_over_one_edge_along_the_wall() -> None:
    """One loaded ring of a wall that touches everywhere: a Gauss function of the distance, over what it has of the area."""
    face = _pressed("ball beside the axis")[1]
    ring, rows, angles = 4, np.arange(3.0, 6.0), np.array([0.4])
    forces = np.zeros_like(face.forces)
    forces[ring, :, 2] = face.areas[ring]
    pressure = replace(face, forces=forces, touching=face.areas).pressure(rows, angles)[:, 0]
    share = np.exp(-0.5 * (rows[:, None] - np.arange(face.edges + 1.0)) ** 2) * face.areas.sum(axis=1)
    np.testing.assert_allclose(pressure, share[:, ring] / share.sum(axis=1), rtol=0.15)


def test_a_calibrations_factor_on_the_force_is_one_on_the_face(evaluated):
    """Pressed nodes stay where they are, and bear as much more."""
    state = evaluated("paper-dome", "pneumatics.driving_pressures_kPa=[0]").prediction.states[0]
    factor = state.corrected(ResponseCorrection((0.0,), (1.25,), (0.9,)))
    own, other = state.face(), factor.face()
    assert other.forces == pytest.approx(1.25 * own.forces, rel=1e-12) and own.forces.any()
    assert np.array_equal(other.coefficients, own.coefficients)
