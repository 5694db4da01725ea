"""A sensor for a simulator: its masses and inertia in m, kg and N, written as MJCF for MuJoCo and as URDF."""

import pprint
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Body, Solid
from pneutouch.body.solid import mesh_of
from pneutouch.export import templates
from pneutouch.export.scene import stl
from pneutouch.results.reader import DomePress, DomeTable
from pneutouch.results.record import plain
from pneutouch.shape.dome import DomeShape
from pneutouch.shape.meridian import Line, Segment
from pneutouch.wording import rounded

TEXTS = Path(__file__).parent

_KG, _M = 1e-3, 1e-3


@dataclass(frozen=True)
class RigidInertia:
    """Mass in kg, centre of mass in m (3,), and inertia about the origin of the frame, kg m2 (3, 3)."""

    mass: float
    centre: Array
    about_origin: Array

    @property
    def about_centre(self) -> Array:
        """Inertia about the centre of mass, kg m2 (3, 3)."""
        return self.about_origin - _steiner(self.mass, self.centre)

    def __add__(self, other: "RigidInertia") -> "RigidInertia":
        mass = self.mass + other.mass
        centre = (self.mass * self.centre + other.mass * other.centre) / mass
        return RigidInertia(mass, centre, self.about_origin + other.about_origin)

    def moved(self, way: Array) -> "RigidInertia":
        """Inertia of the same body, moved by a way in m (3,), its frame left where it is."""
        about = self.about_centre + _steiner(self.mass, self.centre + way)
        return RigidInertia(self.mass, self.centre + way, about)

    def without(self, part: "RigidInertia") -> "RigidInertia":
        """Inertia that is left when a part of it moves on its own."""
        return self + RigidInertia(-part.mass, part.centre, -part.about_origin)


def ball_inertia(mass: float, centre: Array, gyration: float) -> RigidInertia:
    """A mass (kg) about ``centre`` (m) with one radius of gyration (m) about all axes."""
    return RigidInertia(mass, centre, _steiner(mass, centre) + mass * gyration**2 * np.eye(3))


def inertia_of(bodies: Iterable[Body], solids: Iterable[Solid]) -> RigidInertia:
    """Inertia of bodies in their common frame, at the nominal densities of their materials.

    The mass is that of the exact volume. Centre and shape of the tensor are the mesh's, whose volume differs by the
    chord tolerance: the tensor is scaled by the ratio of both volumes.
    """
    parts = [_inertia(body, solid) for body, solid in zip(bodies, solids, strict=True)]
    total = parts[0]
    for part in parts[1:]:
        total = total + part
    return total


def _inertia(body: Body, solid: Solid) -> RigidInertia:
    """Inertia by the integrals of 1, x and x y over the tetrahedra from the origin to every triangle."""
    a, b, c = np.moveaxis(body.corners * _M, 1, 0)
    volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0
    total, sums = volumes.sum(), a + b + c
    centre = (volumes[:, None] * sums).sum(axis=0) / 4.0 / total
    second = sum(np.einsum("i,ij,ik->jk", volumes, part, part) for part in (a, b, c, sums)) / 20.0
    density = solid.mass * _KG / total
    return RigidInertia(density * total, centre, density * (np.trace(second) * np.eye(3) - second))


def _steiner(mass: float, centre: Array) -> Array:
    return np.asarray(mass * (centre @ centre * np.eye(3) - np.outer(centre, centre)))


_TIME_STEP = 0.002
"""Time step, s: MuJoCo's default."""

_INERTIA_SHARE = 0.5
"""Inertia of the joint over greatest stiffness times time step squared; an explicit spring is stable from 0.25 on."""

_GAUSS = 24
"""Points of Gauss along a piece of a face: exact to rounding on a quarter circle."""

_DAMPING_SHARE = 0.2
"""Damping of the joint over time step times greatest stiffness. Our choice: the wall's own damping is not known."""


@dataclass(frozen=True)
class PressTable:
    """A press at one driving pressure: nodes of a cubic Hermite spline over the indentation.

    Attributes:
        driving_pressure_kPa: Pressure before contact.
        apex: Height of the dome's outer apex over its base plane, m.
        indentation: Nodes, m (n,), from 0 to the end of the range.
        force, force_slope: N and N/m at the nodes (n,).
        pressure_kPa, pressure_slope_kPa_per_m: Gauge pressure and its slope at the nodes (n,).
    """

    driving_pressure_kPa: float
    apex: float
    indentation: Array
    force: Array
    force_slope: Array
    pressure_kPa: Array
    pressure_slope_kPa_per_m: Array

    @property
    def stiffest(self) -> float:
        """Greatest slope of the force at the nodes, N/m."""
        return float(self.force_slope.max())


def press_table(
    driving_pressure_kPa: float, apex_mm: float, indentation_mm: Array, force: Array, rise_kPa: Array
) -> PressTable:
    """Table of a curve, monotone between its points (Fritsch and Carlson), with the slopes of `PchipInterpolator`."""
    from scipy.interpolate import PchipInterpolator

    depth = 1e-3 * indentation_mm
    pressure_kPa = driving_pressure_kPa + rise_kPa
    slopes = [PchipInterpolator(depth, values).derivative()(depth) for values in (force, pressure_kPa)]
    return PressTable(driving_pressure_kPa, 1e-3 * apex_mm, depth, force, slopes[0], pressure_kPa, slopes[1])


@dataclass(frozen=True)
class SimulatedDome:
    """One dome: its name in the model, the place of its axis, m (3,), and a table for each driving pressure, rising."""

    name: str
    place: Array
    tables: tuple[PressTable, ...]


@dataclass(frozen=True)
class SimulatedSensor:
    """A sensor of one dome, or a pad of several equal ones, as simulators take it.

    Attributes:
        name: Name of the design, of its link and body.
        bodies: Print meshes, mm, in the frame of the base plane: z outwards along the axis of the dome.
        inertia: Inertia of all bodies together.
        moving: The share of this inertia that moves with the apex of a dome on the z axis; see `moving_share`.
        radius: Outer height of the unloaded dome, and radius of the sphere that stands for it, m.
        rear: Height of the rearmost face, m: below the base plane.
        domes: Those of a pad in the order of their numbers.
    """

    name: str
    bodies: tuple[Body, ...]
    inertia: RigidInertia
    moving: RigidInertia
    radius: float
    rear: float
    domes: tuple[SimulatedDome, ...]

    @property
    def tables(self) -> tuple[PressTable, ...]:
        """The tables of the first dome."""
        return self.domes[0].tables

    @property
    def stiffest(self) -> float:
        """Greatest stiffness of all tables, N/m."""
        return max(table.stiffest for dome in self.domes for table in dome.tables)

    @property
    def armature(self) -> float:
        """Inertia of the joint in addition to the moving mass that makes it stable at `_TIME_STEP`, kg."""
        return max(0.0, _INERTIA_SHARE * self.stiffest * _TIME_STEP**2 - self.moving.mass)


def simulated_sensor(
    name: str,
    bodies: tuple[Body, ...],
    solids: tuple[Solid, ...],
    shape: DomeShape,
    density: float,
    domes: tuple[SimulatedDome, ...],
) -> SimulatedSensor:
    """A sensor of bodies and solids; its domes have one shape, and a density in g/cm3."""
    return SimulatedSensor(
        name,
        bodies,
        inertia_of(bodies, solids),
        moving_share(shape, 1e3 * density),
        1e-3 * shape.outer_height,
        1e-3 * min(float(body.bounds[0, 2]) for body in bodies),
        domes,
    )


def moving_share(shape: DomeShape, density: float) -> RigidInertia:
    """Inertia that moves with the apex, at the centroid of the wall, by the ``density`` in kg/m3.

    A wall whose points move in proportion to their height z has the kinetic energy of the mass of z2/h2: over a
    hemisphere z is evenly spread (Archimedes), and that is a third of the wall's. A flat wall moves as a clamped plate
    under an even pressure, by (1 - r2/R2)2, which is a fifth.
    """
    edge = Line(shape.inner[0].start, shape.outer[0].start, "")
    area, square = _motion(shape.outer, flat=shape.outer_height < shape.wall_thickness)
    mass = density * _M**3 * shape.wall_volume * square / area
    middle = (_within((edge, *shape.outer)) - _within(shape.inner)) / shape.wall_volume
    return ball_inertia(mass, _M * np.array([0.0, 0.0, middle]), 0.5 * _M * shape.outer_radius)


_AT, _WEIGHT = np.polynomial.legendre.leggauss(_GAUSS)
_SHARE = 0.5 * (1.0 + _AT)


def _motion(face: Sequence[Segment], *, flat: bool) -> tuple[float, float]:
    """Area of a face (mm2) and the integral of its squared motion over it (mm2), that of the pole being 1."""
    area, square, rim, high = 0.0, 0.0, face[0].start[0], face[-1].end[1]
    for piece in face:
        r, z = piece.along(_SHARE).T
        ring, moved = np.pi * r * _WEIGHT * piece.length, (1.0 - (r / rim) ** 2) ** 2 if flat else z / high
        area, square = area + float(ring.sum()), square + float(ring @ moved**2)
    return area, square


def _within(face: Sequence[Segment]) -> float:
    """Integral of z over the space within a face (mm4)."""
    total = 0.0
    for piece in face:
        (r, z), rise = piece.along(_SHARE).T, piece.normals(_SHARE)[:, 0]
        total += 0.5 * float((np.pi * r * _WEIGHT * piece.length) @ (r * z * rise))
    return total


_DIGITS = 9

_NOTHING = 1e-15
"""Coordinates (m) and moments (kg m2) below this are rounding, and written as 0."""


def _number(value: float) -> str:
    return f"{float(value):.{_DIGITS}g}"


def _vector(values: Iterable[float]) -> str:
    """Numbers as text with spaces between, those within `_NOTHING` of zero as 0."""
    return " ".join(_number(value if abs(value) > _NOTHING else 0.0) for value in values)


def _filled(template: str, sensor: SimulatedSensor, **more: Any) -> bytes:
    """An XML document of a sensor without driving pressure and force."""
    environment = templates(TEXTS / "templates", autoescape=True)
    environment.filters |= {"number": _number, "vector": _vector}
    values = {"name": sensor.name, "sensor": sensor, "table": sensor.tables[0], **more}
    return environment.get_template(template).render(values).encode() + b"\n"


def mjcf_files(sensor: SimulatedSensor) -> dict[str, bytes]:
    """The model, its module and its meshes, by their paths in the folder."""
    meshes = {f"meshes/{body.name}.stl": stl(body) for body in sensor.bodies}
    return {f"{sensor.name}.xml": mjcf(sensor), "dome_force.py": module(sensor), **meshes}


def module(sensor: SimulatedSensor) -> bytes:
    """The callbacks with the tables of the domes, as a module that needs only MuJoCo."""
    source = (TEXTS / "dome_force.py").read_text(encoding="utf-8")
    tables = [plain(dome_table(sensor, dome)) for dome in sensor.domes]
    one = len(tables) == 1
    data = pprint.pformat(tables[0] if one else tables, width=118, compact=True, sort_dicts=False)
    named = f"TABLE: dict[str, Any] = {data}" if one else f"TABLES: list[dict[str, Any]] = {data}"
    gives, call = "DomeForce", "install_dome(model, TABLE, driving_pressure_kPa, prefix)"
    if not one:
        gives, call = f"list[{gives}]", f"[{call.replace('TABLE', 'table')} for table in TABLES]"
    usage = (
        f'\n\ndef install(model: Any, driving_pressure_kPa: float | None = None, prefix: str = "") -> {gives}:\n'
        '    """Give a model that holds this sensor the force and the pressure of each dome; see `install_dome`."""\n'
        f"    return {call}\n"
    )
    return f"{source}\n\n{named}\n{usage}".encode()


def dome_table(sensor: SimulatedSensor, dome: SimulatedDome) -> DomeTable:
    """The table of a dome as the module reads it."""
    table = DomeTable(dome.name, sensor.radius, _INERTIA_SHARE, _DAMPING_SHARE, tuple(map(_state, dome.tables)))
    return rounded(table, _DIGITS)


def _state(table: PressTable) -> DomePress:
    return DomePress(
        driving_pressure_kPa=table.driving_pressure_kPa,
        apex_m=table.apex,
        indentation_m=tuple(table.indentation.tolist()),
        force_N=tuple(table.force.tolist()),
        force_slope_N_per_m=tuple(table.force_slope.tolist()),
        pressure_kPa=tuple(table.pressure_kPa.tolist()),
        pressure_slope_kPa_per_m=tuple(table.pressure_slope_kPa_per_m.tolist()),
    )


def mjcf(sensor: SimulatedSensor) -> bytes:
    """The model: a base with everything that does not move, and each dome as a sphere on a sliding joint.

    The inertia of all together is that of the bodies, without driving pressure and force.
    """
    base = sensor.inertia
    for dome in sensor.domes:
        base = base.without(sensor.moving.moved(dome.place))
    return _filled("mjcf.xml.j2", sensor, step=_TIME_STEP, base=base)


def urdf_files(sensor: SimulatedSensor) -> dict[str, bytes]:
    """The link and its meshes, by their paths in the folder. Meshes in mm, scaled where they are named."""
    files = {f"{sensor.name}.urdf": urdf(sensor)}
    for body in sensor.bodies:
        files[f"meshes/{body.name}.stl"] = stl(body)
        files[f"meshes/{body.name}-contact.stl"] = stl(hull(body))
    return files


def hull(body: Body) -> Body:
    """The convex hull of a body: the contact shape that most simulators make of a mesh, written for all of them."""
    return Body(f"{body.name}-contact", body.role, body.material, *mesh_of(body.manifold().hull()))


def urdf(sensor: SimulatedSensor) -> bytes:
    """One link in the frame of the base plane, z outwards, and two frames fixed to it: its mount and its apex."""
    return _filled("urdf.xml.j2", sensor)
