"""The shipped shapes: textbook volumes, one thickness, arcs on ellipses, equal figures of equal forms, and refusals."""

from __future__ import annotations

import itertools
import math
import re
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.catalogue import load_scene
from pneutouch.errors import InputError
from pneutouch.evaluation import evaluate
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.shape import ShapeError, shape_of
from pneutouch.shape.even import biarc, fitted
from pneutouch.shape.round import quarter
from tests.shape.shapes import shipped

HALF_BALLS = {
    "cap": {"membrane.rise_mm": 9.25},
    "ellipsoid": {"membrane.rise_mm": 9.25},
    "profile": {"membrane.profile_mm": [[9.25, 0.0], [9.25, 9.25, 9.25], [0.0, 9.25]]},
}


def test_cavities_have_textbook_volumes():
    def volume(key, **sizes):
        return shape_of(key, 9.25, 1.0, sizes).cavity_volume

    assert volume("cap", rise=4.0) == pytest.approx(math.pi * 4.0 / 6 * (3 * 9.25**2 + 4.0**2), rel=1e-12)
    assert volume("ellipsoid", rise=5.0) == pytest.approx(2 / 3 * math.pi * 9.25**2 * 5.0, rel=3e-5)
    assert volume("ellipsoid", rise=14.0) == pytest.approx(2 / 3 * math.pi * 9.25**2 * 14.0, rel=3e-5)
    thimble = math.pi * 9.25**2 * 6.0 + 2 / 3 * math.pi * 9.25**3
    assert volume("thimble", side=6.0) == pytest.approx(thimble, rel=1e-12)
    assert volume("disc", cavity_depth=3.0) == pytest.approx(math.pi * 9.25**2 * 3.0, rel=1e-12)
    level = volume("corrugated", rise=1e-3, cavity_depth=3.0)
    assert level == pytest.approx(math.pi * 9.25**2 * 3.0, rel=1e-3)


@given(radius=st.floats(1.0, 50.0), share=st.floats(0.15, 3.0))
def test_arcs_stay_within_a_micrometre_of_the_ellipse(radius, share):
    rise = share * radius
    # Density along the arc, where a place is nearest to the ellipse by Newton's method on its angle.
    points = np.concatenate([piece.along(np.linspace(0.0, 1.0, 33)) for piece in quarter(radius, rise)])
    angle = np.arctan2(points[:, 1] / rise, points[:, 0] / radius)
    for _ in range(20):
        c, s = np.cos(angle), np.sin(angle)
        apart = np.stack([radius * c, rise * s], axis=1) - points
        along = np.stack([-radius * s, rise * c], axis=1)
        turned = (along**2).sum(axis=1) + (apart * np.stack([-radius * c, -rise * s], axis=1)).sum(axis=1)
        angle = angle - (apart * along).sum(axis=1) / turned
    near = np.stack([radius * np.cos(angle), rise * np.sin(angle)], axis=1)
    assert np.linalg.norm(near - points, axis=1).max() < 1e-3


@given(turn=st.floats(-2.0, 2.0), lean=st.floats(-1.2, 1.2), span=st.floats(0.1, 50.0))
def test_two_arcs_leave_and_arrive_as_asked_and_meet_smoothly(turn, lean, span):
    leaving, arriving = ((math.cos(a), math.sin(a)) for a in (lean, lean + turn))
    one, other = biarc((1.0, 2.0), leaving, (1.0 + span, 2.0), arriving)

    def heading(piece, at):
        return np.array([-1.0, 1.0]) * piece.normals(np.array([at]))[0][::-1]

    assert one.start == pytest.approx((1.0, 2.0), abs=1e-9) and other.end == pytest.approx((1.0 + span, 2.0), abs=1e-9)
    assert heading(one, 0.0) == pytest.approx(leaving, abs=1e-9)
    assert heading(other, 1.0) == pytest.approx(arriving, abs=1e-9)
    assert one.end == pytest.approx(other.start, abs=1e-9 * span)
    assert heading(one, 1.0) == pytest.approx(heading(other, 0.0), abs=1e-8)


def test_arcs_fitted_to_a_wave_follow_it():
    def wave(share):
        x = 6.0 * share
        return np.stack([x, np.sin(x)], axis=1), np.stack([np.ones_like(x), np.cos(x)], axis=1)

    pieces = fitted(wave, 1e-4)
    assert np.min([piece.distance(wave(np.linspace(0, 1, 999))[0]) for piece in pieces], axis=0).max() < 2e-4
    assert all(one.end == pytest.approx(other.start, abs=1e-12) for one, other in pairwise(pieces))


EVEN = [shape for shape in shipped(9.25, 0.8) if not getattr(shape, "wall_stations", ())]


@pytest.mark.parametrize("shape", EVEN, ids=lambda shape: shape.key)
def test_the_wall_is_as_thick_as_stated_everywhere_but_on_a_boss(shape):
    share = np.linspace(0.0, 1.0, 501)
    inner, outer = np.moveaxis(shape.points(share, np.array([0.0, 1.0])), 1, 0)
    if getattr(shape, "boss_height", 0.0):
        inner, outer = inner[inner[:, 0] > 3.6], outer[inner[:, 0] > 3.6]
    assert np.linalg.norm(outer - inner, axis=1) == pytest.approx(0.8, rel=1e-9)
    off = np.min([piece.distance(outer) for piece in shape.inner], axis=0)
    assert off == pytest.approx(0.8, rel=1e-9)


@pytest.mark.parametrize("key", ["hemisphere", "cap", "ellipsoid", "thimble", "disc"])
def test_a_wall_of_stations_is_as_thick_as_they_say_and_level_at_the_pole(key):
    shape = shape_of(key, 9.25, 0.8, {"wall_stations": [[0.0, 1.0], [0.5, 1.4], [1.0, 1.8]]})
    share = np.array([0.0, 0.5, 1.0])
    thick = np.linalg.norm(np.diff(shape.points(share, np.array([0.0, 1.0])), axis=1)[:, 0], axis=1)
    assert thick[[0, 2]] == pytest.approx([0.8 * 1.8, 0.8], rel=1e-5)
    assert thick[1] == pytest.approx(0.8 * 1.4, rel=0.05)
    assert shape.normals(np.ones(1))[0] == pytest.approx((0.0, 1.0), abs=2e-3)


def test_a_wall_of_equal_stations_and_a_fillet_are_those_of_the_even_hemisphere(library):
    at = {"pneumatics.driving_pressures_kPa": [5.0], "membrane.root_fillet_mm": 1.0}
    one, other = (
        evaluate("paper-dome", {**at, **more}, library=library).prediction.states[0].figures
        for more in ({}, {"membrane.wall_stations": [[0.0, 1.0], [1.0, 1.0]]})
    )
    assert other.sensitivity == pytest.approx(one.sensitivity, rel=2e-4)
    assert other.force_high == pytest.approx(one.force_high, rel=2e-4)


@pytest.mark.parametrize(
    ("stations", "shape"),
    [
        ([[0, 1.0]], "cap"),
        ([[0.1, 1.0], [1, 1.2]], "cap"),
        ([[0, 1.0], [1, 9.0]], "cap"),
        ([[0, 4.9], [1, 4.9]], "hemisphere"),
        ([[0, 1.0], [1, 3.0]], "corrugated"),
    ],
)
def test_stations_that_make_no_wall_are_refused(stations, shape, library):
    rise = {"membrane.wall_thickness_mm": 2.0} if shape == "hemisphere" else {"membrane.rise_mm": 3.0}
    with pytest.raises(InputError) as caught:
        load_scene("paper-dome", {"membrane.shape": shape, **rise, "membrane.wall_stations": stations}, library)
    assert "membrane.wall_stations" in (caught.value.key, *caught.value.fields)


@pytest.mark.parametrize(
    ("shape", "upright"), [("cap", False), ("disc", False), ("thimble", True), ("ellipsoid", True)]
)
def test_a_flange_held_as_printed_is_for_upright_walls(shape, upright, library):
    changes = {"membrane.shape": shape, "pneumatics.driving_pressures_kPa": [8.0]}
    if upright:
        assert evaluate("paper-dome", changes, clamp="flange", library=library).prediction.states[0].range_end > 0.0
        return
    with pytest.raises(InputError) as caught:
        evaluate("paper-dome", changes, clamp="flange", library=library)
    assert (caught.value.key, caught.value.value) == ("clamp", "flange")


@pytest.mark.parametrize(
    "changes",
    [
        {"membrane.shape": "cap"},
        {"membrane.shape": "disc", "membrane.boss_radius_mm": 4.0, "membrane.boss_height_mm": 2.5},
        {"membrane.shape": "corrugated", "membrane.rise_mm": 1.0},
    ],
    ids=lambda changes: changes["membrane.shape"],
)
def test_a_central_press_is_the_same_by_solid_and_harmonic(changes, library):
    at = {"pneumatics.driving_pressures_kPa": [8.0], "pneumatics.dead_volume_mL": 1.0}
    solid, harmonic = (
        evaluate("paper-dome", {**changes, **at}, model=model, library=library).prediction.states[0].figures
        for model in ("solid", "harmonic")
    )
    assert harmonic.sensitivity == pytest.approx(solid.sensitivity, rel=1e-4)
    assert harmonic.force_high == pytest.approx(solid.force_high, rel=1e-4)


def test_a_plate_that_comes_down_on_the_flange_ends_the_range_with_a_finding(library):
    """A level disc without driving pressure lies in the plane of its flange: a wide plate touches both at once."""
    at = {"pneumatics.driving_pressures_kPa": [0.0, 12.0], "membrane.wall_thickness_mm": 1.0}
    found = evaluate("paper-dome", {"membrane.shape": "disc", **at}, library=library)
    level, blown = found.prediction.states
    assert level.range_end < 1e-3 < blown.range_end and level.figures is None
    warned = [one for one in found.findings_alone if one.rule == "driving" and one.severity == "warning"]
    # The advice is the pressure of this design that has figures.
    assert 12.0 in [float(value) for one in warned for value in re.findall(r"([\d.]+) kPa", one.fix)]


@pytest.mark.parametrize("key", HALF_BALLS)
def test_a_hemisphere_under_another_name_has_its_figures(key, evaluated):
    usual = evaluated("paper-dome").prediction
    other = evaluate("paper-dome", {"membrane.shape": key, **HALF_BALLS[key]}).prediction
    assert other.limit_point.driving_pressure == pytest.approx(usual.limit_point.driving_pressure, rel=1e-6)
    for one, two in zip(usual.states, other.states, strict=True):
        assert two.figures.sensitivity == pytest.approx(one.figures.sensitivity, rel=1e-6)
        assert two.figures.stiffness == pytest.approx(one.figures.stiffness, rel=1e-6)
        assert two.pressure_rise == pytest.approx(one.pressure_rise, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize(
    ("changes", "key", "words"),
    [
        ({"shape": "cap", "rise_mm": 10.0}, "rise_mm", "take an ellipsoid"),
        ({"shape": "cap", "rise_mm": 1.0}, "rise_mm", "take a disc"),
        ({"shape": "cap", "side_mm": 1.0}, "side_mm", "it takes membrane.rise_mm"),
        ({"rise_mm": 9.0}, "rise_mm", "hemisphere"),
        ({"shape": "disc", "boss_radius_mm": 2.0}, "boss_height_mm", "boss_height_mm, or neither"),
        ({"shape": "disc", "boss_radius_mm": 8.0, "boss_height_mm": 1.0}, "boss_radius_mm", "0.25 mm of wall"),
        ({"shape": "corrugated", "grooves": 3, "rise_mm": 1.0}, "grooves", "thinner wall"),
        ({"shape": "profile"}, "profile_mm", "needs"),
        ({"shape": "profile", "profile_mm": [[9.0, 0.0], [0.0, 5.0]]}, "profile_mm", "from 9.25 mm to 0"),
        (
            {"shape": "profile", "profile_mm": [[9.25, 0.0], [0.0, 5.0]]},
            "profile_mm",
            "not level on the axis, at z = 5",
        ),
        (
            {"shape": "profile", "profile_mm": [[9.25, 0], [9.25, 5], [0, 5]]},
            "profile_mm",
            "90 degrees at r = 9.25, z = 5",
        ),
        ({"shape": "profile", "profile_mm": [[9.25, 0], [9.25, 5, 6], [0, 5]]}, "profile_mm", "take smaller radii"),
        (
            {"shape": "profile", "profile_mm": [[9.25, 0], [9.25, 4, 1], [6, 4, 1], [6, 1, 1], [0, 1]]},
            "profile_mm",
            "overlaps itself",
        ),
        (
            {"shape": "profile", "profile_mm": [[9.25, 0], [2, 8, 0.3], [9, 8, 0.3], [4, 2, 0.3], [0, 2]]},
            "profile_mm",
            "crosses itself at r = ",
        ),
        ({"shape": "profile", "profile_mm": [[9.25, 0, 1, 2], [0, 5]]}, "profile_mm[0]", "a point is [r, z]"),
    ],
)
def test_impossible_shapes_are_refused_with_key_and_place(changes, key, words):
    with pytest.raises(InputError) as caught:
        load_scene("paper-dome", {f"membrane.{name}": value for name, value in changes.items()})
    assert words in str(caught.value) and key in str(caught.value)


@pytest.mark.parametrize("key", ["torus", "corrugated"])
def test_a_wall_that_is_as_thick_as_its_bends_allow_has_cells_everywhere(key):
    made = 0
    for rise, wall in itertools.product((0.1, 0.2, 0.3, 0.4), np.arange(0.02, 0.45, 0.01)):
        try:
            shape = shape_of(key, 9.25, 9.25 * wall, {"rise": 9.25 * rise})
        except ShapeError:
            continue
        assert SolidModel(dome(shape), neo_hookean(0.17)).rest.size
        made += 1
    assert made > 20


@pytest.mark.parametrize("points", [[[9.25, 0.0], [0.0, 0.0]], [[9.25, 0.0], [5.0, -2.0, 6.0], [0.0, -2.0]]])
def test_a_profile_without_room_behind_it_is_refused_and_takes_a_cavity(points, library):
    changes = {"membrane.shape": "profile", "membrane.profile_mm": points}
    with pytest.raises(InputError):
        load_scene("paper-dome", changes, library)
    load_scene("paper-dome", {**changes, "membrane.cavity_depth_mm": 4.0}, library)


@pytest.mark.parametrize("cavity", [0.1, 0.3, 0.6, 4.0])
def test_the_limits_of_a_flat_wall_do_not_depend_on_the_cavity_behind_it(cavity, library):
    changes = {"membrane.shape": "disc", "membrane.cavity_depth_mm": cavity, "pneumatics.driving_pressures_kPa": [5.0]}
    limits = evaluate("paper-dome", changes, library=library).prediction.limits
    deep = evaluate("paper-dome", {**changes, "membrane.cavity_depth_mm": 3.0}, library=library).prediction.limits
    assert limits.limit_point == pytest.approx(deep.limit_point, rel=1e-4)


@pytest.mark.parametrize("steps", [14, 28, 60])
def test_a_plate_on_the_flange_leaves_the_curve_before_it_alone(steps, library):
    changes = {
        "membrane.shape": "disc",
        "membrane.inner_radius_mm": 9.37,
        "membrane.boss_radius_mm": 3.27,
        "membrane.boss_height_mm": 1.87,
        "pneumatics.driving_pressures_kPa": [0.0],
        "indentation.steps": steps,
    }
    found = []
    for wall in (2.7, 2.82, 2.83, 3.0):
        (state,) = evaluate(
            "paper-dome", {**changes, "membrane.wall_thickness_mm": wall}, library=library
        ).prediction.states
        assert state.range_end == pytest.approx(1.87, abs=1e-5) and state.indentation[-1] <= 1.87 + 1e-5
        found.append(wall * state.figures.sensitivity)
    assert np.ptp(found) < 0.05 * np.mean(found)
