"""A subject measured: every measurement of a part or a job is made once, when a rule requires it."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple, cast

import numpy as np

from pneutouch.arrays import Array, Flags, grouped
from pneutouch.body import Body
from pneutouch.body.solid import mesh_of
from pneutouch.catalogue import ResolvedDesign
from pneutouch.mechanics import Sensor, SensorPrediction
from pneutouch.mechanics.prediction import CurveOutcome
from pneutouch.mechanics.rating import Rating
from pneutouch.parts.glue import GlueSurface
from pneutouch.printability.measure.cavities import PartVoxels, Pocket, balls, build_frame, fill, pockets, seen, unseen
from pneutouch.printability.measure.chords import Chords, Side, chords, refined
from pneutouch.printability.measure.joined import Hollow, voids
from pneutouch.printability.measure.surface import SurfaceMesh, SurfaceSamples, sample
from pneutouch.printability.measure.thin import OPENINGS, ThinPlace, thin_places
from pneutouch.printability.subject import Point3, PrintItem, PrintSubject
from pneutouch.spec.gauge import Gauge
from pneutouch.spec.printer import FeatureSize, Printer


class WettedSurface(NamedTuple):
    """Surface that a silicone is poured against: the body's name, its material's label and its print process."""

    body: str
    material: str
    process: str


class GluedSeat(NamedTuple):
    """Name of the glue of a seat, and the kinds of surface of membrane and connector."""

    glue: str
    membrane: GlueSurface
    connector: GlueSurface


@dataclass(frozen=True)
class SensorContext:
    """Data for the rules on the sensor's working: its prediction, the sensor as the mechanics take it, its rating.

    ``membrane`` is the name of the item that is the sensor's wall; ``calibrated``: True if the sensor exists already.
    ``gauge`` is the one that the design names; None stands for the paper's. ``wetted``: surfaces that a cast membrane
    cures against. ``glued``: glue of membrane and connector, None if none is named or chosen. ``curves``: the sensor by
    every mixing curve of its mix. ``scene``: its parts, for the rules on what is bought for it.
    """

    prediction: SensorPrediction
    sensor: Sensor
    rating: Rating
    membrane: str = "membrane"
    calibrated: bool = False
    gauge: Gauge | None = None
    wetted: tuple[WettedSurface, ...] = ()
    glued: GluedSeat | None = None
    curves: tuple[CurveOutcome, ...] = ()
    scene: ResolvedDesign | None = None


NARROW = 3.0
"""With PolyJet, holes up to this width (mm) are examined: support has to come out (our estimate, unverified)."""


@dataclass(frozen=True)
class PrintPart:
    """An item with the measurements of its body."""

    item: PrintItem

    @property
    def name(self) -> str:
        """The body's name."""
        return self.item.body.name

    @property
    def process(self) -> str:
        """The printer's process."""
        return self.item.printer.process

    @cached_property
    def read(self) -> Body:
        """The body as a file reader sees it: corners rounded to 32-bit floats and merged."""
        return self.item.body.welded()

    @cached_property
    def manifold(self) -> Any:
        """manifold3d's solid of the mesh; empty if the mesh is not closed."""
        return self.item.body.manifold()

    @cached_property
    def sound(self) -> bool:
        """True if the mesh bounds a solid; only then can the rest be measured."""
        return self.item.body.is_closed() and not self.manifold.is_empty() and self.manifold.volume() > 0

    @cached_property
    def surface(self) -> SurfaceMesh:
        """Mesh of the manifold, whose faces have the numbers that its rays return."""
        return SurfaceMesh(*mesh_of(self.manifold))

    @cached_property
    def samples(self) -> SurfaceSamples:
        """Points all over the surface."""
        return sample(self.surface)

    @property
    def _limits(self) -> dict[Side, float]:
        """Greatest length of a chord that any rule needs, by side, mm."""
        least, kind = self.item.printer.smallest, self.item.body.material.kind
        emboss = 1.5 * least.emboss_mm.recommended
        inside = max(least.wall(kind).recommended, least.pin(kind).recommended, emboss)
        outside = max(least.hole_mm.recommended, least.channel_mm.recommended, least.gap_mm.recommended, emboss)
        if self.process == "polyjet":
            outside = max(outside, NARROW)
        return {"inside": inside, "outside": outside}

    @cached_property
    def chords(self) -> dict[Side, Chords]:
        """Thicknesses (inside) and clearances (outside) up to the greatest limit of the printer."""
        return chords(self.manifold, self.surface, self.samples, max(self._limits.values()))

    @cached_property
    def places(self) -> list[ThinPlace]:
        """Thin places, narrowest first."""
        solid = self.item.solid
        exact = None if solid is None else lambda chords: refined(chords, solid.distance)
        places = thin_places(self.manifold, self.surface, self.chords, self._limits, exact)
        return [place for place in places if not self._filled(place)]

    def _filled(self, place: ThinPlace) -> bool:
        """True if a place is an opening that the item's insert fills, which no tool has to make."""
        insert = self.item.insert
        if insert is None or place.kind not in OPENINGS:
            return False
        return bool(insert.distance(np.array([place.where]))[0] <= 0.5 * place.size + self.surface.chord_error[0])

    def slack(self, size: float, turn: float) -> float:
        """Possible error, mm, of a size (mm) measured between curves whose faces turn by ``turn`` (radians).

        A chord may miss the axis by half that turn, and without the exact solid the mesh may be off as well.
        """
        chord = 1e-3 + size * turn**2 / 8
        return chord if self.item.solid is not None else chord + 2 * self.surface.chord_error[0]

    def limit(self, name: str) -> FeatureSize:
        """The printer's limit ``name`` (wall, pin, hole, channel, gap or emboss) for this part's kind of material."""
        smallest, kind = self.item.printer.smallest, self.item.body.material.kind
        if name in ("wall", "pin"):
            return smallest.wall(kind) if name == "wall" else smallest.pin(kind)
        return cast(FeatureSize, getattr(smallest, f"{name}_mm"))


@dataclass(frozen=True)
class PrintJob:
    """Parts printed together, placed to one another as in the design frame."""

    name: str
    parts: tuple[PrintPart, ...]

    @property
    def up(self) -> Array:
        """Build direction, unit, (3,)."""
        up = np.asarray(self.parts[0].item.up, dtype=float)
        return cast(Array, up / np.linalg.norm(up))

    @property
    def printer(self) -> Printer:
        """The machine."""
        return self.parts[0].item.printer

    @property
    def sound(self) -> bool:
        """True if every part is a solid."""
        return all(part.sound for part in self.parts)

    @cached_property
    def union(self) -> Any:
        """All parts joined to one manifold3d solid."""
        from manifold3d import Manifold, OpType

        if len(self.parts) == 1:
            return self.parts[0].manifold
        return Manifold.batch_boolean([part.manifold for part in self.parts], OpType.Add)

    @cached_property
    def voxels(self) -> PartVoxels:
        """All parts in cubes, in the build frame."""
        return fill([part.surface.corners for part in self.parts], build_frame(self.up))

    @cached_property
    def pockets(self) -> list[Pocket]:
        """Hollows behind a narrow opening, and closed ones."""
        return pockets(self.voxels, self.balls)

    @cached_property
    def balls(self) -> Array:
        """Radius of the largest ball around each empty cube, mm."""
        return balls(self.voxels)

    @cached_property
    def hidden(self) -> Flags:
        """Empty cubes that no straight jet from outside reaches."""
        return unseen(self.voxels, self.balls, seen(self.voxels))

    @cached_property
    def hollows(self) -> list[Hollow]:
        """Closed hollows of each part, and those that several parts enclose."""
        parts_shells = [shell for part in self.parts for shell in voids(part.manifold, part.name)]
        if len(self.parts) == 1:
            return parts_shells
        joined = [shell for shell in voids(self.union, "") if not any(shell.alike(other) for other in parts_shells)]
        return parts_shells + [replace(shell, body=self.nearest(shell.where).name) for shell in joined]

    def in_hollow(self, where: Point3) -> bool:
        """True if a point lies in the box of a closed hollow."""
        return any(bool(((where >= h.bounds[0]) & (where <= h.bounds[1])).all()) for h in self.hollows)

    def nearest(self, where: Point3) -> PrintPart:
        """The part with a vertex nearest to a point."""
        point = np.asarray(where)
        return min(self.parts, key=lambda part: float(np.linalg.norm(part.item.body.vertices - point, axis=1).min()))

    @cached_property
    def bounds(self) -> Array:
        """Smallest and largest corner in the build frame, (2, 3), mm."""
        turned = np.concatenate([part.item.body.vertices for part in self.parts]) @ build_frame(self.up).T
        return np.array([turned.min(axis=0), turned.max(axis=0)])


@dataclass(frozen=True)
class PrintView:
    """A subject with its parts and jobs, and the context of its sensor or None."""

    subject: PrintSubject
    sensor: SensorContext | None = None

    @cached_property
    def parts(self) -> tuple[PrintPart, ...]:
        """Parts of the subject, one for each item."""
        return tuple(PrintPart(item) for item in self.subject.items)

    @cached_property
    def sound(self) -> tuple[PrintPart, ...]:
        """The parts that can be measured."""
        return tuple(part for part in self.parts if part.sound)

    @cached_property
    def jobs(self) -> tuple[PrintJob, ...]:
        """Jobs in order of their first part; a part without a job's name is a job by itself."""
        numbered = enumerate(self.parts)
        jobs = grouped(((part.item.job, -1 if part.item.job else number), part) for number, part in numbered)
        return tuple(PrintJob(name or parts[0].name, tuple(parts)) for (name, _), parts in jobs.items())

    def part(self, name: str) -> PrintPart | None:
        """The part of a name; None if there is none."""
        return next((part for part in self.parts if part.name == name), None)
