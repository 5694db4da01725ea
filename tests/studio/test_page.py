"""The files of the page: what they are, that they refer to nothing outside, and how much they weigh."""

from __future__ import annotations

import gzip
import hashlib
import json
import re
from importlib.resources import files

import pytest

STATIC = files("pneutouch.studio") / "static"
OWN = sorted((each for each in STATIC.iterdir() if each.is_file()), key=lambda each: each.name)
VENDOR = STATIC / "vendor"


def test_files_of_others_are_those_that_are_listed():
    listed = json.loads((VENDOR / "versions.json").read_text())["files"]
    there = {each.name for each in VENDOR.iterdir()} - {"versions.json"}
    assert set(listed) == there
    for name, entry in listed.items():
        assert hashlib.sha256((VENDOR / name).read_bytes()).hexdigest() == entry["sha256"], name
        assert entry["licence"] == "MIT"
        assert "MIT" in (VENDOR / f"LICENSE.{entry['package']}").read_text()


@pytest.mark.parametrize("each", OWN, ids=lambda each: each.name)
def test_the_page_refers_to_nothing_outside(each):
    text = each.read_text().replace("http://www.w3.org/2000/svg", "")
    assert not re.findall(r"(?:https?:)?//[\w.]+\.\w+", text)
    referred = re.findall(r'(?:src|href)="([^"#]+)"|from "([^"]+)"', text)
    for path in (one or other for one, other in referred):
        place = path.removeprefix("./").lstrip("/")
        assert (STATIC / place).is_file(), path


def test_no_script_and_no_style_stands_in_the_page():
    page = (STATIC / "index.html").read_text()
    assert re.findall(r"<script[^>]*>([^<]*)</script>", page) == [""]
    assert "<style" not in page
    assert not re.findall(r"\s(?:style|on\w+)=", page)


def test_the_page_is_small(client):
    weight = 0
    for path in (
        "/",
        *(f"/{each.name}" for each in OWN if each.name != "index.html"),
        *(f"/vendor/{each.name}" for each in VENDOR.iterdir() if each.name.endswith(("js", "css"))),
    ):
        answer = client.get(path, headers={"Accept-Encoding": "gzip"})
        assert answer.headers["content-encoding"] == "gzip"
        weight += len(gzip.compress(answer.content, 9))
    assert weight < 1.5e6


def test_files_stay_short():
    assert {each.name for each in OWN if each.read_text().count("\n") > 300} == set()
