"""A sensor as a link of URDF: meshes for sight and for contact, mass, inertia, and the frames of mount and contact."""

from __future__ import annotations

from xml.etree import ElementTree

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Body
from pneutouch.export.scene import stl
from pneutouch.export.simulator.model import SimulatedSensor
from pneutouch.export.simulator.xml_text import add, vector, xml_document


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
