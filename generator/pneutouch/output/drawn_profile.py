"""The meridian of a dome as drawn in CAD: one open polyline of a DXF file, as points with radii of rounding."""

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.errors import InputError
from pneutouch.shape.even import arc_to
from pneutouch.shape.meridian import Arc
from pneutouch.shape.profile import Profile
from pneutouch.wording import counted

_MM = (0, 4)
"""Values of $INSUNITS for drawings without a unit, taken as mm, and in mm."""

_UNITS = {1: "inches", 2: "feet", 5: "cm", 6: "m", 13: "µm"}
_CURVES = ("LWPOLYLINE", "POLYLINE", "LINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE")
_DIGITS = 6
_OFF = 1e-3
"""Greatest distance in mm of a point of the polyline from the rounded profile."""

_MOST = 0.45
"""Greatest bulge of an arc: that of 97 degrees; the rounding of a longer one would need a corner far away."""


def drawn_profile(path: Path) -> list[list[float]]:
    """Points [r, z, radius] of the inner face from rim to pole, mm, of the one open polyline in a DXF file.

    x is the distance from the axis, y the height. Arcs of the polyline become roundings of the corner where the lines
    on their ends meet. Raises InputError for a file that holds anything else.
    """
    points = _polyline(path)
    if points[0][0] < points[-1][0]:
        points = [(x, y, -bulge) for (x, y, _), bulge in zip(points[::-1], _shifted(points), strict=True)]
    if abs(points[-1][0]) > 10**-_DIGITS:
        raise InputError(f"the polyline ends at x = {points[-1][0]:g}, not on the axis x = 0", file=path)
    corners: list[list[float]] = [[points[0][0], points[0][1], 0.0]]
    for (x0, y0, bulge), (x1, y1, _) in pairwise(points):
        if abs(bulge) > 10**-_DIGITS:
            corners.append(_corner(path, (x0, y0), (x1, y1), bulge))
            # The ends of an arc lie within its lines, and are no corners.
            corners = [*corners[:-2], corners[-1]] if len(corners) > 2 and corners[-2][2] == 0.0 else corners
            continue
        corners.append([x1, y1, 0.0])
    if corners[-1][:2] != [points[-1][0], points[-1][1]]:
        corners.append([points[-1][0], points[-1][1], 0.0])
    rounded = [[round(value, _DIGITS) for value in corner] for corner in corners]
    _check_smooth(path, points, rounded)
    return rounded


def _check_smooth(path: Path, points: list[tuple[float, float, float]], corners: list[list[float]]) -> None:
    """Raise InputError where an arc does not go on in the direction of the pieces beside it."""
    line = Profile(points[0][0], 1.0, 0.0, tuple((r, z, radius) for r, z, radius in corners)).line
    places = np.array([[x, y - points[0][1]] for x, y, _ in points])
    off = np.min([piece.distance(places) for piece in line], axis=0)
    if off.max() > _OFF:
        x, y, _ = points[int(off.argmax())]
        raise InputError(
            f"a corner beside an arc at x = {x:.4g}, y = {y:.4g}",
            file=path,
            remedy="let arcs touch the pieces beside them",
        )


def _polyline(path: Path) -> list[tuple[float, float, float]]:
    try:
        import ezdxf
    except ModuleNotFoundError:
        remedy = 'pip install "pneutouch[cad]" adds it'
        raise InputError("reading a drawing takes ezdxf, which is not installed", file=path, remedy=remedy) from None
    try:
        drawing = ezdxf.readfile(path)  # type: ignore[attr-defined]
    except (OSError, ezdxf.DXFError) as error:  # type: ignore[attr-defined]
        why = getattr(error, "strerror", None) or error
        raise InputError(f"not a drawing in DXF that can be read: {why}", file=path) from None
    unit = drawing.header.get("$INSUNITS", 0)
    if unit not in _MM:
        raise InputError(f"drawn in {_UNITS.get(unit, f'unit {unit}')}", file=path, remedy="save it in mm")
    drawn: list[Any] = [one for one in drawing.modelspace() if one.dxftype() in _CURVES]
    found = [one for one in drawn if one.dxftype() == "LWPOLYLINE" and not one.closed]
    if len(found) != 1 or len(drawn) > 1:
        raise InputError(
            f"{counted(len(found), 'open polyline')} and {counted(len(drawn) - len(found), 'other curve')}; "
            "one polyline alone is needed, from the rim to the axis",
            file=path,
            remedy="join the pieces of the inner face into one polyline, and leave all else out",
        )
    return [(float(x), float(y), float(bulge)) for x, y, bulge in found[0].get_points("xyb")]


def _shifted(points: list[tuple[float, float, float]]) -> list[float]:
    """Bulges of the reversed polyline: each belongs to the piece that begins at its point."""
    return [*(bulge for *_, bulge in points[-2::-1]), 0.0]


def _corner(path: Path, start: tuple[float, float], end: tuple[float, float], bulge: float) -> list[float]:
    """Corner and radius of the rounding that is an arc of a polyline."""
    if abs(bulge) > _MOST:
        angle = math.degrees(4 * math.atan(abs(bulge)))
        raise InputError(
            f"an arc of {angle:.3g} degrees at x = {start[0]:.4g}, y = {start[1]:.4g}",
            file=path,
            remedy="divide arcs of more than 97 degrees into shorter ones",
        )
    heading = math.atan2(end[1] - start[1], end[0] - start[0]) - 2 * math.atan(bulge)
    arc = arc_to(start, (math.cos(heading), math.sin(heading)), end)
    assert isinstance(arc, Arc)
    reach = arc.radius * math.tan(2 * math.atan(abs(bulge)))
    return [start[0] + reach * math.cos(heading), start[1] + reach * math.sin(heading), arc.radius]
