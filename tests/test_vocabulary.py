"""The package and its documentation use the words of docs/reference/vocabulary.md; tests/vocabulary.py reads them."""

from __future__ import annotations

import re
from collections import Counter

import pytest

from tests.vocabulary import PACKAGE, VOCABULARY, covered, in_file, in_python, places, read_vocabulary

WORDS = read_vocabulary()


def found_in(source: str) -> list[tuple[int, str]]:
    return [(place.line, place.word) for place in in_python(source, "example.py", WORDS)]


def test_the_table_is_read():
    assert WORDS.text["rung"] == WORDS.names["rung"] == "model; models, cheapest first"
    assert "ground" in WORDS.names and "ground" not in WORDS.text
    assert "found" in WORDS.whole and "found" not in WORDS.text


def test_every_term_stands_once():
    rows = [line for line in VOCABULARY.read_text().partition("## Words not used")[0].splitlines() if line[:1] == "|"]
    terms = Counter(line.strip("|").split("|")[0].strip() for line in rows)
    assert {term for term, count in terms.items() if count > 1} == {"term", "---"}
    assert len(terms) > 100


def test_every_name_in_code_is_in_the_package():
    sources = {path.read_text() for path in PACKAGE.rglob("*.py")}
    known = set(re.findall(r"\w+", " ".join(sources))) | {path.stem for path in PACKAGE.rglob("*.py")}
    table = VOCABULARY.read_text().partition("## Words not used")[0]
    names = {
        name
        for line in table.splitlines()
        if line[:1] == "|"
        for name in re.findall(r"`(\w+)`", line[1:].rsplit("|", 2)[1])
    }
    assert len(names) > 100
    assert not names - known


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ('raise ValueError("nothing was\\nasked for")', [(1, "asked")]),
        ('"""A module.\n\nIt tells the modes.\n"""', [(3, "tells")]),
        ('x = f"model {1}: no rung"', [(1, "rung")]),
        ("x = 1\ny = 2  # the cheapest way", [(2, "way")]),
        ('help = {"not_told_apart": 1}', [(1, "told")]),
        ("def scene_shelves(): pass", [(1, "scene_shelves")]),
        ("class DomeWish: pass", [(1, "DomeWish")]),
        ("class HTTPWay: pass", [(1, "HTTPWay")]),
        ("def f(asked_by): pass", [(1, "asked_by")]),
        ("x.asked = 1", [(1, "asked")]),
        ("f(doubts=1)", [(1, "doubts")]),
        ("import a.room as b", [(1, "room")]),
        ("from a.room import b", [(1, "room")]),
        ("found = 1", [(1, "found")]),
        ("x = own", [(1, "own")]),
        ('"the body\'s own\\nfaces"', [(1, "body's own")]),
    ],
)
def test_a_word_is_seen_wherever_it_stands(source, expected):
    assert found_in(source) == expected


@pytest.mark.parametrize(
    "source",
    [
        '"At room temperature, half\\nway along a one-way valve"',
        "not_found = 1\nclass NotFoundError: pass",
        "# The ground truth of its own faces was found.",
        'x = "always"',
    ],
)
def test_allowed_words_pass(source):
    assert not found_in(source)


def test_templates_pages_and_file_names_are_read(tmp_path):
    for name in ("page.md", "sheet.html.j2", "sheet.typ"):
        path = tmp_path / name
        path.write_text("fine\nThe rung says so.\n")
        assert [(place.line, place.word) for place in in_file(path, WORDS)] == [(2, "rung"), (2, "says")]
    path = tmp_path / "room.py"
    path.write_text("")
    assert [place.word for place in in_file(path, WORDS)] == ["room"]


@pytest.mark.parametrize("part", sorted(covered()))
def test_words_are_those_of_the_vocabulary(part):
    listed = places(covered()[part])
    assert not listed, "\n".join(map(str, listed))
