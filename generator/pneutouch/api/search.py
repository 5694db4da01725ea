"""Many designs: those that meet a target, and all those of a grid."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from pneutouch.api import show
from pneutouch.api.design import Design, source_of
from pneutouch.api.fields import WHERE, changes, named_by_keyword, path_of
from pneutouch.catalogue import DesignSource, Library
from pneutouch.catalogue.library import read_given
from pneutouch.errors import InputError, PneutouchError
from pneutouch.output.new import new_changed
from pneutouch.results.selection import (
    FoundDesign,
    GradedRecord,
    ProcessesRecord,
    SelectionRecord,
    ShapesRecord,
    SingleChange,
)
from pneutouch.spec.design import DesignFile
from pneutouch.spec.read import override, validate
from pneutouch.spec.target import Target
from pneutouch.stopping import temporary_folder
from pneutouch.wording import counted
from pneutouch.workflows.select.base import read_shelf
from pneutouch.workflows.select.checks import assigned
from pneutouch.workflows.select.search import FoundChoice, SelectedRecord, search

if TYPE_CHECKING:
    import xarray

    from pneutouch.parts import Assembly


_OnBase = TypeVar("_OnBase", bound=SelectionRecord | GradedRecord)


def unmet_lines(record: SelectedRecord) -> list[str]:
    """Lines on the nearest design and its misses, the requirements whose removal admits a design, and the designs that
    a check rejects."""
    if isinstance(record, ProcessesRecord):
        by_process = record.processes.items()
        return [
            *(f"{process}: {line}" for process, one in by_process if not one.met for line in unmet_lines(one)),
            *(f"{process}: {why}" for process, why in record.left_out.items()),
        ]
    if isinstance(record, ShapesRecord):
        return [f"{name}: {why}" for name, why in {**record.missed, **record.left_out}.items()]
    if isinstance(record, GradedRecord):
        return _of_grade(record)
    lines = [f"rejected: {_size(each.design)}: {each.reason}" for each in record.rejected]
    nearest = record.nearest
    if nearest is not None:
        missed = [
            f"{name}{', not known' if percent is None else f' by {percent:.3g} %'}"
            for name, percent in nearest.misses_percent.items()
        ]
        lines.append(f"nearest: {_size(nearest)}: misses {', '.join(missed) or 'nothing once rounded'}")
    if not record.rejected:
        dropped = record.dropped_requirements
        lines += [f"drop the requirement on {each.requirement}: {each.attainable}" for each in dropped]
        lines += [] if dropped else ["no design fits with any single requirement dropped"]
        theirs = record.target["setting"]["assignments"]
        lines += [f"enough by itself: {_keyword(each, theirs)}: {_size(each.design)}" for each in record.single_changes]
    return lines


def _of_grade(record: GradedRecord) -> list[str]:
    """Line on the nearest grade: why it is rejected, or by how much it exceeds each tolerance or limit, percent."""
    if record.rejected:
        return [f"rejected: {record.rejected}"]
    best = record.design
    used = ", ".join(f"{name} by {100 * (share - 1):.3g} %" for name, share in best.share_used.items() if share > 1)
    return [f"nearest grade: {best.reason or f'beyond what is allowed: {used}'}"]


def _keyword(change: SingleChange, assignments: list[str]) -> str:
    """A change as the keyword of `select`, with the ``assignments`` that the target has already."""
    key = change.field.partition(".")[2]
    return f"{key}={[*assignments, change.value] if key == 'assignments' else change.value!r}"


def _size(design: FoundDesign) -> str:
    radius_mm, wall_mm = show.short(design.inner_radius_mm), show.short(design.wall_thickness_mm)
    return f"{design.material}, R0 {radius_mm} mm, t0 {wall_mm} mm"


def with_base_named(fields: Mapping[str, Any]) -> tuple[dict[str, Any], Design | None]:
    """Keyword arguments of a target with a base that is a `Design` replaced by its name; and that design, or None."""
    setting = fields.get("setting")
    inner = setting.get("base") if isinstance(setting, Mapping) else None
    if isinstance(inner, Design) and isinstance(setting, Mapping):
        return {**fields, "setting": {**setting, "base": inner.name}}, inner
    base = fields.get("base")
    return ({**fields, "base": base.name}, base) if isinstance(base, Design) else (dict(fields), None)


class GivenBase:
    """A library that holds a design under its name, and the words that replace the path of its temporary file."""

    def __init__(self, design: Design | None, folder: Path) -> None:
        self._folder, self._design, self.library = folder, design, Library.default()
        if design is not None:
            new_changed(design.source, design.name, folder / "designs")
            self.library = Library((folder, *self.library.folders))

    def named(self, record: SelectedRecord) -> SelectedRecord:
        """The selection, with the design's name as its ``base`` in place of the temporary file."""
        if isinstance(record, ProcessesRecord):
            return replace(record, processes={key: self._renamed(one) for key, one in record.processes.items()})
        return record if isinstance(record, ShapesRecord) else self._renamed(record)

    def _renamed(self, record: _OnBase) -> _OnBase:
        if self._design is None or not self._holds(record.base):
            return record
        where = self._design.source.where
        return replace(record, base=self._design.name if where == WHERE else where)

    def blame(self, error: PneutouchError) -> None:
        """In an error, name the design's own file, or none, in place of the temporary file."""
        for each in (error, *error.others):
            if self._design is not None and each.file is not None and self._holds(each.file):
                each.file = self._design.source.where

    def _holds(self, file: str) -> bool:
        return Path(file).is_relative_to(self._folder)


@contextmanager
def given_base(design: Design | None) -> Iterator[GivenBase]:
    """The library of a selection on ``design``; None: the default library."""
    with temporary_folder() as folder:
        base = GivenBase(design, folder)
        try:
            yield base
        except PneutouchError as error:
            base.blame(error)
            raise


class Selection(show.Documented):
    """Designs that meet a target, best first; empty if none does. `to_dict` has the margins of each."""

    def __init__(self, designs: tuple[Design, ...], record: SelectedRecord) -> None:
        self.designs, self._record = designs, record

    def __iter__(self) -> Iterator[Design]:
        return iter(self.designs)

    def __len__(self) -> int:
        return len(self.designs)

    def __getitem__(self, place: int) -> Design:
        return self.designs[place]

    @property
    def met(self) -> bool:
        """True if a design meets the target."""
        return bool(self.designs)

    def _document(self) -> Any:
        return self._record

    def _head(self) -> str:
        return f"Selection: {counted(len(self.designs), 'design')} meet{'s' * (len(self.designs) == 1)} the target"

    def _picture(self) -> Assembly | None:
        return self.designs[0].assembly if self.designs else None

    def _rows(self) -> list[Any]:
        if not self.designs:
            return [(line,) for line in unmet_lines(self._record)]
        keys = ("material", "inner_radius_mm", "wall_thickness_mm", "driving_pressures_kPa")
        return [
            (design.name, *(f"{key}={show.short(getattr(design, key))}" for key in keys)) for design in self.designs
        ]


_REMEDY = "give the path of a target file, or keyword arguments such as sensitivity_kPa_per_N=1.9"


def select(target: str | Path | None = None, **fields: Any) -> Selection:
    """Designs for a target: a target file, keyword arguments named as its keys, or both; keywords override the file.

    ``select(sensitivity_kPa_per_N=1.9, driving_pressure_kPa=12)``. ``base`` may be a `Design`. With
    ``processes=["polyjet", "casting"]`` or ``"any"`` the designs are the best of each process, named after it; with
    ``shapes=["cap", "disc"]`` or ``"any"`` those of each shape. ``have`` is what the lab has: a mapping, or the path of
    a file. Raises InputError naming the keyword.
    """
    if isinstance(fields.get("have"), str | Path):
        fields["have"] = read_shelf(Path(fields["have"])).model_dump(exclude_none=True)
    file = None if target is None else path_of(target, "target", _REMEDY)
    named, design = with_base_named(fields)
    with named_by_keyword(Target), given_base(design) as base:
        content = override({} if file is None else read_given(file, _REMEDY), changes(Target, named), Target)
        where = WHERE if file is None else str(file)
        goal = validate(Target, {"target": {}, **content} if file is None else content, where)
        found = search(goal, where, base.library)
        designs = tuple(_selected(goal, choice) for choice in found.choices)
        return Selection(designs, base.named(found.record))


def _selected(goal: Target, choice: FoundChoice) -> Design:
    """The design of a search result: its base with the changes found, named after the base if the target has one."""
    name = f"{choice.base.name if goal.setting.base else 'selected'}-{choice.label}"
    return Design.of(DesignSource(name, assigned(choice.base.design, choice.assignments, name), WHERE))


def sweep(
    design: Design | str | Path,
    out: str | Path | None = None,
    *,
    model: str | None = None,
    closure: str = "variational",
    clamp: str = "base",
    workers: int = 1,
    fresh: bool = False,
    yes: bool = False,
    **fields: Any,
) -> xarray.Dataset:
    """Predict every combination of values of a design's fields, given as lists or as ``{"from", "to", "count"}``.

    A field with a single value has it in all designs. Without ``model`` the solid answers, and off the axis the model
    harmonic. ``out`` (a netCDF file) keeps the dataset, and the progress of a sweep that is interrupted. More than ten
    million designs need ``yes``. Raises InputError, and ComputationError where it stopped; Ctrl-C interrupts it.
    """
    import xarray

    from pneutouch.workflows.sweep import plan_of_grid
    from pneutouch.workflows.sweep import sweep as run
    from pneutouch.workflows.sweep.execute import ComputeResources

    with named_by_keyword(), temporary_folder() as folder:
        values = changes(DesignFile, fields)
        grid = {
            key: value
            for key, value in values.items()
            if isinstance(value, list) or (isinstance(value, Mapping) and "count" in value)
        }
        fixed = {key: value for key, value in values.items() if key not in grid}
        if not grid:
            raise InputError("no field has several values", remedy="give a list, such as wall_thickness_mm=[1, 1.2]")
        plan = plan_of_grid(source_of(design), grid, fixed, WHERE, model=model, closure=closure, clamp=clamp)
        path = folder / "sweep.nc" if out is None else Path(out)
        run(plan, path, ComputeResources(workers), fresh=fresh, yes=yes)
        return xarray.load_dataset(path, engine="scipy")


def map_sweep(dataset: xarray.Dataset | str | Path, charts: str | Path) -> list[Path]:
    """Draw contour maps of a sweep over two numeric fields of four values or more into a folder, SVG and PNG.

    ``dataset`` is one that `sweep` returned, or the path of its file. Returns the files. A refused or failed state is
    hatched, its reason in the legend. Raises InputError without two such fields.
    """
    from pneutouch.workflows.sweep.dataset import stored_dataset, write_maps

    with named_by_keyword():
        content = stored_dataset(Path(dataset)) if isinstance(dataset, str | Path) else dataset
        return write_maps(content, Path(charts))
