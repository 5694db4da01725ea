"""A studio that is asked without a server, as the browser that was given its address."""

from __future__ import annotations

import pytest

pytest.importorskip("starlette")
pytest.importorskip("httpx2")

from starlette.testclient import TestClient

from pneutouch.studio.application import application
from pneutouch.studio.server import bases_of

PORT = 8123
HOME = f"http://127.0.0.1:{PORT}"
TOKEN = "the-token-of-the-tests"


@pytest.fixture
def stranger():
    """A client that was given nothing; the studio runs while it is used."""
    bases, first = bases_of(None)
    with TestClient(application(bases, first, PORT, TOKEN), base_url=HOME, follow_redirects=False) as client:
        yield client


@pytest.fixture
def client(stranger):
    """A client that opened the address."""
    assert stranger.get("/", params={"token": TOKEN}).status_code == 303
    return stranger
