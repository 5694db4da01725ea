"""Fills the Markdown templates of docs/templates from stored measurements: ``make pages``.

A template docs/templates/PATH.j2 is Jinja2 and becomes docs/PATH. In it ``stored("NAME")`` is
docs/background/NAME.json, which a module of ``benchmarks`` wrote. ``python docs/_ext/stored_pages.py [PATH ...]``
writes all pages, or some such as ``background/atlas.md``; with ``--check`` it names those that differ and writes none.
"""

from __future__ import annotations

import json
import sys
from functools import cache
from pathlib import Path
from typing import Any

import gauges
from jinja2 import Environment, FileSystemLoader, StrictUndefined

DOCS = Path(__file__).resolve().parents[1]
TEMPLATES = DOCS / "templates"


@cache
def stored(name: str) -> Any:
    """A stored measurement."""
    return json.loads((DOCS / "background" / f"{name}.json").read_text(encoding="utf-8"))


def fixed(value: float | None, digits: int = 2) -> str:
    """A number with so many decimals; a dash for none."""
    return "–" if value is None else f"{value:.{digits}f}"


def short(value: float | None, digits: int = 3) -> str:
    """A number to so many significant digits; a dash for none."""
    return "–" if value is None else f"{value:.{digits}g}"


def percent(value: float | None, digits: int = 0) -> str:
    """A share in percent."""
    return "–" if value is None else f"{100 * value:.{digits}f} %"


def change(value: float | None, digits: int = 0) -> str:
    """A relative change in percent, with its sign."""
    return "–" if value is None else f"{100 * value:+.{digits}f} %"


def hundredths(value: float | None, digits: int = 0) -> str:
    """A share as the bare number of its percent, for columns whose head has the unit."""
    return "–" if value is None else f"{100 * value:.{digits}f}"


def changes(value: float | None, digits: int = 0) -> str:
    """A relative change likewise, with its sign."""
    return "–" if value is None else f"{100 * value:+.{digits}f}"


def rule(count: int) -> str:
    """The line below the head of a table of so many columns."""
    return "|" + "---|" * count


FILTERS = {each.__name__: each for each in (fixed, short, percent, change, hundredths, changes)}


@cache
def environment() -> Environment:
    """Reads templates; a key that a measurement does not have is an error."""
    made = Environment(
        loader=FileSystemLoader(TEMPLATES),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    made.filters.update(FILTERS)
    made.globals.update(stored=stored, rule=rule, gauges=gauges.gauges)
    made.globals.update(gauge_table=gauges.table, gauge_sources=gauges.sources)
    return made


def paths() -> list[str]:
    """Paths of all pages below docs/."""
    return sorted(path.relative_to(TEMPLATES).as_posix().removesuffix(".j2") for path in TEMPLATES.rglob("*.md.j2"))


def render(path: str) -> str:
    """The text of a page."""
    return environment().get_template(f"{path}.j2").render()


def _current(path: str) -> str:
    return (DOCS / path).read_text(encoding="utf-8") if (DOCS / path).is_file() else ""


def main(*words: str) -> int:
    """Write or check pages; the exit code."""
    wanted = [word for word in words if word != "--check"] or paths()
    differ = [path for path in wanted if _current(path) != render(path)]
    for path in differ:
        if "--check" not in words:
            (DOCS / path).write_text(render(path), encoding="utf-8")
        sys.stdout.write(f"{'differs' if '--check' in words else 'wrote'}: docs/{path}\n")
    return 1 if differ and "--check" in words else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
