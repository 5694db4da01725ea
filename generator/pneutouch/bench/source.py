"""Columns of a measured file, found by their names: channel and unit of each, and the layout of the file."""

import re
import shlex
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

from pneutouch.errors import InputError
from pneutouch.results.measured import ReadColumn, ReadTables
from pneutouch.results.record import plain
from pneutouch.spec.campaign import Column, ColumnMap, FileFormat
from pneutouch.spec.toml_text import value_text
from pneutouch.tables.layout import TableFormat, TableLayout
from pneutouch.tables.read import layout_of
from pneutouch.tables.unit_words import BRACKETS, UNITS, unit_of
from pneutouch.wording import data_of

_DATA = data_of(__file__)
_WORDS, _ENDINGS, _OTHER_QUANTITIES = _DATA["words"], _DATA["endings"], _DATA["other_quantities"]["words"]
_SPLIT = re.compile(r"[^\W_]+")
_LONGEST = 200
"""Greatest length of a header in which a unit without brackets is looked for."""

_ABSOLUTE = re.compile(r"(.*?)[\s_]+(\w+?)_abs")
_LAST = re.compile(r"(.*?)(?:[\s_,:;/.-]+|\bin\s+)([^\s_,:;/]+)")


class MissingChannelError(InputError):
    """Error for a file without a column for one of the required ``channels``."""

    channels: tuple[str, ...] = ()


class HeaderMeaning(NamedTuple):
    """Meaning of a header: ``word`` is the channel that its words name, ``kind`` the channel of its unit, ``unit`` the
    unit; each "" if unknown. ``odd``: its unit or quantity belongs to no channel."""

    word: str
    kind: str
    unit: str
    odd: bool = False

    @property
    def channel(self) -> str:
        """The channel; "" where words and unit name none, or name different ones."""
        if self.odd or (self.word and self.kind and self.word != self.kind):
            return ""
        return self.word or self.kind

    @property
    def certain(self) -> bool:
        """True if words and unit name the same channel."""
        return bool(self.channel) and self.word == self.kind


def meaning_of(name: str, unit: str = "") -> HeaderMeaning:
    """Meaning of a header such as "Load [N]", "P_kPa" or "Kraft (N)"; ``unit`` is that of a row of units."""
    label, stated = (name, unit) if unit.strip() else _parted(name)
    known = unit_of(stated) if stated else None
    if known is None and not unit.strip() and (alone := unit_of(name)):
        return HeaderMeaning("", *alone)
    words = [word.lower() for word in _SPLIT.findall(label)]
    odd = (bool(stated.strip("()[] -")) and known is None) or any(word in _OTHER_QUANTITIES.split() for word in words)
    return HeaderMeaning(_channel(label, words), *(known or ("", "")), odd)


def _parted(name: str) -> tuple[str, str]:
    """Label and unit of a header; the unit is in brackets, or the last part if that is a unit."""
    brackets = list(BRACKETS.finditer(name))
    if brackets:
        last = brackets[-1]
        return f"{name[: last.start()]} {name[last.end() :]}".strip(), last[1] or "?"
    absolute = _ABSOLUTE.fullmatch(name.strip()) if len(name) <= _LONGEST else None
    if absolute and unit_of(f"{absolute[2]}_abs"):
        return absolute[1], f"{absolute[2]}_abs"
    # The pattern takes the square of the length.
    parts = _LAST.fullmatch(name.strip()) if len(name) <= _LONGEST else None
    if parts and parts[1].strip() and unit_of(parts[2]):
        return parts[1], parts[2]
    return name, ""


def _channel(label: str, words: list[str]) -> str:
    """Channel that a label's words name, "" if none or several; a single letter counts only if it is the only word."""
    if label.strip().lower() == "x_value":
        return "time"
    named = set()
    for channel, known in _WORDS.items():
        if any(word in known.split() and (len(word) > 1 or len(words) == 1) for word in words):
            named.add(channel)
    named |= {channel for ending, channel in _ENDINGS.items() if any(word.endswith(ending) for word in words)}
    return named.pop() if len(named) == 1 else ""


_ANY = FileFormat()
_PLAIN = {"delimiter": ",", "decimal": ".", "encoding": "utf-8"}
"""Layout of a text file that need not be stated in a campaign file."""


@dataclass(frozen=True, slots=True)
class MeasuredFile:
    """A file with its columns and layout; ``stated`` is its format in the campaign, ``guessed`` what was found."""

    path: Path
    columns: ColumnMap
    layout: TableLayout
    channels: tuple[str, ...]
    guessed: tuple[str, ...]
    stated: FileFormat

    @property
    def content(self) -> ReadTables:
        """Layout and columns, found or stated, as the tables [format] and [columns] of a campaign file.

        The header's place is left out, because the columns' names determine it."""
        used = {key: getattr(self.layout.format, key) for key in _PLAIN}
        kept = {key: value for key, value in used.items() if value not in (None, _PLAIN[key])}
        kept |= self.stated.model_dump(exclude_none=True)
        columns = {key: _entry(getattr(self.columns, key)) for key in self.channels}
        return ReadTables(columns=columns, format=kept or None)


def campaign_lines(content: ReadTables, within: str = "") -> str:
    """The tables [format] and [columns] of `MeasuredFile.content` as lines of a campaign file.

    ``within`` is put before the tables' names: "runs." for tables of the [[runs]] entry above them.
    """
    return "\n\n".join(
        "\n".join([f"[{within}{name}]", *(f"{key} = {value_text(plain(value))}" for key, value in table.items())])
        for name, table in (("format", content.format), ("columns", content.columns))
        if table is not None
    )


def as_option(**columns: Column) -> str:
    """Columns by channel as the option of a command: "give `columns` force=Load:N"."""
    texts = (
        f"{key}={'-' if one.sign < 0 else ''}{one.name}{f':{one.unit}' if one.unit else ''}"
        for key, one in columns.items()
    )
    return f"give `columns` {shlex.quote(','.join(texts))}"


def otherwise(columns: ColumnMap, key: str, unit: str = "") -> str:
    """Remedy that reads a channel in another unit, or without one with the other sign, as option and campaign key."""
    column: Column = getattr(columns, key)
    return _stated(**{key: column.model_copy(update={"unit": unit} if unit else {"sign": -column.sign})})


def exchanged(columns: ColumnMap, first: str, second: str) -> str:
    """Remedy that reads two channels each from the column of the other."""
    one, other = getattr(columns, first), getattr(columns, second)
    pairs = ((first, one, other), (second, other, one))
    return _stated(**{key: to.model_copy(update={"name": by.name}) for key, to, by in pairs})


def _stated(**columns: Column) -> str:
    keys = (f"columns.{key} = {value_text(plain(_entry(one)))}" for key, one in columns.items())
    return f"{as_option(**columns)}, or in a campaign set {' and '.join(keys)}"


def identify(path: Path, columns: ColumnMap, channels: Sequence[str], written: FileFormat = _ANY) -> MeasuredFile:
    """Find the columns of ``channels`` in a file.

    A channel stated in ``columns`` is that column. Any other is the column with its default name; else the only one
    whose name and unit mean the channel; else the only one whose name or unit does. Raises InputError, with the lines
    of a campaign file that decide, where several columns may be a channel or its unit is not known or none is."""
    stated = columns.model_fields_set
    known = [getattr(columns, key).name for key in channels]
    layout = layout_of(path, TableFormat(**written.model_dump()), known)
    meanings = [meaning_of(name, unit) for name, unit in zip(layout.all_names, layout.all_units, strict=True)]
    taken = {_index(layout, getattr(columns, key).name) for key in channels if key in stated}
    matched: dict[str, Column] = {}
    open_: dict[str, list[int]] = {}
    for key in channels:
        column: Column = getattr(columns, key)
        if key in stated or column.name in layout.all_names:
            matched[key] = _with_unit(path, key, column, layout)
        else:
            places = [k for k, meaning in enumerate(meanings) if meaning.channel == key]
            places = [k for k in places if k not in taken]
            places = [k for k in places if meanings[k].certain] or places
            if len(places) == 1 and meanings[places[0]].unit:
                matched[key] = Column(name=_called(layout, places[0]), unit=meanings[places[0]].unit)
            else:
                open_[key] = places
    if open_:
        raise _undecided(path, channels, columns, layout, matched, open_, meanings)
    guessed = tuple(key for key in channels if key not in stated and matched[key] != getattr(columns, key))
    full = ColumnMap.model_validate(
        plain({key: _entry(column) for key, column in matched.items()} | _rest(columns, matched))
    )
    return MeasuredFile(path, full, layout, tuple(channels), (*guessed, *layout.guessed), written)


def _entry(column: Column) -> ReadColumn:
    return ReadColumn(column.name, column.unit, -1 if column.sign < 0 else None)


def _rest(columns: ColumnMap, matched: dict[str, Column]) -> dict[str, ReadColumn]:
    """Entries of the channels that are not needed, without those whose name a needed column has."""
    names = {column.name for column in matched.values()}
    others = {key: getattr(columns, key) for key in UNITS if key not in matched}
    return {key: _entry(column) for key, column in others.items() if column.name not in names}


def _with_unit(path: Path, key: str, column: Column, layout: TableLayout) -> Column:
    """Stated column with the unit from its header if the campaign gives none. Raises InputError without either."""
    if column.unit:
        return column
    place = _index(layout, column.name)
    if place is None:
        return column.model_copy(update={"unit": next(iter(UNITS[key]))})
    unit = layout.all_units[place]
    meaning = meaning_of(layout.all_names[place], unit)
    if meaning.kind == key:
        return column.model_copy(update={"unit": meaning.unit})
    problem = f"no unit of {key} in the header" if not unit else f"its unit {unit} is none of {key}"
    remedy = f"state it, one of {', '.join(UNITS[key])}:\n{_lines({key: column}, {})}"
    raise InputError(problem, file=path, key=f"column {column.name}", remedy=remedy)


def _index(layout: TableLayout, name: str) -> int | None:
    """Index in `TableLayout.all_names` of a column given by its name or number; None if the file has no such column."""
    if name in layout.all_names:
        return layout.all_names.index(name)
    place = layout.place(name)
    return None if place is None else place + (layout.clock is not None)


def _undecided(
    path: Path,
    channels: Sequence[str],
    columns: ColumnMap,
    layout: TableLayout,
    matched: dict[str, Column],
    open_: dict[str, list[int]],
    meanings: Sequence[HeaderMeaning],
) -> InputError:
    """Error for channels without a column, with campaign lines that show the columns found and those to choose from."""
    names, first = layout.all_names, next(iter(open_))
    lines, remarks = {}, {}
    for key in channels:
        places = open_.get(key)
        if places is None:
            lines[key] = matched[key]
            continue
        called = [_called(layout, k) for k in places]
        unit = meanings[places[0]].unit if places else ""
        lines[key] = Column.model_construct(name=called[0] if called else "?", unit=unit or "?", sign=1)
        others = " or ".join(map(value_text, called[1:6]))
        remarks[key] = f"or {others}" if others else _choice(key, layout, places)
    where = f"the header '{', '.join(names)[:80]}'" + (f" (row {layout.header_row})" if layout.header_row else "")
    if layout.header_row is None and all(name.startswith("#") for name in layout.names):
        where = f"a table without header (row {layout.first_row} holds numbers; #1 is its first column)"
    few = {0: "no column of {0}", 1: "no unit of the {0}"}
    text = "; ".join(few.get(len(at), f"{len(at)} columns may be the {{0}}").format(key) for key, at in open_.items())
    missing = not open_[first]
    key = f"column {getattr(columns, first).name if missing else names[open_[first][0]]}"
    problem = f"{'missing from' if missing else 'in'} {where}: {text}"
    remedy = (
        "state it in the campaign file (of this file alone: as [runs.columns] below its entry), or give `columns`:\n"
        f"{_lines(lines, remarks)}"
    )
    if any(open_.values()):
        return InputError(problem, file=path, key=key, remedy=remedy)
    error = MissingChannelError(problem, file=path, key=key, remedy=remedy)
    error.channels = tuple(open_)
    return error


def _called(layout: TableLayout, place: int) -> str:
    """Name of a column in a campaign file: its own name, or its number if it has none or shares it with another."""
    name = layout.all_names[place]
    return name if name and layout.all_names.count(name) == 1 else f"#{place + 1 - (layout.clock is not None)}"


def _choice(key: str, layout: TableLayout, places: Sequence[int]) -> str:
    unit = f"unit: {', '.join(UNITS[key])}"
    if places:
        return unit
    return f"name of the column; {unit}" if layout.header_row else f"#1 to #{len(layout.names)}; {unit}"


def _lines(columns: dict[str, Column], remarks: dict[str, str]) -> str:
    """The table [columns] of a campaign file, with remarks on the columns left open."""
    lines = ["[columns]"]
    for key, column in columns.items():
        entry = value_text(plain(replace(_entry(column), unit=column.unit or "?")))
        lines.append(f"{key} = {entry}" + (f"  # {remarks[key]}" if key in remarks else ""))
    return "\n".join(lines)
