"""``pneutouch show``: what a 3MF holds."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pneutouch.cli.app import JsonOption, app, print_json, reporting


@app.command()
def show(
    file: Annotated[Path, typer.Argument(metavar="FILE.3mf", help="A 3MF, ours or not.")], json: JsonOption = False
) -> None:
    """Show a 3MF: its bodies, its metadata and the recipe it was built from."""
    with reporting():
        from pneutouch.pipeline.show import show as run

        document = run(file)
        if json:
            print_json(document)
        else:
            from pneutouch.cli.show_text import show_text

            typer.echo(show_text(document))
