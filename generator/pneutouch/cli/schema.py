"""``pneutouch schema``: JSON schemas of the files that are read and of the documents that are written."""

from typing import Annotated

from pneutouch.cli.app import JsonOption, app, print_json
from pneutouch.cli.complete import parameters_of
from pneutouch.cli.terminal import echo, report_next, table_text

parameter = parameters_of(__file__)


def known(incomplete: str) -> list[str]:
    """Completions of the name of a kind of document."""
    from pneutouch.schemas import document_kinds as known

    return [name for name in known() if name.startswith(incomplete)]


@app.command()
def schema(
    name: Annotated[str | None, parameter("name", autocompletion=known)] = None, json: JsonOption = False
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
