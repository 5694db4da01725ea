"""Sheets as HTML pages and PDFs, and texts in Markdown: Jinja fills the templates, Typst sets the PDF."""

import base64
import datetime
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.export import templates
from pneutouch.parts.lettering.glyphs import FONTS
from pneutouch.report.blocks import Sheet, View, found
from pneutouch.stopping import temporary_folder
from pneutouch.wording import markdown_escaped

TEMPLATES = Path(__file__).parent / "templates"

_UNDATED = datetime.datetime(2026, 1, 1, tzinfo=datetime.UTC)
"""Creation time in the PDF of an undated sheet: the clock must not change the bytes."""


def set_sheet(sheet: Sheet, name: str) -> dict[str, bytes]:
    """``NAME.html`` and ``NAME.pdf`` by file name; the same sheet gives the same bytes."""
    return {f"{name}.html": html(sheet).encode(), f"{name}.pdf": pdf(sheet)}


def html(sheet: Sheet) -> str:
    """The sheet as a page that loads nothing: its fonts, figures and pictures are part of it."""
    from markupsafe import Markup

    seen: set[str] = set()

    def encoded(data: bytes) -> str:
        return base64.b64encode(data).decode()

    def figure(text: str) -> Markup:
        """SVG of a figure, without definitions that an earlier figure has."""
        return Markup(without_repeats(text, seen))

    fonts = {name: encoded((FONTS / f"Inter-{name}.otf").read_bytes()) for name in ("Regular", "SemiBold")}
    return _filled(
        "sheet.html.j2", sheet, None, figure=figure, encoded=encoded, fonts=fonts, turns=bool(found(sheet.blocks, View))
    )


def without_repeats(text: str, seen: set[str]) -> str:
    """An SVG figure without definitions (mostly glyphs) that are in ``seen``; new ones are added to ``seen``."""

    def once(match: re.Match[str]) -> str:
        if match[0] in seen:
            return ""
        seen.add(match[0])
        return match[0]

    return _DEFINITION.sub(once, _GROUP.sub("<g>", text))


_DEFINITION = re.compile(r'<(path|clipPath|pattern) id="[^"]+"(?:[^>]*/>|.*?</\1>)', re.DOTALL)
_GROUP = re.compile(r'<g id="[^"]+">')
"""Start of a group with its name: groups are named alike in every figure, and nothing refers to them."""


def source(sheet: Sheet) -> dict[str, bytes]:
    """Files that the PDF is set from: ``sheet.typ``, and the figures and pictures that it names."""
    from markupsafe import Markup

    files: dict[str, bytes] = {}

    def stored(data: str | bytes) -> str:
        """Name of a new file that holds a figure or a picture."""
        name = f"figure-{len(files) + 1}.{'svg' if isinstance(data, str) else 'png'}"
        files[name] = data.encode() if isinstance(data, str) else data
        return name

    def literal(value: Any) -> Any:
        """A text as a string literal of Typst, so that no text from outside is read as Typst code."""
        if isinstance(value, Markup | int | float):
            return value
        text = "".join(letter if letter >= " " or letter == "\n" else " " for letter in str(value))
        return Markup(json.dumps(text, ensure_ascii=False))

    text = _filled("sheet.typ.j2", sheet, literal, stored=stored)
    return {"sheet.typ": text.encode(), **files}


def pdf(sheet: Sheet) -> bytes:
    """The sheet as a PDF, set by Typst, a compiler in a Python wheel: it needs no system packages, no system fonts."""
    import typst

    date = sheet.date
    created = datetime.datetime(date.year, date.month, date.day, tzinfo=datetime.UTC) if date else _UNDATED
    with temporary_folder() as root:
        for name, data in source(sheet).items():
            (root / name).write_bytes(data)
        return bytes(
            typst.compile(
                root / "sheet.typ", root=root, font_paths=[FONTS], ignore_system_fonts=True, timestamp=created
            )
        )


def _filled(template: str, sheet: Sheet, finalize: Callable[[Any], Any] | None, **more: Any) -> str:
    environment = templates(TEMPLATES, autoescape=True, finalize=finalize)
    environment.filters["kind"] = lambda block: type(block).__name__
    return environment.get_template(template).render(sheet=sheet, **more)


def filled(template: str, **values: Any) -> str:
    """A Markdown template filled with ``values``; filters format numbers, times and lists, and escape Markdown."""
    environment = templates(TEMPLATES, autoescape=False)
    environment.filters |= {"f": format, "md": markdown_escaped, "time": _time}
    environment.filters["listed"] = lambda values: ", ".join(f"{value:g}" for value in values)
    environment.filters["size"] = lambda body: " x ".join(f"{length:.1f}" for length in np.ptp(body.bounds, axis=0))
    environment.filters["value"] = lambda value: "–" if value is None else f"{value:.2f}"
    return environment.get_template(template).render(**values).rstrip() + "\n"


def _time(seconds: float) -> str:
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.1f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"
