"""Pieces of Markdown."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table; columns that are empty in every row are left out."""
    filled = [list(row) for row in rows]
    kept = [k for k in range(len(head)) if any(row[k] for row in filled)]
    lines = [[head[k] for k in kept], ["---"] * len(kept), *([cell(row[k]) for k in kept] for row in filled)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def cell(text: str) -> str:
    """A text on one line, its bars escaped."""
    return " ".join(text.split()).replace("\\|", "|").replace("|", "\\|")


def code(text: str) -> str:
    """A text as code; nothing where there is none."""
    return f"`{text}`" if text else ""


def plain(text: str) -> str:
    """A text of the program whose brackets, stars and angle brackets are no markup."""
    for mark in ("[", "]", "<", ">", "*", "$"):
        text = text.replace(mark, f"\\{mark}")
    return text


def page(title: str, intro: str, *sections: str) -> str:
    """A page of sections."""
    return "\n\n".join([f"# {title}", intro, *sections]) + "\n"
