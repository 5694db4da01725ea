"""A link whose text is a file name, as it reads best in an editor, shows the title of its page on the site."""

from __future__ import annotations

import re
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any

from docutils import nodes

if TYPE_CHECKING:
    from sphinx.application import Sphinx

_FILE = re.compile(r"[\w/-]+\.md")


def name_pages(app: Sphinx, doctree: nodes.document, docname: str) -> None:
    """Replace file names by titles."""
    for link in doctree.findall(nodes.reference):
        if link.get("internal") and _FILE.fullmatch(link.astext()):
            title = _title(app, docname, link.get("refuri", ""))
            if title is not None:
                link.children = [nodes.emphasis("", title)]


def _title(app: Sphinx, docname: str, address: str) -> str | None:
    """The title of the page that an address, relative to a page, leads to."""
    parts: list[str] = []
    for part in (PurePosixPath(docname).parent / address.partition("#")[0]).parts:
        if part == "..":
            parts.pop()
        else:
            parts.append(part)
    target = app.env.titles.get("/".join(parts).removesuffix(".html"))
    return None if target is None else target.astext()


def setup(app: Sphinx) -> dict[str, Any]:
    """Called by Sphinx."""
    app.connect("doctree-resolved", name_pages)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
