"""Shaded pictures of the sensor, cut open, and of the pressed dome, drawn with a depth buffer: no graphics driver.

They stand in PDFs, image files and the README, which cannot be turned.
"""

import io
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.evaluation.sheet_data import PressedView
from pneutouch.export.scene import TILT_DEG, ShadedBody, cut_open, shaded, shaded_glb, view_data
from pneutouch.parts import Assembly
from pneutouch.report.blocks import Columns, SheetBlock, Text, View
from pneutouch.report.style import ACCENT, INK, figure, svg
from pneutouch.shape.dome import DomeShape
from pneutouch.spec.material import ArcGrading

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


_LIGHT = np.array([-0.35, -0.55, 0.76])
_OVERSAMPLING = 2
_PIXELS_AT_ONCE = 50_000
"""Number of pixels of triangles processed at a time: as many as fit the processor's cache."""
_LEVEL_EDGE = 1e-6
"""An edge of less height than this, in pixels, counts as horizontal."""


def picture(bodies: Sequence[ShadedBody], width: int = 900, height: int = 640) -> bytes:
    """PNG of the bodies (z up) from above and in front, on white; ``width`` and ``height`` in pixels."""
    return png(pixels(bodies, width, height))


def png(image: Array, colours: int | None = None) -> bytes:
    """PNG of an image (height, width, 3), 0 to 1, top line first, with at most ``colours`` colours if given."""
    from matplotlib.image import imsave
    from PIL import Image

    buffer = io.BytesIO()
    if colours is None:
        imsave(buffer, image, format="png", metadata={"Software": "pneutouch"})
        return buffer.getvalue()
    whole = Image.fromarray(np.rint(255 * image).astype(np.uint8))
    few = whole.quantize(colours, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    few.save(buffer, format="png", optimize=True)
    return buffer.getvalue()


def pixels(bodies: Sequence[ShadedBody], width: int, height: int, tilt_deg: float = TILT_DEG) -> Array:
    """Image (height, width, 3), 0 to 1, of bodies (z up) on white, from in front, ``tilt_deg`` above the horizon."""
    view = _view(math.radians(-62), math.radians(tilt_deg))
    size = (height * _OVERSAMPLING, width * _OVERSAMPLING)
    image, depth = np.ones((*size, 3)), np.full(size, -np.inf)
    corners = np.concatenate([body.corners for body in bodies]) @ view.T
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    scale = 0.94 * min(size[1] / (high[0] - low[0]), size[0] / (high[1] - low[1]))
    shift = 0.5 * np.array([size[1], size[0]]) - 0.5 * scale * (low + high)[:2]
    corners[..., :2] = corners[..., :2] * scale + shift
    _paint(image, depth, corners, np.concatenate([_shades(body) for body in bodies]))
    small = image.reshape(height, _OVERSAMPLING, width, _OVERSAMPLING, 3).mean(axis=(1, 3))
    return np.asarray(np.clip(small[::-1], 0, 1))


def _view(turn: float, tilt: float) -> Array:
    """Rotation (3, 3) whose rows are right, up and towards the viewer; ``turn`` about z and ``tilt`` in radians."""
    towards = np.array([math.cos(tilt) * math.cos(turn), math.cos(tilt) * math.sin(turn), math.sin(tilt)])
    right = np.array([-math.sin(turn), math.cos(turn), 0.0])
    return np.array([right, np.cross(towards, right), towards])


def _shades(body: ShadedBody) -> Array:
    """Colours at the corners, (n, 3, 3): ambient light, diffuse light from the upper left, a little from above."""
    diffuse = np.clip(body.normals @ (_LIGHT / np.linalg.norm(_LIGHT)), 0, 1)
    shade = body.relief * (0.42 + 0.62 * diffuse + 0.05 * body.normals[..., 2]) + (1.0 - body.relief)
    return np.asarray(np.clip(shade[..., None] * body.colours, 0, 1))


def _paint(image: Array, depth: Array, corners: Array, colours: Array) -> None:
    """Paint triangles (n, 3, 3), x and y in pixels and depth, that face the viewer, where they are nearest.

    The ``colours`` (n, 3, 3) of the corners are interpolated; of two equally near triangles the first shows.
    """
    a, b, c = np.moveaxis(corners, 1, 0)
    whole = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (c[:, 0] - a[:, 0]) * (b[:, 1] - a[:, 1])
    corners, colours, whole = corners[whole > 0], colours[whole > 0], whole[whole > 0]
    low = np.floor(corners[..., :2].min(axis=1)).astype(int)
    high = np.minimum(np.ceil(corners[..., :2].max(axis=1)).astype(int), np.array(depth.shape)[::-1] - 1)
    which, y = _counted(low[:, 1], high[:, 1])
    left, right = _span(corners[which], whole[which], np.asarray(y + 0.5), low[which, 0], high[which, 0])
    ends = np.cumsum(np.maximum(right - left + 1, 0))
    start = 0
    while start < y.size:
        stop = int(np.searchsorted(ends, (ends[start - 1] if start else 0) + _PIXELS_AT_ONCE, side="right"))
        part = slice(start, max(stop, start + 1))
        line, x = _counted(left[part], right[part])
        rows = which[part][line]
        _nearest(image, depth, x, y[part][line], corners[rows], whole[rows], colours[rows])
        start = part.stop


def _counted(low: Index, high: Index) -> tuple[Index, Index]:
    """All whole numbers from low to high (n,) of each pair in a row: index of the pair, and the number."""
    count = np.maximum(high - low + 1, 0)
    which = np.repeat(np.arange(low.size), count)
    return which, np.arange(which.size) - np.repeat(np.cumsum(count) - count - low, count)


def _span(corners: Array, whole: Array, y: Array, low: Index, high: Index) -> tuple[Index, Index]:
    """First and last pixel (n,) of triangles (n, 3, 3) on lines at y, a pixel or two wider, from low to high."""
    left, right = low.astype(float), high.astype(float)
    for k in range(3):
        (px, py), (qx, qy) = corners[:, k, :2].T, corners[:, k - 2, :2].T
        # Of edges nearly along the line the meeting point is not known to a pixel.
        steep = np.abs(py - qy) > _LEVEL_EDGE
        meets = (px * (qy - y) - qx * (py - y)) / np.where(steep, qy - py, 1.0)
        left = np.where(steep & (py > qy), np.maximum(left, meets - 2.0), left)
        right = np.where(steep & (py < qy), np.minimum(right, meets + 2.0), right)
    return np.floor(left).astype(np.intp), np.ceil(right).astype(np.intp)


def _nearest(image: Array, depth: Array, x: Index, y: Index, corners: Array, whole: Array, colours: Array) -> None:
    """Paint pixels ``x``, ``y`` (n,) that lie in their triangles (n, 3, 3) and in front of ``depth``; renew it."""
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = np.moveaxis(corners, 0, -1)
    right, up = x + 0.5, y + 0.5
    u = ((bx - right) * (cy - up) - (cx - right) * (by - up)) / whole
    v = ((cx - right) * (ay - up) - (ax - right) * (cy - up)) / whole
    w = 1 - u - v
    level = u * az + v * bz + w * cz
    place = y * depth.shape[1] + x
    seen = np.flatnonzero((np.minimum(np.minimum(u, v), w) >= -1e-9) & (level > depth.ravel()[place]))
    seen = seen[np.lexsort((seen, -level[seen], place[seen]))]
    seen = seen[np.diff(place[seen], prepend=-1) != 0]
    depth.reshape(-1)[place[seen]] = level[seen]
    mixed = np.stack([u, v, w], axis=-1)[seen]
    image.reshape(-1, 3)[place[seen]] = np.einsum("nk,nkc->nc", mixed, colours[seen])


PRESSED_TILT_DEG = 38.0
"""Angle above the horizon from which the dome is seen: steeper than bodies, for the contact lies on top."""

_PIXELS = (720, 512)
"""Width and height of the picture of the pressed dome, pixels."""

_COLOURS = 128
"""Number of colours of that picture in a page, where it has to be small."""

_RAMP = ("#D3E8F5", "#62A8CF", "#0B5C8A", "#04263C")
"""Colours from no to the greatest pressure: one hue, light to dark, so that gray paper keeps the order."""

_BARE, _PLANE = "#EFEDE8", "#DDE1E4"
"""Colours of the wall where nothing touches it, and of the base plane."""

_RELIEF = 0.45
"""Share of light and shadow in the colours of the dome: enough for its shape, little enough to read the pressure."""

_LINE = 0.004
"""Radius of the lines of the object over the width of the view."""


def pressed_files(view: PressedView, name: str) -> dict[str, bytes]:
    """Files by name: ``NAME-pressed.glb``, and ``NAME-pressed.png`` with the colour scale."""
    bodies = _bodies(view)
    return {f"{name}-pressed.glb": shaded_glb(bodies), f"{name}-pressed.png": _with_scale(view, _image(bodies))}


def pressed_blocks(view: PressedView) -> list[SheetBlock]:
    """The pressed dome on a sheet: the 3D view over its scale, and its caption beside it."""
    bodies = _bodies(view)
    with figure(86, 13) as drawn:
        _scale(drawn, drawn.add_subplot(), view)
        scale = svg(drawn)
    words = "The pressed dome from above and in front, its contact pressure in colour"
    shown = View("pressed", view_data(bodies, PRESSED_TILT_DEG), png(_image(bodies), _COLOURS), words, scale=scale)
    return [Columns(((shown,), (Text(pressed_caption(view), "muted"),)))]


def pressed_caption(view: PressedView) -> str:
    """Caption of the picture of the pressed dome."""
    moved = f" and moved {view.travel:g} mm sideways" if view.travel else ""
    return (
        f"The outer surface at {view.driving_pressure_kPa:g} kPa driving pressure, pressed {view.indentation:.2f} mm"
        f"{moved} (contact force {view.force:.2f} N), in the colours of the contact pressure: normal force over the "
        "area of the deformed wall. Lines: the object; no colour: no contact."
    )


def _bodies(view: PressedView) -> list[ShadedBody]:
    """Bodies of the picture: dome, base plane, and the lines of the object if there are any."""
    wide = float(np.ptp(view.points[..., 0]))
    tubes = [_tube(line, _LINE * wide) for line in view.lines]
    drawn = []
    if tubes:
        corners, normals = (np.concatenate(parts) for parts in zip(*tubes, strict=True))
        drawn = [ShadedBody("object", corners, normals, np.broadcast_to(_colour(INK), corners.shape), 0.0)]
    return [_dome(view), _base(view), *drawn]


def _colour(text: str) -> Array:
    return np.array(list(bytes.fromhex(text[1:]))) / 255


def _dome(view: PressedView) -> ShadedBody:
    """The outer surface, coloured by pressure: two triangles for each cell of the grid, one in the row at the pole."""
    share = view.pressure_kPa / max(float(view.pressure_kPa.max()), 1e-12)
    steps, ramp = np.linspace(0.0, 1.0, len(_RAMP)), np.stack([_colour(text) for text in _RAMP])
    pressed = np.stack([np.interp(share, steps, part) for part in ramp.T], axis=-1)
    colours = np.where(share[..., None] > 0.0, pressed, _colour(_BARE))
    rows, columns = share.shape
    row, column = (part.ravel() for part in np.indices((rows - 1, columns)))
    after = (column + 1) % columns
    corner = [row * columns + column, row * columns + after, (row + 1) * columns + after, (row + 1) * columns + column]
    last = row < rows - 2
    triangles = np.concatenate([np.stack(corner[:3], axis=1), np.stack([corner[0], *corner[2:]], axis=1)[last]])
    corners, normals, shades = (part.reshape(-1, 3)[triangles] for part in (view.points, view.normals, colours))
    return ShadedBody("pressed dome", corners, normals, shades, _RELIEF, columns)


def _base(view: PressedView) -> ShadedBody:
    """A disc in the base plane, inside the clamped edge of the dome and a little around it."""
    around = view.points[0] * [1.25, 1.25, 1.0]
    middle = around.mean(axis=0)
    corners = np.stack([np.broadcast_to(middle, around.shape), around, np.roll(around, -1, axis=0)], axis=1)
    normals = np.broadcast_to([0.0, 0.0, 1.0], corners.shape)
    return ShadedBody("base plane", corners, normals, np.broadcast_to(_colour(_PLANE), corners.shape), 0.0)


def _tube(line: Array, radius: float) -> tuple[Array, Array]:
    """Corners and normals (m, 3, 3) of a square tube along a line (k, 3)."""
    along = np.gradient(line, axis=0)
    if np.allclose(line[0], line[-1]):
        along[[0, -1]] = along[0] + along[-1]
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    upright = np.where(np.abs(along[:, 2:]) < 0.9, [0.0, 0.0, 1.0], [1.0, 0.0, 0.0])
    first = np.cross(along, upright)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    second = np.cross(along, first)
    sides = np.stack([first, second, -first, -second], axis=1)
    points = line[:, None] + radius * sides
    near, far = (points[:-1], sides[:-1]), (points[1:], sides[1:])
    parts = []
    for here, ahead in zip(near, far, strict=True):
        after, ahead_after = np.roll(here, -1, axis=1), np.roll(ahead, -1, axis=1)
        quads = [np.stack([here, ahead, ahead_after], axis=2), np.stack([here, ahead_after, after], axis=2)]
        parts.append(np.concatenate([quad.reshape(-1, 3, 3) for quad in quads]))
    return parts[0], parts[1]


def _image(bodies: list[ShadedBody]) -> Array:
    return pixels(bodies, *_PIXELS, PRESSED_TILT_DEG)


def _scale(drawn: "Figure", ax: "Axes", view: PressedView) -> None:
    """Draw the colour scale of the pressure, with its unit, into axes."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LinearSegmentedColormap

    colours = ScalarMappable(cmap=LinearSegmentedColormap.from_list("pressure", _RAMP))
    colours.set_clim(0.0, max(float(view.pressure_kPa.max()), 1e-12))
    drawn.colorbar(colours, cax=ax, orientation="horizontal", label="contact pressure  (kPa)")


def _with_scale(view: PressedView, image: Array) -> bytes:
    """PNG of an image (height, width, 3) above its colour scale."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    buffer = io.BytesIO()
    with figure(120, 102) as drawn:
        FigureCanvasAgg(drawn)
        above, below = drawn.subplots(2, 1, height_ratios=(32, 1))
        above.imshow(image, interpolation="antialiased")
        above.axis("off")
        _scale(drawn, below, view)
        drawn.savefig(buffer, format="png", dpi=200, metadata={"Software": "pneutouch"})
    return buffer.getvalue()


GRADE_COLOURS = ("#F4EBD6", ACCENT)
"""Colours of no and of the greatest share of the stiff resin: light to dark, so that gray paper keeps the order."""


def shown(assembly: Assembly, pixels: int) -> tuple[ShadedBody, ...]:
    """The bodies of an assembly, cut open, for a view ``pixels`` wide: meshes within an eighth of a pixel."""
    extent = max(float(np.ptp(body.vertices, axis=0).max()) for body in assembly.bodies)
    tolerance = max(assembly.scene.mesh_tolerance, extent / pixels / 8)
    grading, shape = assembly.scene.membrane_material.along, assembly.layout.shape
    bodies = [cut_open(solid.mesh(tolerance)) for solid in assembly.solids]
    return tuple(
        shaded(body, grade_colours(grading, shape, body.vertices) if grading and body.role == "membrane" else None)
        for body in bodies
    )


def greatest_share(grading: ArcGrading) -> float:
    """Share of the stiff resin at the dark end of the colours; at least one percent, so that a share of 0 is light."""
    return max(*grading.stiff_fraction, 0.01)


def grade_colours(grading: ArcGrading, shape: DomeShape, points: Array) -> Array:
    """Colours (n, 3), 0 to 1, of points (n, 3) of the wall, mm in the design frame, by the stiff resin's share."""
    light, dark = map(_colour, GRADE_COLOURS)
    arc = shape.arc_share(np.hypot(points[:, 0], points[:, 1]), points[:, 2])
    share = np.interp(arc, grading.arc, grading.stiff_fraction)[:, None] / greatest_share(grading)
    return np.asarray(light + share * (dark - light))
