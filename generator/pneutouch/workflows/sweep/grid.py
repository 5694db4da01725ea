"""Plan of a sweep, from a file or from flags: the varied fields of a design, their values, and the points."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, get_origin

from pydantic.fields import FieldInfo

from pneutouch.catalogue import DesignSource
from pneutouch.catalogue.library import read_given
from pneutouch.errors import InputError, nearest, shown
from pneutouch.evaluation.evaluate import CLAMPS
from pneutouch.mechanics import MODEL_CHOICES
from pneutouch.mechanics.models.choice import CLOSURES, USUAL
from pneutouch.spec.design import CALIBRATION, DesignFile
from pneutouch.spec.fields import table_of
from pneutouch.spec.files import design_inside
from pneutouch.spec.read import Changes
from pneutouch.spec.tray import MAX_VALUES, parse_over, spread
from pneutouch.spec.values import file_name, is_finite, name_of

PRESSURES = "pneumatics.driving_pressures_kPa"
"""The one field that is a dimension of every sweep, because a prediction gives all its states at once."""

FILLINGS = "pneumatics.injected_volumes_mL", "pneumatics.apex_heights_mm"
"""Fields of which a point of a sweep has one value, as a state beside those at its driving pressures."""

MAX_POINTS = 10_000_000
"""Greatest number of points that are computed without being asked for again: ten hours of one core by the atlas."""

MOST_POINTS = 2**31 - 1
"""Greatest number of points: the longest dimension of a netCDF file."""

Value = float | int | str | bool | list[Any]
Settings = dict[str, Value]


@dataclass(frozen=True, slots=True)
class SweepAxis:
    """One field of the design, ``table.key``, and the values that it takes."""

    key: str
    values: tuple[float | int | str | bool, ...]

    @property
    def name(self) -> str:
        """Name of the dimension: ``membrane.material`` becomes ``membrane_material``, an identifier in any language."""
        return self.key.replace(".", "_")


@dataclass(frozen=True, slots=True)
class SweepPlan:
    """A base design, the settings of all points, and either the ``axes`` of a grid or a list of ``points``.

    ``where`` names the sweep file or the flags, for messages; ``design`` is a name, a path or a source.
    """

    name: str
    where: str
    design: str | DesignSource
    settings: Settings
    axes: tuple[SweepAxis, ...] = ()
    points: tuple[Settings, ...] = ()
    model: str = USUAL
    closure: str = "variational"
    clamp: str = "base"

    def __post_init__(self) -> None:
        """Raise InputError if the plan contradicts itself or names what does not exist."""
        for option, value, known in (
            ("model", self.model, MODEL_CHOICES),
            ("closure", self.closure, CLOSURES),
            ("clamp", self.clamp, CLAMPS),
        ):
            if value not in known and (option, value) != ("model", USUAL):
                raise InputError(f"{option} = {shown(value)}: unknown.{nearest(value, known)}", file=self.where)
        if bool(self.axes) == bool(self.points):
            raise InputError("give either a grid or a list of points, one of them and not both", file=self.where)
        varied = [axis.key for axis in self.axes] + [key for point in self.points for key in point]
        for key in (*(key for key in self.settings if key != CALIBRATION), *varied):
            _check_key(self.where, key)
        for key in dict.fromkeys(varied):
            if key in self.settings:
                raise InputError(
                    "set for all points and varied too", file=self.where, key=key, value=self.settings[key]
                )
        if self.count > MOST_POINTS:
            raise InputError(f"{self.count} points", file=self.where, remedy=f"it must be at most {MOST_POINTS}")

    @property
    def shape(self) -> tuple[int, ...]:
        """Lengths of the dimensions that number the points."""
        return tuple(len(axis.values) for axis in self.axes) if self.axes else (len(self.points),)

    @property
    def dimensions(self) -> tuple[str, ...]:
        """Names of the dimensions that number the points."""
        return tuple(axis.name for axis in self.axes) if self.axes else ("point",)

    @property
    def count(self) -> int:
        """Number of points."""
        return math.prod(self.shape)

    @property
    def varied(self) -> tuple[str, ...]:
        """Fields that differ between points, in the order written."""
        keys = [axis.key for axis in self.axes] or [key for point in self.points for key in point]
        return tuple(dict.fromkeys(keys))

    def position(self, index: int) -> tuple[int, ...]:
        """Index of a point along every dimension; the last dimension varies fastest."""
        places = []
        for length in reversed(self.shape):
            index, here = divmod(index, length)
            places.append(here)
        return tuple(reversed(places))

    def overrides(self, index: int) -> Settings:
        """All settings of the point ``index``, including those common to all points."""
        if self.points:
            own = self.points[index]
        else:
            own = {axis.key: axis.values[k] for axis, k in zip(self.axes, self.position(index), strict=True)}
        given = {**self.settings, **own}
        return {
            key: [value] if key in FILLINGS and not isinstance(value, list) else value for key, value in given.items()
        }


def _check_key(where: str, key: str) -> None:
    table_name, dot, field = key.partition(".")
    table = table_of(DesignFile, table_name)
    if not dot:
        raise InputError("write table.key, such as membrane.wall_thickness_mm", file=where, key=key)
    if table is None:
        problem = f"unknown table {table_name}.{nearest(table_name, DesignFile.model_fields)}"
        raise InputError(problem, file=where, key=key)
    if field not in table.model_fields:
        raise InputError(f"unknown key.{nearest(field, table.model_fields)}", file=where, key=key)
    if table_name == "document":
        raise InputError("no prediction depends on it", file=where, key=key, remedy="sweep over another table")


def _field(key: str) -> FieldInfo | None:
    """Declaration of ``table.key``; None if there is none."""
    table_name, _, name = key.partition(".")
    table = table_of(DesignFile, table_name)
    return None if table is None else table.model_fields.get(name)


def takes_words(key: str) -> bool:
    """True if the field is one of a few words, or a boolean."""
    field = _field(key)
    return field is not None and (field.annotation is bool or get_origin(field.annotation) is Literal)


DENSE = 4
"""Least number of values of a field over which a map is drawn."""


def is_dense(values: Sequence[Any]) -> bool:
    """True for values over which a map can be drawn: at least `DENSE` numbers, all of them finite."""
    numbers = all(isinstance(v, int | float) and not isinstance(v, bool) and math.isfinite(v) for v in values)
    return numbers and len(values) >= DENSE


def check_dense(axes: Mapping[str, Sequence[Any]]) -> tuple[str, str]:
    """Names of the fields of a map: the first two dense ones of a grid. Raises InputError for fewer."""
    dense = [name for name, values in axes.items() if is_dense(values)]
    if len(dense) < 2:
        lengths = ", ".join(f"{name} with {len(values)}" for name, values in axes.items()) or "a list of points"
        problem = f"a map needs a grid over two fields of numbers, with {DENSE} values each; this sweep has {lengths}"
        raise InputError(problem, key="charts", remedy="give more, such as membrane.wall_thickness_mm=1:1.8:12")
    return dense[0], dense[1]


KEYS = ("design", "model", "closure", "clamp", "set", "grid", "point")
"""Keys that a sweep file may hold."""

_RANGE = {"from", "to", "count"}


def plan_of_file(path: Path, changes: Changes | None = None, **options: str | None) -> SweepPlan:
    """Plan of a sweep file; ``changes`` and ``options`` (model, closure, clamp) override it. Raises InputError."""
    where, content = str(path), read_given(path, "give the path of a sweep file; a design to vary is given as `design`")
    for key in content:
        if key not in KEYS:
            raise InputError(f"{key}: unknown key.{nearest(key, KEYS)}", file=where)
    words = {key: _text(where, key, content[key]) for key in KEYS[:4] if key in content}
    words |= {key: value for key, value in options.items() if value is not None}
    design = words.pop("design", "")
    if not design:
        raise InputError("design: missing", file=where, remedy='name the base design, such as design = "paper-dome"')
    design = design_inside(path.parent, design, file=path, key="design")
    fixed = {key: _entries(where, key, v, key) for key, v in _flat(where, "set", content.get("set", {})).items()}
    grid = {key: _values(where, key, v) for key, v in _flat(where, "grid", content.get("grid", {})).items()}
    entries = content.get("point", [])
    if not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
        raise InputError("point: must be a list of tables, each headed [[point]]", file=where)
    points = tuple(
        {key: _entries(where, key, v, f"point[{k}]: {key}") for key, v in _flat(where, f"point[{k}]", entry).items()}
        for k, entry in enumerate(entries)
    )
    fixed |= _checked(changes)
    return _plan(name_of(path), where, design, fixed, grid, points, words)


def plan_of_flags(design: str, over: list[str], changes: Changes | None = None, **options: str | None) -> SweepPlan:
    """Plan of a grid from texts ``table.key=VALUES``: values with commas between, or ``from:to:count``."""
    # A single list in brackets is the list of values, because a sweep varies scalars.
    varied = parse_over(over).items()
    grid = {key: each[0] if len(each) == 1 and isinstance(each[0], list) else each for key, each in varied}
    return plan_of_grid(design, grid, changes, "over", **options)


def plan_of_grid(
    design: str | DesignSource,
    grid: Mapping[str, Any],
    changes: Changes | None = None,
    where: str = "over",
    **options: str | None,
) -> SweepPlan:
    """Plan of a grid over each ``table.key``: a list, or from, to and count; ``where`` is the file in messages."""
    values = {key: _values(where, key, entry) for key, entry in grid.items()}
    words = {key: value for key, value in options.items() if value is not None}
    name = design.name if isinstance(design, DesignSource) else file_name(Path(design).stem)
    return _plan(f"{name}-sweep", where, design, _checked(changes), values, (), words)


def _plan(
    name: str,
    where: str,
    design: str | DesignSource,
    fixed: Settings,
    grid: dict[str, list[Any]],
    points: tuple[Settings, ...],
    words: dict[str, str],
) -> SweepPlan:
    """The plan; driving pressures of a grid become those of every point, because they are a dimension already."""
    if PRESSURES in grid:
        if PRESSURES in fixed:
            raise InputError("set for all points and varied too", file=where, key=PRESSURES, value=fixed[PRESSURES])
        fixed = {**fixed, PRESSURES: grid[PRESSURES]}
    axes = tuple(SweepAxis(key, tuple(values)) for key, values in grid.items() if key != PRESSURES)
    return SweepPlan(
        name, where, design, fixed, axes, points or (({},) if PRESSURES in grid and not axes else ()), **words
    )


def _values(where: str, key: str, given: Any) -> list[Any]:
    """Values of one axis, from a list or a table ``{from, to, count}``. Raises InputError for a value twice."""
    if isinstance(given, dict):
        if set(given) != _RANGE:
            raise InputError("a range has the keys from, to and count", file=where, key=key, value=given)
        given = spread(where, key, given["from"], given["to"], given["count"])
    if not isinstance(given, list) or not 1 <= len(given) <= MAX_VALUES:
        problem = f"must be a list of 1 to {MAX_VALUES} values, or {{from=, to=, count=}}"
        raise InputError(problem, file=where, key=key, value=given)
    values = [_scalar(where, key, value, f"{key}[{k}]") for k, value in enumerate(given)]
    seen: set[Any] = set()
    for k, value in enumerate(values):
        if value in seen:
            raise InputError("every value may appear once only", file=where, key=f"{key}[{k}]", value=value)
        seen.add(value)
    return values


def _entries(where: str, key: str, given: Any, label: str) -> Value:
    """Value of one field at one point: a number, a text, a boolean, or a list of numbers or of such lists.

    ``label`` is the key in messages."""
    if isinstance(given, list):
        return [_entries(where, key, value, f"{label}[{k}]") for k, value in enumerate(given)]
    return _scalar(where, key, given, label)


def _scalar(where: str, key: str, given: Any, label: str) -> float | int | str | bool:
    """A value that JSON can hold: infinity, if the field takes it, is the text "inf". Raises InputError for others."""
    field = _field(key)
    if given == math.inf and field and any(getattr(entry, "allow_inf_nan", False) for entry in field.metadata):
        return "inf"
    is_flag = field is not None and field.annotation is bool
    allowed = is_flag if isinstance(given, bool) else isinstance(given, str) or is_finite(given)
    if not allowed:
        raise InputError("must be a finite number or a name", file=where, key=label, value=given)
    return given  # type: ignore[no-any-return]


def _flat(where: str, table: str, given: Any) -> dict[str, Any]:
    """Keys as ``table.key``, from quoted keys, or from dotted keys, which TOML turns into tables."""
    if not isinstance(given, dict):
        raise InputError(f"{table} = {shown(given)}: must be a table", file=where)
    flat: dict[str, Any] = {}
    for key, value in given.items():
        inner = (
            {f"{key}.{k}": v for k, v in value.items()} if isinstance(value, dict) and "." not in key else {key: value}
        )
        for name, item in inner.items():
            if name in flat:
                raise InputError(f"{table}: {name} is given twice", file=where)
            flat[name] = item
    return flat


def _checked(changes: Changes | None) -> Settings:
    return {key: _entries("set", key, value, key) for key, value in (changes or {}).items()}


def _text(where: str, key: str, given: Any) -> str:
    if not isinstance(given, str) or not given:
        raise InputError(f"{key} = {shown(given)}: must be a name", file=where)
    return given
