"""Force and pressure of a sensor's dome in MuJoCo: the callbacks of the exported model.

It is shipped with a table in front; MuJoCo is all that it needs.
"""

from __future__ import annotations

from bisect import bisect_right
from typing import Any

import mujoco

IN_RANGE, BEYOND_RANGE = 0.0, 1.0
"""Values of the sensor NAME_status: beyond the range force and pressure go on straight, and are not to be trusted."""

_domes: dict[int, list[Any]] = {}
_before: list[Any] = [None, None]


class DomeForce:
    """The dome of one sensor in a model at one driving pressure (kPa).

    Args:
        model: The MjModel.
        table: What was exported of the sensor.
        driving_pressure_kPa: One of the table's; None: that of the number NAME_driving_pressure_kPa in the model.
        prefix: In front of all names where the sensor was attached with one.

    Raises:
        ValueError: For a model without the sensor, and a driving pressure that the table has not.
    """

    def __init__(self, model: Any, table: dict[str, Any], driving_pressure_kPa: float | None, prefix: str) -> None:
        name = prefix + table["name"]
        if driving_pressure_kPa is None:
            number = self._named(model, mujoco.mjtObj.mjOBJ_NUMERIC, f"{name}_driving_pressure_kPa")
            driving_pressure_kPa = float(model.numeric_data[model.numeric_adr[number]])
        states = [one for one in table["states"] if abs(one["driving_pressure_kPa"] - driving_pressure_kPa) < 1e-6]
        if not states:
            known = ", ".join(f"{one['driving_pressure_kPa']:g}" for one in table["states"])
            raise ValueError(f"driving_pressure_kPa = {driving_pressure_kPa:g}: the table has {known} kPa")
        self.state = states[0]
        joint = self._named(model, mujoco.mjtObj.mjOBJ_JOINT, f"{name}_indentation")
        self.joint, self.place, self.degree = joint, int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint])
        self.outputs = [
            int(model.sensor_adr[self._named(model, mujoco.mjtObj.mjOBJ_SENSOR, f"{name}_{what}")])
            for what in ("force_N", "pressure_kPa", "status")
        ]
        self._adapt(model, table)

    @staticmethod
    def _named(model: Any, kind: Any, name: str) -> int:
        index = mujoco.mj_name2id(model, kind, name)
        if index < 0:
            raise ValueError(f"the model has no {name}: is a prefix missing?")
        return int(index)

    def _adapt(self, model: Any, table: dict[str, Any]) -> None:
        """Set the height of the apex, and what keeps the joint stable at the model's time step.

        The force acts over the step without being solved for: it is stable where the inertia is at least
        a quarter of stiffness times time step squared. MuJoCo makes a contact stiff by the inertia of a body
        without that of its joint, which is therefore corrected.
        """
        body, step = int(model.jnt_bodyid[self.joint]), model.opt.timestep
        stiffest = max(max(one["force_slope_N_per_m"]) for one in table["states"])
        self.mass = float(model.body_mass[body])
        inertia = max(self.mass, table["inertia_share"] * stiffest * step**2)
        model.dof_armature[self.degree] = inertia - self.mass
        self.damping = table["damping_share"] * stiffest * step
        model.body_pos[body, 2] = self.state["apex_m"] - table["radius_m"]
        model.body_invweight0[body, 0] = 1.0 / inertia
        model.dof_invweight0[self.degree] = 1.0 / inertia

    def read(self, indentation_m: float) -> tuple[float, float, float]:
        """Force in N, gauge pressure in kPa and status at an indentation in m."""
        state = self.state
        nodes = state["indentation_m"]
        if indentation_m <= 0.0:
            # Away from contact the joint is held by the first stiffness; the pressure is the driving pressure.
            return state["force_slope_N_per_m"][0] * indentation_m, state["pressure_kPa"][0], IN_RANGE
        if indentation_m > nodes[-1]:
            beyond = indentation_m - nodes[-1]
            force = state["force_N"][-1] + state["force_slope_N_per_m"][-1] * beyond
            return force, state["pressure_kPa"][-1] + state["pressure_slope_kPa_per_m"][-1] * beyond, BEYOND_RANGE
        k = min(bisect_right(nodes, indentation_m), len(nodes) - 1)
        width = nodes[k] - nodes[k - 1]
        t = (indentation_m - nodes[k - 1]) / width
        force, pressure_kPa = (
            (1 + 2 * t) * (1 - t) ** 2 * y[k - 1]
            + t**2 * (3 - 2 * t) * y[k]
            + width * t * (1 - t) * ((1 - t) * slope[k - 1] - t * slope[k])
            for y, slope in (
                (state["force_N"], state["force_slope_N_per_m"]),
                (state["pressure_kPa"], state["pressure_slope_kPa_per_m"]),
            )
        )
        return force, pressure_kPa, IN_RANGE

    def press(self, model: Any, data: Any) -> None:
        """Add the force of the dome to its joint, and carry the weight of the moving wall, which the force holds
        already."""
        force, _, _ = self.read(float(data.qpos[self.place]))
        axis, gravity = data.xaxis[self.joint], model.opt.gravity
        weight = self.mass * sum(float(a) * float(g) for a, g in zip(axis, gravity, strict=True))
        # The solver of contacts does not see the damping of a joint, which acts within the step: a contact chatters.
        data.qfrc_passive[self.degree] -= force + weight + self.damping * float(data.qvel[self.degree])

    def sense(self, data: Any) -> None:
        """Write force, pressure and status."""
        for place, value in zip(self.outputs, self.read(float(data.qpos[self.place])), strict=True):
            data.sensordata[place] = value


def _passive(model: Any, data: Any) -> None:
    if _before[0] is not None:
        _before[0](model, data)
    for dome in _domes.get(model._address, ()):
        dome.press(model, data)


def _sensor(model: Any, data: Any, stage: int) -> None:
    if _before[1] is not None:
        _before[1](model, data, stage)
    if stage == int(mujoco.mjtStage.mjSTAGE_POS):
        for dome in _domes.get(model._address, ()):
            dome.sense(data)


def install_dome(
    model: Any, table: dict[str, Any], driving_pressure_kPa: float | None = None, prefix: str = ""
) -> DomeForce:
    """Give a model the force and the pressure of the dome; again for another driving pressure or sensor.

    MuJoCo's callbacks are global: those set before go on, and models without the sensor are left alone. Call it again
    after the time step was changed. Raises ValueError as `DomeForce`.
    """
    dome = DomeForce(model, table, driving_pressure_kPa, prefix)
    others = [one for one in _domes.get(model._address, []) if one.joint != dome.joint]
    _domes[model._address] = [*others, dome]
    if mujoco.get_mjcb_passive() is not _passive:
        _before[0] = mujoco.get_mjcb_passive()
        mujoco.set_mjcb_passive(_passive)
    if mujoco.get_mjcb_sensor() is not _sensor:
        _before[1] = mujoco.get_mjcb_sensor()
        mujoco.set_mjcb_sensor(_sensor)
    return dome
