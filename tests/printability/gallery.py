"""Deliberately bad parts, at least one a rule, each with the rules it breaks, and good ones that break none."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from manifold3d import CrossSection, Manifold, OpType

from pneutouch.body import Body
from pneutouch.catalogue import Library
from pneutouch.printability import Joint, PrintItem, PrintSubject
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer
from tests.conftest import ROOT

LIBRARY = Library((ROOT,))
ROUND = 96


@dataclass(frozen=True)
class Exhibit:
    """A subject and the rules it breaks, with the severity of each."""

    make: Callable[[], PrintSubject]
    breaks: dict[str, str]


@cache
def printer(name: str = "objet260-connex") -> Printer:
    return LIBRARY.all("printers", Printer)[name]


@cache
def material(name: str = "VeroClear") -> Material:
    return LIBRARY.all("materials", Material)[name]


def body_of(solid: Manifold, name: str = "part", resin: str = "VeroClear") -> Body:
    mesh = solid.to_mesh64()
    vertices, triangles = np.array(mesh.vert_properties[:, :3]), np.array(mesh.tri_verts).astype(np.int64)
    return Body(name, "coupon", material(resin), vertices, triangles)


def item(
    shape: Manifold, name: str = "part", resin: str = "VeroClear", machine: str = "objet260-connex", **more
) -> PrintItem:
    chosen = printer(machine)
    mode = chosen.mode_for(material(resin))
    assert mode is not None
    return PrintItem(body_of(shape, name, resin), chosen, mode, **more)


def one(shape: Manifold, **more) -> PrintSubject:
    return PrintSubject((item(shape, **more),))


def box(x: float, y: float, z: float, at: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Manifold:
    """A box with its lowest corner at a point."""
    return Manifold.cube((x, y, z)).translate(at)


def rod(radius: float, length: float, at: tuple[float, float, float] = (0.0, 0.0, 0.0), sides: int = ROUND) -> Manifold:
    """A rod along z from a point."""
    return Manifold.cylinder(length, radius, radius, sides).translate(at)


def ball(radius: float, at: tuple[float, float, float] = (0.0, 0.0, 0.0), sides: int = ROUND) -> Manifold:
    return Manifold.sphere(radius, sides).translate(at)


def prism(points: list[tuple[float, float]], length: float) -> Manifold:
    return CrossSection([points]).extrude(length)


def taper(degrees: float, tip: float) -> Manifold:
    """A wedge of an angle, its edge cut off where it is ``tip`` mm thick."""
    half, back = 0.5 * tip, 0.5 * tip + 12 * math.tan(math.radians(0.5 * degrees))
    corners = [(0.0, -half), (12.0, -back), (12.0, back), *([(0.0, half)] if tip else [])]
    return prism(corners, 10)


def outside(points):
    """Points on the outside of a cup of 10 mm."""
    return (np.linalg.norm(points, axis=1) > 9.9) & (points[:, 2] > 0.01)


def cup(outer: float = 10.0, wall: float = 1.5) -> Manifold:
    """A hemispherical dome, open below."""
    shell = ball(outer) - ball(outer - wall)
    return shell.trim_by_plane((0.0, 0.0, 1.0), 0.0)


def meander() -> Manifold:
    """A block with a passage of five turns."""
    legs = [
        rod(1.5, 15.0, (4.0, 6.0, 5.0)),
        rod(1.5, 17.5, (12.0, 6.0, 2.5)),
        rod(1.5, 15.0, (20.0, 6.0, 5.0)),
        rod(1.5, 8.0).rotate((0, 90, 0)).translate((4.0, 6.0, 5.0)),
        rod(1.5, 8.0).rotate((0, 90, 0)).translate((12.0, 6.0, 18.0)),
    ]
    turns = [ball(1.5, at, 48) for at in ((4.0, 6.0, 5.0), (12.0, 6.0, 18.0), (20.0, 6.0, 18.0))]
    way_in = rod(1.5, 5.0, (4.0, 6.0, 19.0)) + rod(1.5, 5.0, (20.0, 6.0, 1.0))
    return box(24, 12, 22) - Manifold.batch_boolean([*legs, *turns, way_in], OpType.Add)


def with_hole(body: Body, missing: int = 0) -> Body:
    return replace(body, triangles=np.delete(body.triangles, missing, axis=0))


def _open_mesh() -> PrintSubject:
    whole = item(box(10, 10, 10))
    return PrintSubject((replace(whole, body=with_hole(whole.body)),))


def _inside_out() -> PrintSubject:
    whole = item(box(10, 10, 10))
    return PrintSubject((replace(whole, body=replace(whole.body, triangles=whole.body.triangles[:, ::-1])),))


def _sliver() -> PrintSubject:
    """A block with a point on its top face, a ten-millionth of a millimetre beside an edge."""
    whole = item(box(10, 10, 10, (100.0, 0.0, 0.0)))
    vertices, triangles = whole.body.vertices, whole.body.triangles
    top = np.flatnonzero((vertices[triangles][:, :, 2] == 10.0).all(axis=1))[0]
    a, b, c = triangles[top]
    new = vertices[[a, b]].mean(axis=0) + 1e-7 * (vertices[c] - vertices[[a, b]].mean(axis=0)) / 10
    n = len(vertices)
    fan = np.array([[a, b, n], [b, c, n], [c, a, n]])
    body = replace(
        whole.body, vertices=np.vstack([vertices, new]), triangles=np.vstack([np.delete(triangles, top, axis=0), fan])
    )
    return PrintSubject((replace(whole, body=body),))


def two(
    apart: float, job: str = "", joint: bool = False, resins: tuple[str, str] = ("VeroClear", "VeroClear")
) -> PrintSubject:
    """Two blocks of 10 mm above one another, ``apart`` mm."""
    items = (
        item(box(10, 10, 10), "one", resins[0], job=job),
        item(box(10, 10, 10, (0.0, 0.0, 10.0 + apart)), "other", resins[1], job=job),
    )
    return PrintSubject(items, (Joint("one", "other", 100.0, (5.0, 5.0, 10.0)),) if joint else ())


def _mixed() -> PrintSubject:
    """Two resins in one job, in the mode that runs one."""
    return two(5.0, "tray", resins=("VeroClear", "TangoPlus"))


def _unrun() -> PrintSubject:
    whole = item(box(10, 10, 10))
    return PrintSubject((replace(whole, body=replace(whole.body, material=material("ABS"))),))


def _face_down() -> PrintSubject:
    dome = item(cup(), up=(0.0, 0.0, -1.0), sensing=outside)
    return PrintSubject((dome,))


def _shadowed() -> PrintSubject:
    """A dome that looks up, under a roof printed with it."""
    dome = item(cup(), "dome", job="tray", sensing=outside)
    return PrintSubject((dome, item(box(30, 30, 2, (-15.0, -15.0, 14.0)), "roof", job="tray")))


def _closed_by_two() -> PrintSubject:
    """A tray and its lid, printed as one: neither has a hollow."""
    tray = box(12, 12, 8) - box(8, 8, 6, (2.0, 2.0, 2.0))
    lid = box(12, 12, 2, (0.0, 0.0, 8.0))
    return PrintSubject((item(tray, "tray", job="both"), item(lid, "lid", job="both")))


def _vault() -> Manifold:
    """A block with a room under a flat ceiling, entered through a narrow door."""
    return box(18, 18, 14) - box(10, 10, 6, (4.0, 4.0, 4.0)) - rod(1.6, 6).rotate((90, 0, 0)).translate((9.0, 5.0, 7.0))


BAD: dict[str, Exhibit] = {
    "thin plate": Exhibit(lambda: one(box(30, 30, 0.45)), {"walls": "error"}),
    "thinnish plate": Exhibit(lambda: one(box(30, 30, 0.8)), {"walls": "warning"}),
    "thin fin": Exhibit(lambda: one(box(20, 20, 3) + box(0.4, 15, 8, (10.0, 2.5, 2.0))), {"walls": "error"}),
    "thin tube": Exhibit(lambda: one(rod(4.5, 10) - rod(4.1, 12, (0.0, 0.0, -1.0))), {"walls": "error"}),
    "thin dome": Exhibit(lambda: one(cup(10, 0.5), resin="TangoPlus"), {"walls": "error"}),
    "needle": Exhibit(lambda: one(box(10, 10, 3) + rod(0.2, 7, (5.0, 5.0, 2.0))), {"pins": "error"}),
    "soft bristle": Exhibit(
        lambda: one(box(10, 10, 3) + box(1.2, 1.2, 6, (4.0, 4.0, 2.0)), resin="TangoPlus"), {"pins": "warning"}
    ),
    "strut": Exhibit(
        lambda: one(box(10, 10, 3) + rod(0.4, 10, (5.0, 5.0, 2.0)) + box(10, 10, 3, (0, 0, 11))), {"pins": "warning"}
    ),
    "pinhole": Exhibit(lambda: one(box(10, 10, 1.05) - rod(0.2, 3, (5.0, 5.0, -1.0))), {"holes": "error"}),
    "square hole": Exhibit(lambda: one(box(10, 10, 2) - box(0.8, 0.8, 4, (4.0, 4.0, -1.0))), {"holes": "warning"}),
    "capillary": Exhibit(lambda: one(box(10, 10, 4) - rod(0.25, 6, (5.0, 5.0, -1.0))), {"channels": "error"}),
    "long bore": Exhibit(lambda: one(box(12, 12, 30) - rod(1.1, 32, (6.0, 6.0, -1.0))), {"cleaning": "warning"}),
    "saw cut": Exhibit(lambda: one(box(12, 12, 8) - box(0.15, 14, 4, (6.0, -1.0, 4.5))), {"gaps": "error"}),
    "tight fit": Exhibit(lambda: two(0.1, "tray"), {"gaps": "error"}),
    "hairline": Exhibit(lambda: one(box(12, 12, 5) + box(8, 0.25, 0.7, (2.0, 6.0, 5.0))), {"emboss": "warning"}),
    "scratch": Exhibit(lambda: one(box(12, 12, 5) - box(8, 0.25, 0.5, (2.0, 6.0, 4.5))), {"emboss": "warning"}),
    "low dot": Exhibit(lambda: one(box(12, 12, 5) + rod(0.5, 0.3, (6.0, 6.0, 5.0))), {"emboss": "warning"}),
    "knife": Exhibit(lambda: one(prism([(0, 0), (20, 0), (20, 5.36)], 10)), {"edges": "warning"}),
    "sliver": Exhibit(_sliver, {"edges": "warning"}),
    "bubble": Exhibit(lambda: one(box(12, 12, 12) - ball(3, (6.0, 6.0, 6.0), 64)), {"hollows": "error"}),
    "closed by two": Exhibit(_closed_by_two, {"hollows": "error"}),
    "bottle": Exhibit(
        lambda: one(box(14, 14, 14) - ball(5, (7.0, 7.0, 7.0)) - rod(1.5, 8, (7.0, 7.0, 7.0))), {"cleaning": "error"}
    ),
    "vault": Exhibit(lambda: one(_vault(), resin="ABS", machine="abs-filament"), {"cleaning": "warning"}),
    "meander": Exhibit(lambda: one(meander()), {"cleaning": "warning"}),
    "beam": Exhibit(lambda: one(box(300, 12, 12)), {"envelope": "error"}),
    "pole": Exhibit(lambda: one(box(220, 12, 12), up=(1.0, 0.0, 0.0)), {"envelope": "error"}),
    "overlap": Exhibit(lambda: two(-0.5, joint=True), {"contact faces": "error"}),
    "parted": Exhibit(lambda: two(0.5, joint=True), {"contact faces": "error"}),
    "face down": Exhibit(_face_down, {"matte": "warning"}),
    "shadowed": Exhibit(_shadowed, {"matte": "warning"}),
    "two resins": Exhibit(_mixed, {"resins": "error"}),
    "foreign resin": Exhibit(_unrun, {"resins": "error"}),
    "coarse": Exhibit(lambda: one(ball(10, sides=32)), {"mesh": "warning"}),
    "fine": Exhibit(lambda: one(ball(2, sides=400)), {"mesh": "note"}),
    "open mesh": Exhibit(_open_mesh, {"mesh": "error"}),
    "inside out": Exhibit(_inside_out, {"mesh": "error"}),
}

GOOD: dict[str, Callable[[], PrintSubject]] = {
    "plate": lambda: one(box(30, 30, 1.1)),
    "fin": lambda: one(box(20, 20, 3) + box(1.1, 15, 8, (10.0, 2.5, 2.0))),
    "tube": lambda: one(rod(4.5, 10) - rod(3.0, 12, (0.0, 0.0, -1.0))),
    "dome": lambda: one(cup(), resin="TangoPlus", sensing=outside),
    "pin": lambda: one(box(10, 10, 3) + rod(0.6, 7, (5.0, 5.0, 2.0))),
    "hole": lambda: one(box(10, 10, 2) - rod(0.6, 4, (5.0, 5.0, -1.0))),
    "bore": lambda: one(box(10, 10, 10) - rod(1.1, 12, (5.0, 5.0, -1.0))),
    "slot": lambda: one(box(12, 12, 8) - box(0.6, 14, 4, (6.0, -1.0, 4.5))),
    "ridge": lambda: one(box(12, 12, 5) + box(8, 0.7, 0.7, (2.0, 6.0, 5.0))),
    **{
        f"taper of {angle} degrees, tip {tip:g}": lambda angle=angle, tip=tip: one(taper(angle, tip))
        for angle in (32, 36, 45, 48)
        for tip in (0.0, 0.1, 0.4)
    },
    "blunt wedge": lambda: one(prism([(0, 0), (20, 0), (20, 16)], 10)),
    "pot": lambda: one(box(14, 14, 14) - ball(5, (7.0, 7.0, 7.0)) - rod(4, 8, (7.0, 7.0, 7.0))),
    "lying pole": lambda: one(box(220, 12, 12)),
    "turned beam": lambda: one(box(12, 253, 12)),
    "joined": lambda: two(0.0, joint=True),
    "one job": lambda: two(0.0, "tray", joint=True),
    "ball": lambda: one(ball(10, sides=96)),
    "filament bottle": lambda: one(
        box(14, 14, 14) - ball(3, (7.0, 7.0, 7.0), 48) - rod(1.5, 8, (7.0, 7.0, 7.0), 32),
        resin="ABS",
        machine="abs-filament",
    ),
    "knobs": lambda: one(box(20, 20, 3) + rod(2, 4, (6.0, 6.0, 2.0)) + rod(2, 4, (14.0, 14.0, 2.0))),
}
