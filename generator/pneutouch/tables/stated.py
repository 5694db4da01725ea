"""Headers in which text files of some makers describe themselves: LabVIEW measurement files and MTS's exports.

Sources: NI, Specification for the LabVIEW Measurement File (.lvm), ni.com/tutorial/4139; MTS Series 793 Application
manual, MultiPurpose TestWare, page 136, How to parse the MPT specimen data file.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from pneutouch.errors import InputError
from pneutouch.tables.cells import blank, cells, score
from pneutouch.tables.layout import DECIMALS, NAMES, TableFormat, TableLayout

_LVM, _END = "LabVIEW Measurement", "***End_of_Header***"
_LVM_DELIMITERS = {"Tab": "\t", "Comma": ",", "Semicolon": ";", "Space": " "}
_MTS, _MTS_DELIMITERS = "MTS793|", {"0": " ", "1": ",", "2": "\t"}
_MTS_FIELDS = 6


def stated_format(lines: Sequence[str], given: TableFormat) -> TableFormat:
    """``given`` with the delimiter and the decimal mark that an MTS file gives in its first line."""
    fields = lines[0].split("|") if lines and lines[0].startswith(_MTS) else []
    if len(fields) < _MTS_FIELDS:
        return given
    delimiter, decimal = _MTS_DELIMITERS.get(fields[4]), fields[5] if fields[5] in DECIMALS else None
    return replace(given, delimiter=given.delimiter or delimiter, decimal=given.decimal or decimal)


def is_lvm(lines: Sequence[str]) -> bool:
    """True if these are the first lines of a LabVIEW measurement file."""
    return bool(lines) and lines[0].startswith(_LVM)


def lvm_layout(path: Path, lines: Sequence[str], given: TableFormat) -> TableLayout:
    """Layout of a LabVIEW measurement file. Raises InputError if its header is not whole, or has several clocks."""
    ends = [k for k, line in enumerate(lines) if line.startswith(_END)]
    tags = _tags(lines[: ends[0]] if ends else lines)
    delimiter = given.delimiter or _delimiter(tags.get("Separator", ""))
    mark = tags.get("Decimal_Separator", "\t.")[1:].strip() or "."
    decimal = given.decimal or (mark[0] if mark[0] in DECIMALS else ".")
    names = [k for k in range(ends[1] + 1, len(lines)) if not blank(lines[k], "\t")] if len(ends) > 1 else []
    if not names:
        problem = f"a LabVIEW measurement file without its two lines {_END} and a header"
        raise InputError(problem, file=path, remedy="cut off, or written without headers?")
    if tags.get("X_Columns", "")[1:].strip() == "Multi":
        problem = "each channel has times of its own (X_Columns Multi)"
        raise InputError(problem, file=path, remedy="write the file again with one column of times")
    segment = {row[0]: row[1:] for line in lines[ends[0] + 1 : ends[1]] if (row := cells(line, delimiter)) and row[0]}
    header, written = names[0], replace(given, delimiter=delimiter, decimal=decimal, skip_rows=names[0])
    columns = cells(lines[header], delimiter)
    units = [*segment.get("Y_Unit_Label", []), *[""] * len(columns)][: len(columns) - 1]
    time = "s" if segment.get("X_Dimension", ["Time"])[0] in ("Time", "") else ""
    layout = TableLayout(tuple(columns), (time, *units), written, (), header + 1, header + 2)
    numbers = [cells(line, delimiter) for line in lines[header + 1 :] if not blank(line, delimiter)]
    layout = replace(layout, least=_least(columns, numbers, decimal))
    return _with_clock(path, layout, segment, numbers) if tags.get("X_Columns", "")[1:].strip() == "No" else layout


def _tags(lines: Sequence[str]) -> dict[str, str]:
    """Tags with the text that follows them, the delimiter first."""
    heads = ("Separator", "Decimal_Separator", "X_Columns")
    return {head: line[len(head) :] for line in lines for head in heads if line.startswith(head)}


def _delimiter(text: str) -> str:
    """The delimiter follows its tag, and its name, as a rule, follows it."""
    name = text[1:].strip(" ,;\t")
    return _LVM_DELIMITERS.get(name) or (text[0] if text and text[0] in NAMES else "\t")


def _least(columns: Sequence[str], numbers: Sequence[Sequence[str]], decimal: str) -> int:
    """Fewest cells of a row: without the last column, that of remarks, if rows leave it out."""
    short = any(len(row) == len(columns) - 1 and score(row, decimal) > 0 for row in numbers)
    return len(columns) - 1 if short and len(columns) > 1 else len(columns)


def _with_clock(
    path: Path, layout: TableLayout, segment: dict[str, list[str]], numbers: Sequence[Sequence[str]]
) -> TableLayout:
    """The layout with the clock of the first channel, all of which must have the same."""
    clock = []
    for tag in ("X0", "Delta_X"):
        values = {text for text in segment.get(tag, []) if text}
        try:
            (text,) = values
            clock.append(float(text.replace(",", ".")))
        except ValueError:
            problem = f"no column of times (X_Columns No), and {tag} is not one number for all channels"
            raise InputError(problem, file=path, remedy="write the file again with one column of times") from None
    first = numbers[0] if numbers else []
    # The cell of the times is there and empty, or it is left out.
    if first and first[0]:
        kept = replace(layout, names=layout.names[1:], units=layout.units[1:], least=max(layout.least - 1, 1))
    else:
        kept = replace(layout, names=("", *layout.names[1:]))
    return replace(kept, clock=(clock[0], clock[1]))
