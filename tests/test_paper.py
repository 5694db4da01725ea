"""The paper: what it cites is in its list with a place to find it, its figures are made, and its numbers are stored ones."""

from __future__ import annotations

import re

from tests.conftest import ROOT

TEXT = (ROOT / "paper/paper.md").read_text()
LIST = (ROOT / "paper/paper.bib").read_text()


def test_what_is_cited_is_listed_and_what_is_listed_is_cited():
    cited = set(re.findall(r"@([a-z]+\d*)", TEXT))
    assert cited == set(re.findall(r"^@\w+\{(\w+),", LIST, re.M))
    assert all(re.search(r"^  (doi|url) = ", entry, re.M) for entry in LIST.split("\n\n"))


def test_every_figure_is_one_that_the_repository_makes():
    made = re.findall(r'PAPER / "([\w-]+\.png)"', (ROOT / "release/paper.py").read_text())
    assert re.findall(r"\]\(([\w-]+\.png)\)", TEXT) == made


def test_numbers_are_those_of_the_pages():
    accuracy = (ROOT / "docs/background/accuracy.md").read_text()
    validation = (ROOT / "docs/background/validation.md").read_text()
    solid, variational = re.search(r"solid \*\*([\d.]+)%\*\*, membrane variational (\d+)%", accuracy).groups()
    assert f"is {variational} % for a variational" in TEXT and f"and {solid} % for the finite elements" in TEXT
    every, relaxed = re.search(r"all fourteen cells is (\d+)%, and that of the ten .*? ([\d.]+)%\.", accuracy).groups()
    words = " ".join(TEXT.split())
    assert f"is {every} % (fourteen cells)" in words and f"it is {relaxed} % (ten cells)" in words
    for name in ("README.md", "docs/background/limits.md"):
        assert re.search(rf"{every} %( for all|\. The other two)", (ROOT / name).read_text()), name
    errors = re.findall(r"^\| FLX9995-DM \|.*?\*?\| [\d.]+ \| \+(\d+)% \|", accuracy, re.M)[:2]
    assert "off by {} % and {} %".format(*errors) in " ".join(TEXT.split())
    for number in re.search(r"converges: ([\d.]+) kPa, against ([\d.]+) kPa here", validation).groups():
        assert f"{number} kPa" in TEXT
