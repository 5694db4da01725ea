"""Force and pressure of a sensor's dome in MuJoCo: the callbacks of the exported model.

It is shipped with a table in front; MuJoCo is all that it needs.
"""

import functools
import threading
import weakref
from bisect import bisect_right
from collections.abc import Callable, Sequence
from typing import Any

import mujoco

IN_RANGE, BEYOND_RANGE = 0.0, 1.0
"""Values of the sensor NAME_status; beyond the range force and pressure are extrapolated and not to be trusted."""

_SHARED = "_pneutouch_domes_1"
"""Name of mujoco's attribute for the registry that all copies of this module share; the number is its version."""

_LOADERS = (
    (mujoco.MjModel, staticmethod, ("from_xml_path", "from_xml_string")),
    (mujoco.MjSpec, lambda method: method, ("compile", "recompile", "to_xml")),
)
"""Classes, the function that binds a method to each, and the names of their methods that compile a model."""


class DomeForce:
    """The dome of one sensor in a model at one driving pressure (kPa).

    Args:
        model: The MjModel.
        table: Exported data of the sensor.
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
        """Add the force of the dome to its joint, and carry the moving wall's weight, which the force holds already."""
        force, _, _ = self.read(float(data.qpos[self.place]))
        axis, gravity = data.xaxis[self.joint], model.opt.gravity
        weight = self.mass * sum(float(a) * float(g) for a, g in zip(axis, gravity, strict=True))
        # The solver of contacts does not see the damping of a joint, which acts within the step: a contact chatters.
        data.qfrc_passive[self.degree] -= force + weight + self.damping * float(data.qvel[self.degree])

    def sense(self, data: Any) -> None:
        """Write force, pressure and status."""
        for place, value in zip(self.outputs, self.read(float(data.qpos[self.place])), strict=True):
            data.sensordata[place] = value


class ChainedCallback:
    """A global callback of MuJoCo that calls the one that was set before it, and then serves the domes."""

    def __init__(self, get: Callable[[], Any], put: Callable[[Any], None], serve: Callable[..., None]) -> None:
        self._get, self._put, self._serve = get, put, serve
        self._before: list[Any] = [None]
        self._thread = threading.local()

    def __call__(self, *arguments: Any) -> None:
        """Call the callback set before, then serve the domes; takes model, data and, of sensors, the stage."""
        # One that was set later may call this one in turn. Each time it goes on to an older one, so that it ends.
        depth = getattr(self._thread, "depth", 0)
        before = self._before[max(0, len(self._before) - 1 - depth)]
        self._thread.depth = depth + 1
        try:
            if before is not None:
                before(*arguments)
        finally:
            self._thread.depth = depth
        if depth == 0:
            self._serve(*arguments)

    def set(self) -> None:
        """Set this callback in MuJoCo; the one that is set is called before it."""
        current = self._get()
        if current is self:
            return
        if current in self._before:
            del self._before[self._before.index(current) + 1 :]
        else:
            self._before.append(current)
        self._put(self)

    def pause(self) -> Callable[[], None]:
        """Take away the Python callback that is set, this or another; returns a function that sets it again."""
        current = self._get()
        if current is None or hasattr(current, "restype"):  # A C function of ctypes.
            return lambda: None
        self._put(None)
        return lambda: self._put(current)


class DomeRegistry:
    """The domes of all models by the model's address, and the callbacks that serve them; one in a process."""

    def __init__(self) -> None:
        self._domes: dict[int, tuple[weakref.ref[Any], list[Any]]] = {}
        self._callbacks = (
            ChainedCallback(mujoco.get_mjcb_passive, mujoco.set_mjcb_passive, self._press),
            ChainedCallback(mujoco.get_mjcb_sensor, mujoco.set_mjcb_sensor, self._sense),
        )
        self._loading = threading.RLock()
        for owner, bind, names in _LOADERS:
            for name in names:
                setattr(owner, name, bind(self._without_callbacks(getattr(owner, name))))

    def _without_callbacks(self, load: Callable[..., Any]) -> Callable[..., Any]:
        """``load`` with callbacks paused: MuJoCo steps a model as it compiles it, and has no Python object for it."""

        @functools.wraps(load)
        def paused(*arguments: Any, **named: Any) -> Any:
            with self._loading:
                again = [callback.pause() for callback in self._callbacks]
                try:
                    return load(*arguments, **named)
                finally:
                    for one in again:
                        one()

        return paused

    def add(self, model: Any, dome: Any) -> None:
        """Serve a dome of a model, in place of the one at the same joint."""
        address = model._address
        others = [one for one in self.of(model) if one.joint != dome.joint]
        self._domes[address] = (weakref.ref(model, functools.partial(self._forget, address)), [*others, dome])
        for callback in self._callbacks:
            callback.set()

    def of(self, model: Any) -> Sequence[Any]:
        """The domes of a model; none for one that has the address of a model that is gone."""
        known, domes = self._domes.get(model._address, (None, ()))
        return domes if known is not None and known() is model else ()

    def _forget(self, address: int, gone: weakref.ref[Any]) -> None:
        if address in self._domes and self._domes[address][0] is gone:
            del self._domes[address]

    def _press(self, model: Any, data: Any) -> None:
        for dome in self.of(model):
            dome.press(model, data)

    def _sense(self, model: Any, data: Any, stage: int) -> None:
        if stage == int(mujoco.mjtStage.mjSTAGE_POS):
            for dome in self.of(model):
                dome.sense(data)


def install_dome(
    model: Any, table: dict[str, Any], driving_pressure_kPa: float | None = None, prefix: str = ""
) -> DomeForce:
    """Give a model the force and the pressure of the dome; again for another driving pressure or sensor.

    MuJoCo's callbacks are global: those set before go on, and models without the sensor are left alone. While a model
    is loaded or compiled they are paused: no other thread may step a sensor then. Call it again after the time step
    was changed. Raises ValueError as `DomeForce`.
    """
    dome = DomeForce(model, table, driving_pressure_kPa, prefix)
    registry = getattr(mujoco, _SHARED, None)
    if registry is None:
        registry = DomeRegistry()
        setattr(mujoco, _SHARED, registry)
    registry.add(model, dome)
    return dome
