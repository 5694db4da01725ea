"""docs/reference/vocabulary.md: its terms stand once, its names are in the package, and the words it drops stand nowhere."""

from __future__ import annotations

import re
from collections import Counter

import pytest

from tests.conftest import ROOT

PACKAGE = ROOT / "generator" / "pneutouch"
VOCABULARY = ROOT / "docs" / "reference" / "vocabulary.md"
TERMS, _, DROPPED = VOCABULARY.read_text().partition("## Words not used")
WORDS = [word for line in DROPPED.splitlines() if line[:1] == "|" for word in line.split("|")[1].strip().split(", ")][
    2:
]


def words_in(text: str) -> set[str]:
    """The dropped words in a text, in names with underscores or capitals too; a plural counts."""
    plain = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|_|\s+", " ", text).lower()
    return {word for word in WORDS if re.search(rf"\b{word}(?:s|es)?\b", plain)}


def test_every_term_stands_once():
    terms = Counter(line.strip("|").split("|")[0].strip() for line in TERMS.splitlines() if line[:1] == "|")
    assert {term for term, count in terms.items() if count > 1} == {"term", "---"}
    assert len(terms) > 100


def test_every_name_in_code_is_in_the_package():
    sources = {path.read_text() for path in PACKAGE.rglob("*.py")}
    known = set(re.findall(r"\w+", " ".join(sources))) | {path.stem for path in PACKAGE.rglob("*.py")}
    rows = [line for line in TERMS.splitlines() if line[:1] == "|"]
    names = {name for line in rows for name in re.findall(r"`(\w+)`", line[1:].rsplit("|", 2)[1])}
    assert len(names) > 100
    assert not names - known


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("class DomeWalker: pass", {"walker"}),
        ("scene_rungs = 1", {"rung"}),
        ("All of\nthe told.", {"the told"}),
        ("We told you that it always falls.", set()),
    ],
)
def test_a_dropped_word_is_seen_in_names_and_texts(text, found):
    assert words_in(text) == found


def test_dropped_words_stand_nowhere():
    pages = [path for path in (ROOT / "docs").rglob("*.md") if "generated" not in path.parts and path != VOCABULARY]
    texts_of_sheets = [path for ending in ("j2", "toml") for path in PACKAGE.rglob(f"*.{ending}")]
    paths = [*PACKAGE.rglob("*.py"), *texts_of_sheets, *pages, ROOT / "README.md", ROOT / "CONTRIBUTING.md"]
    texts = {path: f"{path.stem}\n{path.read_text()}" for path in paths}
    found = {str(path.relative_to(ROOT)): words for path, text in texts.items() if (words := words_in(text))}
    assert not found
