"""Files next to a dataset: its table as CSV, and its pictures."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.errors import InputError
from pneutouch.output.files import replace_files
from pneutouch.tables.csv_write import csv_bytes
from pneutouch.workflows.sweep.dataset import PRESSURE, stored_dataset
from pneutouch.workflows.sweep.plan import SweepPlan
from pneutouch.workflows.sweep.variables import POINT, STATE
from pneutouch.workflows.sweep.workfolder import check_output

if TYPE_CHECKING:
    import xarray

    from pneutouch.report.swept import SweptFigure

FIGURE = "sensitivity_kPa_per_N"
"""The figure that is drawn."""

_ENDS = "sensitivity_low_kPa_per_N", "sensitivity_high_kPa_per_N"


def table_rows(content: xarray.Dataset) -> list[dict[str, Any]]:
    """A row for every state of the sweep, in the order of the dataset: swept fields, driving pressure, then figures.

    Numbers that are not there are None.
    """
    dims = list(content["status"].dims)
    names = [v.name for v in (*STATE, *POINT)]
    fields = [str(name) for name in content.coords if name not in (*dims, PRESSURE)]
    swept = [*(str(dim) for dim in dims if dim != PRESSURE), *fields]
    arrays = {name: content[name].values for name in (*swept, PRESSURE, *names)}
    of_dims = {name: [dims.index(dim) for dim in content[name].dims] for name in arrays}
    rows = []
    for place in np.ndindex(*(content.sizes[dim] for dim in dims)):
        row = {name: _plain(values[tuple(place[k] for k in of_dims[name])]) for name, values in arrays.items()}
        if row["status"]:
            rows.append(row)
    return rows


def _plain(value: Any) -> Any:
    """A number or text of Python; None for NaN."""
    value = value.item() if hasattr(value, "item") else value
    return None if isinstance(value, float) and np.isnan(value) else value


def table_csv(rows: list[dict[str, Any]]) -> bytes:
    """The rows as a CSV file; numbers with twelve digits, as the dataset holds them."""
    head = list(rows[0]) if rows else []
    return csv_bytes(head, [[_cell(value) for value in row.values()] for row in rows])


def _cell(value: Any) -> Any:
    return "" if value is None else f"{value:.12g}" if isinstance(value, float) else value


def check_companions(out: Path, plan: SweepPlan) -> None:
    """Raise InputError where ``out`` can be no dataset, or the table or a picture would replace another's file.

    Where there is no dataset, what stands in their places was written by no sweep.
    """
    check_output(out)
    if out.exists():
        return
    names = [f"over-{key.replace('.', '_')}" for key in plan.varied] + ["over-point", f"over-{PRESSURE}", "map"]
    places = {out.with_suffix(".csv"): "the table"}
    places |= {path: "a picture" for name in names for path in _picture_files(out, name)}
    for path, what in places.items():
        if os.path.lexists(path):
            raise InputError(f"{path} is in the place of {what}", key="out", remedy="give another `out`, or move it")


def write_companions(out: Path) -> tuple[list[dict[str, Any]], list[Path]]:
    """Write table and pictures of a finished dataset next to it; returns the rows and the files written.

    Raises InputError for a dataset that is not as the sweep wrote it.
    """
    from pneutouch.report.swept import pictures

    content = stored_dataset(out)
    rows, swept = table_rows(content), swept_figure(content)
    files = {out.with_suffix(".csv"): table_csv(rows)}
    if swept is not None:
        for name, (text, image) in pictures(swept).items():
            files |= dict(zip(_picture_files(out, name), (text.encode(), image), strict=True))
    replace_files(files)
    return rows, list(files)


def _picture_files(out: Path, name: str) -> tuple[Path, Path]:
    return out.with_name(f"{out.stem}-{name}.svg"), out.with_name(f"{out.stem}-{name}.png")


def swept_figure(content: xarray.Dataset) -> SweptFigure | None:
    """The drawn figure over the swept fields; None if no state has one. A list is drawn over its first field."""
    from pneutouch.report.swept import SweptFigure

    if not np.isfinite(content[FIGURE].values).any():
        return None
    dims = [str(dim) for dim in content[FIGURE].dims]
    if dims[0] == "point":
        content = _gridded(content)
        dims = [str(dim) for dim in content[FIGURE].dims]
    axes = tuple(_axis(content, name) for name in dims)
    arrays = (content[name].values for name in (FIGURE, *_ENDS))
    return SweptFigure("sensitivity  (kPa/N)", axes, *arrays)


def _gridded(content: xarray.Dataset) -> xarray.Dataset:
    """A list of points as a grid over its fields, where it is one; else over the number of the point."""
    fields = [str(name) for name, values in content.coords.items() if name != "point" and values.dims == ("point",)]
    kept = content[[FIGURE, *_ENDS]]
    places = list(zip(*(content[name].values.tolist() for name in fields), strict=True))
    if len(fields) == 1 and len(set(places)) == len(places):
        return kept.swap_dims(point=fields[0]).sortby(fields[0])
    return kept


def _axis(content: xarray.Dataset, name: str) -> Any:
    from pneutouch.report.swept import SweptAxis

    values = content[name]
    unit = str(values.attrs.get("units", ""))
    plain = tuple(_plain(value) for value in values.values)
    if name == PRESSURE:
        return SweptAxis(name, "driving pressure", unit, plain)
    words = str(values.attrs.get("key", name)).replace(".", " ").replace("_", " ")
    return SweptAxis(name, words.removesuffix(f" {unit.replace('/', ' per ')}"), unit, plain)
