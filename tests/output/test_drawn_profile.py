"""Profiles from drawings: polylines of DXF files become points with roundings, and others are refused."""

from __future__ import annotations

import math

import ezdxf
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.catalogue import load_scene
from pneutouch.errors import InputError
from pneutouch.output.drawn_profile import drawn_profile
from pneutouch.shape.profile import Profile
from pneutouch.shape.round import Cap

QUARTER = math.tan(math.pi / 8)
ROUND = [(10.0, 0.0, 0.0), (10.0, 4.0, QUARTER), (6.0, 8.0, 0.0), (0.0, 8.0, 0.0)]


def drawing(folder, *lines, unit=4, closed=False):
    made = ezdxf.new()
    made.header["$INSUNITS"] = unit
    for points in lines:
        made.modelspace().add_lwpolyline(points, format="xyb", close=closed)
    path = folder / "inner.dxf"
    made.saveas(path)
    return path


def test_lines_and_arcs_become_points_with_roundings(tmp_path):
    assert drawn_profile(drawing(tmp_path, ROUND)) == [[10.0, 0.0, 0.0], [10.0, 8.0, 4.0], [0.0, 8.0, 0.0]]


def test_a_polyline_may_begin_on_the_axis(tmp_path):
    turned = [(0.0, 9.0, -QUARTER), (9.0, 0.0, 0.0)]
    assert drawn_profile(drawing(tmp_path, turned)) == [[9.0, 0.0, 0.0], [9.0, 9.0, 9.0], [0.0, 9.0, 0.0]]


@given(turn=st.floats(0.1, 1.4), radius=st.floats(2.0, 20.0))
def test_arcs_one_after_another_stay_the_arcs_of_their_circle(turn, radius, tmp_path_factory):
    angles = np.linspace(0.0, 0.5 * math.pi, max(3, 1 + math.ceil(0.5 * math.pi / turn)))
    bulge = math.tan(0.25 * (angles[1] - angles[0]))
    points = [(radius * math.cos(a), radius * math.sin(a), bulge) for a in angles[:-1]] + [(0.0, radius, 0.0)]
    corners = drawn_profile(drawing(tmp_path_factory.mktemp("dxf"), points))
    shape = Profile(radius, 0.1 * radius, 0.0, tuple((r, z, c) for r, z, c in corners))
    along = np.concatenate([piece.along(np.linspace(0.0, 1.0, 9)) for piece in shape.line])
    assert np.hypot(*along.T) == pytest.approx(radius, abs=1e-4 * radius)


@given(radius=st.floats(4.0, 20.0), rise=st.floats(0.2, 0.97), digits=st.integers(3, 9))
def test_one_arc_from_rim_to_pole_is_the_cap_however_its_numbers_are_rounded(radius, rise, digits, tmp_path_factory):
    radius, rise = round(radius, digits), round(rise * radius, digits)
    bulge = round(math.tan(0.5 * math.atan(rise / radius)), 6)
    corners = drawn_profile(drawing(tmp_path_factory.mktemp("dxf"), [(radius, 0.0, bulge), (0.0, rise, 0.0)]))
    shape = Profile(radius, 0.1 * radius, 0.0, tuple((r, z, c) for r, z, c in corners))
    cap = Cap(radius, 0.1 * radius, rise)
    assert shape.fault is None
    assert [face[-1].end[0] for face in (shape.inner, shape.outer)] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert shape.wall_volume == pytest.approx(cap.wall_volume, rel=1e-4)


@pytest.mark.parametrize(
    ("lines", "more", "words"),
    [
        ([ROUND], {"unit": 1}, "inches"),
        ([ROUND, ROUND], {}, "2 open polylines"),
        ([ROUND], {"closed": True}, "0 open polylines"),
        ([[(10.0, 0.0, 0.0), (8.0, 4.0, QUARTER), (6.0, 8.0, 0.0), (0.0, 8.0, 0.0)]], {}, "x = 8, y = 4"),
        ([[(10.0, 0.0, 0.0), (1.0, 8.0, 0.0)]], {}, "x = 1,"),
        ([[(10.0, 0.0, 0.9), (0.0, 8.0, 0.0)]], {}, "shorter ones"),
    ],
)
def test_other_drawings_are_refused_by_their_file(tmp_path, lines, more, words):
    path = drawing(tmp_path, *lines, **more)
    with pytest.raises(InputError) as caught:
        drawn_profile(path)
    assert words in str(caught.value) and caught.value.file == str(path)


def test_a_curve_beside_the_polyline_is_refused(tmp_path):
    path = drawing(tmp_path, ROUND)
    both = ezdxf.readfile(path)
    both.modelspace().add_circle((0.0, 0.0), 3.0)
    both.saveas(path)
    with pytest.raises(InputError) as caught:
        drawn_profile(path)
    assert "1 other" in str(caught.value)


def test_a_file_that_is_no_drawing_is_refused(tmp_path):
    path = tmp_path / "x.dxf"
    path.write_text("no drawing")
    with pytest.raises(InputError):
        drawn_profile(path)
    with pytest.raises(InputError):
        drawn_profile(tmp_path / "none.dxf")


def test_a_new_design_takes_it(tmp_path, command):
    path = drawing(tmp_path, ROUND)
    done = command("new", "drawn", "--drawing", str(path), "--out", str(tmp_path))
    assert done.returncode == 0
    shape = load_scene(str(tmp_path / "drawn.toml")).design.membrane.dome
    assert (shape.inner_radius, shape.inner_height, shape.key) == (10.0, 8.0, "profile")
    wrong = command("new", "other", "--drawing", str(path), "--shape", "disc", "--out", str(tmp_path))
    assert wrong.returncode == 2 and "profile" in wrong.stderr
