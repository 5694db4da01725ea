"""``pneutouch schema``: JSON schemas of the files that are read and of the documents that are written."""

from typing import Annotated

import typer

from pneutouch.cli.app import JsonOption, app, print_json
from pneutouch.cli.complete import document_kinds as known
from pneutouch.cli.terminal import echo, report_next, table_text


@app.command()
def schema(
    name: Annotated[
        str | None,
        typer.Argument(
            help="Kind of document, such as design or prediction; left out: all are listed.", autocompletion=known
        ),
    ] = None,
    json: JsonOption = False,
) -> None:
    """Print the JSON schema (draft 2020-12) of a file that is read or of a document that is written."""
    from pneutouch.schemas import document_kinds, schema_of

    if name is not None:
        print_json(schema_of(name))
        return
    kinds = document_kinds()
    if json:
        print_json({key: {"form": kind.form, "title": kind.title, "where": kind.where} for key, kind in kinds.items()})
        return

    rows = [[key, kind.form, kind.title, kind.where.replace("`", "")] for key, kind in kinds.items()]
    echo(table_text(["name", "form", "document", "where"], rows))
    report_next("schema", "design")
