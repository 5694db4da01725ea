"""A browser that opens a page, told what to do over its pipes: no package beside the browser itself."""

from __future__ import annotations

import base64
import json
import os
import shutil
import subprocess
from contextlib import contextmanager
from pathlib import Path
from typing import Any

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
FOUND = next((path for name in NAMES if (path := shutil.which(name))), None)
WHY_NOT = "no Chromium on this machine: the page was not looked at in a browser"

WITH_WEBGL = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")
WITHOUT_WEBGL = ("--disable-gpu", "--disable-3d-apis")


class Browser:
    """A running browser with one page."""

    def __init__(self, send: int, receive: int) -> None:
        self._send, self._receive, self._kept, self._number = send, receive, b"", 0
        self.errors: list[str] = []
        self.requested: list[str] = []
        target = self._call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self._call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **words: Any) -> dict[str, Any]:
        """A command of the DevTools protocol to the page."""
        return self._call(method, self._session, **words)

    def show(self, path: Path, width: int) -> None:
        """Open a file in a window of a width in pixels."""
        self.visit(path.resolve().as_uri(), width)

    def visit(self, address: str, width: int) -> None:
        """Open an address in a window of a width in pixels; errors and requests are counted from there on."""
        self.errors.clear()
        self.requested.clear()
        self.call(
            "Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 600
        )
        self.call("Page.navigate", url=address)
        self.evaluate(
            "new Promise(done => { const wait = () => document.readyState === 'complete' "
            "? document.fonts.ready.then(() => done(1)) : setTimeout(wait, 20); wait(); })"
        )

    def evaluate(self, script: str) -> Any:
        """The value of a script in the page."""
        words = {"expression": script, "returnByValue": True, "awaitPromise": True}
        done = self.call("Runtime.evaluate", **words)
        assert "exceptionDetails" not in done, done
        return done["result"].get("value")

    def picture(self, top: int = 0, height: int = 4000) -> bytes:
        """PNG of a part of the page: a browser without a graphics card draws no more than some thousand lines at once."""
        width = self.evaluate("innerWidth")
        clip = {"x": 0, "y": top, "width": width, "height": height, "scale": 1}
        words = {"format": "png", "captureBeyondViewport": True, "clip": clip}
        return base64.b64decode(self.call("Page.captureScreenshot", **words)["data"])

    def printed(self) -> bytes:
        """The page as it is printed, PDF."""
        words = {"preferCSSPageSize": True, "printBackground": False}
        return base64.b64decode(self.call("Page.printToPDF", **words)["data"])

    def _call(self, method: str, session: str = "", **words: Any) -> dict[str, Any]:
        self._number += 1
        message = {"id": self._number, "method": method, "params": words} | ({"sessionId": session} if session else {})
        os.write(self._send, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._next()
            if answer.get("id") == self._number:
                assert "error" not in answer, answer
                return answer["result"]
            self._note(answer.get("method"), answer.get("params", {}))

    def _note(self, event: str | None, content: dict[str, Any]) -> None:
        if event == "Network.requestWillBeSent":
            self.requested.append(content["request"]["url"])
        elif event == "Runtime.exceptionThrown":
            self.errors.append(json.dumps(content))

    def _next(self) -> dict[str, Any]:
        while b"\0" not in self._kept:
            part = os.read(self._receive, 1 << 16)
            assert part, "the browser ended"
            self._kept += part
        message, _, self._kept = self._kept.partition(b"\0")
        return json.loads(message)


@contextmanager
def browser(folder: Path, *options: str):
    """A browser with its files in ``folder``; it ends with the block."""
    assert FOUND is not None
    theirs_in, send = os.pipe()
    receive, theirs_out = os.pipe()
    # The browser reads its commands from file 3 and answers on file 4.
    shell = f'exec "$0" "$@" 3<&{theirs_in} 4>&{theirs_out}'
    words = [FOUND, "--headless", "--no-sandbox", "--remote-debugging-pipe", "--hide-scrollbars", "--no-first-run"]
    words += ["--disable-dev-shm-usage", f"--user-data-dir={folder}", *options]
    with (folder / "log").open("w") as log:
        running = subprocess.Popen(
            ["bash", "-c", shell, *words], pass_fds=(theirs_in, theirs_out), stdout=log, stderr=log
        )
    os.close(theirs_in)
    os.close(theirs_out)
    try:
        yield Browser(send, receive)
    finally:
        os.close(send)
        os.close(receive)
        running.terminate()
        running.wait(30)
