"""Find words in the package and its documentation that docs/reference/vocabulary.md replaces by others.

Run as ``python tests/vocabulary.py [PATHS...]``; without paths, everything that the test covers. One line for each
place: file, line, word, what to use instead. Exit code 1 where there is one.
"""

from __future__ import annotations

import ast
import io
import re
import sys
import tokenize
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "generator" / "pneutouch"
VOCABULARY = ROOT / "docs" / "reference" / "vocabulary.md"
TEXTS = (".md", ".j2", ".html", ".typ", ".css", ".js")
_HEADING = "## Words not used"
_CAPITALS = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")
_WORDS = re.compile(r"[A-Za-z]+")


class Place(NamedTuple):
    """A word that is not used, where it stands and what replaces it."""

    file: str
    line: int
    word: str
    instead: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.word}: use {self.instead}"


class Vocabulary(NamedTuple):
    """Words (lower case) and what replaces them, by where they are not used; phrases that are allowed."""

    text: dict[str, str]
    names: dict[str, str]
    whole: dict[str, str]
    phrases: re.Pattern[str]

    def in_text(self, text: str, file: str, line: int, last: int | None = None) -> Iterator[Place]:
        """Words in a text whose first line has the number ``line``; ``last`` bounds it where line ends are escaped."""
        text = self.phrases.sub(lambda match: re.sub(r"\S", " ", match[0]), text)
        hits = [(match.start(), match[0]) for match in _WORDS.finditer(text) if match[0].lower() in self.text]
        for phrase in filter(lambda word: " " in word, self.text):
            hits += [(match.start(), phrase) for match in _phrase(phrase).finditer(text)]
        for start, word in sorted(hits):
            at = line + text.count("\n", 0, start)
            yield Place(file, at if last is None else min(at, last), word, self.text[word.lower()])

    def in_name(self, name: str, file: str, line: int) -> Iterator[Place]:
        """Words in an identifier."""
        instead = self.whole.get(name.strip("_").lower())
        if instead is not None:
            yield Place(file, line, name, instead)
            return
        for part in (p for piece in name.split("_") for p in _CAPITALS.split(piece)):
            if part.lower() in self.names:
                yield Place(file, line, name, self.names[part.lower()])


def read_vocabulary(path: Path = VOCABULARY) -> Vocabulary:
    """The second table of the vocabulary and the allowed phrases below it."""
    words, _, phrases = path.read_text().partition(_HEADING)[2].partition("### Phrases allowed")
    places: dict[str, dict[str, str]] = {"text": {}, "names": {}, "whole name": {}}
    for listed, instead, where in (row for row in _rows(words) if len(row) == 3):
        for place in where.split(", "):
            places[place].update({word.lower(): instead for word in listed.split(", ")})
    allowed = "|".join(_phrase(row[0]).pattern for row in _rows(phrases)) or "(?!)"
    return Vocabulary(places["text"], places["names"], places["whole name"], re.compile(allowed, re.IGNORECASE))


def _rows(text: str) -> list[list[str]]:
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line[:1] == "|"]
    return [row for row in cells if set(row[0]) != {"-"} and row[0] not in {"word", "phrase"}]


def _phrase(phrase: str) -> re.Pattern[str]:
    return re.compile(r"\b" + r"\s+".join(map(re.escape, phrase.split())) + r"(?!\w)", re.IGNORECASE)


def in_python(source: str, file: str, vocabulary: Vocabulary) -> Iterator[Place]:
    """Words in comments, strings and identifiers of a module."""
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            yield from vocabulary.in_text(token.string, file, token.start[0])
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield from vocabulary.in_text(node.value, file, node.lineno, node.end_lineno)
        for name in _names(node):
            yield from vocabulary.in_name(name, file, node.lineno)


def _names(node: ast.AST) -> list[str]:
    if isinstance(node, ast.Name):
        return [node.id]
    if isinstance(node, ast.Attribute):
        return [node.attr]
    if isinstance(node, ast.arg | ast.keyword):
        return [node.arg] if node.arg else []
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        return [node.name]
    if isinstance(node, ast.alias):
        return [*node.name.split("."), *([node.asname] if node.asname else [])]
    return node.module.split(".") if isinstance(node, ast.ImportFrom) and node.module else []


def in_file(path: Path, vocabulary: Vocabulary) -> Iterator[Place]:
    """Words in a file and in its name; files that are neither Python nor text have none."""
    file = str(path.relative_to(ROOT)) if path.is_relative_to(ROOT) else str(path)
    yield from vocabulary.in_name(path.stem.split(".")[0].replace("-", "_"), file, 1)
    if path.suffix == ".py":
        yield from in_python(path.read_text(), file, vocabulary)
    elif path.suffix in TEXTS:
        text = path.read_text()
        yield from vocabulary.in_text(text.partition(_HEADING)[0] if path == VOCABULARY else text, file, 1)


def files(path: Path) -> list[Path]:
    """A file, or the files below a folder that are read."""
    if path.is_file():
        return [path]
    return sorted(
        p for p in path.rglob("*") if p.suffix in {".py", *TEXTS} and not {"__pycache__", "vendor"} & set(p.parts)
    )


def covered() -> dict[str, list[Path]]:
    """All files that must be clean, by their top-level part: a folder of the package, a module, ``docs``."""
    parts = {path.name.removesuffix(".py"): files(path) for path in PACKAGE.iterdir() if path.name != "__pycache__"}
    # Generated pages hold words of sources, and what the package states, which is read where it is written.
    pages = sorted(path for path in (ROOT / "docs").rglob("*.md") if "generated" not in path.parts)
    return {**parts, "docs": [*pages, ROOT / "README.md", ROOT / "CONTRIBUTING.md"]}


def places(paths: list[Path]) -> list[Place]:
    """All places in files and folders."""
    vocabulary = read_vocabulary()
    hits = {place for path in paths for file in files(path) for place in in_file(file, vocabulary)}
    return sorted(hits)


def main() -> int:
    """List the places in the paths given on the command line."""
    paths = [Path(text).resolve() for text in sys.argv[1:]] or [path for part in covered().values() for path in part]
    listed = places(paths)
    sys.stdout.writelines(f"{place}\n" for place in listed)
    return int(bool(listed))


if __name__ == "__main__":
    raise SystemExit(main())
