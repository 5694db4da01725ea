"""Files of the pressed dome: what they hold, and that the pressure can be read without colour."""

from __future__ import annotations

import base64
import io
import json
from dataclasses import replace

import numpy as np
import pytest

from pneutouch.evaluation.sheet_data import PressedView
from pneutouch.report.blocks import View, found
from pneutouch.report.pictures import pressed_blocks, pressed_caption, pressed_files

RADIUS = 10.0


@pytest.fixture(scope="module")
def view() -> PressedView:
    """A half sphere under pressure that rises towards its pole."""
    arc, around = np.linspace(0.0, 0.5 * np.pi, 13), np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    out = np.stack([np.outer(np.cos(arc), np.cos(around)), np.outer(np.cos(arc), np.sin(around))], axis=2)
    normals = np.concatenate([out, np.repeat(np.sin(arc)[:, None, None], 24, axis=1)], axis=2)
    pressure = np.repeat(np.maximum(np.linspace(-60.0, 60.0, 13), 0.0)[:, None], 24, axis=1)
    ring = np.stack([4 * np.cos(around), 4 * np.sin(around), np.full(24, 11.0)], axis=1)
    return PressedView(5.0, 3.0, 0.0, 2.5, RADIUS * normals, normals, pressure, (np.vstack([ring, ring[:1]]),))


def shown(view: PressedView) -> View:
    (block,) = found(pressed_blocks(view), View)
    return block


def test_the_mesh_is_the_dome_in_metres_with_colours(view: PressedView) -> None:
    import trimesh

    scene = trimesh.load(io.BytesIO(pressed_files(view, "dome")["dome-pressed.glb"]), file_type="glb")
    assert set(scene.geometry) == {"pressed dome", "base plane", "object"}
    whole = scene.geometry["pressed dome"]
    assert whole.area == pytest.approx(2 * np.pi * RADIUS**2, rel=0.02)
    # glTF is in metres with y up.
    placed = whole.copy().apply_transform(scene.graph["pressed dome"][0])
    np.testing.assert_allclose(placed.bounds[:, 1], [0.0, 0.01], atol=1e-9)
    assert (np.einsum("ij,ij->i", whole.face_normals, whole.triangles_center) > 0).all()
    colours, height = whole.visual.vertex_colors[:, :3].astype(float), whole.vertices[:, 2]
    gray = colours @ [0.2126, 0.7152, 0.0722]
    touched = height > 0.1 + RADIUS * np.sin(np.pi / 4)
    assert len(np.unique(gray[~touched].round())) <= 2
    order = np.argsort(height[touched])
    assert (np.diff(gray[touched][order]) <= 1e-9).all()
    assert gray[touched].max() < gray[~touched].min()


@pytest.mark.slow
def test_the_same_view_gives_the_same_bytes(view: PressedView) -> None:
    assert pressed_files(view, "dome") == pressed_files(view, "dome")
    assert pressed_blocks(view) == pressed_blocks(view)


def test_the_scale_names_quantity_and_unit_and_ends_at_the_greatest_pressure(view: PressedView) -> None:
    scale = shown(view).scale
    assert "contact pressure" in scale and "(kPa)" in scale
    assert "<!-- 60 -->" in scale and "<!-- 0 -->" in scale and "<!-- 70 -->" not in scale


def test_the_view_of_the_page_shades_the_pressure_less_than_a_body(view: PressedView) -> None:
    drawn = json.loads(shown(view).data)
    relief = {part["name"]: part["relief"] for part in drawn["bodies"]}
    assert relief["object"] == 0.0 < relief["pressed dome"] < 1.0
    assert drawn["tilt_deg"] > 26.0


def test_a_grid_of_the_page_holds_every_vertex_once_and_the_pole_in_a_row(view: PressedView) -> None:
    drawn = json.loads(shown(view).data)
    dome = next(part for part in drawn["bodies"] if part["name"] == "pressed dome")
    steps = np.frombuffer(base64.b64decode(dome["positions"]), "<i2").reshape(-1, dome["columns"], 3)
    found = np.array(drawn["middle"]) + drawn["reach"] * steps / 32767
    np.testing.assert_allclose(found, view.points, atol=1e-3)


def test_the_caption_states_the_state(view: PressedView) -> None:
    assert "5 kPa driving pressure, pressed 3.00 mm (contact force 2.50 N)" in pressed_caption(view)
    assert "pressed 3.00 mm and moved -2 mm sideways (" in pressed_caption(replace(view, travel=-2.0))


def test_the_picture_has_a_dark_dome_top_on_white_ground(view: PressedView) -> None:
    import matplotlib.image

    image = matplotlib.image.imread(io.BytesIO(pressed_files(view, "dome")["dome-pressed.png"]))[..., :3]
    assert image[:3].min() == 1.0
    high, wide = image.shape[:2]
    top = image[int(0.15 * high) : int(0.5 * high), int(0.4 * wide) : int(0.6 * wide)].mean(axis=2)
    assert top.min() < 0.25
