"""Tasks of a sensor: the figure that each requires, and the files that list them."""

import csv
import re
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, model_validator

from pneutouch.errors import InputError, nearest
from pneutouch.spec.design import Printable
from pneutouch.spec.fields import Table, declaration, number
from pneutouch.spec.files import read_bytes
from pneutouch.spec.read import read_toml, validate
from pneutouch.spec.values import plain_number

TASK_FIGURES = {
    "sensitivity": "sensitivity_kPa_per_N",
    "stiffness": "stiffness_N_per_mm",
    "force_range": "force_range_N",
}
"""Keys of the figures that a task can require, by their short names."""


class DrivingTask(Table):
    """[[task]]: one figure that a task requires, and the task's name."""

    name: Printable | None = Field(default=None, max_length=80, description="Name of the task; may be left out.")
    sensitivity_kPa_per_N: float | None = number(
        None, unit="kPa/N", low=1e-4, high=1e4, help="Slope of pressure rise over contact force."
    )
    stiffness_N_per_mm: float | None = number(
        None, unit="N/mm", low=1e-6, high=1e5, help="Mean contact force over indentation in the range."
    )
    force_range_N: float | None = number(None, unit="N", low=1e-4, high=1e5, help="Contact force at the range's end.")

    @model_validator(mode="after")
    def _one_figure(self) -> "DrivingTask":
        given = [key for key in TASK_FIGURES.values() if getattr(self, key) is not None]
        if len(given) != 1:
            stated = f"{' and '.join(given)} are given" if given else "no figure is given"
            raise ValueError(f"{stated}; a task requires exactly one of {', '.join(TASK_FIGURES.values())}")
        return self

    @property
    def figure(self) -> str:
        """Key of the required figure."""
        return next(key for key in TASK_FIGURES.values() if getattr(self, key) is not None)

    @property
    def value(self) -> float:
        """The required value, in the unit of its key."""
        return float(getattr(self, self.figure))


_DELIMITERS = (",", ";", "\t")
"""Separators of the cells of a CSV file: the one that its header has most of is taken."""

_DECIMAL_COMMA = re.compile(r"[+-]?(\d+,\d*|,\d+)([eE][+-]?\d+)?")
_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+")

MOST_TASKS = 50
"""Largest number of tasks of one file."""


class TaskFile(Table):
    """A whole file of tasks, in the order in which they are done."""

    task: Annotated[list[DrivingTask], Field(min_length=1, max_length=MOST_TASKS)] = Field(
        description="a list of tasks"
    )


def parse_task(text: str) -> DrivingTask:
    """Task of a text such as ``sensitivity=1.8``, by the figure's short or full key. Raises InputError."""
    key, equals, value = (part.strip() for part in text.partition("="))
    keys = TASK_FIGURES | {full: full for full in TASK_FIGURES.values()}
    if not equals:
        raise InputError("write FIGURE=VALUE, such as sensitivity=1.8", key="for", value=text)
    if key not in keys:
        raise InputError(f"unknown figure.{nearest(key, keys)}", key="for", value=text)
    unit = declaration(DrivingTask, keys[key]).unit
    try:
        number_given = float(value)
    except ValueError:
        raise InputError("the value must be a number", key="for", value=text, remedy=f"its unit is {unit}") from None
    try:
        return validate(DrivingTask, {keys[key]: number_given}, "")
    except InputError as error:
        raise InputError(error.problem, key="for", value=text) from None


def read_tasks(path: Path) -> list[DrivingTask]:
    """The tasks of a TOML file (tables ``[[task]]``) or of a CSV file (columns of the same keys).

    Semicolons or tabs may separate the cells; a comma is then a decimal one. Raises InputError.
    """
    if path.suffix.lower() != ".csv":
        return validate(TaskFile, read_toml(path), str(path)).task
    rows = _csv_rows(path)
    return [_of_row(row, f"{path}: line {line}") for line, row in rows]


def _csv_rows(path: Path) -> list[tuple[int, dict[str, str]]]:
    """Line number of every row, and its cells by column, empty ones left out. Raises InputError for another column."""
    try:
        text = read_bytes(path, kind="CSV file").decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"not UTF-8 text (byte {error.start})", file=path) from None
    try:
        written = text.splitlines()
        head_line = next((line for line in written if line.strip()), "")
        delimiter = max(_DELIMITERS, key=head_line.count)
        reader = csv.reader(written, delimiter=delimiter, strict=True)
        lines = [(reader.line_num, [cell.strip() for cell in row]) for row in reader if any(map(str.strip, row))]
    except csv.Error as error:
        raise InputError(f"no CSV table: {error}", file=path) from None
    if len(lines) < 2:
        raise InputError("holds no task", file=path, remedy="give a header and a row for each task")
    if len(lines) > 1 + MOST_TASKS:
        raise InputError(f"{len(lines) - 1} tasks; at most {MOST_TASKS}", file=path)
    head, known = lines[0][1], list(DrivingTask.model_fields)
    for column in head:
        if column not in known:
            raise InputError(f"unknown column.{nearest(column, known)}", file=path, key="header", value=column)
    for line, row in lines[1:]:
        if len(row) != len(head):
            raise InputError(f"line {line} has {len(row)} cells, the header {len(head)}", file=path)
    mark = "." if delimiter == "," else ","
    return [(line, {k: _pointed(k, c, mark) for k, c in zip(head, row, strict=True) if c}) for line, row in lines[1:]]


def _pointed(key: str, cell: str, mark: str) -> str:
    """Cell with the decimal comma of a figure replaced by a point, where commas do not separate cells (``mark`` ",").

    A comma that may separate thousands stays: the cell is then refused as no number.
    """
    decimal = mark == "," and key in TASK_FIGURES.values() and not _THOUSANDS.fullmatch(cell)
    return cell.replace(",", ".") if decimal and _DECIMAL_COMMA.fullmatch(cell) else cell


def _of_row(row: dict[str, str], where: str) -> DrivingTask:
    content: dict[str, Any] = dict(row)
    for key in content.keys() & set(TASK_FIGURES.values()):
        try:
            content[key] = plain_number(row[key])
        except ValueError:
            remedy = "write it with a decimal point, without marks of thousands" if "," in row[key] else None
            raise InputError("must be a number", file=where, key=key, value=row[key], remedy=remedy) from None
    return validate(DrivingTask, content, where)
