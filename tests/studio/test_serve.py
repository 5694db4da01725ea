"""Start and end of the command."""

from __future__ import annotations

import http.client
import signal
import socket
import sys
import threading
from contextlib import closing
from urllib.parse import urlsplit

import pytest

from tests.studio.served import served


@pytest.mark.slow
@pytest.mark.parametrize(
    ("number", "code", "line"), [(signal.SIGINT, 130, "stopped by Ctrl-C"), (signal.SIGTERM, 143, "stopped by SIGTERM")]
)
def test_a_stop_signal_ends_it_with_one_line(number, code, line):
    with served() as (address, running):
        parts = urlsplit(address)
        with closing(http.client.HTTPConnection(parts.hostname, parts.port)) as asked:
            asked.request("GET", f"/?{parts.query}")
            assert asked.getresponse().status == 200
        running.send_signal(number)
        _, said = running.communicate(timeout=60)
        assert running.returncode == code
        assert said.splitlines()[-1] == line
        assert "Traceback" not in said
        with pytest.raises(OSError):
            socket.create_connection((parts.hostname, parts.port), timeout=5)


def test_a_port_that_is_taken_is_one_clear_error(command):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        done = command("studio", "--no-browser", "--port", str(taken.getsockname()[1]))
    assert done.returncode == 2
    assert done.stderr.startswith("error: --port ")
    assert "give another port" in done.stderr


def test_an_unknown_design_is_the_error_of_every_command(command):
    assert command("studio", "paper-dom", "--no-browser").stderr == command("predict", "paper-dom").stderr


def test_without_its_packages_it_names_what_to_install(command, monkeypatch):
    monkeypatch.setitem(sys.modules, "uvicorn", None)
    done = command("studio", "--no-browser")
    assert done.returncode == 2
    assert done.stderr.startswith("error: the studio needs the packages starlette and uvicorn; ")
    assert "pip install 'pneutouch[studio]'" in done.stderr


@pytest.mark.slow
def test_the_address_is_opened_in_a_browser(command, monkeypatch):
    opened = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    monkeypatch.setattr(
        "pneutouch.studio.server.serve", lambda design, port, ready: ready("http://127.0.0.1:1/?token=x")
    )
    assert command("studio").stdout == "http://127.0.0.1:1/?token=x\n"
    for thread in threading.enumerate():
        if thread is not threading.current_thread() and thread.daemon:
            thread.join(5)
    assert opened == ["http://127.0.0.1:1/?token=x"]
    command("studio", "--no-browser")
    assert len(opened) == 1


def test_answers_are_sent_without_waiting_for_more(monkeypatch):
    """The listener states TCP: asyncio then sets TCP_NODELAY on what it accepts."""
    taken = []

    async def serve(server, sockets):
        taken.extend(each.proto for each in sockets)

    monkeypatch.setattr("pneutouch.studio.server._Server.serve", serve)
    monkeypatch.setattr("pneutouch.studio.server.application", lambda *words: None)
    from pneutouch.studio.server import serve as studio

    studio("paper-dome", 0, print)
    assert taken == [socket.IPPROTO_TCP]
