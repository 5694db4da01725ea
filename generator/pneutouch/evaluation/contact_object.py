"""The object that presses a design's sensor, as the solid takes it, and checks of object and plate.

Notes on the uncertainty of a sensor under a contact other than a plate without friction.
"""

import dataclasses
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.catalogue import ResolvedDesign
from pneutouch.errors import InputError
from pneutouch.mechanics import Sensor, SensorPrediction
from pneutouch.mechanics.sensor import Filling, RigidBase
from pneutouch.mechanics.solid.mesh import CELLS_PER_RADIUS, MOST_CELLS, object_cells
from pneutouch.mechanics.solid.object_contact import RIM, first_contact, flat_radius
from pneutouch.shape.hemisphere import no_hemisphere
from pneutouch.spec.contact import NODULE
from pneutouch.spec.part import ClampedFlange
from pneutouch.units import ML
from pneutouch.wording import data_of

if TYPE_CHECKING:
    from pneutouch.mechanics.soft.body import SoftBody
    from pneutouch.mechanics.solid.indenter import RigidObject
    from pneutouch.mechanics.uncertainty.contact_model import ContactModel
    from pneutouch.parts import Assembly

_AT_ONCE = 1e-6
"""Indentation, as a share of R0, up to which contact that reaches an edge does so at first touch."""

_STEEPEST = math.radians(60.0)
"""Greatest lean (angle to the axis) of the place at which a round object off the axis may touch the dome first."""

_POINTS = 2001
"""Number of points of the unloaded dome among which first touch is sought."""


def rigid_base(assembly: "Assembly") -> RigidBase | None:
    """Base that the wall of a design can lie down on, from the connector's faces; None if it passes through."""
    layout, seat = assembly.layout, assembly.scene.seat
    if not assembly.scene.design.contact.base:
        return None
    if isinstance(seat, ClampedFlange):
        return RigidBase(layout.channel_radius, ring=layout.ring_inner, ring_height=seat.ring_thickness)
    return RigidBase(layout.channel_radius)


def contact_object(scene: ResolvedDesign) -> "RigidObject | None":
    """The object of a design in mm; None for a plate. Raises InputError for a profile that is no underside."""
    contact = scene.design.contact
    if contact.is_plate:
        return None
    from pneutouch.mechanics.solid.indenter import ObjectShapeError, object_of

    try:
        return dataclasses.replace(object_of(contact), label=contact.label)
    except ObjectShapeError as error:
        corners = contact.profile_mm or []
        key, value = f"contact.profile_mm[{error.index}]", corners[error.index]
        raise InputError(str(error), file=scene.where, key=key, value=value) from None


def soft_object(scene: ResolvedDesign) -> "SoftBody | None":
    """Material of the object of a design; None for a rigid one."""
    contact = scene.design.contact
    if contact.object_modulus_MPa is None:
        return None
    from pneutouch.mechanics.soft.body import Nodule, SoftBody

    sizes = [getattr(contact, key) for key in NODULE]
    nodule = None if None in sizes else Nodule(*sizes)
    stuff = (contact.object_modulus_MPa, contact.object_poisson_ratio, contact.object_thickness_mm)
    return SoftBody(*stuff, nodule, contact.label)


def contact_document(scene: ResolvedDesign) -> dict[str, Any]:
    """The entry ``contact`` of a document: the pressing object by the keys of ``[contact]``; empty for a frictionless
    plate with its usual rim. A surface that grips has the friction "inf"."""
    contact = scene.design.contact
    if contact.is_atlas_plate:
        return {}
    plate = {"plate_diameter_mm": scene.design.indentation.plate_diameter_mm, "plate_rim_mm": contact.plate_rim_mm}
    friction = contact.model_dump(mode="json")["friction"]
    sizes = {key: size for key, size in plate.items() if size is not None} if contact.is_plate else contact.sizes()
    return {
        "contact": {
            "object": contact.object,
            "label": contact.label,
            **sizes,
            **contact.softness,
            "friction": friction,
            **contact.off_axis,
        }
    }


def _check_cells(scene: ResolvedDesign, sensor: Sensor) -> None:
    """Raise InputError for an object that the finest mesh of the solid cannot follow."""
    body, cells = sensor.protocol.body, object_cells(sensor)
    if body is None or cells is None or cells <= MOST_CELLS:
        return
    least = body.smallest * cells / MOST_CELLS
    raise _object_error(
        scene,
        f"its least radius of curvature, {body.smallest:.3g} mm, is too small for the mesh: a mesh of {cells} cells "
        f"along the arc would do ({CELLS_PER_RADIUS} to that radius), the solid takes {MOST_CELLS} at most",
        f"for this dome the radius must be at least {math.ceil(100 * least) / 100:g} mm",
    )


def check_shape(scene: ResolvedDesign) -> None:
    """Raise InputError for a dome of another shape than the atlas's: searches use the atlas."""
    membrane = scene.design.membrane
    why = no_hemisphere(membrane.dome)
    if why is not None:
        key, value = (
            ("shape", membrane.shape)
            if membrane.root_fillet_mm is None
            else ("root_fillet_mm", membrane.root_fillet_mm)
        )
        raise InputError(f"the atlas finds designs: {why}", file=scene.where, key=f"membrane.{key}", value=value)


def check_object(scene: ResolvedDesign, sensor: Sensor) -> None:
    """Raise InputError for an object that the mesh cannot follow or that meets the unloaded dome with its edge.

    Off the axis objects are round, and the greatest offset (`_check_offset`) limits where they touch.
    """
    _check_offset(scene, sensor)
    body = sensor.protocol.body
    if body is None:
        return
    _check_cells(scene, sensor)
    if sensor.protocol.offset:
        return
    _, at = at_rest(body, sensor)
    if not body.span[0] <= at <= body.span[1]:
        raise _edge_first(scene)


def _check_offset(scene: ResolvedDesign, sensor: Sensor) -> None:
    """Raise InputError for an offset with a first touch on a flank over 60 degrees, by a plate's edge, or with none."""
    test, shape = sensor.protocol, sensor.dome.shape
    if not test.offset:
        return
    if test.body is None:
        flat = float(flat_radius(np.array(test.plate_radius), RIM * np.array(test.plate_radius)))
        steepest = largest = flat * math.cos(test.tilt) - shape.leaning(test.tilt)[0]
        problem = "the plate's edge would touch the dome first"
    else:
        # A driven dome is higher than the unloaded one, and keeps the object farther from the connector.
        share = np.linspace(0.0, 1.0, _POINTS)
        centre = shape.points(share, np.ones(1))[:, 0] + test.body.smallest * shape.normals(share)
        clear = float(np.interp(test.depth + test.body.smallest, centre[:, 1], centre[:, 0]))
        steepest = shape.leaning(_STEEPEST)[0] + test.body.smallest * math.sin(_STEEPEST)
        largest = min(steepest, clear)
        name = scene.design.contact.object
        problem = f"the {name} would touch the dome on a flank steeper than 60 degrees, or beyond it"
    if test.offset > steepest:
        raise InputError(
            problem,
            file=scene.where,
            key="contact.offset_mm",
            value=test.offset,
            remedy=f"for this dome and object give at most {max(0.0, math.floor(100 * largest) / 100):g} mm",
        )


def at_rest(body: "RigidObject", sensor: Sensor) -> tuple[float, float]:
    """Height of the object at first contact with the unloaded dome, and its distance from the object's axis, mm."""
    # An object off the axis touches first on its side of the plane of symmetry.
    r, z = sensor.dome.shape.points(np.linspace(1.0, 0.0, _POINTS), np.ones(1))[:, 0].T
    return first_contact(body, np.abs(r - sensor.protocol.offset), z)


def check_first_touch(scene: ResolvedDesign, prediction: SensorPrediction) -> None:
    """Raise InputError for an object that meets an inflated dome with its edge or a steep flank from the start."""
    limit = _AT_ONCE * scene.design.membrane.inner_radius_mm
    for state in prediction.states:
        if any(event.kind == "object edge" and event.indentation <= limit for event in state.events):
            raise _edge_first(scene)


def _edge_first(scene: ResolvedDesign) -> InputError:
    problem = "it meets the dome with its edge, or with a flank steeper than 60 degrees, at first touch"
    return _object_error(scene, problem, "take an object that touches the dome nearer to its axis", 0)


def _object_error(scene: ResolvedDesign, problem: str, remedy: str, which: int = -1) -> InputError:
    """InputError on the size number ``which`` of the object; the last size sets its least radius."""
    key, value = list[tuple[str, Any]](scene.design.contact.sizes().items())[which]
    return InputError(problem, file=scene.where, key=f"contact.{key}", value=value, remedy=remedy)


def check_plate(scene: ResolvedDesign, prediction: SensorPrediction) -> None:
    """Raise InputError for a plate whose edge the contact reaches within the depth."""
    for state in prediction.states:
        ending = [event for event in state.events if event.ends_range]
        if ending and ending[0].kind == "plate edge":
            safe = 2 * scene.design.membrane.inner_radius_mm
            raise InputError(
                f"the contact reaches the plate's edge at {ending[0].indentation:.2f} mm of indentation; it must be "
                f"wider than the contact (twice membrane.inner_radius_mm = {safe:g} mm is safe), or "
                "indentation.depth_mm less",
                file=scene.where,
                key="indentation.plate_diameter_mm",
                value=scene.design.indentation.plate_diameter_mm,
            )


def contact_notes(sensor: Sensor, contact: "ContactModel | None") -> tuple[str, ...]:
    """Notes on the uncertainty under a contact; empty if ``contact`` is None, for a plate without friction."""
    if contact is None:
        return ()
    words, friction = data_of(__file__), contact.friction
    notes = [words["by_solid"].format(contact=sensor.protocol.other_contact)]
    if friction is not None and not np.isfinite(friction.standard).any(axis=0).all():
        notes.append(words["no_equilibrium"])
    return tuple(notes)


def fillings_of(scene: ResolvedDesign) -> list[Filling]:
    """The fillings of a scene that give states in addition to its driving pressures: injected gas, then heights."""
    pneumatics = scene.design.pneumatics
    injected = [Filling("injected", v * ML) for v in pneumatics.injected_volumes_mL or ()]
    return [*injected, *(Filling("apex", h) for h in pneumatics.apex_heights_mm or ())]
