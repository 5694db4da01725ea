"""Options of commands, made of fields declared in ``spec/``: there unit, type and help are written once."""

import inspect
import operator
import types
import typing
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache, partial
from typing import Annotated, Any, NamedTuple

import typer
from pydantic import BaseModel

from pneutouch.cli.complete import names, parameters_of
from pneutouch.errors import InputError, PneutouchError
from pneutouch.spec.fields import Declaration, declaration, declarations, entries_of, extra_of, table_of
from pneutouch.spec.options import AnyOptions, Options, flag_of, options_of
from pneutouch.spec.values import plain_number


class FieldOption(NamedTuple):
    """The field ``table.key`` behind an option; ``parse`` turns its text into a value, ``metavar`` shows its form.

    ``table`` is empty for a field of the model itself; ``flag`` None: named as the parameter.
    """

    table: str
    key: str
    parse: Callable[[str], Any] | None = None
    metavar: str | None = None
    flag: str | None = None


def with_fields(model: type[BaseModel], options: Mapping[str, FieldOption]) -> Callable[[Callable[..., None]], Any]:
    """Decorator that gives a command an option for each field, passed as a keyword, None if it is left out."""

    def decorate(command: Callable[..., None]) -> Callable[..., None]:
        """The command, whose signature then has the options."""
        hints = typing.get_type_hints(command, include_extras=True)
        written = [
            p.replace(annotation=hints.get(p.name, p.annotation))
            for p in inspect.signature(command).parameters.values()
        ]
        made = [_parameter(model, name, option) for name, option in options.items()]
        arguments = [p for p in written if "ArgumentInfo" in str(p.annotation) or p.annotation is typer.Context]
        others = [p for p in written if p not in arguments and p.kind is not inspect.Parameter.VAR_KEYWORD]
        in_order = sorted([*arguments, *made, *others], key=lambda p: p.default is not inspect.Parameter.empty)
        command.__signature__ = inspect.Signature(in_order)  # type: ignore[attr-defined]
        return command

    return decorate


def field_tables(options: Mapping[str, FieldOption], values: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Values by key by table, as in a file, of the options given. Raises InputError if a text is not of its form."""
    tables: dict[str, dict[str, Any]] = {}
    for name, value in values.items():
        if value is not None:
            table, key, parse, *_ = options[name]
            if isinstance(value, list) and parse is None and table:
                # Names with commas between, as everywhere; the option may be repeated as well.
                value = [word.strip() for text in value for word in str(text).split(",") if word.strip()]
            tables.setdefault(table, {})[key] = parse(value) if parse else value
    return tables


@contextmanager
def named_by_flag(given: Mapping[str, str], where: str, *, alone: bool) -> Iterator[None]:
    """In an error on a field of the file ``where`` that was given as an option, name the option and no file.

    ``given`` holds the options' parameters by ``table.key``. With ``alone`` there are only options: ``where`` is no
    file, and is not named.
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


def with_options(model: type[Options]) -> Callable[[Callable[..., None]], Any]:
    """Decorator that gives a command an option for each field of ``model``; `given` makes a model of them."""
    return with_fields(model, _flags(model))


def given(model: type[AnyOptions], values: Mapping[str, Any]) -> AnyOptions:
    """A ``model`` with the options given, defaults for the others. Raises InputError that names the parameter."""
    options = _flags(model)
    stated = {name: value for name, value in values.items() if name in options}
    with named_by_flag({key: key for key in options}, "", alone=False):
        return options_of(model, field_tables(options, stated).get("", {}))


@cache
def _flags(model: type[Options]) -> dict[str, FieldOption]:
    """The options for the fields of ``model``, by parameter; a parameter is named as its field."""
    options = {}
    for field in declarations(model):
        flag, metavar = flag_of(model, field.key), extra_of(model, field.key)["metavar"]
        options[field.key] = FieldOption("", field.key, _parser(model, field.key, flag), metavar, flag)
    return options


def _parser(model: type[Options], key: str, flag: str) -> Callable[[Any], Any] | None:
    if flag.startswith("no_"):
        return operator.not_
    entries = entries_of(model, key)
    if entries == "numbers":
        return partial(_numbers, parameter=key, separator=str(extra_of(model, key)["separator"]))
    return words if entries in ("names", "texts") else None


def words(texts: Iterable[str], separator: str = ",") -> list[str]:
    """Words of an option that has ``separator`` between them, or is repeated."""
    return [word.strip() for text in texts for word in text.split(separator) if word.strip()]


def _numbers(texts: Sequence[str], parameter: str, separator: str) -> list[float]:
    try:
        return [plain_number(word.removesuffix("mm")) for word in words(texts, separator)]
    except ValueError:
        between = "commas" if separator == "," else separator
        problem = f"must be numbers with {between} between, such as {separator.join(('20', '6'))}"
        raise InputError(problem, key=parameter, value=",".join(texts)) from None


def _parameter(model: type[BaseModel], name: str, option: FieldOption) -> inspect.Parameter:
    table = table_of(model, option.table) if option.table else model
    assert table is not None
    field = declaration(table, option.key)
    kind: Any = _kind(table, option.key)
    if option.parse and kind is not bool:
        kind = str if option.table else list[str]
    flags = [f"--{(option.flag or name).replace('_', '-')}"] if option.flag or kind is bool else []
    known = names(field.registry, listed=kind is not str) if field.registry else None
    default = None if option.table else _default(table, field)
    shown = extra_of(table, option.key).get("shown") or default is not None
    info = typer.Option(*flags, metavar=option.metavar, help=_help(field), autocompletion=known, show_default=shown)
    annotation: Any = Annotated[kind if default is inspect.Parameter.empty else kind | None, info]
    return inspect.Parameter(name, inspect.Parameter.POSITIONAL_OR_KEYWORD, default=default, annotation=annotation)


def _default(table: type[BaseModel], field: Declaration) -> Any:
    """Default of an option as a user would type it; None if there is nothing to type, `Parameter.empty` if required."""
    if table.model_fields[field.key].is_required():
        return inspect.Parameter.empty
    if field.default is None or isinstance(field.default, bool) or field.default == []:
        return None
    if not isinstance(field.default, list):
        return field.default
    return [",".join(entry if isinstance(entry, str) else f"{entry:g}" for entry in field.default)]


def _kind(table: type[BaseModel], key: str) -> Any:
    """Type of a field without None and without its bounds; str if it is a choice of words."""
    annotation = table.model_fields[key].annotation
    if typing.get_origin(annotation) in (typing.Union, types.UnionType):
        (annotation,) = (kind for kind in typing.get_args(annotation) if kind is not types.NoneType)
    if typing.get_origin(annotation) is typing.Literal:
        return str
    if typing.get_origin(annotation) is list:
        return list[_bare(typing.get_args(annotation)[0])]  # type: ignore[misc]
    return _bare(annotation)


def _bare(annotation: Any) -> Any:
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

ColumnsOption = Annotated[list[str] | None, parameters_of(__file__)("columns")]


def reading_of(columns: Sequence[str] | None, fields: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """The tables [columns] and [format] that the options state."""
    from pneutouch.workflows.characterize.load import parse_columns

    stated = {name: value for name, value in fields.items() if name in READING_FIELDS}
    return {"columns": parse_columns(columns or []), **field_tables(READING_FIELDS, stated)}


def reading_words(columns: Sequence[str] | None, fields: Mapping[str, Any]) -> list[str]:
    """The options on columns and format as they were given, as words for the next command."""
    words = [word for text in columns or () for word in ("--columns", text)]
    for name in READING_FIELDS:
        if fields.get(name) is not None:
            words += [f"--{name.replace('_', '-')}", str(fields[name])]
    return words
