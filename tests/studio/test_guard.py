"""Who may talk to the studio, and what a request may hold."""

from __future__ import annotations

import pytest

from pneutouch.studio.guard import HEADERS, LARGEST_BODY
from tests.studio.conftest import HOME, TOKEN

ASK = {"Origin": HOME, "Content-Type": "application/json"}
QUESTION = '{"base": "paper-dome", "values": {"membrane.wall_thickness_mm": "-1"}}'


def test_the_token_opens_the_page_once_and_nothing_does_without(stranger):
    for path in ("/", "/studio.js", "/api/form", "/?token=wrong", "/?token="):
        assert stranger.get(path).status_code == 403, path
    opened = stranger.get("/", params={"token": TOKEN})
    assert (opened.status_code, opened.headers["location"]) == (303, "/")
    cookie = opened.headers["set-cookie"].lower()
    assert "httponly" in cookie
    assert "samesite=strict" in cookie
    assert stranger.get("/").status_code == 200
    assert TOKEN not in cookie
    stranger.cookies.clear()
    assert stranger.get("/", params={"token": TOKEN}).status_code == 403


def test_another_host_gets_nothing_even_with_the_cookie(client):
    for host in ("example.org", "example.org:8123", "127.0.0.1", "127.0.0.1:8124", "localhost.example.org:8123", ""):
        answer = client.get("/", headers={"Host": host})
        assert (answer.status_code, answer.text) == (403, "unknown host"), host
    assert client.get("/", headers={"Host": "localhost:8123", "Cookie": cookie(client)}).status_code == 200


def cookie(client) -> str:
    return "; ".join(f"{one.name}={one.value}" for one in client.cookies.jar)


@pytest.mark.parametrize(
    "origin", [None, "null", "http://example.org", "http://127.0.0.1:8124", "https://127.0.0.1:8123"]
)
def test_a_question_of_another_page_is_refused(client, origin):
    headers = {key: value for key, value in {**ASK, "Origin": origin}.items() if value is not None}
    assert client.post("/api/quick", content=QUESTION, headers=headers).status_code == 403


def test_every_answer_forbids_what_is_not_ours(client):
    for answer in (
        client.get("/"),
        client.get("/nothing"),
        client.get("/", headers={"Host": "example.org"}),
        client.post("/api/quick", content=QUESTION, headers=ASK),
    ):
        for name, value in HEADERS.items():
            assert answer.headers[name] == value
    assert "default-src 'self'" in HEADERS["Content-Security-Policy"]
    assert "unsafe" not in HEADERS["Content-Security-Policy"]


def test_unknown_paths_are_not_found_and_none_reaches_a_file(client):
    for path in (
        "/nothing",
        "/../../../etc/passwd",
        "/%2e%2e/%2e%2e/etc/passwd",
        "/vendor/../../server.py",
        "/vendor/",
        "/vendor/versions.json",
        "//etc/passwd",
        "/static/index.html",
        "/index.html",
    ):
        assert client.get(path).status_code == 404, path
    assert client.put("/api/quick", content="{}").status_code == 405
    assert client.get("/api/quick").status_code in (404, 405)


def test_a_question_is_limited_in_size_whatever_it_states(client):
    large = b'{"base": "' + b"x" * LARGEST_BODY + b'"}'
    assert client.post("/api/quick", content=large, headers=ASK).status_code == 413

    def parts():
        for start in range(0, len(large), 4096):
            yield large[start : start + 4096]

    assert client.post("/api/quick", content=parts(), headers=ASK).status_code == 413
    assert client.post("/api/quick", content=QUESTION, headers={**ASK, "Content-Type": "text/plain"}).status_code == 415


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("", "not JSON"),
        ("[" * 20000, "not JSON"),
        ("[]", "keys base and values"),
        ('{"base": 1, "values": {}}', "base is a text"),
        ('{"base": "paper-dome", "values": {"membrane.material": 3}}', "each value is a text"),
        ('{"base": "../../etc/passwd", "values": {}}', "unknown design"),
        ('{"base": "/etc/passwd", "values": {}}', "unknown design"),
        ('{"base": "paper-dome", "values": {"membrane.inner_radius_mm": "' + "9" * 5000 + '"}}', "longer than"),
        ('{"base": "paper-dome", "values": {"calibration": "/etc/passwd"}}', "calibration"),
        ('{"base": "paper-dome", "values": {"membrane.__class__": "1"}}', "unknown key"),
    ],
)
def test_what_is_no_question_is_one_clear_error(client, content, says):
    answer = client.post("/api/quick", content=content, headers=ASK)
    assert answer.status_code == 422
    assert says in "\n".join(str(problem) for problem in answer.json()["problems"])
