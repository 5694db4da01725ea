"""The pressed dome in three dimensions, in the colours of its contact pressure, under the outline of the object."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.evaluation.chart_data import PressedView
from pneutouch.export.scene import shaded_glb
from pneutouch.export.view import ShadedBody, view_data
from pneutouch.report.picture import pixels, png
from pneutouch.report.style import INK, figure, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

TILT_DEG = 38.0
"""Angle above the horizon from which the dome is seen: steeper than bodies, for the contact lies on top."""

_PIXELS = (720, 512)
"""Width and height of the picture."""

_COLOURS = 128
"""Colours of the picture in a page, which has to be small."""

_RAMP = ("#D3E8F5", "#62A8CF", "#0B5C8A", "#04263C")
"""Colours from no to the greatest pressure: one hue, light to dark, so that gray paper keeps the order."""

_BARE, _PLANE = "#EFEDE8", "#DDE1E4"
"""Colours of the wall where nothing touches it, and of the base plane."""

_RELIEF = 0.45
"""Share of light and shadow in the colours of the dome: enough for its shape, little enough to read the pressure."""

_LINE = 0.004
"""Radius of the lines of the object over the width of the view."""


def pressed_files(view: PressedView, name: str) -> dict[str, bytes]:
    """``NAME-pressed.glb``, and ``NAME-pressed.png`` with its scale."""
    bodies = _bodies(view)
    return {f"{name}-pressed.glb": shaded_glb(bodies), f"{name}-pressed.png": _with_scale(view, _image(bodies))}


class PressedFigure(NamedTuple):
    """Data of the 3D view (JSON), the picture in its place (PNG), and the scale of the pressure (SVG)."""

    data: str
    image: bytes
    scale: str


def pressed_figure(view: PressedView) -> PressedFigure:
    """Picture of the pressed dome as a page shows it."""
    bodies = _bodies(view)
    with figure(86, 13) as drawn:
        _scale(drawn, drawn.add_subplot(), view)
        scale = svg(drawn)
    return PressedFigure(view_data(bodies, TILT_DEG), png(_image(bodies), _COLOURS), scale)


def caption(view: PressedView) -> str:
    """Caption of the picture."""
    moved = f" and moved {view.travel:g} mm sideways" if view.travel else ""
    return (
        f"The outer surface at {view.driving_pressure_kPa:g} kPa driving pressure, pressed {view.indentation:.2f} mm"
        f"{moved} (contact force {view.force:.2f} N), in the colours of the contact pressure: normal force over the "
        "area of the deformed wall. Lines: the object; no colour: no contact."
    )


def _bodies(view: PressedView) -> list[ShadedBody]:
    """Dome, base plane and lines."""
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
    """The outer surface; two triangles to a field of the grid, one at the pole."""
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
    return pixels(bodies, *_PIXELS, TILT_DEG)


def _scale(drawn: Figure, ax: Axes, view: PressedView) -> None:
    """The scale of the pressure, with its unit, along axes."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LinearSegmentedColormap

    colours = ScalarMappable(cmap=LinearSegmentedColormap.from_list("pressure", _RAMP))
    colours.set_clim(0.0, max(float(view.pressure_kPa.max()), 1e-12))
    drawn.colorbar(colours, cax=ax, orientation="horizontal", label="contact pressure  (kPa)")


def _with_scale(view: PressedView, image: Array) -> bytes:
    """PNG of the picture over its scale."""
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
