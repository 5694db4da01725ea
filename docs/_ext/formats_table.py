"""The table of file formats in ``reference/generated/formats.txt``, made from their declaration before the site is."""

from __future__ import annotations

from pathlib import Path

from sphinx.application import Sphinx

from pneutouch.formats import FORMATS, format_of


def table() -> str:
    """The formats as a Markdown table."""
    rows = [f"| `{format_of(name)}` | {stored.file} |" for name, stored in sorted(FORMATS.items())]
    return "\n".join(["| format | file |", "| --- | --- |", *rows, ""])


def write(app: Sphinx) -> None:
    """Write the table where the page includes it; the same table is not written again."""
    path = Path(app.srcdir) / "reference" / "generated" / "formats.txt"
    path.parent.mkdir(exist_ok=True)
    if not path.is_file() or path.read_text(encoding="utf-8") != table():
        path.write_text(table(), encoding="utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    """Connect to the start of a build."""
    app.connect("builder-inited", write)
    return {"parallel_read_safe": True}
