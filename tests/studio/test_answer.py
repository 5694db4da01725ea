"""What the studio answers equals what the commands print."""

from __future__ import annotations

import json

import pytest

from tests.studio.served import is_declared
from tests.studio.test_guard import ASK

WALL = {"membrane.wall_thickness_mm": "1.4", "pneumatics.driving_pressures_kPa": "[0, 12]"}
WORDS = ["--set", "membrane.wall_thickness_mm=1.4", "--set", "pneumatics.driving_pressures_kPa=0,12"]


def asked(client, path, values, base="paper-dome"):
    return client.post(path, json={"base": base, "values": values}, headers={"Origin": ASK["Origin"]})


def printed(command, *words):
    return json.loads(command(*words, "--json").stdout)


def test_the_atlas_completes_its_quick_answer_to_the_prediction_of_the_command(client, command):
    quick, whole = (asked(client, f"/api/{path}", WALL).json() for path in ("quick", "intervals"))
    assert quick["outside"] is None
    expected = printed(command, "predict", "paper-dome", *WORDS, "--model", "atlas")
    assert whole["prediction"] == expected
    for state, one in zip(quick["prediction"]["states"], expected["states"], strict=True):
        assert state == {key: value for key, value in one.items() if key != "uncertainty"}
    later = {
        "states",
        "viscous",
        "dynamics",
        "dead_volume_note",
        "dead_volume_as_drawn_mL",
        "as_drawn",
        "as_drawn_model",
    }
    assert {**quick["prediction"], **dict.fromkeys(later)} == {**expected, **dict.fromkeys(later)}
    states = {state["driving_pressure_kPa"]: state["sensitivity_kPa_per_N"] for state in expected["states"]}
    curve = whole["curves"]["design"]
    assert curve["sensitivity_kPa_per_N"][0] == pytest.approx(states[0.0], rel=1e-5)
    assert quick["curves"]["design"] == {key: curve[key] for key in quick["curves"]["design"]}
    for low, value, high in zip(
        curve["low_kPa_per_N"], curve["sensitivity_kPa_per_N"], curve["high_kPa_per_N"], strict=True
    ):
        assert low < value < high
    titles = [resin["title"] for resin in whole["curves"]["resins"]]
    assert len(titles) == len(set(titles)) >= 7


def test_the_intervals_are_those_of_the_question_whatever_came_before(client):
    other = {"membrane.wall_thickness_mm": "1.3"}
    fresh = asked(client, "/api/intervals", other).json()
    asked(client, "/api/quick", WALL)
    assert asked(client, "/api/intervals", other).json() == fresh
    asked(client, "/api/quick", other)
    assert asked(client, "/api/intervals", other).json() == fresh


def test_the_drawing_is_that_of_the_bodies(client):
    answer = asked(client, "/api/quick", WALL).json()
    drawing = answer["drawing"]
    assert (drawing["inner_radius_mm"], drawing["wall_thickness_mm"]) == (9.25, 1.4)
    assert drawing["high_mm"] == pytest.approx(9.25 + 1.4, abs=0.02)
    # The section of the membrane alone: twice the quarter of a ring, and the flange below the base.
    (loops,) = [body["loops"] for body in drawing["bodies"] if body["role"] == "membrane"]
    points = [(x, z) for loop in loops for x, z in zip(loop[::2], loop[1::2], strict=True)]
    radii = [(x * x + z * z) ** 0.5 for x, z in points if z > 0.5]
    assert min(radii) == pytest.approx(9.25, abs=0.02)
    assert max(radii) == pytest.approx(10.65, abs=0.02)


def test_a_key_that_is_left_out_has_its_default(client):
    stated = asked(client, "/api/quick", {}).json()
    computed = asked(client, "/api/quick", {"pneumatics.dead_volume_mL": None}).json()
    assert stated["prediction"]["dead_volume_mL"] == 0
    assert computed["prediction"]["dead_volume_mL"] == pytest.approx(1.5, abs=0.05)


@pytest.mark.parametrize(
    ("values", "field"),
    [
        ({"membrane.wall_thickness_mm": "60"}, "membrane.wall_thickness_mm"),
        ({"membrane.wall_thickness_mm": "12"}, "membrane.wall_thickness_mm"),
        ({"membrane.material": "Tanga"}, "membrane.material"),
        ({"pneumatics.driving_pressures_kPa": "[0, 80]"}, "pneumatics.driving_pressures_kPa"),
        ({"indentation.depth_mm": "9.2"}, "indentation.depth_mm"),
        ({"contact.object": "ball"}, "contact.ball_radius_mm"),
        ({"contact.friction": "-1"}, "contact.friction"),
        ({"connector.port": "none-such"}, "connector.port"),
    ],
)
def test_an_error_stands_at_its_field_in_the_words_of_the_command(client, command, values, field):
    answer = asked(client, "/api/quick", values)
    assert answer.status_code == 422
    problems = answer.json()["problems"]
    assert field in problems[0]["fields"]
    ((key, value),) = values.items()
    said = command("predict", "paper-dome", "--set", f"{key}={value}")
    assert said.returncode == 2
    assert problems[0]["message"].rpartition(": ")[2] in " ".join(said.stderr.split())


def test_what_the_atlas_does_not_cover_is_said_and_drawn(client):
    values = {"contact.object": "ball", "contact.ball_radius_mm": "4"}
    answer = asked(client, "/api/quick", values).json()
    assert answer["prediction"] is None
    assert "plate" in answer["outside"] or "ball" in answer["outside"]
    assert answer["drawing"]["bodies"]


def test_the_form_is_made_of_the_declared_fields(client):
    from pneutouch.spec.design import DesignFile
    from pneutouch.spec.fields import declarations, table_of

    form = client.get("/api/form").json()
    fields = {field["name"]: field for group in form["groups"] for field in group["fields"]}
    for name in DesignFile.model_fields:
        table = table_of(DesignFile, name)
        for declared in declarations(table) if table else ():
            field = fields.pop(f"{name}.{declared.key}", None)
            if f"{name}.{declared.key}" == "contact.plate_diameter_mm":
                continue
            assert is_declared(field, declared)
    assert not fields
    assert form["first"] == "paper-dome"
    # Their membranes alone have a mould, so the page shows its table for them.
    assert form["castings"] == ["silicone-casting"]
    assert {"paper-dome", "soft-pad"} <= {one["name"] for one in form["designs"]}


def test_the_view_holds_every_triangle_with_unit_normals(client):
    import base64

    import numpy as np

    for body in asked(client, "/api/view", {}).json()["bodies"]:
        corners = np.frombuffer(base64.b64decode(body["corners"]), "<f4").reshape(-1, 3, 3)
        normals = np.frombuffer(base64.b64decode(body["normals"]), "<i1").reshape(-1, 3, 3)
        assert corners.shape == normals.shape
        assert np.abs(np.linalg.norm(normals, axis=2) / 127 - 1).max() < 0.01


@pytest.mark.slow
def test_the_solid_s_answer_is_what_the_commands_print(client, command):
    answer = asked(client, "/api/solved", WALL).json()
    assert answer["prediction"] == printed(command, "predict", "paper-dome", *WORDS)
    if "check" in answer:
        said = printed(command, "check", "paper-dome", *WORDS)
        assert answer["check"]["findings"] == said["findings"]


def test_the_pressed_walls_are_those_that_the_solid_solved(client):
    answer = asked(client, "/api/solved", {"pneumatics.driving_pressures_kPa": "[0, 12]"}).json()
    for walls, state in zip(answer["walls"], answer["prediction"]["states"], strict=True):
        assert walls["driving_pressure_kPa"] == state["driving_pressure_kPa"]
        assert walls["indentation_mm"] == pytest.approx(state["curve"]["indentation_mm"], abs=1e-3)
        highest = [max(loop[1::2]) for loop in walls["walls"]]
        # The plate lies on the wall: its height falls by the indentation, to the depth by which the contact gives way.
        for top, depth in zip(highest, walls["indentation_mm"], strict=True):
            assert top == pytest.approx(highest[0] - depth, abs=0.03)
        assert highest[0] == pytest.approx(state["apex_height_outer_mm"], abs=1e-3)
        # Without touching its base the wall keeps its volume, nearly: Poisson's ratio is 0.49.
        areas = [_turned_volume(loop) for loop in walls["walls"]]
        assert areas[-1] == pytest.approx(areas[0], rel=0.02)


def _turned_volume(loop):
    """Volume of a loop (r, z) turned about the axis, by Pappus: integral of pi r^2 dz around it."""
    r, z = loop[::2], loop[1::2]
    pairs = zip(r, z, [*r[1:], r[0]], [*z[1:], z[0]], strict=True)
    return abs(sum(3.141592653589793 / 3 * (a * a + a * c + c * c) * (d - b) for a, b, c, d in pairs))


def test_a_vacuum_is_left_to_the_solid(client, command):
    sucked = {"pneumatics.driving_pressures_kPa": "[-5, 0]"}
    quick = asked(client, "/api/quick", sucked).json()
    assert "below ambient" in quick["outside"] and quick["prediction"] is None
    answer = asked(client, "/api/solved", sucked).json()
    expected = printed(command, "predict", "paper-dome", "--set", "pneumatics.driving_pressures_kPa=[-5,0]")
    assert answer["prediction"]["states"] == expected["states"]
