"""``pneutouch show``: what a 3MF or a voxel stack holds."""

from pathlib import Path
from typing import Annotated

import typer

from pneutouch.cli.app import JsonOption, app, print_json, refuse_flags, reporting
from pneutouch.cli.terminal import echo


@app.command()
def show(
    context: typer.Context,
    file: Annotated[
        Path, typer.Argument(metavar="FILE.3mf", help="A 3MF, ours or not; or the folder of a voxel stack.")
    ],
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE.png", help="Picture of a voxel stack's sections.")
    ] = None,
    json: JsonOption = False,
) -> None:
    """Show a 3MF: its bodies, its metadata and the recipe it was built from. Of a voxel stack: what lies in it."""
    with reporting():
        if file.is_dir() and file.suffix.lower() != ".3mf":
            from pneutouch.cli.show_text import stack_text as text
            from pneutouch.workflows.show.voxels import show_stack

            document = show_stack(file, out)
        else:
            from pneutouch.cli.show_text import show_text as text
            from pneutouch.workflows.show.package import show as run

            refuse_flags(context, {"out": "--out"}, "a 3MF, which has no sections", str(file))
            document = run(file)
        if json:
            print_json(document)
        else:
            echo(text(document))
