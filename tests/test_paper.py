"""The paper: what it cites is in its list with a place to find it, its figures are made, and its numbers are stored ones."""

from __future__ import annotations

import re

from benchmarks.store import stored

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


def test_numbers_are_the_stored_ones():
    contact, words = stored("paper")["contact"], " ".join(TEXT.split())
    twelve = contact["median_of_twelve"]
    assert f"is {100 * twelve['variational']:.0f} % for a variational" in words
    assert f"and {100 * twelve['solid']:.1f} % for the finite elements" in words
    every, relaxed = (contact[f"median_of_{count}"]["solid"] for count in ("fourteen", "ten"))
    assert f"is {100 * every:.0f} % (fourteen cells)" in words and f"it is {100 * relaxed:.1f} % (ten cells)" in words
    for name in ("README.md", "docs/background/limits.md"):
        assert re.search(rf"{100 * every:.0f} %( for all|\. The other two)", (ROOT / name).read_text()), name
    errors = [100 * cell["errors"]["solid"] for cell in contact["cells"] if cell["material"] == "FLX9995-DM"]
    assert "off by {:.0f} % and {:.0f} %".format(*errors) in words
    for limit in stored("validation")["calculix"].values():
        assert f"{limit:.3f} kPa" in words
