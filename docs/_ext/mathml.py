"""Equations as MathML, which every browser shows: no script is loaded, so they show offline."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from docutils import nodes
from latex2mathml.converter import convert

if TYPE_CHECKING:
    from sphinx.application import Sphinx
    from sphinx.writers.html5 import HTML5Translator

_STOPS = ".,:;)"


def take_stops(app: Sphinx, doctree: nodes.document, docname: str) -> None:
    """Give an equation the stop behind it: a browser would break the line between them."""
    for equation in doctree.findall(nodes.math):
        after = equation.next_node(descend=False, siblings=True)
        if isinstance(after, nodes.Text) and after[:1] in tuple(_STOPS):
            equation["stop"] = after[0]
            after.parent.replace(after, nodes.Text(after[1:]))


def inline(translator: HTML5Translator, node: nodes.math) -> None:
    """An equation in a line."""
    translator.body.append(f'<span class="text-nowrap">{convert(node.astext())}{node.get("stop", "")}</span>')
    raise nodes.SkipNode


def displayed(translator: HTML5Translator, node: nodes.math_block) -> None:
    """An equation of its own; one that is wider than the page scrolls."""
    translator.body.append(f'<div class="equation">{convert(node.astext(), display="block")}</div>\n')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, Any]:
    """Called by Sphinx."""
    app.connect("doctree-resolved", take_stops)
    app.add_html_math_renderer("mathml", (inline, None), (displayed, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
