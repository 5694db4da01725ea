"""A pad with its cell resolved, its bodies, and the cell as a sensor behind its own channel."""

import math
from dataclasses import dataclass
from functools import cached_property, partial

from pneutouch.arrays import Array
from pneutouch.body import Body, Solid
from pneutouch.catalogue import DesignSource, Library, ResolvedDesign, load_scene
from pneutouch.catalogue.library import compared
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import DrawnScene, Evaluation, PredictionOptions, evaluate_drawn, sensor_of
from pneutouch.mechanics.models.choice import DEFAULT_TOLERANCE
from pneutouch.parts.assembly import Assembly, print_offset
from pneutouch.parts.layout import lay_out
from pneutouch.parts.pad import PadLayout, lay_out_pad, pad_solids
from pneutouch.parts.pad.solids import line_volume
from pneutouch.spec.design import CALIBRATION, NO_CALIBRATION
from pneutouch.spec.pad import PadFile
from pneutouch.spec.printer import Mode, Printer
from pneutouch.spec.read import Changes, override, read_toml, validate
from pneutouch.spec.values import name_of
from pneutouch.units import ML

_DIGITS = 4
"""Decimals of a cell's dead volume, mL: cells of equal volume share one prediction."""


@dataclass(frozen=True)
class ResolvedPad:
    """A pad: its file, its cell as a scene of its own, and its layout. ``where`` is the file as the user gave it."""

    name: str
    where: str
    file: PadFile
    scene: ResolvedDesign
    cell_changes: Changes
    library: Library

    @cached_property
    def layout(self) -> PadLayout:
        """The places of cells, channels and ports."""
        return lay_out_pad(self.scene, self.file.pad, self.where)

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
        holes = len(self.layout.places) * math.pi * self.layout.cell.inner_radius**2
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
    def evaluations(self) -> dict[float, Evaluation]:
        """The cell as a sensor, by each of the dead volumes (mL)."""
        return {volume_mL: self.evaluation_of(volume_mL) for volume_mL in sorted(set(self.dead_volumes_mL))}

    @property
    def worst(self) -> Evaluation:
        """The cell with the most gas behind it, which reads least."""
        return self.evaluations[max(self.dead_volumes_mL)]

    def evaluation_of(self, volume_mL: float) -> Evaluation:
        """The cell as a sensor with a dead volume, on the manifold: a connector of its own need not have space."""
        changes = {**self.cell_changes, "pneumatics.dead_volume_mL": volume_mL}
        scene = load_scene(self.file.pad.cell, changes, self.library)
        assembly = Assembly(scene, lay_out(scene))
        options = PredictionOptions("solid", "variational", "base", DEFAULT_TOLERANCE)
        drawn = DrawnScene(scene, assembly, sensor_of(assembly), options, ())
        return evaluate_drawn(drawn, partial(compared, self.library, scene.printer))


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
    return ResolvedPad(name_of(path), str(path), file, load_scene(source, of_cell, library), of_cell, library)
