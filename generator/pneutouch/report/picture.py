"""A shaded picture of the sensor, cut open, drawn with a depth buffer: no display, no graphics driver.

Used for the PDF and the README, where a page cannot turn.
"""

import io
import math
from collections.abc import Sequence

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.export.view import TILT_DEG, ShadedBody

_LIGHT = np.array([-0.35, -0.55, 0.76])
_OVERSAMPLING = 2
_PIXELS_AT_ONCE = 50_000
"""Pixels of triangles that are worked on together: what fits the processor's cache."""
_LEVEL_EDGE = 1e-6
"""Height in pixels below which an edge lies along a line of pixels."""


def picture(bodies: Sequence[ShadedBody], width: int = 900, height: int = 640) -> bytes:
    """PNG of the bodies (z up) from above and in front, on white."""
    return png(pixels(bodies, width, height))


def png(image: Array, colours: int | None = None) -> bytes:
    """PNG of an image (height, width, 3) from 0 to 1, the uppermost line first; a small one in so many colours."""
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
    """The bodies (z up) from above, by ``tilt_deg``, and in front, on white: (height, width, 3), 0 to 1."""
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
    """Rotation whose rows are right, up and towards the viewer."""
    towards = np.array([math.cos(tilt) * math.cos(turn), math.cos(tilt) * math.sin(turn), math.sin(tilt)])
    right = np.array([-math.sin(turn), math.cos(turn), 0.0])
    return np.array([right, np.cross(towards, right), towards])


def _shades(body: ShadedBody) -> Array:
    """Colours at the corners, (n, 3, 3): ambient, diffuse from the upper left, a little from below."""
    diffuse = np.clip(body.normals @ (_LIGHT / np.linalg.norm(_LIGHT)), 0, 1)
    shade = body.relief * (0.42 + 0.62 * diffuse + 0.05 * body.normals[..., 2]) + (1.0 - body.relief)
    lit: Array = np.clip(shade[..., None] * body.colours, 0, 1)
    return lit


def _paint(image: Array, depth: Array, corners: Array, colours: Array) -> None:
    """Paint triangles (n, 3, 3), in pixels and depth, where they lie in front; of two equally near the first shows.

    Their ``colours`` (n, 3, 3) at the corners are mixed between them.
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
    """All whole numbers from low to high, (n,) each, and which pair each belongs to."""
    count = np.maximum(high - low + 1, 0)
    which = np.repeat(np.arange(low.size), count)
    return which, np.arange(which.size) - np.repeat(np.cumsum(count) - count - low, count)


def _span(corners: Array, whole: Array, y: Array, low: Index, high: Index) -> tuple[Index, Index]:
    """First and last pixel of triangles (n, 3, 3) on lines at y, with one to spare, between low and high; (n,) each."""
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
    """Paint pixels (n,) of triangles (n, 3, 3) that lie in the triangle and in front of the picture so far."""
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
