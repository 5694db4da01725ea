"""A page and a PDF from the same content and the same figures: Jinja sets the one, Typst the other."""

import base64
import datetime
import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pneutouch.parts.lettering.glyphs import FONTS
from pneutouch.stopping import temporary_folder

TEMPLATES = Path(__file__).parent / "templates"

_UNDATED = datetime.datetime(2026, 1, 1, tzinfo=datetime.UTC)
"""Creation time in the PDF of an undated sheet: the clock must not change the bytes."""


def html(template: str, content: Mapping[str, Any], figures: Mapping[str, str], **more: str) -> str:
    """A page that needs nothing from outside: fonts and figures (SVG by name) stand in it. ``more`` are further
    values."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined
    from markupsafe import Markup

    environment = Environment(
        loader=FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    fonts = {
        name: base64.b64encode((FONTS / f"Inter-{name}.otf").read_bytes()).decode() for name in ("Regular", "SemiBold")
    }
    safe = {name: Markup(text) for name, text in _without_repeats(figures).items()}  # our own SVG
    return environment.get_template(template).render(sheet=content, figures=safe, fonts=fonts, **more)


def _without_repeats(figures: Mapping[str, str]) -> dict[str, str]:
    """Figures for one page: definitions that several share, letters above all, stand in the first alone."""
    seen: set[str] = set()

    def once(match: re.Match[str]) -> str:
        if match[0] in seen:
            return ""
        seen.add(match[0])
        return match[0]

    return {name: _DEFINITION.sub(once, _GROUP.sub("<g>", text)) for name, text in figures.items()}


_DEFINITION = re.compile(r'<(path|clipPath|pattern) id="[^"]+"(?:[^>]*/>|.*?</\1>)', re.DOTALL)
_GROUP = re.compile(r'<g id="[^"]+">')
"""Groups are named alike in every figure, and nothing refers to them."""


def pdf(
    template: str,
    content: Mapping[str, Any],
    figures: Mapping[str, str],
    date: datetime.date | None = None,
    images: Mapping[str, bytes] | None = None,
) -> bytes:
    """Set a PDF with Typst, a compiler in one wheel: no system packages, no system fonts.

    ``content`` becomes sheet.json, ``figures`` SVG files, ``images`` files of their own names next to the template.
    """
    import typst

    created = datetime.datetime(date.year, date.month, date.day, tzinfo=datetime.UTC) if date else _UNDATED
    with temporary_folder() as root:
        (root / template).write_bytes((TEMPLATES / template).read_bytes())
        (root / "sheet.json").write_text(json.dumps(content), encoding="utf-8")
        for name, image in (images or {}).items():
            (root / name).write_bytes(image)
        for name, text in figures.items():
            (root / f"{name}.svg").write_text(text, encoding="utf-8")
        return bytes(
            typst.compile(root / template, root=root, font_paths=[FONTS], ignore_system_fonts=True, timestamp=created)
        )
