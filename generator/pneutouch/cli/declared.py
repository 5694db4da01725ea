"""Options of a command made from the declared fields of a file, so that unit, type and help stand in one place.

Options of the commands that read measured files, and the text on how they read them.
"""

import inspect
import types
import typing
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer
from pydantic import BaseModel

from pneutouch.cli.complete import names
from pneutouch.errors import PneutouchError
from pneutouch.spec.fields import Declaration, declaration, table_of

if TYPE_CHECKING:
    from pneutouch.results.measured import ReadFiles


class FieldOption(NamedTuple):
    """The field ``table.key`` behind an option; ``parse`` where the option is a text in its own form, ``metavar``."""

    table: str
    key: str
    parse: Callable[[str], Any] | None = None
    metavar: str | None = None


def with_fields(model: type[BaseModel], options: Mapping[str, FieldOption]) -> Callable[[Callable[..., None]], Any]:
    """Give a command an option for each field, after its arguments; it takes them as keywords, None if left out."""

    def decorate(command: Callable[..., None]) -> Callable[..., None]:
        hints = typing.get_type_hints(command, include_extras=True)
        written = [p.replace(annotation=hints[p.name]) for p in inspect.signature(command).parameters.values()]
        made = [_parameter(model, name, option) for name, option in options.items()]
        arguments = [p for p in written if "ArgumentInfo" in str(p.annotation) or p.annotation is typer.Context]
        others = [p for p in written if p not in arguments and p.kind is not inspect.Parameter.VAR_KEYWORD]
        command.__signature__ = inspect.Signature([*arguments, *made, *others])  # type: ignore[attr-defined]
        return command

    return decorate


def field_tables(options: Mapping[str, FieldOption], values: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Tables of a file that holds the options given. Raises InputError if a text is not of its form."""
    tables: dict[str, dict[str, Any]] = {}
    for name, value in values.items():
        if value is not None:
            table, key, parse, _ = options[name]
            if isinstance(value, list):
                # Names with commas between, as everywhere; the option may be repeated as well.
                value = [word.strip() for text in value for word in str(text).split(",") if word.strip()]
            tables.setdefault(table, {})[key] = parse(value) if parse else value
    return tables


@contextmanager
def named_by_flag(given: Mapping[str, str], where: str, *, alone: bool) -> Iterator[None]:
    """Name the option, and no file, in an error about a field of ``where`` that was given as one.

    ``given``: the options' parameters by ``table.key``. Where they are ``alone``, ``where`` is no file, and is
    not named.
    """
    try:
        yield
    except PneutouchError as error:
        for each in (error, *error.others):
            keys = ((each.key or "").partition("[")[0], *each.fields)
            parameter = next((given[key] for key in keys if key in given), None)
            if each.file in (None, where) and parameter is not None:
                each.file, each.key = None, parameter
            elif alone and each.file == where:
                each.file = None
        raise


def _parameter(model: type[BaseModel], name: str, option: FieldOption) -> inspect.Parameter:
    table = table_of(model, option.table)
    assert table is not None
    field = declaration(table, option.key)
    kind: Any = str if option.parse else _kind(table, option.key)
    flags = [f"--{name.replace('_', '-')}"] if kind is bool else []
    known = names(field.registry, listed=kind is not str) if field.registry else None
    info = typer.Option(*flags, metavar=option.metavar, help=_help(field), autocompletion=known)
    annotation: Any = Annotated[kind | None, info]
    return inspect.Parameter(name, inspect.Parameter.POSITIONAL_OR_KEYWORD, default=None, annotation=annotation)


def _kind(table: type[BaseModel], key: str) -> Any:
    """The type of a field without None and without its bounds."""
    annotation = table.model_fields[key].annotation
    if typing.get_origin(annotation) in (typing.Union, types.UnionType):
        (annotation,) = (kind for kind in typing.get_args(annotation) if kind is not types.NoneType)
    return typing.get_args(annotation)[0] if typing.get_origin(annotation) is Annotated else annotation


def _help(field: Declaration) -> str:
    return (
        f"{field.help.removesuffix('.')}, {field.unit}." if field.unit and field.unit not in field.help else field.help
    )


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


def reading_text(read_as: "Iterable[ReadFiles]") -> str:
    """Notes on the columns and formats that were guessed from the files, with lines for campaign.toml to keep them."""
    from pneutouch.workflows.characterize.load import reading_text as text

    return text(read_as)
