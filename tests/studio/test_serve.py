"""Start and end of the command."""

from __future__ import annotations

import html
import http.client
import signal
import socket
import stat
import sys
import threading
from contextlib import closing
from pathlib import Path
from urllib.parse import unquote, urlsplit

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


def test_a_browser_is_started_with_a_page_of_the_users_own_and_not_with_the_token(command, monkeypatch):
    """What a process is started with can be read by every user of the machine."""
    address, opened, begun = "http://127.0.0.1:1/?token=x&a=1", [], threading.Event()

    def browser(given):
        page = Path(unquote(urlsplit(given).path))
        modes = [stat.S_IMODE(each.stat().st_mode) for each in (page, page.parent)]
        opened.append((given, page, page.read_text(), modes))
        begun.set()

    def serve(design, port, ready):
        ready(address)
        assert begun.wait(60)

    monkeypatch.setattr("webbrowser.open", browser)
    monkeypatch.setattr("pneutouch.studio.server.serve", serve)
    assert command("studio").stdout == f"{address}\n"
    [(given, page, text, modes)] = opened
    assert given.startswith("file:///")
    assert "token" not in given
    assert f"url={html.escape(address)}" in text
    assert modes == [0o600, 0o700]
    # It goes with the studio.
    assert not page.parent.exists()
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
