"""Rigid objects: the shape of their undersides, and what a dome answers to them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.indenter import STEEPEST, ObjectShapeError, ProfileVertex, ball, cone, profile, ring
from pneutouch.mechanics.solid.inflate import first_touch, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.shape.hemisphere import Hemisphere

SIZE = st.floats(0.3, 30.0)
DOME = SolidModel(dome(Hemisphere(9.25, 1.5)), neo_hookean(0.17))


@st.composite
def meridians(draw):
    """Corners that go outwards under 60 degrees, with roundings that their lines have space for."""
    count = draw(st.integers(2, 4))
    steps = [draw(st.floats(0.5, 5.0)) for _ in range(count)]
    slopes = [draw(st.floats(-1.7, 1.7)) for _ in range(count)]
    slopes[-1] = abs(slopes[-1])
    start = draw(st.sampled_from([0.0, 2.0]))
    slopes[0] = slopes[0] if start == 0.0 else -abs(slopes[0])
    r = np.cumsum([start, *steps])
    z = np.cumsum([0.0, *np.multiply(steps, slopes)])
    # Two arcs of 60 degrees at most take half of the shortest line at most.
    return profile([ProfileVertex(float(a), float(b), 0.25 * min(steps)) for a, b in zip(r, z, strict=True)])


objects = st.one_of(
    st.builds(ball, SIZE),
    st.builds(cone, st.floats(np.pi / 6, 1.5), SIZE),
    st.builds(lambda radius, share: ring(radius, share * radius), SIZE, st.floats(0.05, 0.9)),
    meridians(),
)


@settings(max_examples=60, deadline=None)
@given(objects, st.floats(-5.0, 5.0), st.floats(0.1, 10.0))
def test_an_underside_is_smooth_and_its_derivatives_are_its_own(body, height, factor):
    body = body.at(height).scaled(factor)
    wide = 1.2 * min(body.span[1], 40.0 * factor)
    r = np.linspace(1e-3, 1.0, 801) * wide
    under, slope, curve = body.underside(r)
    assert under.min() >= body.height - 1e-9 * wide
    step = 1e-5 * wide
    (high, up, _), (low, down, _) = body.underside(r + step), body.underside(r - step)
    # a jump of height or slope would be divided by the step
    assert np.allclose((high - low) / (2 * step), slope, atol=1e-3 * (1 + np.abs(curve).max() * step))
    steepest = np.abs(slope[(r > body.span[0]) & (r < body.span[1])]).max(initial=0.0)
    assert steepest <= STEEPEST * (1 + 1e-9)
    differences = (up - down) / (2 * step)
    # between pieces the curvature jumps: there the difference lies between both
    assert np.quantile(np.abs(differences - curve) / (1.0 / wide + np.abs(curve)), 0.97) < 1e-3
    # a corner would be divided by the step
    assert (np.abs(differences) <= 2.0 * np.abs(curve).max() + 1.0 / wide).all()


def test_a_ball_is_an_arc_to_sixty_degrees_and_above_it_a_parabola():
    body = ball(3.0)
    r = np.linspace(0.0, 3.0 * np.sin(np.pi / 3), 50)
    assert body.underside(r)[0] == pytest.approx(3.0 - np.sqrt(9.0 - r**2), abs=1e-12)
    assert body.span == pytest.approx((0.0, 3.0 * np.sin(np.pi / 3)))


def test_corners_of_a_profile_make_the_other_objects():
    r = np.linspace(0.01, 2.5, 97)
    slope = STEEPEST
    edge = 3.0 * np.tan(np.pi / 6)
    flat = profile([ProfileVertex(0, 0), ProfileVertex(edge, 0, 3.0), ProfileVertex(edge + 2, 2 * slope, 1.0)])
    assert flat.underside(r)[0] == pytest.approx(ball(3.0).underside(r)[0], abs=1e-12)
    tipped = profile([ProfileVertex(0, 0, 0.5), ProfileVertex(5, 5, 1.0)])
    assert tipped.underside(r)[0] == pytest.approx(cone(np.pi / 4, 0.5).underside(r)[0], abs=1e-12)


@pytest.mark.parametrize(
    ("corners", "index", "words"),
    [
        ([(0, 0), (3, 0, 0), (5, 1, 1)], 1, "sharp edge"),
        ([(0, 0, 0), (3, 1, 1)], 0, "sharp edge"),
        ([(0, 0), (3, 0, 1), (5, 1, 0)], 2, "sharp edge"),
        ([(0, 0), (3, 0, 1), (2, 1, 1)], 2, "outwards"),
        ([(0, 0), (3, 0, 1), (4, 3, 1)], 2, "60 degrees"),
        ([(0, 0), (1, 0, 5), (3, 2, 1)], 1, "overlap"),
        ([(0, 0)], 0, "two points"),
        ([(0, 0), (3, 0, 1), (5, -1, 1)], 2, "towards its edge"),
        ([(2, 0, 1), (4, 1, 1)], 0, "towards its edge"),
    ],
)
def test_a_meridian_that_is_no_underside_is_refused_with_its_corner(corners, index, words):
    with pytest.raises(ObjectShapeError, match=words) as refused:
        profile([ProfileVertex(*corner) for corner in corners])
    assert refused.value.index == index


def press(body, pressure=0.022, depth=4.0, **options):
    return indent(DOME, state_at(DOME, pressure), PressSettings(depth, steps=8, body=body, **options))


def test_a_huge_ball_is_the_endless_plate():
    flat, huge = press(None, plate_diameter=None), press(ball(1e5))
    for name in ("force", "rise", "contact_radius"):
        assert huge.column(name)[1:] == pytest.approx(flat.column(name)[1:], rel=1e-3)


def test_a_flat_profile_is_the_plate():
    flat = press(None, plate_diameter=None)
    stated = press(profile([ProfileVertex(0, 0), ProfileVertex(40, 0, 2.0)]))
    assert stated.column("force") == pytest.approx(flat.column("force"), rel=1e-12)


def test_sharper_objects_meet_less_force():
    force = [press(body).column("force")[1:] for body in (ball(3.0), ball(10.0), ball(30.0), None)]
    assert (np.diff(force, axis=0) > 0).all()
    blunt, sharp = press(cone(np.pi / 3, 3.0)).column("force"), press(cone(np.pi / 4, 3.0)).column("force")
    # Before their flanks touch both are the same ball.
    assert (sharp[1:] <= blunt[1:] * (1 + 1e-9)).all() and sharp[-1] < 0.95 * blunt[-1]


def test_a_ring_touches_around_the_axis_and_keeps_its_hole_free():
    body = ring(5.0, 2.0)
    run = press(body, depth=3.0)
    last = run.states[-1]
    assert 0.0 < last.contact_inner < 5.0 < last.contact_radius
    assert "separation" not in [event.kind for event in run.events]
    assert last.force > 0 and run.complete


def test_an_object_meets_an_unloaded_dome_where_two_circles_touch():
    # A ring of section a over a sphere of outer radius R touches where the centres of section and sphere are R + a apart.
    outer, radius, section = 10.75, 5.0, 2.0
    solid_free = state_at(DOME, 0.0)
    run = indent(DOME, solid_free, PressSettings(0.01, steps=1, body=ring(radius, section)))
    touch = first_touch(DOME, solid_free, ring(radius, section), None)
    assert touch.radius * 9.25 == pytest.approx(radius * outer / (outer + section), abs=0.05)
    above = np.sqrt((outer + section) ** 2 - radius**2) - section
    assert touch.body.height * 9.25 == pytest.approx(above, abs=2e-4)
    assert run.states[0].force < 1e-3 * run.states[-1].force


@pytest.mark.parametrize("body", [ball(4.0), ring(5.0, 2.5)], ids=["ball", "ring"])
def test_force_is_the_derivative_of_the_energy(body):
    run = indent(DOME, state_at(DOME, 0.022), PressSettings(3.0, steps=60, body=body))
    d, f, k = (run.column(n) for n in ("indentation", "force", "stiffness"))
    slope = np.gradient(f, d)
    assert np.median(np.abs(k[5:-2] / slope[5:-2] - 1)) < 0.03
    content = (run.column("pressure") + 0.101325) * run.column("volume")
    assert np.allclose(content, content[0], rtol=1e-9)


def test_the_stiffness_of_the_contact_does_not_count_on_the_steepest_flank():
    """A gap measured vertically is stiffer by 1 + slope^2 on a flank: nothing of it shows at 60 degrees."""
    body, runs = cone(np.pi / 6, 1.0), []
    for factor in (1.0, 0.1):
        solid = SolidModel(dome(Hemisphere(9.25, 1.5), arc=48), neo_hookean(0.17))
        solid.contact.stiffness *= factor
        runs.append(indent(solid, state_at(solid, 0.022), PressSettings(5.0, steps=5, body=body)))
    stiff, soft = runs
    assert stiff.states[-1].contact_radius > 1.5 * np.sin(np.pi / 3)
    assert soft.column("force")[1:] == pytest.approx(stiff.column("force")[1:], rel=2e-3)
    assert stiff.column("penetration").max() < 1e-3 * 1.5


def test_a_stated_rim_rounds_the_edge_of_the_plate():
    blunt, sharp = (press(None, plate_diameter=10.0, plate_rim=rim) for rim in (6.0, 1.5))
    assert (blunt.column("force") <= sharp.column("force") * (1 + 1e-9)).all()
    assert blunt.states[-1].force < 0.99 * sharp.states[-1].force
    usual = press(None, plate_diameter=90.0)
    assert press(None, plate_diameter=90.0, plate_rim=1.5).column("force") == pytest.approx(usual.column("force"))
