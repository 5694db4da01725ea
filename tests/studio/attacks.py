"""Attacks on the studio by single requests, and what each gets. docs/howto/studio.md has them as a table."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from typing import NamedTuple

from pneutouch.studio.guard import FILES, KEY, LARGEST_BODY
from tests.studio.raw import request
from tests.studio.served import Studio


class Attack(NamedTuple):
    """What is sent, in words and as requests to a studio, and the statuses that answer; None: closed without an answer."""

    what: str
    gets: tuple[int | None, ...]
    requests: Callable[[Studio], Iterable[bytes]]

    def row(self) -> str:
        """Its row of the table."""
        answers = " or ".join("no answer" if each is None else str(each) for each in self.gets)
        return f"| {self.what} | {answers} |"


_ASK = b"POST /api/quick"
_CLOSED = ("/api/form", "/api/form/target", "/api/jobs", "/api/jobs/1", "/vendor/versions.json", "/nothing")
_HOSTS = (
    "example.org",
    "{host}.example.org:{port}",
    "127.0.0.1.nip.io:{port}",
    "rebind.example.org:{port}",
    "127.0.0.1",
    "127.0.0.1:80",
    "127.1:{port}",
    "2130706433:{port}",
    "0.0.0.0:{port}",
    "[::1]:{port}",
    "[::ffff:127.0.0.1]:{port}",
    "LOCALHOST:{port}",
    "localhost.:{port}",
    "user@127.0.0.1:{port}",
    "127.0.0.1:{port}, example.org",
    "",
)
_ORIGINS = (
    None,
    "null",
    "",
    "http://example.org",
    "http://127.0.0.1",
    "http://127.0.0.1:1",
    "http://[::1]:{port}",
    "https://127.0.0.1:{port}",
)
_TYPES = (
    None,
    "",
    "text/plain",
    "text/plain; charset=application/json",
    "application/x-www-form-urlencoded",
    "multipart/form-data; boundary=x",
)
_PATHS = (
    b"/../../../../etc/passwd",
    b"/vendor/../../server.py",
    b"/%2e%2e/%2e%2e/%2e%2e/etc/passwd",
    b"/..%2f..%2f..%2fetc%2fpasswd",
    b"/%252e%252e/etc/passwd",
    b"//etc/passwd",
    b"///etc/passwd",
    b"/..\\..\\etc\\passwd",
    b"/..%5c..%5cetc%5cpasswd",
    b"/C:/Windows/win.ini",
    b"/studio.js%00.html",
    b"/%ff%c0%ae%c0%ae/etc/passwd",
    b"/vendor/versions.json",
    b"/static/index.html",
    b"/files/1/..%2f..%2fetc%2fpasswd",
    b"/files/%2e%2e.zip",
    b"/api/jobs/" + b"9" * 5000,
    b"http://example.org/",
    b"file:///etc/passwd",
)


def _design(**values: str) -> bytes:
    return json.dumps(
        {"base": "paper-dome", "values": {key.replace("__", "."): text for key, text in values.items()}}
    ).encode()


def _wall(text: str) -> bytes:
    return _design(membrane__wall_thickness_mm=text)


_NO_QUESTIONS = (
    b"",
    b"\xff\xfe",
    b"[" * 20000,
    b'{"a":' * 10000,
    b'{"base": "paper-dome", "values": ' + b"[" * 30000,
    b"9" * 60000,
    b"NaN",
    b"[]",
    b'{"base": 1, "values": {}}',
    b'{"base": "paper-dome", "values": {}, "path": "/etc/passwd"}',
    b'{"base": "paper-dome", "values": {"membrane.inner_radius_mm": 1e999}}',
    b'{"base": "\\ud800", "values": {}}',
    b'{"base": "paper-dome", "values": {"membrane.\\ud800": "1"}}',
    json.dumps({"base": "paper-dome", "values": {f"a{number}.b": "1" for number in range(201)}}).encode(),
)
_VALUES = (
    *(_wall(text) for text in ("nan", "inf", "1e999", "1e-320", "-0.0", "9" * 3999, "9" * 5000, "0x" + "f" * 3000)),
    _wall("[" * 3900),
    _wall('1.4\n[print]\nprofile="x"'),
    _design(indentation__steps="999999999"),
    _design(pneumatics__driving_pressures_kPa="[" + "1," * 1900 + "1]"),
    _design(pneumatics__driving_pressures_kPa="[" * 1900 + "]" * 1900),
    _design(membrane____class__="1"),
    _design(__proto__="1"),
    _design(nothing__known="1"),
    b'{"base": "../../etc/passwd", "values": {}}',
    b'{"base": "/etc/passwd", "values": {}}',
    b'{"base": "paper-dome\\u0000", "values": {}}',
    _design(calibration="/etc/passwd"),
    _design(calibration='"a\\u0000b"'),
    _design(print__profile='"../../../etc/passwd"'),
    _design(membrane__material='"/dev/zero"'),
)
_LARGE = b'{"base": "' + b"x" * LARGEST_BODY + b'"}'


def _chunked(studio: Studio, *sizes: bytes, **changed: str | None) -> bytes:
    heads = {"Content_Length": None, "Transfer_Encoding": "chunked", **changed}
    head = request(studio, _ASK, **heads)
    return head + b"".join(sizes)


def _hosts(studio: Studio) -> Iterable[bytes]:
    return (request(studio, Host=each.format(host="127.0.0.1", port=studio.port)) for each in _HOSTS)


def _origins(studio: Studio) -> Iterable[bytes]:
    named = (each and each.format(port=studio.port) for each in _ORIGINS)
    return (request(studio, _ASK, _wall("-1"), Origin=each) for each in named)


ATTACKS = (
    Attack("no key", (403,), lambda to: [request(to, b"GET " + path.encode(), **{KEY: None}) for path in _CLOSED]),
    Attack(
        "a wrong key",
        (403,),
        lambda to: [request(to, b"GET /api/form", **{KEY: each}) for each in (f"{to.key}x", to.key[1:], to.token, "")],
    ),
    Attack(
        "the key as a cookie, or in the address",
        (403,),
        lambda to: [
            request(to, b"GET /api/form", **{KEY: None, "Cookie": f"{KEY}={to.key}"}),
            request(to, f"GET /api/form?{KEY}={to.key}&key={to.key}".encode(), **{KEY: None}),
        ],
    ),
    Attack(
        "a wrong token, none, or one that was used",
        (403,),
        lambda to: [request(to, b"POST /api/open", **{KEY: each}) for each in ("wrong", "", "\xff", to.token, None)],
    ),
    Attack(
        "the files of a job by a wrong ticket",
        (404,),
        lambda to: [
            request(to, f"GET {FILES}{each}".encode(), **{KEY: None})
            for each in ("x/a.txt", "1.zip", "1/a.txt", "/", "")
        ],
    ),
    Attack(
        "a request that a browser makes for a page of another port or site",
        (403,),
        lambda to: [
            request(to, b"GET " + path, **{"Sec-Fetch-Site": each})
            for path in (b"/api/form", FILES.encode() + b"1.zip")
            for each in ("same-site", "cross-site")
        ],
    ),
    Attack("another Host: rebound names, other ports, other writings of the address", (403,), _hosts),
    Attack("no Host, or two", (400,), lambda to: [request(to, Host=None), request(to, host="example.org")]),
    Attack("a request without Origin, or of another page", (403,), _origins),
    Attack(
        "a request as text, a form or nothing",
        (415,),
        lambda to: [request(to, _ASK, _wall("-1"), Content_Type=each) for each in _TYPES],
    ),
    Attack(
        "other methods: PUT, DELETE, TRACE, OPTIONS, CONNECT",
        (405,),
        lambda to: [
            request(to, each + b" /api/quick") for each in (b"PUT", b"DELETE", b"TRACE", b"OPTIONS", b"CONNECT")
        ],
    ),
    Attack(
        "paths: `/../`, `%2e%2e`, `//etc/passwd`, `\\`, `%00`, those of a proxy",
        (404,),
        lambda to: [request(to, b"GET " + each) for each in _PATHS],
    ),
    Attack(
        "a path with a NUL or with bytes beyond ASCII",
        (400,),
        lambda to: [request(to, b"GET " + each) for each in (b"/\0/etc/passwd", b"/\xff\xfe")],
    ),
    Attack("a path of 3 MB", (400, 404), lambda to: [request(to, b"GET /" + b"a" * 3_000_000)]),
    Attack("a body of more than 64 kB, whose length is stated", (413,), lambda to: [request(to, _ASK, _LARGE)]),
    Attack(
        "the same in parts",
        (413,),
        lambda to: [_chunked(to, *[b"2000\r\n" + b"x" * 8192 + b"\r\n"] * 20, b"0\r\n\r\n")],
    ),
    Attack(
        "a stated length of 99 MB, and one byte",
        (413,),
        lambda to: [request(to, _ASK, b"x", Content_Length="99999999")],
    ),
    Attack(
        "a stated length of 2 bytes, and 200 kB",
        (422,),
        lambda to: [request(to, _ASK, b"x" * 200_000, Content_Length="2")],
    ),
    Attack(
        "a length that is none, or two lengths",
        (400,),
        lambda to: [
            *(request(to, _ASK, b"{}", Content_Length=each) for each in ("-2", "abc", "9" * 500)),
            request(to, _ASK, b"{}", content_length="3"),
        ],
    ),
    Attack("a part of 2^80 bytes", (None,), lambda to: [_chunked(to, b"fffffffffffffffffff\r\nx")]),
    Attack(
        "a second request inside a body with two lengths",
        (422,),
        lambda to: [_chunked(to, b"2\r\n{}\r\n0\r\n\r\nGET /api/form HTTP/1.1\r\n\r\n", Content_Length="4")],
    ),
    Attack(
        "what is not HTTP",
        (400,),
        lambda to: [b"\x16\x03\x01\x02\x00\x01\x00" + b"\0" * 100, b"\xff" * 1000 + b"\r\n\r\n"],
    ),
    Attack(
        "what is no request of the page: deep, huge or broken JSON, unknown keys",
        (422,),
        lambda to: [request(to, _ASK, each) for each in _NO_QUESTIONS],
    ),
    Attack(
        "values that are no numbers, huge, deep, paths, or of unknown fields",
        (422,),
        lambda to: [request(to, _ASK, each) for each in _VALUES],
    ),
)
