"""What attacks on a studio get that runs as a user starts it."""

from __future__ import annotations

import asyncio
import json
import socket
import threading
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack

import pytest
from starlette.requests import Request

from pneutouch.studio.guard import HEADERS
from pneutouch.studio.server import Studio
from tests.studio.attacks import ATTACKS
from tests.studio.raw import answer, request, status

_QUESTION = b'{"base": "paper-dome", "values": {}}'


@pytest.mark.parametrize("attack", ATTACKS, ids=lambda attack: attack.what)
def test_an_attack_gets_what_the_table_says(attack, studio):
    for sent in attack.requests(studio):
        got = answer(studio, sent, ends=None in attack.gets)
        assert status(got) in attack.gets, (sent[:300], got[:300])
        assert got.count(b"HTTP/1.1 ") <= 1
        assert b"Traceback" not in got
        assert b"root:" not in got
        # HTTP itself is refused by the server, what is HTTP by the studio.
        if status(got) not in (None, 400):
            for name, value in HEADERS.items():
                assert f"{name.lower()}: {value}\r\n".encode() in got
    assert status(answer(studio, request(studio))) == 200
    assert studio.process.poll() is None


def test_the_table_of_the_docs_is_this_one(root):
    text = (root / "docs" / "howto" / "studio.md").read_text()
    assert "\n".join(attack.row() for attack in ATTACKS) in text


def test_of_fifty_questions_at_once_eight_wait_and_the_others_are_told_so():
    held, content = threading.Event(), {"design": "answered"}

    def slow(question):
        held.wait()
        return content

    async def run():
        asked = Studio({"paper-dome": "paper-dome"}, "paper-dome")
        tasks = [asyncio.create_task(asked.at_once(slow, _received(_QUESTION))) for _ in range(50)]
        refused = 0
        for task in asyncio.as_completed(tasks):
            refused += (await task).status_code == 503
            if refused == 42:
                held.set()
        await asked.desk.close()
        return [(task.result().status_code, json.loads(task.result().body)) for task in tasks]

    answers = asyncio.run(run())
    assert answers[:8] == [(200, content)] * 8
    assert {code for code, _ in answers[8:]} == {503}


def _received(body: bytes) -> Request:
    async def receive():
        return {"type": "http.request", "body": body, "more_body": False}

    return Request({"type": "http", "method": "POST", "headers": []}, receive)


def test_of_fifty_questions_over_the_network_every_one_is_answered(studio):
    sent = request(studio, b"POST /api/quick", _QUESTION)
    with ThreadPoolExecutor(50) as threads:
        answers = list(threads.map(lambda _: answer(studio, sent), range(50)))
    counted = Counter(status(each) for each in answers)
    assert set(counted) <= {200, 503}
    # Those that are answered are so in full; the others are told to wait.
    assert counted[200] >= 8
    assert all(each.endswith(b"}") for each in answers)
    assert all(b"wait for an answer" in each for each in answers if status(each) == 503)
    assert status(answer(studio, sent)) == 200


def test_connections_that_send_nothing_keep_nobody_out(studio):
    with ExitStack() as open_ones:
        for _ in range(200):
            each = open_ones.enter_context(socket.create_connection(("127.0.0.1", studio.port), timeout=60))
            each.sendall(b"POST /api/quick HTTP/1.1\r\nHost: ")
        assert status(answer(studio, request(studio, b"POST /api/quick", _QUESTION))) == 200
