"""Subject of the rules: bodies as they will be printed, whatever they are, and the places where they must meet.

A sensor's bodies become a subject like this::

    PrintSubject(
        items=tuple(
            PrintItem(
                body, printer, mode, solid, up=(0.0, 0.0, 1.0), job=solid.name,
                hints={"walls": "raise membrane.wall_thickness_mm"},
            )
            for body, solid in zip(assembly.bodies, assembly.solids, strict=True)
        ),
        joints=(Joint("membrane", "connector", area=seat_area, where=(12.0, 0.0, -2.25)),),
        name=scene.name,
    )

A coupon is a subject of one item and no joints.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

from pneutouch.arrays import Array, Flags
from pneutouch.body import Body
from pneutouch.spec.printer import Mode, Printer

Point3 = tuple[float, float, float]


class ExactShape(Protocol):
    """An exact shape of a body. Its attributes may be fields or properties."""

    @property
    def name(self) -> str:
        """Name of the body."""

    @property
    def volume(self) -> float:
        """Exact volume, mm3."""

    def distance(self, points: Array) -> Array:
        """Distances, shape (n,), of (n, 3) points in mm from the exact surface."""


@dataclass(frozen=True)
class PrintItem:
    """One body as it will be printed, in the design frame (mm).

    ``solid`` is its exact shape, if there is one. ``up`` is the build direction in the body's frame. Items with the
    same ``job`` are printed together, placed as in the design frame; "" is a job of its own. ``sensing`` selects the
    points, of (n, 3) on the surface, that must not be matte. ``hints`` states, by the name of a rule, the change of the
    design that would fix its finding. ``insert`` is a body around which this one is cast: it fills its openings. Of
    what lies behind the outlines a filament printer fills the share ``infill``.
    """

    body: Body
    printer: Printer
    mode: Mode
    solid: ExactShape | None = None
    up: Point3 = (0.0, 0.0, 1.0)
    job: str = ""
    sensing: Callable[[Array], Flags] | None = None
    hints: Mapping[str, str] = field(default_factory=dict)
    insert: ExactShape | None = None
    infill: float = 1.0


@dataclass(frozen=True)
class Joint:
    """Two items, by name, that must meet on a face of ``area`` (exact, mm2) near ``where`` without overlapping."""

    one: str
    other: str
    area: float
    where: Point3


@dataclass(frozen=True)
class PrintSubject:
    """Items to be checked together, the joints that they must have, and a name."""

    items: tuple[PrintItem, ...]
    joints: tuple[Joint, ...] = ()
    name: str = ""
