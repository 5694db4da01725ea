"""Options of the commands that read measured files, and the text on how they read them."""

from collections.abc import Mapping, Sequence
from typing import Annotated, Any

import typer

from pneutouch.cli.declared import FieldOption, field_tables

_WORDS = {"comma": ",", "semicolon": ";", "tab": "\t", "\\t": "\t", "space": " ", "point": "."}


def _mark(text: str) -> str:
    return _WORDS.get(text.lower(), text)


READING_FIELDS = {
    "decimal": FieldOption("format", "decimal", _mark, "MARK"),
    "delimiter": FieldOption("format", "delimiter", _mark, "MARK"),
    "encoding": FieldOption("format", "encoding", str, "NAME"),
    "skip_rows": FieldOption("format", "skip_rows"),
    "sheet": FieldOption("format", "sheet"),
}
"""Options of the table [format] of a campaign file."""

ColumnsOption = Annotated[
    list[str] | None,
    typer.Option(
        "--columns",
        metavar="CHANNEL=NAME[:UNIT]",
        help="Columns of time, position, force, pressure, volume, such as force=Load:N; -NAME turns the sign.",
    ),
]


def reading_of(columns: Sequence[str] | None, fields: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """The tables [columns] and [format] that the options state."""
    from pneutouch.workflows.characterize import parse_columns

    return {"columns": parse_columns(columns or []), **field_tables(READING_FIELDS, fields)}


def reading_words(columns: Sequence[str] | None, fields: Mapping[str, Any]) -> list[str]:
    """The options as they were given, for the next command."""
    words = [word for text in columns or () for word in ("--columns", text)]
    for name in READING_FIELDS:
        if fields.get(name) is not None:
            words += [f"--{name.replace('_', '-')}", str(fields[name])]
    return words


def reading_text(read_as: Sequence[Mapping[str, Any]]) -> str:
    """Lines for a campaign file that keep the columns and formats which were found by looking at the files."""
    from pneutouch.workflows.characterize.reading import reading_text as text

    return text(read_as)
