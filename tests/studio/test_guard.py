"""Who may talk to the studio, and what a request may hold."""

from __future__ import annotations

import pytest

from pneutouch.studio.guard import HEADERS, KEY, LARGEST_BODY, OPENING
from tests.studio.conftest import HOME, TOKEN, admitted

ASK = {"Origin": HOME, "Content-Type": "application/json"}
QUESTION = '{"base": "paper-dome", "values": {"membrane.wall_thickness_mm": "-1"}}'


def test_the_token_gives_the_key_once_and_nothing_opens_without(stranger):
    closed = ("/api/form", "/api/jobs", "/api/echo", "/nothing", "/api/open")
    for path in closed:
        assert stranger.get(path).status_code == 403, path
        assert stranger.post(path, json={}, headers={"Origin": HOME}).status_code == 403, path
    given = stranger.post(OPENING, headers={"Origin": HOME, KEY: TOKEN})
    assert "set-cookie" not in given.headers
    key = given.json()["key"]
    assert key != TOKEN
    assert stranger.get("/api/form", headers={KEY: key}).status_code == 200
    for wrong in (TOKEN, f"{key}x", ""):
        assert stranger.get("/api/form", headers={KEY: wrong}).status_code == 403
    assert stranger.post(OPENING, headers={"Origin": HOME, KEY: TOKEN}).status_code == 403


@pytest.mark.parametrize("origin", [None, "null", "http://127.0.0.1:8124", "http://127.0.0.1"])
def test_a_page_of_another_port_cannot_use_the_token_up(origin, stranger):
    asked = {"Origin": origin} if origin else {}
    assert stranger.post(OPENING, headers={KEY: TOKEN} | asked).status_code == 403
    assert stranger.post(OPENING, headers={KEY: TOKEN, "Origin": HOME}).status_code == 200


def test_a_browser_has_nothing_that_it_would_send_to_another_port(stranger):
    """Cookies go to every port of an address: the studio gives none, and takes none."""
    for path in ("/", f"/?token={TOKEN}", "/studio.js", "/nothing"):
        assert "set-cookie" not in stranger.get(path).headers, path
    key = admitted(stranger).headers.pop(KEY)
    assert len(stranger.cookies.jar) == 0
    assert stranger.get("/api/form", headers={"Cookie": f"{KEY}={key}"}).status_code == 403


def test_the_page_itself_holds_nothing_and_opens_for_all(stranger):
    assert stranger.get("/").content == stranger.get(f"/?token={TOKEN}").content
    assert stranger.get("/studio.js").status_code == 200
    assert stranger.post("/", json={}, headers={"Origin": HOME}).status_code == 405


def test_another_host_gets_nothing_even_with_the_key(client):
    for host in ("example.org", "example.org:8123", "127.0.0.1", "127.0.0.1:8124", "localhost.example.org:8123", ""):
        answer = client.get("/api/form", headers={"Host": host})
        assert (answer.status_code, answer.text) == (403, "unknown host"), host
    assert client.get("/api/form", headers={"Host": "localhost:8123"}).status_code == 200


@pytest.mark.parametrize(
    ("site", "code"), [("none", 200), ("same-origin", 200), ("same-site", 403), ("cross-site", 403)]
)
def test_what_a_browser_asks_for_another_page_is_refused(site, code, client):
    assert client.get("/api/form", headers={"Sec-Fetch-Site": site}).status_code == code
    assert client.get("/api/form", headers={"Origin": "http://127.0.0.1:8124"}).status_code == 403


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
