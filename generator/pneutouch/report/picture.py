"""A shaded picture of the sensor, cut open, drawn with a depth buffer: no display, no graphics driver.

Used for the PDF and the README, where a page cannot turn.
"""

from __future__ import annotations

import io
import math

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Body

_LIGHT = np.array([-0.35, -0.55, 0.76])
_OVERSAMPLING = 2


def picture(bodies: tuple[Body, ...], width: int = 900, height: int = 640) -> bytes:
    """PNG of the bodies (mm, z up) from above and in front, on white."""
    from matplotlib.image import imsave

    view = _view(math.radians(-62), math.radians(26))
    size = (height * _OVERSAMPLING, width * _OVERSAMPLING)
    image, depth = np.ones((*size, 3)), np.full(size, -np.inf)
    points = np.concatenate([body.vertices for body in bodies]) @ view.T
    low, high = points.min(axis=0), points.max(axis=0)
    scale = 0.94 * min(size[1] / (high[0] - low[0]), size[0] / (high[1] - low[1]))
    shift = 0.5 * np.array([size[1], size[0]]) - 0.5 * scale * (low + high)[:2]
    for body in bodies:
        colours = _shades(body)
        corners = body.corners @ view.T
        corners[..., :2] = corners[..., :2] * scale + shift
        for corner, colour in zip(corners, colours, strict=True):
            _fill(image, depth, corner, colour)
    small = image.reshape(height, _OVERSAMPLING, width, _OVERSAMPLING, 3).mean(axis=(1, 3))
    buffer = io.BytesIO()
    imsave(buffer, np.clip(small[::-1], 0, 1), format="png", metadata={"Software": "pneutouch"})
    return buffer.getvalue()


def _view(turn: float, tilt: float) -> Array:
    """Rotation whose rows are right, up and towards the viewer."""
    towards = np.array([math.cos(tilt) * math.cos(turn), math.cos(tilt) * math.sin(turn), math.sin(tilt)])
    right = np.array([-math.sin(turn), math.cos(turn), 0.0])
    return np.array([right, np.cross(towards, right), towards])


def _shades(body: Body) -> Array:
    """One colour a triangle: ambient, diffuse from the upper left, a little from below."""
    a, b, c = np.moveaxis(body.corners, 1, 0)
    normal = np.cross(b - a, c - a)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-30)
    diffuse = np.clip(normal @ (_LIGHT / np.linalg.norm(_LIGHT)), 0, 1)
    base = np.array(list(bytes.fromhex(body.material.colour[1:]))) / 255
    shade = 0.42 + 0.62 * diffuse + 0.05 * normal[:, 2]
    lit: Array = np.clip(shade[:, None] * base, 0, 1)
    return lit


def _fill(image: Array, depth: Array, corner: Array, colour: Array) -> None:
    """Paint one triangle where it lies in front; ``corner`` (3, 3) is in pixels and depth."""
    (x0, y0), (x1, y1) = np.floor(corner[:, :2].min(axis=0)).astype(int), np.ceil(corner[:, :2].max(axis=0)).astype(int)
    xs, ys = np.arange(x0, x1 + 1) + 0.5, np.arange(y0, y1 + 1) + 0.5
    a, b, c = corner
    whole = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
    if whole <= 0:
        return
    u = ((b[0] - xs[None, :]) * (c[1] - ys[:, None]) - (c[0] - xs[None, :]) * (b[1] - ys[:, None])) / whole
    v = ((c[0] - xs[None, :]) * (a[1] - ys[:, None]) - (a[0] - xs[None, :]) * (c[1] - ys[:, None])) / whole
    w = 1 - u - v
    level = u * a[2] + v * b[2] + w * c[2]
    block = depth[y0 : y1 + 1, x0 : x1 + 1]
    seen = (np.minimum(np.minimum(u, v), w) >= -1e-9) & (level > block)
    block[seen] = level[seen]
    image[y0 : y1 + 1, x0 : x1 + 1][seen] = colour
