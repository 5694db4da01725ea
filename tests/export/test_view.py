"""The data of the 3D view: the bodies themselves, to the steps of their two bytes."""

from __future__ import annotations

import base64
import json

import numpy as np
import pytest

from pneutouch.export import scene
from pneutouch.export.scene import ShadedBody, shaded, view_data
from pneutouch.report.pictures import GRADE_COLOURS, shown


def unpacked(part, reach, middle):
    """Corners (mm), normals and colours of a part, (m, 3, 3) each."""
    rows = {
        key: np.frombuffer(base64.b64decode(part[key]), kind).reshape(-1, 3).astype(float)
        for key, kind in (("positions", "<i2"), ("normals", "i1"), ("colours", "u1"), ("triangles", "<u2"))
    }
    index = rows["triangles"].astype(int)
    return middle + reach * rows["positions"][index] / 32767, rows["normals"][index] / 127, rows["colours"][index] / 255


def test_the_view_holds_the_bodies(evaluated):
    bodies = shown(evaluated("paper-dome", model="atlas").assembly, 900)
    found = json.loads(view_data(bodies))
    assert [part["name"] for part in found["bodies"]] == [body.name for body in bodies] == ["membrane", "connector"]
    for part, body in zip(found["bodies"], bodies, strict=True):
        corners, normals, colours = unpacked(part, found["reach"], np.array(found["middle"]))
        volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
        exact = np.einsum("ij,ij->", body.corners[:, 0], np.cross(body.corners[:, 1], body.corners[:, 2])) / 6
        assert volume == pytest.approx(exact, rel=1e-3)
        assert np.abs(np.linalg.norm(normals, axis=2) - 1).max() < 0.02
        assert np.ptp(colours.reshape(-1, 3), axis=0).max() == 0


def test_a_body_of_many_triangles_is_split(monkeypatch, evaluated):
    (membrane, _) = shown(evaluated("paper-dome", model="atlas").assembly, 100)
    whole = json.loads(view_data([membrane]))
    monkeypatch.setattr(scene, "_MOST", 100)
    parts = json.loads(view_data([membrane]))["bodies"]
    assert len(parts) == -(-len(membrane.corners) // 100)
    count = sum(len(base64.b64decode(part["triangles"])) for part in parts)
    assert count == len(base64.b64decode(whole["bodies"][0]["triangles"]))


def test_a_graded_membrane_is_light_at_the_pole_and_darkest_at_the_rim(evaluated):
    """In gray as well: the luminance falls all the way along the arc."""
    membrane, connector = shown(evaluated("graded-dome", model="solid").assembly, 400)[:2]
    points, colours = membrane.corners.reshape(-1, 3), membrane.colours.reshape(-1, 3)
    radius = np.linalg.norm(points, axis=1)
    outside = (np.abs(radius - 10.75) < 0.05) & (points[:, 2] >= 0)
    angle = np.arccos(np.clip(points[outside, 2] / radius[outside], -1, 1))
    gray = colours[outside] @ [0.2126, 0.7152, 0.0722]
    order = np.argsort(angle)
    assert (np.diff(gray[order]) < 1e-9).all()
    light, dark = (np.array(list(bytes.fromhex(colour[1:]))) / 255 for colour in GRADE_COLOURS)
    np.testing.assert_allclose(colours[outside][order][[0, -1]], [light, dark], atol=0.02)
    assert np.ptp(connector.colours.reshape(-1, 3), axis=0).max() == 0


def test_a_body_has_the_colour_of_its_material(evaluated):
    body = evaluated("paper-dome", model="atlas").assembly.bodies[0]
    found = shaded(body)
    assert isinstance(found, ShadedBody)
    expected = np.array(list(bytes.fromhex(body.material.colour[1:]))) / 255
    np.testing.assert_allclose(found.colours.reshape(-1, 3), np.tile(expected, (3 * len(body.triangles), 1)))
