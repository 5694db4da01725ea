"""The page when its studio is stopped, its process killed or nobody looks; and what pages of others can do."""

from __future__ import annotations

import http.server
import os
import signal
import subprocess
import threading
from contextlib import contextmanager

import pytest
from playwright.sync_api import Page

from tests.browser import until
from tests.studio.kept import Kept
from tests.studio.served import SOLVED, Studio, move, served, solved

_STATUS = "document.getElementById('status').textContent"
_FIRST = "#paper-dome"


@pytest.mark.slow
def test_a_studio_that_was_stopped_and_another_at_its_port(pages):
    with served() as (address, process):
        first = Studio(address, process)
        page = first.open(pages)
        solved(page, _FIRST)
        process.send_signal(signal.SIGINT)
        process.wait(60)
    move(page, "Wall thickness, mm", 290)
    until(page, f"{_STATUS}.includes('does not answer: it was stopped')")
    assert page.locator("#status").text_content().count(f"--port {first.port} ") == 1
    assert page.evaluate("document.getElementById('area-design').classList.contains('stale')")
    with served("--port", str(first.port)) as (address, _):
        # It knows nothing of the old page, which says so.
        move(page, "Wall thickness, mm", 280)
        until(page, f"{_STATUS}.includes('belongs to a studio that was stopped')")
        left = page.evaluate("location.hash")
        other = page.context.new_page()
        other.goto(address)
        # The key of the new studio is kept only once its page has asked for it.
        until(other, SOLVED)
        other.close()
        # The user comes back from the other tab: the design that was left is answered, without another move.
        page.evaluate("window.dispatchEvent(new Event('focus'))")
        solved(page, left)
        assert not page.evaluate("document.getElementById('area-design').classList.contains('stale')")
        move(page, "Wall thickness, mm", 300)
        until(page, f"location.hash !== {left!r} && document.body.dataset.solved === location.hash && {SOLVED}")


def _children(process: subprocess.Popen[str]) -> list[int]:
    listed = subprocess.run(
        ["ps", "-o", "pid=", "--ppid", str(process.pid)], capture_output=True, text=True, check=False
    )
    return [int(each) for each in listed.stdout.split()]


def _killed_at_work(screen: Page, studio: Studio, place: float) -> int | None:
    """Kill the process that computes while it has a question; its number, None where it had none yet."""
    [worker] = _children(studio.process)
    # Stopped first: a question that reaches it is with it when it is killed.
    os.kill(worker, signal.SIGSTOP)
    with screen.expect_request("**/api/solved"):
        move(screen, "Wall thickness, mm", place)
    os.kill(worker, signal.SIGKILL)
    reported = "document.getElementById('problems').textContent.includes('ended from outside')"
    until(screen, f"{reported} || (document.body.dataset.solved === location.hash && {SOLVED})")
    return worker if screen.evaluate(reported) else None


@pytest.mark.slow
def test_a_killed_process_is_reported_and_the_next_move_is_answered(screen, studio):
    solved(screen, _FIRST)
    # Where the studio had not passed the question on yet when the process was killed, another process answers it.
    worker = next(each for place in range(281, 300) if (each := _killed_at_work(screen, studio, place)))
    move(screen, "Wall thickness, mm", 280)
    until(screen, f"document.body.dataset.solved === location.hash && {SOLVED}")
    assert screen.locator("#problems").text_content() == ""
    assert _children(studio.process) not in ([], [worker])


@pytest.mark.slow
def test_a_page_that_is_left_open_overnight_sends_nothing(pages, studio):
    profile = studio.profile()
    page = pages.open("about:blank", storage_state=profile)
    page.clock.install()
    page.goto(studio.home)
    solved(page, _FIRST)
    sent = len(pages.requested)
    page.clock.fast_forward("12:00:00")
    page.clock.run_for("10:00")
    # A question of our own goes out after all that the page had to send.
    page.evaluate("fetch('/icon.svg').then((answer) => answer.text())")
    assert [each.rpartition("/")[2] for each in pages.requested[sent:]] == ["icon.svg"]


@contextmanager
def foreign():
    """A server of somebody else on this computer, whose pages are empty: its address, and all that it was sent."""
    heads = []

    class Empty(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            heads.append(f"{self.path}\n{self.headers}")
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(b"<!doctype html><title>foreign</title>")

        def log_message(self, *words):
            pass

    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Empty) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield f"http://127.0.0.1:{server.server_port}/", heads
        finally:
            server.shutdown()
            thread.join()


_TRY = """async ([home, question]) => {
const outcome = (promise) => promise.then((answer) => answer.type === "opaque" ? "opaque" : answer.text(), (error) => error.name);
const load = (tag, name) => new Promise((done) => { const made = document.createElement(tag);
    made.onload = () => done("loaded"); made.onerror = () => done("refused"); made[name] = home + (tag === "img" ? "icon.svg" : "dom.js");
    document.head.append(made); });
const body = { method: "POST", body: question, credentials: "include" };
return {
  read: await outcome(fetch(home + "api/form", { credentials: "include" })),
  blind: await outcome(fetch(home + "api/form", { credentials: "include", mode: "no-cors" })),
  asked: await outcome(fetch(home + "api/quick", { ...body, headers: { "Content-Type": "application/json" } })),
  plain: await outcome(fetch(home + "api/quick", { ...body, mode: "no-cors" })),
  script: await load("script", "src"),
  picture: await load("img", "src"),
}; }"""


def test_a_page_of_another_origin_on_this_computer_reads_and_shows_nothing(pages, studio):
    """The browser has the studio's key, and sends it to no page and no server of another port."""
    with foreign() as (address, heads):
        page = pages.open(address, storage_state=studio.profile())
        answers = []
        page.on("response", lambda answer: answers.append((answer.url, answer.status)))
        got = page.evaluate(_TRY, [studio.home, '{"base": "paper-dome", "values": {}}'])
        assert got == {
            "read": "TypeError",
            "blind": "TypeError",
            "asked": "TypeError",
            "plain": "TypeError",
            "script": "refused",
            "picture": "refused",
        }
        assert {code for url, code in answers if url.endswith("/api/quick")} <= {403, 405}
        assert page.evaluate("[localStorage.length, document.cookie]") == [0, ""]
        assert heads
        assert not any(studio.key in head or "Cookie" in head for head in heads)
        # A frame of the studio stays empty.
        page.evaluate(
            "home => { const made = document.createElement('iframe'); made.src = home; document.body.append(made); }",
            studio.home,
        )
        until(page, "document.querySelector('iframe').contentDocument === null")
        frame = page.frames[1]
        assert frame.url.startswith("chrome-error:")
    kept, pages.errors[:] = pages.errors[:], []
    assert all("CORS" in each or "frame" in each for each in kept), kept


_MOVES = """async (count) => {
const slider = document.querySelector('[aria-label="Wall thickness, mm"]');
for (let k = 0; k < count; k += 1) {
  const before = document.body.dataset.painted;
  slider.value = 262 + (k * 7) % 36;
  slider.dispatchEvent(new Event('input'));
  while (document.body.dataset.painted === before) await new Promise((done) => setTimeout(done, 1));
} }"""


@pytest.mark.slow
def test_moves_leave_no_nodes_and_no_listeners_behind(screen):
    def moved(count: int) -> Kept:
        screen.evaluate(_MOVES, count)
        until(screen, f"document.body.dataset.solved === location.hash && {SOLVED}")
        return Kept.of(screen)

    # The first moves make what stays: charts, and rows of the tables.
    before, after = moved(20), moved(200)
    assert after.nodes <= before.nodes + 5
    assert after.listeners == before.listeners
    assert after.documents == before.documents


@pytest.mark.slow
def test_designs_with_other_driving_pressures_leave_no_charts_behind(screen):
    """Each design has four charts of its own, of five listeners each; those of the designs before are let go.

    A browser may keep the last ones for a while, and figures that came late are left out: so much is allowed, once.
    """

    def opened(name: str) -> Kept:
        screen.evaluate(f"location.hash = '#{name}'")
        until(screen, f"document.body.dataset.solved === '#{name}' && {SOLVED}")
        return Kept.of(screen)

    opened("soft-pad")
    before = opened("paper-dome")
    for _ in range(3):
        opened("soft-pad")
        after = opened("paper-dome")
    assert after.listeners <= before.listeners + 20
    assert after.nodes <= before.nodes + 250
