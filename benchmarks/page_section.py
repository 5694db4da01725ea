"""One section of a page of docs/, written anew by the benchmark that computes it."""

from __future__ import annotations

from pathlib import Path


def replace_section(page: Path, lines: list[str]) -> None:
    """Replace the section that begins with the first of ``lines``, a heading of the second level, to the next one.

    Raises ValueError where the page has no such heading.
    """
    before, heading, after = page.read_text(encoding="utf-8").partition(lines[0] + "\n")
    if not heading:
        raise ValueError(f"{page} has no heading {lines[0]!r}")
    _, mark, rest = after.partition("\n## ")
    page.write_text(before + "\n".join(lines) + mark + rest, encoding="utf-8")
