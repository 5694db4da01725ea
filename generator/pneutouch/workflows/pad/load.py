"""A pad with its cell resolved, its bodies, and the cell as a sensor behind its own channel."""

import math
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path

from pneutouch.arrays import Array
from pneutouch.body import Body, Solid
from pneutouch.catalogue import DesignSource, Library, ResolvedDesign, load_scene
from pneutouch.catalogue.library import compared
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import DrawnScene, Evaluation, PredictionOptions, evaluate_drawn, sensor_of
from pneutouch.mechanics.models.choice import DEFAULT_TOLERANCE
from pneutouch.parts.assembly import Assembly, print_offset
from pneutouch.parts.pad import PadLayout, lay_out_pad, pad_solids
from pneutouch.parts.pad.solids import line_volume
from pneutouch.spec.design import CALIBRATION, NO_CALIBRATION
from pneutouch.spec.pad import PadFile, PadGroup
from pneutouch.spec.printer import Mode, Printer
from pneutouch.spec.read import Changes, override, parse_changes, read_toml, validate
from pneutouch.spec.values import name_of
from pneutouch.units import ML

_OF_GROUPS = ("membrane.", "indentation.")
"""Keys of a design in which a group may differ by assignments."""
_DIGITS = 4
"""Decimals of a cell's dead volume, mL: cells of equal volume share one prediction."""


@dataclass(frozen=True)
class ResolvedPad:
    """A pad: its file, its cell as a scene, those of its groups, its layout. ``where`` is the file as it was given."""

    name: str
    where: str
    file: PadFile
    scene: ResolvedDesign
    groups: tuple[ResolvedDesign, ...]
    library: Library

    @cached_property
    def layout(self) -> PadLayout:
        """The places of cells, channels and ports."""
        return lay_out_pad(self.scene, self.file.pad, self.where, self.groups)

    @cached_property
    def solids(self) -> tuple[Solid, Solid]:
        """Membrane and manifold."""
        return pad_solids(self.scene, self.layout)

    @cached_property
    def bodies(self) -> tuple[Body, ...]:
        """Print meshes in the design frame: base plane z = 0, domes up."""
        return tuple(solid.mesh(self.scene.mesh_tolerance) for solid in self.solids)

    @property
    def print_offset(self) -> Array:
        """Shift (3,) in mm from the design frame to the print frame, whole millimetres."""
        return print_offset(self.bodies)

    def machine(self, name: str) -> tuple[Printer, Mode]:
        """Printer of a body, and its mode."""
        return Assembly(self.scene, self.layout.cell).machine(name)

    def solid(self, name: str) -> Solid:
        """The solid of this name: membrane or manifold."""
        return next(solid for solid in self.solids if solid.name == name)

    def job(self, name: str) -> str:
        """Name of the print job of a body: each is its own."""
        return name

    @property
    def plate_mm(self) -> float:
        """Thickness of the plate with the screw holes."""
        return min(self.scene.mount.plate_thickness, self.layout.cell.plate_high - self.layout.low)

    @property
    def glue_mL(self) -> float:
        """Glue between membrane and manifold, mL, as thick as the gap of a printed fit."""
        area = self.solids[0].base.volume() / self.layout.cell.flange_thickness
        holes = sum(math.pi * dome.inner_radius**2 for dome in self.layout.domes)
        return (area - holes) * self.scene.fit_clearance / ML

    def stands_up(self, name: str) -> bool:
        """True if a body is printed as it stands in the design frame, False if turned over, as of a single sensor."""
        if name == "membrane":
            return self.scene.design.print.orientation == "dome-up"
        body = self.bodies[1]
        return self.machine(name)[0].process != "filament" or body.under_ceilings(1.0) <= body.under_ceilings(-1.0)

    @cached_property
    def dead_volumes_mL(self) -> tuple[float, ...]:
        """Gas volume behind each cell, mL: as its design states it, else of channel, port, tube and gauge."""
        stated_mL = self.scene.design.pneumatics.dead_volume_mL
        if stated_mL is not None:
            return (stated_mL,) * len(self.layout.places)
        alone = Assembly(self.scene, self.layout.cell)
        behind_mL, count = alone.tube_volume / ML + alone.gauge_volume_mL, len(self.layout.places)
        return tuple(round(line_volume(self.layout, k) / ML + behind_mL, _DIGITS) for k in range(count))

    @cached_property
    def kinds(self) -> tuple[tuple[int, float], ...]:
        """For each cell the number of its group, and its dead volume, mL: cells with the same are alike."""
        return tuple(zip(self.file.pad.group_of, self.dead_volumes_mL, strict=True))

    @cached_property
    def evaluations(self) -> dict[tuple[int, float], Evaluation]:
        """The cells as sensors, by each of `kinds`."""
        find = partial(compared, self.library, self.scene.printer)
        return {kind: evaluate_drawn(self.drawn(*kind), find) for kind in sorted(set(self.kinds))}

    @property
    def worst(self) -> tuple[Evaluation, ...]:
        """By group, that of none first: the cell with the most gas behind it, which reads least."""
        return tuple(self.evaluations[kind] for kind in self.worst_kinds)

    @property
    def worst_kinds(self) -> tuple[tuple[int, float], ...]:
        """Those of `kinds` with the most gas, by group."""
        return tuple(max(kind for kind in self.kinds if kind[0] == group) for group in range(1 + len(self.groups)))

    def drawn(self, group: int, volume_mL: float) -> DrawnScene:
        """A cell of a group as a sensor with a dead volume, on the manifold, for a connector of its own need not have
        space; and on the flange of the pad, where its wall stands upright."""
        scene = (self.scene, *self.groups)[group]
        design = scene.design
        pneumatics = design.pneumatics.model_copy(update={"dead_volume_mL": volume_mL})
        scene = replace(scene, design=design.model_copy(update={"pneumatics": pneumatics}))
        layout = self.layout.domes[self.file.pad.group_of.index(group)]
        assembly, clamp = Assembly(scene, layout), "flange" if layout.shape.plain.upright else "base"
        options = PredictionOptions("solid", "variational", clamp, DEFAULT_TOLERANCE)
        return DrawnScene(scene, assembly, sensor_of(assembly, clamp), options, ())


def load_pad(name: str, changes: Changes | None = None, library: Library | None = None) -> ResolvedPad:
    """Load a pad by name or path; ``changes`` of [pad] and [document] are of the pad, others of its cell.

    Raises InputError naming file, key and value."""
    library = library or Library.default()
    path = library.pad_file(name)
    if path is None:
        raise InputError("no such pad or file", key="pad", value=name, remedy="give the name or the path of a pad")
    own = {key: value for key, value in (changes or {}).items() if key.partition(".")[0] in ("pad", "document")}
    # What a single sensor was calibrated to is not what is printed anew.
    of_cell = {CALIBRATION: NO_CALIBRATION} | {key: one for key, one in (changes or {}).items() if key not in own}
    file: PadFile = validate(PadFile, override(read_toml(path), own, PadFile), str(path))
    try:
        source = DesignSource.of(file.pad.cell, library)
    except InputError as error:
        raise InputError(
            error.problem, file=str(path), key="pad.cell", value=file.pad.cell, remedy=error.remedy
        ) from None
    groups = [
        _scene_of(group, f"pad.groups[{k}]", path, source, of_cell, library) for k, group in enumerate(file.pad.groups)
    ]
    return ResolvedPad(name_of(path), str(path), file, load_scene(source, of_cell, library), tuple(groups), library)


def _scene_of(
    group: PadGroup, key: str, path: Path, source: DesignSource, of_cell: Changes, library: Library
) -> ResolvedDesign:
    """The cell of a group. Raises InputError, also for what all cells of a membrane share."""
    try:
        assigned = parse_changes(group.assignments)
        shared = [one for one in assigned if not one.startswith(_OF_GROUPS) or one == "membrane.material"]
        if not shared:
            scene = load_scene(source, {**of_cell, **assigned, **group.pressures}, library)
            return replace(scene, where=f"{path}: {key}")
    except InputError as error:
        problem = f"{'assignments' if error.key == 'set' else error.key}: {error.problem}"
        raise InputError(problem, file=str(path), key=key, value=error.value, remedy=error.remedy) from None
    remedy = "give changes of dome or test, and a driving pressure as driving_pressure_kPa"
    raise InputError(f"{shared[0]} is that of all cells", file=str(path), key=key, remedy=remedy)
