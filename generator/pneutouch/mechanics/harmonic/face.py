"""The outer wall of a solved state: forces of contact gathered at its nodes, and the object over it."""

from __future__ import annotations

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.harmonic.contact import HarmonicContact, upward
from pneutouch.mechanics.harmonic.fields import Harmonics
from pneutouch.mechanics.harmonic.outline import object_lines
from pneutouch.mechanics.harmonic.surface import ProfiledObject
from pneutouch.mechanics.pressed_face import PressedFace
from pneutouch.mechanics.solid.elements import line_shapes
from pneutouch.mechanics.solid.mesh import END, START
from pneutouch.mechanics.solid.model import SolidModel

_DRAWN = 1.3
"""Distance over the outer radius of the dome to which an endless object is drawn."""


def pressed_face(
    solid: SolidModel,
    harmonics: Harmonics,
    positions: Array,
    body: ProfiledObject,
    indentation: float,
    travel: float = 0.0,
) -> PressedFace:
    """The outer wall at positions (n_nodes, columns) in mm under an object in R0 that stands in its place.

    With friction its tractions are left out: the pressure is that normal to the object.
    """
    contact = HarmonicContact(solid.contact, harmonics, np.ones(positions.shape))
    x, length = positions / solid.length, solid.length
    touch = contact.touch(x, body)
    load = (contact.weight * touch.traction)[..., None] * upward(touch.slope)
    areas = face_areas(solid, x, harmonics)
    both = _gathered(solid, np.stack([areas, np.where(touch.traction > 0.0, areas, 0.0)], axis=3)) * length**2
    ends = [*solid.mesh.outer[:, START], solid.mesh.outer_apex]
    reach = _DRAWN * float(solid.mesh.nodes[:, 0].max())
    return PressedFace(
        indentation=indentation,
        travel=travel,
        harmonics=harmonics,
        coefficients=positions[_along(solid)],
        forces=_gathered(solid, load)[ends] * solid.mu * length**2,
        areas=both[ends, :, 0],
        touching=both[ends, :, 1],
        lines=tuple(line * length for line in object_lines(body, reach / length)),
    )


def face_areas(solid: SolidModel, x: Array, harmonics: Harmonics) -> Array:
    """Areas of the deformed outer wall at the points of contact (n_edges, n_points, n_angles) in R0 squared: the
    product of the tangents along the meridian and around the axis, of coefficients x (n_nodes, columns)."""
    edges, angles = solid.mesh.outer, harmonics.contact_angles
    place, weight = np.polynomial.legendre.leggauss(solid.contact.shape.shape[0])
    value, slope = line_shapes(place, edges.shape[1])
    along = np.einsum("pn,enc,akc->epak", slope, x[edges], harmonics.values(angles), optimize=True)
    around = np.einsum("pn,enc,akc->epak", value, x[edges], harmonics.turned(angles), optimize=True)
    areas = np.linalg.norm(np.cross(along, around), axis=-1)
    return np.asarray(areas * weight[:, None] * (2.0 * np.pi / angles.size))


def _gathered(solid: SolidModel, load: Array) -> Array:
    """Loads at the points of contact (n_edges, n_points, n_angles, k) at the ends of their edges, in shares by the
    distance from them, (n_mesh_nodes, n_angles, k). No share is negative: no node is pulled."""
    ends = solid.mesh.outer[:, [START, END]]
    place, _ = np.polynomial.legendre.leggauss(solid.contact.shape.shape[0])
    shares = 0.5 + 0.5 * place[:, None] * np.array([-1.0, 1.0])
    out = np.zeros((solid.mesh.nodes.shape[0], *load.shape[2:]))
    np.add.at(out, ends, np.einsum("pn,epak->enak", shares, load))
    return out


def _along(solid: SolidModel) -> list[int]:
    """Nodes of the outer wall from the base to the pole."""
    edges = solid.mesh.outer
    order = [START, 2] if edges.shape[1] == 3 else [START]
    return [*edges[:, order].ravel().tolist(), solid.mesh.outer_apex]
