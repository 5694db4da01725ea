"""The air space of an assembly measured on its meshes: what is left of a box when bodies, glue and fitting are cut out."""

from __future__ import annotations

import numpy as np
from manifold3d import Manifold, Mesh64, OpType

from pneutouch.body import Frame, Turned
from pneutouch.parts.connector import gasket_radii
from pneutouch.shape.meridian import trace

_FINE = 0.003
_HAIR = 1e-6
"""The box ends a hair inside the mouth's plane: no path leads round its rim."""


def manifold(vertices, triangles):
    return Manifold(Mesh64(np.ascontiguousarray(vertices), triangles.astype(np.uint64)))


def ring(inner, outer, low, high, frame=None):
    outline = trace((inner, low), [("", (outer, low)), ("", (outer, high)), ("", (inner, high)), ("", (inner, low))])
    return manifold(*Turned(outline, frame or Frame()).mesh(_FINE))


def measured_volume(assembly, solids=None):
    """Volume in mm3 of the parts of the air space that end at the base plane; 0 where it leaks to the outside.

    ``solids`` are those that bound it, by default all of the assembly.
    """
    layout, port = assembly.layout, assembly.layout.port
    rear = layout.port_axis is None
    reach = layout.plate_radius + port.length + 5
    low = layout.under - port.length + _HAIR if rear else min(b.bounds[0][2] for b in assembly.bodies) - 2
    box = Manifold.cube((2 * reach, 2 * reach, -low)).translate((-reach, -reach, low))
    if not rear:
        box = box.trim_by_plane((-1, 0, 0), -(layout.plate_radius + port.length - _HAIR))
    cuts = [manifold(body.vertices, body.triangles) for body in (s.mesh(_FINE) for s in solids or assembly.solids)]
    if assembly.scene.seat.family == "glued-flange":
        cuts.append(ring(layout.groove_inner, layout.inner_radius, layout.plate_high, 0.0))
        cuts.append(ring(layout.flange_radius, layout.groove_outer, layout.plate_high, 0.0))
    if assembly.scene.seat.family == "cast-ring":
        cuts.append(ring(layout.groove_inner, layout.inner_radius + layout.flange_draft, layout.plate_high, 0.0))
        cuts.append(ring(layout.held_radius, layout.groove_outer, layout.plate_high, 0.0))
    if layout.gasket:
        cuts.append(ring(*gasket_radii(layout), layout.plate_high, -layout.flange_thickness))
    if port.engaged:
        rear_frame = Frame((0.0, 0.0, layout.under), (0.0, 0.0, -1.0))
        frame = (
            rear_frame
            if rear
            else Frame((layout.plate_radius, 0.0, layout.port_axis), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
        )
        cuts.append(ring(port.fitting_bore, port.root - 0.05, port.length - port.engaged, port.length + 1, frame))
    rest = Manifold.batch_boolean([box, *cuts], OpType.Subtract)
    volume = 0.0
    for part in rest.decompose():
        x0, y0, _, x1, y1, top = part.bounding_box()
        if top > -1e-6 and max(-x0, -y0, x1, y1) < reach - 1:
            volume += part.volume()
    return volume


def measured_gas(assembly):
    """Volume in mm3 of the whole gas between membrane and the mouth of a port behind; 0 where it leaks."""
    layout, port = assembly.layout, assembly.layout.port
    reach, low = layout.plate_radius + 5, layout.under - port.length + _HAIR
    high = layout.shape.outer_height + layout.wall + 2
    box = Manifold.cube((2 * reach, 2 * reach, high - low)).translate((-reach, -reach, low))
    cuts = [manifold(body.vertices, body.triangles) for body in (s.mesh(_FINE) for s in assembly.solids)]
    if assembly.scene.seat.family == "glued-flange":
        cuts.append(ring(layout.groove_inner, layout.inner_radius, layout.plate_high, layout.floor))
        cuts.append(ring(layout.flange_radius, layout.groove_outer, layout.plate_high, 0.0))
    if port.engaged:
        frame = Frame((0.0, 0.0, layout.under), (0.0, 0.0, -1.0))
        cuts.append(ring(port.fitting_bore, port.root - 0.05, port.length - port.engaged, port.length + 1, frame))
    rest = Manifold.batch_boolean([box, *cuts], OpType.Subtract)
    boxes = ((part, part.bounding_box()) for part in rest.decompose())
    return sum(
        part.volume()
        for part, (x0, y0, _, x1, y1, top) in boxes
        if max(-x0, -y0, x1, y1, top + reach - high) < reach - 1
    )
