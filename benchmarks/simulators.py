"""The exported model pressed in MuJoCo beside the prediction: ``python -m benchmarks.simulators``.

Writes docs/background/simulators.json and the chart docs/howto/simulators.svg.
"""

from __future__ import annotations

import importlib.util
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib as mpl
import mujoco
import numpy as np
from matplotlib.figure import Figure
from scipy.interpolate import PchipInterpolator

from benchmarks.store import ROOT, store
from pneutouch.evaluation import evaluate
from pneutouch.workflows.export_reader import make_simulator, press_tables, write_simulator

DESIGN = "paper-dome"
GRAVITY = 9.81

PLATE = """<mujoco><include file="{name}.xml"/><worldbody>
<body name="plate" mocap="true" pos="0 0 {height}"><geom type="box" size="0.02 0.02 0.002" pos="0 0 0.002" solref="0.004 1"
 solimp="0.9999 0.9999 0.001"/></body></worldbody></mujoco>"""

BALL = """<mujoco><include file="{name}.xml"/><worldbody>
<body name="ball" pos="0 0 {height}"><joint name="fall" type="slide" axis="0 0 1"/>
<geom type="sphere" size="{radius}" mass="{mass}" solref="0.004 1" solimp="0.9999 0.9999 0.001"/></body></worldbody></mujoco>"""


class MujocoPress(NamedTuple):
    """Plate travel (mm), force on the plate (N), gauge pressure (kPa), status, and speed of the joint (mm/s), (n,)."""

    travel_mm: np.ndarray
    force_N: np.ndarray
    pressure_kPa: np.ndarray
    status: np.ndarray
    speed_mm_per_s: np.ndarray


def module_of(folder: Path) -> Any:
    """The module that was exported with the model."""
    spec = importlib.util.spec_from_file_location(f"dome_force_{abs(hash(folder))}", folder / "dome_force.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def clear() -> None:
    """Take MuJoCo's callbacks away: they are global."""
    mujoco.set_mjcb_passive(None)
    mujoco.set_mjcb_sensor(None)


def scene(folder: Path, text: str, **values: Any) -> Any:
    """A model that includes the exported one."""
    clear()
    (name,) = (path.stem for path in folder.glob("*.xml") if path.stem != "scene")
    (folder / "scene.xml").write_text(text.format(name=name, **values))
    return mujoco.MjModel.from_xml_path(str(folder / "scene.xml"))


def apex_of(module: Any, driving_pressure_kPa: float) -> float:
    """Height of the apex, m."""
    (state,) = (s for s in module.TABLE["states"] if s["driving_pressure_kPa"] == driving_pressure_kPa)
    return float(state["apex_m"])


def press(folder: Path, driving_pressure_kPa: float, travels_mm: np.ndarray, step: float = 0.002) -> MujocoPress:
    """Move a plate to each travel at 20 mm/s, hold it 0.3 s there and read."""
    module = module_of(folder)
    apex = apex_of(module, driving_pressure_kPa)
    model = scene(folder, PLATE, height=apex)
    model.opt.timestep = step
    module.install(model, driving_pressure_kPa)
    data, name = mujoco.MjData(model), module.TABLE["name"]
    joint, rows, at = data.joint(f"{name}_indentation"), [], 0.0
    for travel in 1e-3 * travels_mm:
        moving = np.linspace(at, travel, max(2, int(abs(travel - at) / 0.02 / step)))
        for place in [*moving, *[travel] * int(0.3 / step)]:
            data.mocap_pos[0, 2] = apex - place
            mujoco.mj_step(model, data)
        at = travel
        force = sum(_normal_force(model, data, k) for k in range(data.ncon))
        sensed = [float(data.sensor(f"{name}_{what}").data[0]) for what in ("pressure_kPa", "status")]
        rows.append((1e3 * travel, force, *sensed, 1e3 * float(joint.qvel[0])))
    clear()
    return MujocoPress(*np.array(rows).T)


def _normal_force(model: Any, data: Any, contact: int) -> float:
    force = np.zeros(6)
    mujoco.mj_contactForce(model, data, contact, force)
    return float(force[0])


class BallDrop(NamedTuple):
    """Of every step: energy (J), height of the ball over its first contact (m) and indentation (m); ``stiffness`` at
    rest, N/m, and the weight, N."""

    energy: np.ndarray
    height: np.ndarray
    indentation: np.ndarray
    weight: float


def drop(folder: Path, driving_pressure_kPa: float, mass: float, fall: float, seconds: float = 1.0) -> BallDrop:
    """Drop a ball of a mass (kg) from a height (m) over the apex; it moves along the axis alone."""
    module, radius = module_of(folder), 0.006
    apex = apex_of(module, driving_pressure_kPa)
    model = scene(folder, BALL, height=apex + radius + fall, radius=radius, mass=mass)
    dome = module.install(model, driving_pressure_kPa)
    data, rows = mujoco.MjData(model), []
    inertia = float(model.dof_armature[dome.degree] + dome.mass)
    stored, depth, nodes = 0.0, 0.0, np.linspace(0.0, dome.state["indentation_m"][-1], 2001)
    forces = np.array([dome.read(q)[0] for q in nodes])
    work = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(nodes) * (forces[1:] + forces[:-1]))])
    for _ in range(int(seconds / model.opt.timestep)):
        mujoco.mj_step(model, data)
        depth = float(data.joint(dome.joint).qpos[0])
        stored = (
            float(np.interp(depth, nodes, work)) if depth > 0 else 0.5 * dome.state["force_slope_N_per_m"][0] * depth**2
        )
        height = fall + float(data.joint("fall").qpos[0])
        speeds = (float(data.joint("fall").qvel[0]), float(data.joint(dome.joint).qvel[0]))
        moving = 0.5 * mass * speeds[0] ** 2 + 0.5 * inertia * speeds[1] ** 2
        rows.append((moving + stored + mass * GRAVITY * height, height, depth))
    clear()
    return BallDrop(*np.array(rows).T, mass * GRAVITY)


def main() -> None:
    """Press, draw and write."""
    evaluation = evaluate(DESIGN, model="atlas")
    tables = press_tables(evaluation, steps=320)
    with tempfile.TemporaryDirectory() as made:
        folder = write_simulator(make_simulator(evaluation, "mujoco"), Path(made))
        figure, rows = _compared(folder, tables)
    mpl.rcParams["svg.hashsalt"] = "pneutouch"
    figure.savefig(ROOT / "docs" / "howto" / "simulators.svg", metadata={"Date": None})
    found = {"mujoco": mujoco.__version__, "design": DESIGN, "rows": rows}
    store("simulators", found)


def _compared(folder: Path, tables) -> tuple[Figure, list[dict[str, Any]]]:
    """The chart, and the greatest differences in percent by driving pressure."""
    figure = Figure(figsize=(9, 5.5), layout="constrained")
    axes = figure.subplots(2, 2, sharex=True, height_ratios=(2, 1))
    rows = []
    for k, table in enumerate(tables):
        depth = 1e3 * table.indentation
        travels = np.linspace(0.02, 1.0, 21) * depth[-1]
        pressed = press(folder, table.driving_pressure_kPa, travels)
        columns = (
            (table.force, pressed.force_N),
            (table.pressure_kPa - table.driving_pressure_kPa, pressed.pressure_kPa - table.driving_pressure_kPa),
        )
        grey, mark, worst = f"{0.2 * k:.1f}", "osD^"[k % 4], []
        for (top, bottom), (curve, points) in zip(axes.T, columns, strict=True):
            top.plot(depth, curve, color=grey, lw=1)
            label = f"{table.driving_pressure_kPa:g} kPa"
            top.plot(travels, points, mark, color=grey, mfc="none", ms=4, label=label)
            off = 100 * (points / PchipInterpolator(depth, curve)(travels) - 1)
            bottom.plot(travels, off, mark, ls="-", color=grey, mfc="none", ms=3, lw=0.7)
            worst.append(float(np.abs(off).max()))
        rows.append({"driving_pressure_kPa": table.driving_pressure_kPa, "force": worst[0], "rise": worst[1]})
    for (top, bottom), name in zip(axes.T, ("force on the plate, N", "pressure rise, kPa"), strict=True):
        top.set_ylabel(name)
        bottom.set(xlabel="plate travel, mm", ylabel="MuJoCo off by, %", ylim=(-1.1, 1.1))
        bottom.axhline(0, color="0.7", lw=0.5)
    axes[0, 0].legend(title="MuJoCo; lines: prediction", frameon=False)
    return figure, rows


if __name__ == "__main__":
    main()
