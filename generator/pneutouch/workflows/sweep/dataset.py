"""Conversion of records to one xarray dataset, and of the dataset to the bytes of a netCDF file.

netCDF-3 with 64-bit offsets, by scipy: it needs no further library here, every tool reads it, and it holds no clock.
"""

from __future__ import annotations

import hashlib
import json
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
from pneutouch.workflows.sweep.journal import SweepColumns, check_output
from pneutouch.workflows.sweep.variables import ENDS, INTERVAL, MAPPED, POINT, STATE, SweepVariable, missing_reasons
from pneutouch.workflows.sweep.work import SweepStudy

if TYPE_CHECKING:
    import xarray

    from pneutouch.report.swept import MapPanel, SweptFigure, SweptMap


PRESSURE = "driving_pressure_kPa"
"""Name of the dimension of driving pressures, which holds all that any point has."""

MOST_BYTES = 2**32
"""Largest size of a dataset, which is in memory as a whole: more than `journal.MOST_STATES` states take."""

_CONTENT_HASH = "content_hash"


def dataset(columns: SweepColumns) -> xarray.Dataset:
    """Dataset of a finished sweep. Its dimensions are those of the grid, or ``point``, and the driving pressure.
    Missing numbers are NaN, missing texts are empty."""
    import xarray

    plan = columns.study.plan
    every, dims = (*plan.shape, len(columns.pressures_kPa)), (*plan.dimensions, PRESSURE)
    content: dict[str, Any] = {v.name: _variable(v, columns.states[v.name], every, dims) for v in STATE}
    content |= {v.name: _variable(v, columns.points[v.name], plan.shape, plan.dimensions) for v in POINT}
    coordinates = {
        PRESSURE: (
            PRESSURE,
            np.array(columns.pressures_kPa),
            {"units": "kPa", "long_name": "gauge pressure before contact", "key": PRESSURES},
        ),
        **_coordinates(columns.study),
    }
    whole = xarray.Dataset(content, coordinates, _attributes(columns.study, content))
    whole.attrs[_CONTENT_HASH] = _content_hash(whole)
    return whole


def _content_hash(content: xarray.Dataset) -> str:
    """SHA-256 of names, dimensions, values and attributes, by which a damaged dataset is recognised."""
    digest = hashlib.sha256()
    for name in sorted(map(str, content.variables)):
        column = content[name]
        values = column.values
        head = [
            name,
            list(map(str, column.dims)),
            list(values.shape),
            sorted((k, str(v)) for k, v in column.attrs.items()),
        ]
        digest.update(json.dumps(head).encode())
        if values.dtype.kind not in "OU":
            digest.update(values.astype("<f8").tobytes())
            continue
        # Row by row: all words of a large sweep as one text take more memory than its dataset.
        for k, part in enumerate(values):
            digest.update((", " if k else "[").encode() + json.dumps(np.asarray(part).tolist()).encode())
        digest.update(b"]")
    attributes = sorted((str(k), str(v)) for k, v in content.attrs.items() if k != _CONTENT_HASH)
    digest.update(json.dumps(attributes).encode())
    return digest.hexdigest()


def netcdf(content: xarray.Dataset, path: Path) -> None:
    """Write the dataset as a netCDF file. Raises OSError."""
    content.to_netcdf(path, engine="scipy", format="NETCDF3_64BIT")


def stored_fingerprint(path: Path) -> str:
    """Fingerprint of a finished sweep, its file read whole. Raises InputError if it is no dataset, or damaged."""
    why, remedy = "not a dataset that pneutouch sweep wrote, or damaged", "move it away or give another `out`"
    return str(_loaded(path, InputError(f"{path}: {why}", key="out", remedy=remedy)).attrs["input_hash"])


def stored_dataset(path: Path) -> xarray.Dataset:
    """Dataset of a finished sweep. Raises InputError if it is not as it was written."""
    why = "the dataset is damaged: its content is not what the sweep wrote"
    return _loaded(path, InputError(why, file=path, remedy="move it, or compute it again with `fresh`"), hashed=True)


def _loaded(path: Path, damaged: InputError, *, hashed: bool = False) -> xarray.Dataset:
    """Dataset of a file; raises ``damaged`` if it is none, or if it is to be ``hashed`` and has another content."""
    import xarray

    _check_size(path)
    try:
        with xarray.open_dataset(path, engine="scipy") as opened:
            content = opened.load()
        check_format("dataset", content.attrs, path)
        if "input_hash" in content.attrs and (not hashed or content.attrs[_CONTENT_HASH] == _content_hash(content)):
            return content
    except InputError:
        raise
    # What was changed can be anything: a text that is no text, a number that is a date, a file that was cut.
    except Exception:
        pass
    raise damaged


def _check_size(path: Path) -> None:
    size = check_plain(path, "dataset")
    if size > MOST_BYTES:
        raise oversized(path, size, MOST_BYTES, "dataset")


def _variable(variable: SweepVariable, values: Any, shape: tuple[int, ...], dims: tuple[str, ...]) -> Any:
    names = ({} if variable.text else {"units": variable.units}) | {"long_name": variable.long_name}
    return dims, values.reshape(shape), names


Coordinate = tuple[str, Any, dict[str, str]]
"""Dimension of a coordinate, its values, and its attributes."""


def _coordinates(study: SweepStudy) -> dict[str, Coordinate]:
    """Values of the varied fields: in a grid along a dimension of their own, in a list along ``point``."""
    plan = study.plan
    if plan.axes:
        return {axis.name: (axis.name, *_column(axis.key, axis.values)) for axis in plan.axes}
    coordinates: dict[str, Coordinate] = {
        "point": ("point", np.arange(plan.count, dtype=np.int32), {"long_name": "number in the list"})
    }
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
        return np.array([str(value).lower() if isinstance(value, bool) else value for value in values], object), names
    if table.model_fields[field].annotation is int:
        return np.array(values, np.int32), {"units": declared.unit or "1", **names}
    return np.array(values, float), {"units": declared.unit or "1", **names}


def _attributes(study: SweepStudy, content: dict[str, Any]) -> dict[str, str]:
    plan = study.plan
    bases = sorted({text for text in content["error_sensitivity_basis"][1].ravel() if text})
    design = study.base.model_dump(mode="json")
    return {
        KEY: format_of("dataset"),
        "title": f"pneutouch sweep {plan.name}",
        "pneutouch_version": __version__,
        "model": "solid, harmonic off the axis" if plan.model == USUAL else plan.model,
        **({"closure": plan.closure} if plan.model == "membrane" else {"clamp": plan.clamp}),
        "base_design": study.name,
        "base_design_content": json.dumps(design, sort_keys=True, ensure_ascii=False),
        "set_for_all_points": json.dumps(plan.settings, sort_keys=True, ensure_ascii=False),
        "input_hash": study.fingerprint,
        "error_estimate": "\n".join(bases) or "no point was predicted",
    }


def table_rows(content: xarray.Dataset) -> Iterator[dict[str, Any]]:
    """A row for each state, in the dataset's order: swept fields, driving pressure, figures; None if missing."""
    dims = list(content["status"].dims)
    names = [v.name for v in (*STATE, *POINT)]
    fields = [str(name) for name in content.coords if name not in (*dims, PRESSURE)]
    swept = [*(str(dim) for dim in dims if dim != PRESSURE), *fields]
    arrays = {}
    for name in (*swept, PRESSURE, *names):
        own = content[name].dims
        values = content[name].transpose(*(dim for dim in dims if dim in own)).values
        whole = values.reshape([content.sizes[dim] if dim in own else 1 for dim in dims])
        arrays[name] = np.broadcast_to(whole, [content.sizes[dim] for dim in dims])
    for k in range(content.sizes[dims[0]]):
        columns = [values[k].ravel().tolist() for values in arrays.values()]
        for row in zip(*columns, strict=True):
            found = {name: None if x != x else x for name, x in zip(arrays, row, strict=True)}
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
    """Raise InputError if ``out`` cannot be a dataset, or its table or a picture would replace another file, or one
    that was changed."""
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
    """Sensitivity over the swept fields, to be drawn; None if no state has one. A list becomes a grid (`_gridded`)."""
    from pneutouch.report.swept import SweptFigure

    if not np.isfinite(content[SENSITIVITY_KEY].values).any():
        return None
    dims = [str(dim) for dim in content[SENSITIVITY_KEY].dims]
    if dims[0] == "point":
        content = _gridded(content)
        dims = [str(dim) for dim in content[SENSITIVITY_KEY].dims]
    axes = tuple(_axis(content, name) for name in dims)
    arrays = (content[name].values for name in (SENSITIVITY_KEY, *ENDS))
    return SweptFigure("sensitivity  (kPa/N)", axes, *arrays)


def _gridded(content: xarray.Dataset) -> xarray.Dataset:
    """A list of points over its varied field, if it is the only one and without repeats; else over their number."""
    fields = [str(name) for name, values in content.coords.items() if name != "point" and values.dims == ("point",)]
    kept = content[[SENSITIVITY_KEY, *ENDS]]
    places = list(zip(*(content[name].values.tolist() for name in fields), strict=True))
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
        for name, (label, variable) in MAPPED.items():
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
