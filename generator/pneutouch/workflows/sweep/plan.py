"""A plan: the varied fields of a design, their values, and the points of the sweep."""

import math
from dataclasses import dataclass
from typing import Any

from pneutouch.catalogue import DesignSource
from pneutouch.errors import InputError, nearest, shown
from pneutouch.evaluation.evaluate import CLAMPS
from pneutouch.mechanics import MODEL_CHOICES
from pneutouch.mechanics.contact import CLOSURES
from pneutouch.mechanics.models import USUAL
from pneutouch.spec.design import CALIBRATION, DesignFile
from pneutouch.spec.fields import table_of

PRESSURES = "pneumatics.driving_pressures_kPa"
"""The one field that is a dimension of every sweep: a prediction gives all its states at once."""

MAX_POINTS = 100_000

Value = float | int | str | bool | list[Any]
Settings = dict[str, Value]


@dataclass(frozen=True, slots=True)
class SweepAxis:
    """One field of the design, ``table.key``, and the values it takes."""

    key: str
    values: tuple[float | int | str | bool, ...]

    @property
    def name(self) -> str:
        """Name of the dimension: ``membrane.material`` becomes ``membrane_material``, a name in any language."""
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
        """Raise InputError where the plan contradicts itself or names what does not exist."""
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
        if self.count > MAX_POINTS:
            raise InputError(f"{self.count} points", file=self.where, remedy=f"it must be at most {MAX_POINTS}")

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
        """The fields that differ between points, in the order written."""
        keys = [axis.key for axis in self.axes] or [key for point in self.points for key in point]
        return tuple(dict.fromkeys(keys))

    def position(self, index: int) -> tuple[int, ...]:
        """Place of a point along every dimension; the last varies fastest."""
        places = []
        for length in reversed(self.shape):
            index, here = divmod(index, length)
            places.append(here)
        return tuple(reversed(places))

    def overrides(self, index: int) -> Settings:
        """All settings of a point, those of all points included."""
        if self.points:
            return {**self.settings, **self.points[index]}
        place = self.position(index)
        return {**self.settings, **{axis.key: axis.values[k] for axis, k in zip(self.axes, place, strict=True)}}


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
