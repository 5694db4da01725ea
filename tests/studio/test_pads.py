"""Pads on the page: answers of the server and those of Python, what makes no sense, the job that tabulates a cell."""

from __future__ import annotations

import numpy as np
import pytest

import pneutouch as pt
from pneutouch.studio import pads
from pneutouch.workflows.pad import touch as touching
from tests.studio.conftest import HOME
from tests.studio.pads import NAME, PRESSURE, kept_pad, made_up

BALL = {
    "touch.x_mm": "3.5",
    "touch.y_mm": "-1",
    "touch.radius_mm": "8",
    "touch.depth_mm": "1.2",
    "touch.noise_kPa": "0.004",
}
CYLINDER = BALL | {"touch.object": "cylinder", "touch.turn_deg": "70"}
PLATE = {"touch.object": "plate", "touch.slope_x": "0.03", "touch.slope_y": "-0.02", "touch.depth_mm": "1"}


@pytest.fixture
def home(tmp_path, monkeypatch):
    """The user's folder and the cache, with a pad whose table is kept."""
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    kept_pad(tmp_path)
    return tmp_path


@pytest.fixture
def ask(home, client):
    def asked(path, name=NAME, **changes):
        values = {"touch.pressure": PRESSURE, **changes} if path.endswith("touch") else changes
        return client.post(path, json={"base": name, "values": values}, headers={"Origin": HOME})

    return asked


def test_the_pad_is_drawn_as_it_is_laid_out(ask, client):
    assert NAME in client.get("/api/form").json()["pads"]
    shown, pad = ask("/api/pad").json(), pt.load_pad(NAME)
    assert np.allclose(shown["places_mm"], pad.places_mm)
    corners = np.array(shown["outline_mm"])
    assert (np.abs(corners).max(axis=0) > np.abs(pad.places_mm).max(axis=0) + max(shown["dome_radii_mm"])).all()
    fields = {field["name"]: field for field in shown["groups"][0]["fields"]}
    assert PRESSURE in [each["name"] for each in fields["touch.pressure"]["options"]]
    assert fields["touch.x_mm"]["high"] >= np.abs(corners).max()


@pytest.mark.parametrize(("changes", "kind"), [(BALL, "ball"), (CYLINDER, "cylinder"), (PLATE, "plate")])
def test_answers_are_those_of_python(ask, changes, kind):
    answer = ask("/api/pad/touch", **changes).json()
    touch = pt.load_pad(NAME).touch(float(PRESSURE))
    given = {name.partition(".")[2]: float(text) for name, text in changes.items() if name != "touch.object"}
    noise = given.pop("noise_kPa", 0.002)
    contact = getattr(touch, kind)(**given)
    read = touch.read(contact.pressure_rises_kPa, noise)
    assert np.allclose(answer["contact"]["pressure_rises_kPa"], contact.pressure_rises_kPa) and contact.inside[0]
    assert answer["contact"]["force_N"][0] == pytest.approx(contact.force_N[0])
    assert answer["read"]["kind"][0] == read.kind[0]
    assert answer["read"]["force_N"][0] == pytest.approx(read.force_N[0])
    assert np.allclose(answer["read"]["centre_covariance_mm2"], read.centre_covariance_mm2)


def test_what_is_not_known_is_null_and_beyond_the_range_says_so(ask):
    away = ask("/api/pad/touch", **BALL | {"touch.depth_mm": "0"}).json()
    assert away["contact"]["force_N"] == [0.0] and away["read"]["kind"] == ["none"]
    assert away["read"]["centre_mm"] == [[None, None]] and away["read"]["curvature_per_mm"] == [None]
    beyond = ask("/api/pad/touch", **PLATE | {"touch.slope_x": "0.3", "touch.slope_y": "0.3"}).json()
    assert beyond["contact"]["force_N"][0] > 0.0 and beyond["contact"]["inside"] == [False]


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("x_mm", "nan"),
        ("y_mm", "inf"),
        ("x_mm", "1e300"),
        ("depth_mm", "-0.1"),
        ("radius_mm", "0.1"),
        ("radius_mm", "[8]"),
        ("slope_x", "true"),
        ("noise_kPa", "0"),
        ("pressure", "13.5"),
        ("object", "cat"),
        ("colour", "1"),
    ],
)
def test_what_makes_no_sense_is_refused_at_its_field(ask, name, text):
    answer = ask("/api/pad/touch", **BALL | {f"touch.{name}": text})
    assert answer.status_code == 422
    assert answer.json()["problems"][0]["fields"] == [f"touch.{name}"]


@pytest.mark.parametrize("name", ["", "no-such-pad", "../designs/pads/tip", "paper-dome"])
@pytest.mark.parametrize("path", ["/api/pad", "/api/pad/touch"])
def test_a_pad_that_is_not_known_is_refused(ask, path, name):
    answer = ask(path, name)
    assert answer.status_code == 422 and NAME in answer.json()["problems"][0]["message"]


def test_a_cell_that_no_table_covers_is_refused(ask, home):
    cell = home / "designs" / "tip-cell.toml"
    cell.write_text(cell.read_text().replace('# shape = "hemisphere"', 'shape = "disc"'))
    assert ask("/api/pad").status_code == 200
    answer = ask("/api/pad/touch", **BALL | {"touch.depth_mm": "0.5"})
    assert answer.status_code == 422 and "round" in answer.json()["problems"][0]["message"]


def test_a_table_that_is_missing_is_made_by_a_job_and_a_pad_that_is_opened_is_read_anew(ask, home, monkeypatch):
    monkeypatch.setattr(touching, "cell_table", made_up)
    first = ask("/api/pad/touch", **BALL).json()["contact"]["pressure_rises_kPa"]
    file, cell = home / "designs" / "pads" / "tip.toml", home / "designs" / "tip-cell.toml"
    file.write_text(file.read_text().replace("pitch_mm = 9.0", "pitch_mm = 9.5"))
    cell.write_text(cell.read_text().replace("wall_thickness_mm = 1.0", "wall_thickness_mm = 1.1"))
    assert ask("/api/pad/touch", **BALL).json()["contact"]["pressure_rises_kPa"] == first
    assert ask("/api/pad").json()["places_mm"][2][0] == 9.5
    assert ask("/api/pad/touch", **BALL).json() == {}
    question = {"base": NAME, "values": {"touch.pressure": PRESSURE, **BALL}}
    assert pads.tabulate({"question": question}, home, lambda *given: None) == {"name": NAME}
    assert ask("/api/pad/touch", **BALL).json()["contact"]["pressure_rises_kPa"] != first
