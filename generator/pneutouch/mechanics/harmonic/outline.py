"""Lines by which a rigid object is drawn over the dome: circles around its axis, or lines along a lying body."""

from __future__ import annotations

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.harmonic.surface import LyingObject, PlacedObject, ProfiledObject
from pneutouch.mechanics.solid.contact import Plate
from pneutouch.mechanics.solid.indenter import Indenter, RigidObject

_PARTS = 6
"""Equal parts of the length of a section between which its lines stand."""

_ROUND = 48
"""Straight pieces of a circle."""

_EVERY = 6
"""Points of a section to one of a line along it."""

_THICK = 0.12
"""Thickness of a plate as drawn, in R0: the model has its underside alone."""

_NONE = 1e-6
"""Radius in R0 below which a circle is a point."""


def object_lines(body: ProfiledObject, reach: float) -> tuple[Array, ...]:
    """Lines (k, 3) of an object in its place, in R0; an endless one is drawn to a distance ``reach``."""
    section = _section(body.body, reach)
    if isinstance(body, LyingObject):
        return _lying(section, body.offset, reach)
    assert isinstance(body, PlacedObject)
    angle = np.linspace(0.0, 2.0 * np.pi, _ROUND + 1)
    lines = [_placed(body, radius, angle, height) for radius, height in _spread(section) if radius > _NONE]
    # Nearer to the dome lines along the section would cross the contact.
    upper = section[len(section) // 3 :: _EVERY] if len(section) > 2 else section
    lines += [_placed(body, upper[:, 0], turn, upper[:, 1]) for turn in 0.5 * np.pi * (0.5 + np.arange(4))]
    return tuple(lines)


def _placed(body: PlacedObject, radius: float | Array, angle: float | Array, height: float | Array) -> Array:
    """Points (k, 3) of a body of revolution, given about its own axis, in its place."""
    cos, sin = np.cos(body.tilt), np.sin(body.tilt)
    x, y, z = np.broadcast_arrays(radius * np.cos(angle), radius * np.sin(angle), height - body.height)
    return np.stack([body.offset + cos * x - sin * z, y, body.height + sin * x + cos * z], axis=1)


def _section(body: Indenter, reach: float) -> Array:
    """Half its section, (k, 2) in distance from its middle and height."""
    if isinstance(body, Plate):
        edge = body.radius + 0.5 * body.rim
        return np.array([[edge, body.height], [edge, body.height + _THICK]])
    assert isinstance(body, RigidObject)
    return body.outline(reach)


def _spread(section: Array) -> Array:
    """Points (k, 2) at equal steps along a section; of a section of two points these."""
    if len(section) == 2:
        return section
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(section, axis=0).T)))
    at = np.linspace(0.0, along[-1], _PARTS + 1)
    return np.stack([np.interp(at, along, part) for part in section.T], axis=1)


def _lying(section: Array, offset: float, reach: float) -> tuple[Array, ...]:
    """Lines along a body that lies across the plane of symmetry, and its section at both ends."""
    whole = np.concatenate([section[::-1] * [-1.0, 1.0], section[1:]])
    ends = [
        np.stack([offset + whole[:, 0], np.full(len(whole), side * reach), whole[:, 1]], axis=1) for side in (-1.0, 1.0)
    ]
    lines = []
    for distance, height in _spread(section):
        for x in {offset - distance, offset + distance}:
            lines.append(np.array([[x, -reach, height], [x, reach, height]]))
    return (*ends, *lines)
