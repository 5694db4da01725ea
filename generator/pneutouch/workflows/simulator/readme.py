"""Content of a folder of a simulator's model, in ten lines."""

from pneutouch.export.simulator.model import SimulatedSensor

_MUJOCO = """\
# {name} in MuJoCo

    import mujoco, dome_force
    model = mujoco.MjModel.from_xml_path("{name}.xml")
    dome_force.install(model, driving_pressure_kPa={pressure})  # table: {pressures} kPa
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data)
    data.sensor("{name}_pressure_kPa").data, data.sensor("{name}_force_N").data, data.sensor("{name}_status").data

The dome is a sphere on the sliding joint {name}_indentation (m, inwards). Valid to {depth} mm; status is 1 beyond.
Without `install` the joint has no force. No shear, no rate, no contact off the axis: docs/howto/simulators.md.
"""

_URDF = """\
# {name} as a link of URDF

- Link {name}: origin in the base plane of the dome on its axis, z outwards; lengths in m.
- Mass {mass:.4g} g with the inertia of all bodies, by their exact volumes and nominal densities.
- visual: the print meshes. collision: the convex hull of each body, rigid.
- Frame {name}_mount: the rearmost face of the sensor, z = {rear:.4g} mm.
- Frame {name}_contact: the apex at {pressure} kPa, z = {apex:.4g} mm.
- Mesh paths are relative to this file; where a tool needs a package, put package://NAME/ in front of them.
- URDF has no force over indentation: for that take the export for MuJoCo, or reader.json of `export-reader`.
"""


def readme(sensor: SimulatedSensor, kind: str) -> bytes:
    """The README of a model."""
    table = sensor.tables[0]
    text = {"mujoco": _MUJOCO, "urdf": _URDF}[kind].format(
        name=sensor.name,
        pressure=f"{table.driving_pressure_kPa:g}",
        pressures=", ".join(f"{one.driving_pressure_kPa:g}" for one in sensor.tables),
        depth=f"{1e3 * min(one.indentation[-1] for one in sensor.tables):.2f}",
        mass=1e3 * sensor.inertia.mass,
        rear=1e3 * sensor.rear,
        apex=1e3 * table.apex,
    )
    return text.encode()
