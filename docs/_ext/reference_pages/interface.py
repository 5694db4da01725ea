"""The page of every public name of the package, from its documentation in the code."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any

import pneutouch
from pneutouch.api.fields import keywords
from pneutouch.schemas import document_kinds
from pneutouch.spec.design import DesignFile
from pneutouch.spec.target import Target
from reference_pages import markdown
from reference_pages.documents import HEAD, resolved, row
from reference_pages.markdown import code, table

if TYPE_CHECKING:
    from docutils.nodes import Element, Node, TextElement
    from pydantic import BaseModel
    from sphinx.application import Sphinx
    from sphinx.environment import BuildEnvironment

NAMES = [name for name in pneutouch.__all__ if name != "__version__"]

_INTRO = (
    "Every public name of `import pneutouch as pt`, from its documentation in the code. How they are used together is "
    "on [The Python interface](../python.md). `pneutouch.__version__` is the version as text."
)

_FIELDS: dict[str, tuple[str, type[BaseModel]]] = {"Design": ("design", DesignFile), "select": ("target", Target)}
"""Names whose keyword arguments are the fields of a file: its kind and its model."""

_SIGNATURES = {"Design": '(name="design", **fields)'}
"""Of what the code gives a signature with every field."""


def page() -> str:
    """The page: an overview, then classes, functions and errors."""
    groups: dict[str, list[str]] = {"Classes": [], "Functions": [], "Errors": []}
    for name in NAMES:
        groups[_group(name)].append(name)
    listed = "\n".join(f"   pneutouch.{name}" for name in NAMES)
    overview = f"```{{eval-rst}}\n.. autosummary::\n   :nosignatures:\n\n{listed}\n```"
    parts = ["\n\n".join([f"## {group}", *map(entry, names)]) for group, names in groups.items()]
    return markdown.page("The Python interface, name by name", _INTRO, overview, *parts)


def entry(name: str) -> str:
    """A name with its documentation, and with the fields that it takes."""
    what = getattr(pneutouch, name)
    kind = "autofunction"
    if inspect.isclass(what):
        kind = "autoexception" if issubclass(what, Exception) else "autoclass"
    members = "" if kind == "autofunction" else "\n   :members:"
    parts = [f"### {name}", f"```{{eval-rst}}\n.. {kind}:: pneutouch.{name}{_SIGNATURES.get(name, '')}{members}\n```"]
    if name in _FIELDS:
        parts += [f"Keyword arguments of `{name}`:", fields(*_FIELDS[name])]
    return "\n\n".join(parts)


def fields(kind: str, model: type[BaseModel]) -> str:
    """The keyword arguments that stand for the fields of a file, each with its declaration."""
    schema, rows = document_kinds()[kind].make(), []
    for keyword, path in keywords(model).items():
        field: Any = schema
        for key in path.split("."):
            field = resolved(field, schema)["properties"][key]
        _, *declared = row(keyword, field, schema, required=False)
        rows.append((code(keyword), code(path), *declared))
    return table(("keyword", "field", *HEAD[1:]), rows)


def public_reference(app: Sphinx, env: BuildEnvironment, node: Element, text: TextElement) -> Node | None:
    """Lead a type that the code imports from where it is written to the public name that this page documents."""
    home, _, name = str(node.get("reftarget", "")).rpartition(".")
    if node.get("refdomain") != "py" or name not in NAMES or not home.startswith("pneutouch."):
        return None
    domain: Any = env.get_domain("py")
    return domain.resolve_xref(env, node["refdoc"], app.builder, "obj", f"pneutouch.{name}", node, text)


def _group(name: str) -> str:
    what = getattr(pneutouch, name)
    if not inspect.isclass(what):
        return "Functions"
    return "Errors" if issubclass(what, Exception) else "Classes"
