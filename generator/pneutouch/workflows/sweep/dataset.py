"""The netCDF file of a sweep: written from its journal part by part, read as an xarray dataset, drawn.

netCDF-3 with 64-bit offsets, by scipy: it needs no further library here, every tool reads it, and it holds no clock.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch import __version__
from pneutouch.errors import InputError
from pneutouch.formats import KEY, check_format, format_of
from pneutouch.mechanics.models.choice import USUAL
from pneutouch.output.files import CHARTS_MANIFEST, MANIFEST, FileContent, check_own, replace_own
from pneutouch.results.record import SENSITIVITY_KEY
from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import declaration, table_of
from pneutouch.spec.files import check_plain, oversized
from pneutouch.tables.csv_table import csv_pieces
from pneutouch.workflows.sweep.grid import PRESSURES, SweepPlan, check_dense, takes_words
from pneutouch.workflows.sweep.journal import FinishedPoints, Journal, check_output
from pneutouch.workflows.sweep.variables import (
    ENDS,
    FILLED_MAPPED,
    FILLED_SENSITIVITY,
    INTERVAL,
    MAPPED,
    POINT,
    STATE,
    SweepVariable,
    empty_columns,
    fill_row,
    missing_reasons,
    over_filling,
)
from pneutouch.workflows.sweep.work import Record, SweepStudy

if TYPE_CHECKING:
    import xarray

    from pneutouch.report.swept import MapPanel, SweptFigure, SweptMap


PRESSURE = "driving_pressure_kPa"
"""Name of the dimension of driving pressures, which holds all that any point has."""

MOST_BYTES = 2**40
"""Largest size of a dataset: that of some thousand million states."""

_STATES = 20_000
"""Least number of states that are written or read at once, if there are as many."""

_CONTENT_HASH, _UNHASHED = "content_hash", b"0" * 64
_HEAD = 2**20
"""Bytes at the head of a file among which its hash is."""


def write_dataset(points: FinishedPoints, journal: Journal, path: Path) -> None:
    """Write the dataset of a finished sweep as a netCDF file, part by part. Its dimensions are those of the grid, or
    ``point``, and the driving pressure. Missing numbers are NaN, missing texts are empty. Raises OSError."""
    import xarray

    plan, records = points.study.plan, points.records(journal)
    first, length, inner = plan.dimensions[0], plan.shape[0], math.prod(plan.shape[1:])
    frame = xarray.Dataset(None, _coordinates(points.study), _attributes(points))
    step = max(1, _STATES // (inner * len(points.study.pressures_kPa)))
    for start in range(0, length, step):
        rows = slice(start, min(start + step, length))
        size = rows.stop - start
        part = frame.isel({first: rows}).assign(_columns(points, islice(records, size * inner), size))
        if start == 0:
            # Along the first dimension a file can grow: what follows is appended, as records of the same layout.
            part.to_netcdf(path, engine="scipy", format="NETCDF3_64BIT", unlimited_dims=[first])
            layout = _layout(path)
            continue
        with path.open("ab") as file:
            file.write(_packed(part, size, layout))
    with path.open("r+b") as file:
        file.seek(4)
        file.write(length.to_bytes(4, "big"))
    seal(path)


def _columns(points: FinishedPoints, records: Iterable[Record], size: int) -> dict[str, xarray.Variable]:
    """Values of as many points as the rows of a part have, by the name of their variable."""
    study, widths = points.study, points.widths
    shape, dims, pressures_kPa = (size, *study.plan.shape[1:]), study.plan.dimensions, study.pressures_kPa
    count = math.prod(shape)
    states, values = empty_columns(STATE, count * len(pressures_kPa), widths), empty_columns(POINT, count, widths)
    for k, record in enumerate(records):
        fill_row(values, k, record["values"])
        requested_kPa = study.point(record["point"]).driving_pressures_kPa
        for pressure_kPa, state in zip(requested_kPa, record["states"], strict=True):
            fill_row(states, k * len(pressures_kPa) + pressures_kPa.index(pressure_kPa), state)
    every = (STATE, states, (*shape, len(pressures_kPa)), (*dims, PRESSURE)), (POINT, values, shape, dims)
    return {
        v.name: _variable(v, columns[v.name].reshape(form), names)
        for variables, columns, form, names in every
        for v in variables
    }


def _layout(path: Path) -> np.dtype[np.void]:
    """Type of the record that every value of the first dimension adds to a file."""
    from scipy.io import netcdf_file

    with netcdf_file(path, mmap=False) as file:
        held: list[Any] = []
        for name, variable in file.variables.items():
            if variable.isrec:
                held.append((name, variable.data.dtype, variable.data.shape[1:]))
                held.append((f" {name}", f"V{-variable.data[0].nbytes % 4}"))
    return np.dtype(held)


def _packed(part: xarray.Dataset, size: int, layout: np.dtype[np.void]) -> bytes:
    """A part as ``size`` records, one after the other."""
    records = np.zeros(size, layout)
    for name in set(layout.names or ()).intersection(map(str, part.variables)):
        values = part[name].values
        records[name] = values[..., None].view("S1") if values.dtype.kind == "S" else values
    return records.tobytes()


def seal(path: Path) -> None:
    """Write the hash of a dataset's bytes into the file, by which a damaged one is recognised."""
    with path.open("r+b") as file:
        place = file.read(_HEAD).index(_UNHASHED)
        total = _content_hash(path, _UNHASHED)
        file.seek(place)
        file.write(total)


def _content_hash(path: Path, stated: bytes) -> bytes:
    """SHA-256 of a file with zeros in place of the hash that it states."""
    with path.open("rb") as file:
        total = hashlib.sha256(file.read(_HEAD).replace(stated, _UNHASHED, 1))
        while block := file.read(_HEAD):
            total.update(block)
    return total.hexdigest().encode()


def stored_fingerprint(path: Path) -> str:
    """Fingerprint of a finished sweep, its file read whole. Raises InputError if it is no dataset, or damaged."""
    why, remedy = "not a dataset that pneutouch sweep wrote, or damaged", "move it away or give another `out`"
    return str(_loaded(path, InputError(f"{path}: {why}", key="out", remedy=remedy)).attrs["input_hash"])


def stored_dataset(path: Path) -> xarray.Dataset:
    """Dataset of a finished sweep. Raises InputError if it is not as it was written."""
    why = "the dataset is damaged: its content is not what the sweep wrote"
    return _loaded(path, InputError(why, file=path, remedy="move it, or compute it again with `fresh`"), hashed=True)


def _loaded(path: Path, damaged: InputError, *, hashed: bool = False) -> xarray.Dataset:
    """Dataset of a file, its values still there; raises ``damaged`` if it is none, or ``hashed`` and another."""
    import xarray

    size = check_plain(path, "dataset")
    if size > MOST_BYTES:
        raise oversized(path, size, MOST_BYTES, "dataset")
    try:
        content = xarray.open_dataset(path, engine="scipy")
        check_format("dataset", content.attrs, path)
        stated = str(content.attrs.get(_CONTENT_HASH)).encode()
        if "input_hash" in content.attrs and (not hashed or stated == _content_hash(path, stated)):
            return content
    except InputError:
        raise
    # What was changed can be anything: a text that is no text, a number that is a date, a file that was cut.
    except Exception:
        pass
    raise damaged


def _variable(variable: SweepVariable, values: Any, dims: tuple[str, ...]) -> xarray.Variable:
    import xarray

    names = {"_Encoding": "utf-8"} if variable.text else {"units": variable.units}
    return xarray.Variable(dims, values, names | {"long_name": variable.long_name})


Coordinate = tuple[str, Any, dict[str, str]]
"""Dimension of a coordinate, its values, and its attributes."""


def _coordinates(study: SweepStudy) -> dict[str, Coordinate]:
    """Values of the varied fields: in a grid along a dimension of their own, in a list along ``point``."""
    plan = study.plan
    names = {"units": "kPa", "long_name": "gauge pressure before contact", "key": PRESSURES}
    coordinates: dict[str, Coordinate] = {PRESSURE: (PRESSURE, np.array(study.pressures_kPa), names)}
    if plan.axes:
        return coordinates | {axis.name: (axis.name, *_column(axis.key, axis.values)) for axis in plan.axes}
    coordinates |= {"point": ("point", np.arange(plan.count, dtype=np.int32), {"long_name": "number in the list"})}
    for key in plan.varied:
        if key != PRESSURES:
            table, field = key.split(".")
            default = plan.settings.get(key, getattr(getattr(study.base, table), field))
            values = [point.get(key, default) for point in plan.points]
            coordinates[key.replace(".", "_")] = ("point", *_column(key, values))
    return coordinates


def _column(key: str, values: Sequence[Any]) -> tuple[Any, dict[str, str]]:
    """Values of one field as an array, with unit and help of the field's declaration."""
    table_name, field = key.split(".")
    table = table_of(DesignFile, table_name)
    assert table is not None
    declared = declaration(table, field)
    names = {"long_name": declared.help, "key": key}
    if declared.registry is not None or takes_words(key):
        texts = [(str(value).lower() if isinstance(value, bool) else value).encode() for value in values]
        return np.array(texts), {**names, "_Encoding": "utf-8"}
    if table.model_fields[field].annotation is int:
        return np.array(values, np.int32), {"units": declared.unit or "1", **names}
    return np.array(values, float), {"units": declared.unit or "1", **names}


def _attributes(points: FinishedPoints) -> dict[str, str]:
    study, plan = points.study, points.study.plan
    return {
        # Before all texts of a user, which may hold anything and be of any length.
        _CONTENT_HASH: _UNHASHED.decode(),
        KEY: format_of("dataset"),
        "title": f"pneutouch sweep {plan.name}",
        "pneutouch_version": __version__,
        "model": "solid, harmonic off the axis" if plan.model == USUAL else plan.model,
        **({"closure": plan.closure} if plan.model == "membrane" else {"clamp": plan.clamp}),
        "base_design": study.name,
        "base_design_content": json.dumps(study.base.model_dump(mode="json"), sort_keys=True, ensure_ascii=False),
        "set_for_all_points": json.dumps(plan.settings, sort_keys=True, ensure_ascii=False),
        "input_hash": study.fingerprint,
        "error_estimate": "\n".join(sorted(filter(None, points.bases))) or "no point was predicted",
    }


def parts_of(content: xarray.Dataset) -> Iterator[xarray.Dataset]:
    """Parts of a dataset along its first dimension, of some `_STATES` states, loaded one after the other."""
    dims = content["status"].dims
    length = content.sizes[dims[0]]
    step = max(1, _STATES * length // max(content["status"].size, 1))
    for start in range(0, length, step):
        yield content.isel({dims[0]: slice(start, start + step)}).load()


def table_rows(content: xarray.Dataset) -> Iterator[dict[str, Any]]:
    """A row for each state, in the dataset's order: swept fields, driving pressure, figures; None if missing."""
    dims = list(content["status"].dims)
    fields = [str(name) for name in content.coords if name not in (*dims, PRESSURE)]
    swept = [*(str(dim) for dim in dims if dim != PRESSURE), *fields]
    names = [*swept, PRESSURE, *(v.name for v in (*STATE, *POINT))]
    for part in parts_of(content):
        whole = (part[name].broadcast_like(part["status"]).transpose(*dims).values.ravel().tolist() for name in names)
        for row in zip(*whole, strict=True):
            found = {name: None if x != x else x for name, x in zip(names, row, strict=True)}
            if found["status"]:
                yield found


def table_csv(rows: Iterable[dict[str, Any]]) -> Iterator[bytes]:
    """Rows as a CSV file, piece by piece; numbers with twelve digits."""
    every = iter(rows)
    first = next(every, {})
    return csv_pieces(
        list(first), ([_cell(value) for value in row.values()] for row in chain([first] if first else [], every))
    )


def _cell(value: Any) -> Any:
    return "" if value is None else f"{value:.12g}" if isinstance(value, float) else value


def check_companions(out: Path, plan: SweepPlan) -> None:
    """Raise InputError if ``out`` cannot be a dataset, or if its table or a picture would replace another file."""
    check_output(out)
    names = [f"over-{key.replace('.', '_')}" for key in plan.varied] + ["over-point", f"over-{PRESSURE}", "map"]
    pictures = (path for name in names for path in _picture_files(out, name))
    check_own((out.with_suffix(".csv"), *pictures), out.with_name(f"{out.stem}-{MANIFEST}"))


def write_companions(out: Path, shown: int = 0) -> tuple[list[dict[str, Any]], list[Path]]:
    """Write table and pictures next to a dataset; return the table's first rows to be ``shown``, and the paths. Raises
    InputError if it is not as written."""
    from pneutouch.report.swept import pictures

    content = stored_dataset(out)
    swept = swept_figure(content)
    files: dict[Path, FileContent] = {out.with_suffix(".csv"): table_csv(table_rows(content))}
    if swept is not None:
        for name, (text, image) in pictures(swept).items():
            files |= dict(zip(_picture_files(out, name), (text.encode(), image), strict=True))
    replace_own(files, out.with_name(f"{out.stem}-{MANIFEST}"))
    return list(islice(table_rows(content), shown)), list(files)


def _picture_files(out: Path, name: str) -> tuple[Path, Path]:
    return out.with_name(f"{out.stem}-{name}.svg"), out.with_name(f"{out.stem}-{name}.png")


def swept_figure(content: xarray.Dataset) -> SweptFigure | None:
    """Sensitivity over the swept fields, to be drawn; None if no state has one. A list becomes a grid (`_gridded`).

    Over injected gas or apex heights it is that of the states which have these, without interval."""
    from pneutouch.report.swept import SweptFigure

    names = (FILLED_SENSITIVITY,) * 3 if over_filling(content) else (SENSITIVITY_KEY, *ENDS)
    if not np.isfinite(content[names[0]].values).any():
        return None
    content = content[list(dict.fromkeys(names))]
    if content[names[0]].dims[0] == "point":
        content = _gridded(content)
    axes = tuple(_axis(content, str(name)) for name in content[names[0]].dims)
    return SweptFigure("sensitivity  (kPa/N)", axes, *(content[name].values for name in names))


def _gridded(kept: xarray.Dataset) -> xarray.Dataset:
    """A list of points over its varied field, if it is the only one and without repeats; else over their number."""
    fields = [str(name) for name, values in kept.coords.items() if name != "point" and values.dims == ("point",)]
    places = list(zip(*(kept[name].values.tolist() for name in fields), strict=True))
    if len(fields) == 1 and len(set(places)) == len(places):
        return kept.swap_dims(point=fields[0]).sortby(fields[0])
    return kept


def _axis(content: xarray.Dataset, name: str) -> Any:
    from pneutouch.report.swept import SweptAxis

    values = content[name]
    unit = str(values.attrs.get("units", ""))
    plain = tuple(None if x != x else x for x in values.values.tolist())
    if name == PRESSURE:
        return SweptAxis(name, "driving pressure", unit, plain)
    words = str(values.attrs.get("key", name)).replace(".", " ").replace("_", " ")
    return SweptAxis(name, words.removesuffix(f" {unit.replace('/', ' per ')}"), unit, plain)


def write_maps(content: xarray.Dataset, folder: Path) -> list[Path]:
    """Write the contour maps of a dataset into a folder, as SVG and PNG; return their paths.

    Raises InputError for a dataset without two fields that are dense (`is_dense`), and for a folder that cannot be
    written.
    """
    from pneutouch.report.swept import contour_map

    files: dict[Path, bytes] = {}
    for name, swept in sweep_maps(content).items():
        text, image = contour_map(swept)
        files |= {folder / f"{name}.svg": text.encode(), folder / f"{name}.png": image}
    replace_own(files, folder / CHARTS_MANIFEST, "charts")
    return list(files)


def sweep_maps(content: xarray.Dataset) -> dict[str, SweptMap]:
    """Maps of every figure over the first two dense fields, by the names of their files.

    Up to four values of a third field have maps of their own; every other field is at its middle value.
    """
    from pneutouch.report.swept import SweptMap, spread_places

    axes = {name: _axis(content, name) for name in map(str, content["status"].dims) if name != PRESSURE}
    first, second = check_dense({name: axis.values for name, axis in axes.items() if name != "point"})
    content = content.assign({INTERVAL: 50.0 * np.log(content[ENDS[1]] / content[ENDS[0]])}).sortby([first, second])
    others = [name for name in axes if name not in (first, second)]
    # Names before numbers, and last what does not vary.
    others.sort(key=lambda name: (len(axes[name].values) == 1, axes[name].numeric))
    at = {name: len(axes[name].values) // 2 for name in others}
    maps = {}
    for place in spread_places(len(axes[others[0]].values)) if others else [0]:
        at |= dict.fromkeys(others[:1], place)
        words = ", ".join([str(content.attrs["base_design"]), *(axes[name].named(k) for name, k in at.items())])
        ending = "".join(f"-{_cell(axes[name].values[place])}" for name in others[:1])
        cut = content.isel(at).transpose(first, second, ...)
        for name, (label, variable) in (FILLED_MAPPED if over_filling(content) else MAPPED).items():
            panels = _map_panels(cut, variable)
            if name == "sensitivity" or any(np.isfinite(panel.value).any() for panel in panels):
                caption = f"{label}: {words}; model {content.attrs['model']}"
                maps[f"{name}{ending}"] = SweptMap(caption, (_axis(cut, first), _axis(cut, second)), tuple(panels))
    return maps


def _map_panels(content: xarray.Dataset, variable: str) -> list[MapPanel]:
    """Panels of a figure, one for each of up to four driving pressures; a single one if it does not depend on it."""
    from pneutouch.report.swept import MapPanel, spread_places

    values, messages, axis = content[variable].values, content["message"].values, _axis(content, PRESSURE)
    if PRESSURE not in content[variable].dims:
        return [MapPanel("", values, missing_reasons(values, messages))]
    places = spread_places(len(axis.values))
    cuts = [(values[..., k], messages[..., k : k + 1]) for k in places]
    return [MapPanel(axis.named(k), cut[0], missing_reasons(*cut)) for k, cut in zip(places, cuts, strict=True)]
