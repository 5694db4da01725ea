"""Pages of the reference that are made from declarations when the site is built; git keeps none of them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from reference_pages import commands, documents, interface, printers, rules

if TYPE_CHECKING:
    from sphinx.application import Sphinx

FOLDER = "reference/generated"


def pages() -> dict[str, str]:
    """Every page and every schema by its path in the folder of generated files."""
    return {
        "commands.md": commands.page(),
        "files.md": documents.page("TOML"),
        "documents.md": documents.page("JSON"),
        "interface.md": interface.page(),
        "printers.md": printers.page(),
        "rules.md": rules.page(),
        **documents.schema_files(),
    }


def write(folder: Path) -> None:
    """Write what differs from the last build, and remove pages and schemas that are none any more."""
    made = pages()
    for path in [*folder.glob("*.md"), *folder.glob("schemas/*")]:
        if path.relative_to(folder).as_posix() not in made:
            path.unlink()
    for name, text in made.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def setup(app: Sphinx) -> dict[str, Any]:
    """Called by Sphinx."""
    app.connect("builder-inited", lambda app: write(Path(app.srcdir) / FOLDER))
    app.connect("missing-reference", interface.public_reference)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
