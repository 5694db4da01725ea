"""A sensor as MuJoCo's MJCF, with the module that gives its joint the force of the dome.

A sensor as a link of URDF: meshes for sight and for contact, mass, inertia, and the frames of mount and contact.

Elements of XML with numbers in a fixed form.
"""

from __future__ import annotations

import pprint
from collections.abc import Iterable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Body
from pneutouch.export.scene import stl
from pneutouch.export.simulator.model import (
    DAMPING_SHARE,
    INERTIA_SHARE,
    TIME_STEP,
    PressTable,
    RigidInertia,
    SimulatedSensor,
)
from pneutouch.results.reader import DomePress, DomeTable
from pneutouch.results.record import plain
from pneutouch.rounding import rounded

_XML_DIGITS = 9

_NOTHING = 1e-15
"""Coordinates and moments below this (m, kg m2) are rounding."""


def add(parent: ElementTree.Element, tag: str, **attributes: str | float) -> ElementTree.Element:
    """Add an element with attributes, numbers as text."""
    texts = {key: value if isinstance(value, str) else number_text(value) for key, value in attributes.items()}
    return ElementTree.SubElement(parent, tag, texts)


def number_text(value: float) -> str:
    """A number with nine digits."""
    return f"{float(value):.{_XML_DIGITS}g}"


def vector(values: Iterable[Any]) -> str:
    """Numbers with spaces between."""
    return " ".join(number_text(value if abs(value) > _NOTHING else 0.0) for value in values)


def xml_document(root: ElementTree.Element) -> bytes:
    """A document, indented."""
    ElementTree.indent(root)
    return bytes(ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)) + b"\n"


_DIGITS = 9

_CONTACT = {"solref": f"{2 * TIME_STEP:g} 1", "solimp": "0.9999 0.9999 0.001"}
"""Contact as stiff as the time step allows, and nearly rigid: the joint yields instead."""


def mjcf_files(sensor: SimulatedSensor) -> dict[str, bytes]:
    """The model, its module and its meshes, by their paths in the folder."""
    meshes = {f"meshes/{body.name}.stl": stl(body) for body in sensor.bodies}
    return {f"{sensor.name}.xml": mjcf(sensor), "dome_force.py": module(sensor), **meshes}


def module(sensor: SimulatedSensor) -> bytes:
    """The callbacks with the table of the sensor, as a module that needs MuJoCo alone."""
    source = (Path(__file__).parent / "dome_force.py").read_text(encoding="utf-8")
    table = pprint.pformat(plain(dome_table(sensor)), width=118, compact=True, sort_dicts=False)
    usage = (
        '\n\ndef install(model: Any, driving_pressure_kPa: float | None = None, prefix: str = "") -> DomeForce:\n'
        '    """Give a model that holds this sensor the force and the pressure of its dome; see `install_dome`."""\n'
        "    return install_dome(model, TABLE, driving_pressure_kPa, prefix)\n"
    )
    return f"{source}\n\nTABLE: dict[str, Any] = {table}\n{usage}".encode()


def dome_table(sensor: SimulatedSensor) -> DomeTable:
    """The table as the module reads it."""
    table = DomeTable(sensor.name, sensor.radius, INERTIA_SHARE, DAMPING_SHARE, tuple(map(_state, sensor.tables)))
    return rounded(table, _DIGITS)


def _state(table: PressTable) -> DomePress:
    return DomePress(
        driving_pressure_kPa=table.driving_pressure_kPa,
        apex_m=table.apex,
        indentation_m=tuple(table.indentation.tolist()),
        force_N=tuple(table.force.tolist()),
        force_slope_N_per_m=tuple(table.force_slope.tolist()),
        pressure_kPa=tuple(table.pressure_kPa.tolist()),
        pressure_slope_kPa_per_m=tuple(table.pressure_slope_kPa_per_m.tolist()),
    )


def mjcf(sensor: SimulatedSensor) -> bytes:
    """The model: a base with everything that does not move, and the dome as a sphere on a sliding joint.

    The inertia of both together is that of the bodies, without driving pressure and force.
    """
    name, first = sensor.name, sensor.tables[0]
    root = ElementTree.Element("mujoco", model=name)
    add(root, "compiler", angle="radian", meshdir="meshes")
    add(root, "option", timestep=TIME_STEP)
    assets = add(root, "asset")
    for body in sensor.bodies:
        add(assets, "mesh", name=f"{name}_{body.name}", file=f"{body.name}.stl", scale="0.001 0.001 0.001")
    world = add(root, "worldbody")
    base = add(world, "body", name=name)
    _inertial(base, sensor.inertia.without(sensor.moving))
    for body in sensor.bodies:
        # The convex hull of the membrane would hold the dome, which moves.
        contact = {"contype": 0, "conaffinity": 0, "group": 2} if body.role == "membrane" else {"group": 1}
        add(base, "geom", name=f"{name}_{body.name}", type="mesh", mesh=f"{name}_{body.name}", **contact)
    _dome(base, sensor, first)
    # MuJoCo leaves out contacts with the parent, but not where that is fixed to the world.
    add(add(root, "contact"), "exclude", body1=name, body2=f"{name}_dome")
    outputs = add(root, "sensor")
    add(outputs, "jointpos", name=f"{name}_indentation_m", joint=f"{name}_indentation")
    for what in ("force_N", "pressure_kPa", "status"):
        add(outputs, "user", name=f"{name}_{what}", dim=1, needstage="pos")
    numbers = add(root, "custom")
    add(numbers, "numeric", name=f"{name}_driving_pressure_kPa", data=first.driving_pressure_kPa)
    return xml_document(root)


def _dome(base: ElementTree.Element, sensor: SimulatedSensor, table: PressTable) -> None:
    name, centre = sensor.name, table.apex - sensor.radius
    dome = add(base, "body", name=f"{name}_dome", pos=vector((0.0, 0.0, centre)))
    moving = sensor.moving
    at = (0.0, 0.0, float(moving.centre[2]) - centre)
    add(dome, "inertial", pos=vector(at), mass=moving.mass, diaginertia=vector(moving.about_centre.diagonal()))
    joint = f"{name}_indentation"
    add(dome, "joint", name=joint, type="slide", axis="0 0 -1", armature=sensor.armature)
    add(dome, "geom", name=f"{name}_dome", type="sphere", size=sensor.radius, rgba="0.3 0.5 0.7 0.5", **_CONTACT)
    add(dome, "site", name=f"{name}_contact", pos=vector((0.0, 0.0, sensor.radius)), size="0.0005")


def _inertial(body: ElementTree.Element, inertia: RigidInertia) -> None:
    tensor = inertia.about_centre
    full = [tensor[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
    add(body, "inertial", pos=vector(inertia.centre), mass=inertia.mass, fullinertia=vector(full))


def urdf_files(sensor: SimulatedSensor) -> dict[str, bytes]:
    """The link and its meshes, by their paths in the folder. Meshes in mm, scaled where they are named."""
    files = {f"{sensor.name}.urdf": urdf(sensor)}
    for body in sensor.bodies:
        files[f"meshes/{body.name}.stl"] = stl(body)
        files[f"meshes/{body.name}-contact.stl"] = stl(hull(body))
    return files


def hull(body: Body) -> Body:
    """The convex hull of a body: the contact shape that most simulators make of a mesh, written instead of left to
    them."""
    mesh = body.manifold().hull().to_mesh64()
    vertices: Array = np.array(mesh.vert_properties, float)[:, :3]
    return Body(f"{body.name}-contact", body.role, body.material, vertices, np.array(mesh.tri_verts, np.intp))


def urdf(sensor: SimulatedSensor) -> bytes:
    """One link in the frame of the base plane, z outwards, and two frames fixed to it: its mount and its apex."""
    root = ElementTree.Element("robot", name=sensor.name)
    link = add(root, "link", name=sensor.name)
    inertial = add(link, "inertial")
    add(inertial, "origin", xyz=vector(sensor.inertia.centre), rpy="0 0 0")
    add(inertial, "mass", value=sensor.inertia.mass)
    tensor = sensor.inertia.about_centre
    moments = {f"i{'xyz'[i]}{'xyz'[j]}": vector([tensor[i, j]]) for i in range(3) for j in range(i, 3)}
    add(inertial, "inertia", **moments)
    for tag, suffix in (("visual", ""), ("collision", "-contact")):
        for body in sensor.bodies:
            element = add(link, tag, name=f"{body.name}{suffix}")
            add(element, "origin", xyz="0 0 0", rpy="0 0 0")
            file = f"meshes/{body.name}{suffix}.stl"
            add(add(element, "geometry"), "mesh", filename=file, scale="0.001 0.001 0.001")
    frames = {"mount": sensor.rear, "contact": sensor.tables[0].apex}
    for what, height in frames.items():
        frame = f"{sensor.name}_{what}"
        add(root, "link", name=frame)
        joint = add(root, "joint", name=f"{frame}_fixed", type="fixed")
        add(joint, "parent", link=sensor.name)
        add(joint, "child", link=frame)
        add(joint, "origin", xyz=vector((0.0, 0.0, height)), rpy="0 0 0")
    return xml_document(root)
