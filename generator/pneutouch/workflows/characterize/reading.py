"""Options of a command or a function for the reading of files, in place of [columns] and [format] of a campaign."""

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from pneutouch.bench.source import MeasuredFile, campaign_lines
from pneutouch.errors import InputError
from pneutouch.spec.campaign import Campaign, ColumnMap, FileFormat
from pneutouch.spec.read import validate
from pneutouch.tables.unit_words import UNITS, unit_of
from pneutouch.wording import listed

Reading = Mapping[str, Mapping[str, Any]]
"""Tables ``columns`` and ``format`` as in a campaign file."""

_CHANNELS = "|".join(UNITS)
_NEXT = re.compile(rf",(?=\s*(?:{_CHANNELS})\s*=)")
_NAMED = 12
"""Files that are named of a group that does not hold all."""

_FORM = "write channel=NAME or channel=NAME:UNIT, such as force=Load or force=Load:N; -NAME turns the sign"


def parse_columns(texts: Sequence[str]) -> dict[str, dict[str, Any]]:
    """The table [columns] from texts ``channel=NAME:UNIT``, several with commas between. Raises InputError.

    The unit may be left out where the header gives it; a minus before the name turns the sign."""
    columns: dict[str, dict[str, Any]] = {}
    for text in (part for whole in texts for part in _NEXT.split(whole)):
        channel, equals, name = (part.strip() for part in text.partition("="))
        if not equals or not name.strip("-") or channel not in UNITS:
            remedy = f"{_FORM}; channels: {', '.join(UNITS)}"
            raise InputError("no column of a channel", key="columns", value=text, remedy=remedy)
        sign, name = (-1, name[1:]) if name.startswith("-") else (1, name)
        label, colon, word = name.rpartition(":")
        known = unit_of(word) if colon and label else None
        unit = known[1] if known and known[0] == channel else ""
        columns[channel] = {"name": label.strip() if unit else name, "unit": unit, "sign": sign}
    return columns


def with_reading(campaign: Campaign, reading: Reading | None) -> Campaign:
    """The campaign with ``reading`` in place of its columns and format, those of its runs too. Raises InputError.

    Raises InputError.
    """
    if not reading:
        return campaign
    runs = []
    for run in campaign.runs:
        tables = run.columns or ColumnMap(), run.format or FileFormat()
        is_plain = run.columns is None and run.format is None
        runs.append(run if is_plain else run.model_copy(update=_with_stated(*tables, reading, run.file)))
    return campaign.model_copy(update={**_with_stated(campaign.columns, campaign.format, reading), "runs": runs})


def _with_stated(columns: ColumnMap, written: FileFormat, reading: Reading, file: str = "") -> dict[str, Any]:
    """Columns and format with ``reading`` in their place; ``file``: of one run. Raises InputError."""
    stated = {key: getattr(columns, key).model_dump() for key in columns.model_fields_set}
    try:
        merged = validate(ColumnMap, {**stated, **reading.get("columns", {})}, "")
    except InputError as error:
        where = f"with the columns of {file} in the campaign: " if file else ""
        raise InputError(f"{where}{error}", key="columns") from None
    how = validate(FileFormat, {**written.model_dump(exclude_none=True), **reading.get("format", {})}, "")
    return {"columns": merged, "format": how}


def read_as(sources: Mapping[str, MeasuredFile], runs: int) -> list[dict[str, Any]]:
    """Layouts that were found by looking at the files: files read alike together, with the tables of a campaign file
    for them.

    ``whole_campaign``: the tables hold for all of its ``runs``; else they belong to the runs of these files.
    """
    alike: dict[str, dict[str, Any]] = {}
    for file, source in sources.items():
        if source.guessed:
            alike.setdefault(campaign_lines(source.content), {"files": [], **source.content})["files"].append(file)
    return [{**entry, "whole_campaign": len(entry["files"]) == runs} for entry in alike.values()]


def undisputed(sources: Mapping[str, MeasuredFile], failures: Sequence[tuple[str, str]]) -> dict[str, MeasuredFile]:
    """The files whose columns no failure, (file, message), puts in question."""
    disputed = {file for file, message in failures if "columns." in message}
    return {file: source for file, source in sources.items() if file not in disputed}


def same_failures(failures: Iterable[Sequence[str]]) -> list[tuple[str, str]]:
    """Failures, (file, message), those of one message together: the names of their files, and the message without."""
    alike: dict[str, list[str]] = {}
    for file, message in failures:
        _, named, problem = message.partition(f"{file}: ")
        alike.setdefault(problem if named else message, []).append(file)
    return [(listed(files, _NAMED), problem) for problem, files in alike.items()]


def reading_text(read_as: Sequence[Mapping[str, Any]]) -> str:
    """Lines for a campaign file that keep the columns and formats which were found by looking at the files."""
    blocks = []
    for entry in read_as:
        files, whole = entry["files"], entry["whole_campaign"]
        named = listed(files, 1 if whole else _NAMED)
        place = "into campaign.toml" if whole else "below the [[runs]] entry of each of these files in campaign.toml"
        lines = campaign_lines(entry, "" if whole else "runs.")
        blocks.append(f"note: {named}: read as follows; to keep it, put it {place}\n{lines}")
    return "\n".join(blocks).rstrip()
