"""The model ``local``: the solid's results for the neighbourhood of one design of any shape, from a stored table.

``pneutouch table`` builds the table and stores it in the user's cache; `local_tables` finds those that are there.
"""

import hashlib
import os
import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache, lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import BeyondLimitError, ComputationError, InputError, PneutouchError
from pneutouch.mechanics.atlas.local import (
    REACH,
    STEP,
    LocalAtlas,
    LocalRecipe,
    Progress,
    base_sizes,
    build,
    fixed_sizes,
    recipe_of,
)
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.atlas.recipe import FIELDS
from pneutouch.mechanics.atlas.respond import NEAR, run
from pneutouch.mechanics.atlas.surveyed import INFLATED
from pneutouch.mechanics.models.accuracy import (
    BODY,
    NOT_CHECKED,
    TABULATION,
    discretised,
    sensitivity_discretisation,
    solid_assumptions,
)
from pneutouch.mechanics.models.atlas import VACUUM, FreeCurves, read_answer
from pneutouch.mechanics.models.interface import Answered, Limitation, ModelAnswer, SensorModel, one_by_one
from pneutouch.mechanics.models.solid import solid_states
from pneutouch.mechanics.sensor import Sensor
from pneutouch.results.prediction import ErrorEstimate
from pneutouch.shape.hemisphere import Hemisphere

_HELD_OUT = 20
"""Presses by the solid with which a table is compared: random designs of the neighbourhood, moduli and pressures."""
_STEPS = (STEP, 0.5 * STEP)
"""Steps between the surveyed designs that are tried in turn, until the error is small enough."""
_HOPELESS = 6.0
"""Error over the allowed one from which half a step, with an eighth of the error, will not do."""
_UNANSWERED = 0.5
"""Greatest share of these presses that a table need not answer."""
_OTHER_MODULUS = 0.35
"""Greatest difference in ln modulus of these designs from the table's."""
_SOURCES = ("shape", "mechanics/laws", "mechanics/solid", "mechanics/atlas", "mechanics/models/solid.py")
_UP_TO = 0.97
"""Share of the greatest driving pressure of a table up to which it is used: its edge is less exact."""
_BASE_WITHIN = 0.1
"""Difference in the sizes of the rigid base, R0, within which a table is used."""

_BUCKLES = Limitation(f"the wall would buckle within {NEAR:g} R0 more of travel", False)
_ABOVE = Limitation("the driving pressure is above those of its table", True)
_SHORT = Limitation("the range ends before half of the table's depth", False, beyond_error=True)


class LocalTable(NamedTuple):
    """A stored table: its file, its tables, and the relative errors (n,) of sensitivity in presses by the solid at
    random places of the neighbourhood, NaN for one that the table does not answer."""

    path: Path
    atlas: LocalAtlas
    errors: Array

    @property
    def error(self) -> float:
        """Greatest measured error of the sensitivity, relative."""
        return float(np.nanmax(self.errors))


class LocalTables(SensorModel):
    """The tables in the user's cache as a model."""

    name = "local"

    def covers(self, sensor: Sensor) -> str | None:
        """Reason why no stored table covers a sensor, or None if one does."""
        why = outside_tables(sensor)
        if why is not None:
            return why
        table, damaged = find(sensor)
        if table is not None:
            return None
        if damaged:
            return f"the stored table {damaged[0]} is damaged; `pneutouch table` builds it again"
        return "no table of this neighbourhood is stored; `pneutouch table` builds one"

    def answer(self, sensors: Sequence[Sensor], driving_pressures: Sequence[Array]) -> list[Answered]:
        """Answers from the tables, one sensor at a time."""
        return one_by_one(_answer, sensors, driving_pressures)

    def stated_error(self, sensor: Sensor) -> float:
        """Relative error of the solid's mesh and of the table in sensitivity."""
        return sensitivity_discretisation(sensor) + TABULATION

    def errors(self, sensor: Sensor, driving_pressures: Array) -> ErrorEstimate:
        """Errors of the solid's mesh, and the measured error of the table."""
        table, _ = find(sensor)
        assert table is not None
        text = (
            f"Local table: sensitivity within {table.error:.2%} of the solid in {table.errors.size} presses of its "
            f"neighbourhood; counted as {TABULATION:.2%}."
        )
        mesh = sensitivity_discretisation(sensor)
        return discretised(text, mesh, sensitivity_tabulation_relative=TABULATION)

    def assumptions(self, sensor: Sensor) -> tuple[str, ...]:
        """Assumptions of the solid."""
        return solid_assumptions(sensor, f"{BODY}; {NOT_CHECKED}")


MODEL = LocalTables()


def outside_tables(sensor: Sensor) -> str | None:
    """Reason why no local table can be built for a sensor; None if one can."""
    wall, dome = sensor.wall, sensor.dome
    reasons = [
        (sensor.protocol.other_contact is not None, str(sensor.protocol.other_contact)),
        (type(dome.shape) is Hemisphere, "the shipped atlas is for hemispheres"),
        (wall.grade is not None, "the wall is graded along its arc"),
        (wall.law is not None, "the resin has a law of its own, not the neo-Hookean one"),
        (dome.flange is not None, "the flange is held as printed, not the base plane"),
        (dome.base is None, "the wall passes through its base plane"),
    ]
    return next((why for applies, why in reasons if applies), None)


def _answer(sensor: Sensor, driving_pressures: Array) -> ModelAnswer:
    table, _ = find(sensor)
    assert table is not None
    return looked_up(table.atlas.of(sensor), sensor, driving_pressures)


def looked_up(atlas: LocalAtlas, sensor: Sensor, driving_pressures: Array) -> ModelAnswer:
    """Answer for a sensor at driving pressures (MPa) from tables for its sizes. Raises BeyondLimitError."""
    blown = np.clip(driving_pressures, 0.0, 0.999 * atlas.top_pressure(sensor) * sensor.wall.shear_modulus)
    passed = run(batch_of(sensor, blown), sensor.protocol.steps, atlas, FIELDS)
    fields = dict(zip(FIELDS, passed.press.several(FIELDS, passed.whole), strict=True))
    free = FreeCurves(*atlas.inflation(sensor))
    limit = float(free.pressure[INFLATED]) if atlas.has_limit else np.inf
    answer = read_answer(sensor, passed, fields, range(driving_pressures.size), free, limit)
    if isinstance(answer, PneutouchError):
        raise answer
    result = answer.result
    if not atlas.has_limit:
        result = replace(result, limit_point=None, limits=replace(result.limits, limit_point=None))
    lasts = atlas.last_travel(sensor, passed.press.free)
    return ModelAnswer(result, _limitation(sensor, atlas, driving_pressures, answer, lasts))


def _limitation(
    sensor: Sensor, atlas: LocalAtlas, pressures: Array, answer: ModelAnswer, lasts: Array
) -> Limitation | None:
    """Limitation of an answer; a range that is short for the shipped atlas is none if the table has that depth.

    ``lasts`` (n,) are the travels (R0) at which the wall buckles."""
    if (pressures < 0.0).any():
        return VACUUM
    if (pressures > _UP_TO * atlas.top_pressure(sensor) * sensor.wall.shear_modulus).any():
        return _ABOVE
    given, ends = answer.limitation, np.array([state.range_end for state in answer.result.states])
    if given is None and (ends / sensor.dome.inner_radius > lasts - NEAR).any():
        return _BUCKLES
    if given is None or given.beyond_error:
        half = 0.5 * atlas.local.depth * sensor.dome.inner_radius
        return _SHORT if ends.min() < half else None
    return given


def cache_folder() -> Path:
    """Folder of the stored tables: below ``$XDG_CACHE_HOME``, else the system's usual place for caches of a user."""
    named, home = os.environ.get("XDG_CACHE_HOME"), Path("~").expanduser()
    usual = {"win32": home / "AppData" / "Local", "darwin": home / "Library" / "Caches"}
    root = Path(named) if named else usual.get(sys.platform, home / ".cache")
    return root / "pneutouch" / "tables"


@cache
def fingerprint(*more: str) -> str:
    """Fingerprint of the program's solid and shapes: of the files that make them, and of ``more`` files or folders."""
    package, digest = Path(__file__).parents[2], hashlib.sha256()
    for name in (*_SOURCES, *more):
        place = package / name
        for path in sorted(place.glob("*.py")) if place.is_dir() else [place]:
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def table_path(recipe: LocalRecipe) -> Path:
    """File of the table of a recipe."""
    return cache_folder() / f"{recipe.shape}-{hashlib.sha256(recipe.text().encode()).hexdigest()[:16]}.npz"


def find(sensor: Sensor) -> tuple[LocalTable | None, list[Path]]:
    """The stored table nearest to a sensor whose neighbourhood holds it, None without one; and the damaged files."""
    nearest, damaged, least = None, [], np.inf
    for path in sorted(cache_folder().glob(f"{sensor.dome.shape.key}-*.npz")):
        state = path.stat()
        try:
            table = load(path, state.st_mtime_ns, state.st_size)
        except InputError:
            damaged.append(path)
            continue
        if table is not None and _fits(table.atlas, sensor):
            distance = float(np.abs(table.atlas.place(sensor)).max())
            nearest, least = (table, distance) if distance < least else (nearest, least)
    return nearest, damaged


def _fits(atlas: LocalAtlas, sensor: Sensor) -> bool:
    local, size = atlas.local, sensor.dome.inner_radius
    depth, gas = sensor.protocol.depth / size, sensor.gas.ambient_pressure / sensor.wall.shear_modulus
    base = base_sizes(sensor)
    return bool(
        local.fixed == fixed_sizes(sensor)
        and local.poisson_ratio == sensor.wall.poisson_ratio
        and len(base) == len(local.base)
        and np.allclose(base, local.base, rtol=0.0, atol=_BASE_WITHIN)
        and (np.abs(atlas.place(sensor)) <= REACH).all()
        and 0.5 * local.depth < depth <= local.depth * (1.0 + 1e-9)
        and atlas.softest <= gas <= atlas.recipe.stiffest
    )


@lru_cache(maxsize=32)
def load(path: Path, changed: int, size: int) -> LocalTable | None:
    """The table in a file; None for one of another solid or recipe. ``changed``, ``size``: of the file, for the cache.

    Raises InputError for a damaged file.
    """
    try:
        with path.open("rb") as opened, np.load(opened, allow_pickle=False) as file:
            recipe = LocalRecipe.from_text(str(file["recipe"]))
            tables = {name: file[name] for name in file.files if name != "recipe"}
        errors = tables.pop("errors")
        table = LocalTable(path, LocalAtlas(tables, recipe, np.array(recipe.centre)), errors)
    except Exception as error:
        raise InputError(
            f"the table is damaged: {error}", file=path, remedy="build it again: `pneutouch table`"
        ) from error
    return table if recipe.fingerprint == fingerprint() and table_path(recipe).name == path.name else None


def make(sensor: Sensor, greatest_pressure: float, progress: Progress = lambda done, total: None) -> LocalTable:
    """Build the table around a sensor for driving pressures up to one (MPa), measure its error, and store it.

    Raises InputError for a sensor without tables, ComputationError if the solid fails or the error is too large.
    """
    why = outside_tables(sensor)
    if why is not None:
        raise InputError(f"no local table: {why}", key="design", remedy="take `model` auto")
    for step in _STEPS:
        recipe = recipe_of(sensor, greatest_pressure, fingerprint(), step)
        atlas = build(sensor, recipe, progress)
        table = LocalTable(table_path(recipe), atlas, measured(atlas, sensor, greatest_pressure))
        if np.isnan(table.errors).mean() > _UNANSWERED:
            problem = "the wall buckles, or leaves the table, in most presses of the neighbourhood"
            raise ComputationError(problem, remedy="take `model` solid")
        if table.error <= TABULATION:
            store(table)
            return table
        if table.error > _HOPELESS * TABULATION:
            break
    problem = f"the table's sensitivity is up to {table.error:.1%} off the solid's, more than {TABULATION:.2%}"
    raise ComputationError(problem, remedy="give a smaller indentation.depth_mm, or take `model` solid")


def store(table: LocalTable) -> None:
    """Write a table to its file. Raises InputError if that is impossible."""
    held: dict[str, Any] = {**table.atlas.tables, "recipe": table.atlas.local.text(), "errors": table.errors}
    store_arrays(table.path, held)


def store_arrays(path: Path, held: Mapping[str, Any]) -> None:
    """Write arrays by name to a file of the cache. Raises InputError if that is impossible."""
    part = path.with_suffix(f".{os.getpid()}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with part.open("wb") as file:
            np.savez_compressed(file, **held)
        part.replace(path)
    except OSError as error:
        raise InputError(f"the table cannot be stored: {error.strerror}", file=path) from error


def measured(atlas: LocalAtlas, sensor: Sensor, greatest_pressure: float, count: int = _HELD_OUT) -> Array:
    """Relative errors (count,) of the table's sensitivity at random places of its neighbourhood; NaN: no answer."""
    rng, local, size = np.random.default_rng(0), atlas.local, sensor.dome.inner_radius
    errors = np.full(count, np.nan)
    for i in range(count):
        place = rng.uniform(-1.0, 1.0, len(local.names))
        sizes = np.array(local.centre) * np.exp(local.step * place) * size
        modulus = sensor.wall.shear_modulus * float(np.exp(rng.uniform(-_OTHER_MODULUS, _OTHER_MODULUS)))
        pressure = greatest_pressure * float(rng.choice([0.0, 0.5, 1.0]))
        other = sensor.replace(**dict(zip(local.names, sizes.tolist(), strict=True)), shear_modulus=modulus)
        try:
            found = looked_up(atlas.of(other), other, np.array([pressure]))
            (state,) = solid_states(other, np.array([pressure]))
        except BeyondLimitError:
            continue
        line = found.result.states[0].figures
        if found.limitation is None and line is not None and state.figures is not None:
            errors[i] = abs(line.sensitivity / state.figures.sensitivity - 1.0)
    return errors
