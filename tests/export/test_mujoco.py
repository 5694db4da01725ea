"""MuJoCo presses and drops onto the exported model: it has the force and the pressure that were predicted."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from pneutouch.workflows.export_reader import make_simulator, press_tables, write_simulator

mujoco = pytest.importorskip("mujoco", reason="mujoco is not installed; the development lock has it")

from benchmarks.simulators import clear, drop, module_of, press  # noqa: E402


@pytest.fixture(scope="module")
def evaluation(evaluated):
    return evaluated("paper-dome", model="atlas")


@pytest.fixture(scope="module")
def folder(evaluation, tmp_path_factory):
    return write_simulator(make_simulator(evaluation, "mujoco"), tmp_path_factory.mktemp("mujoco"))


@pytest.fixture(autouse=True)
def _without_callbacks():
    yield
    clear()


def test_force_and_pressure_are_the_prediction_over_the_whole_range(folder, evaluation):
    """Against the prediction in four times as many steps, at a step of 2 ms, by the travel and the force of the plate."""
    for table in press_tables(evaluation, steps=320)[::3]:
        depth = 1e3 * table.indentation
        travels = np.linspace(0.02, 1.0, 9) * depth[-1]
        pressed = press(folder, table.driving_pressure_kPa, travels)
        force = PchipInterpolator(depth, table.force)(travels)
        rise_kPa = PchipInterpolator(depth, table.pressure_kPa - table.driving_pressure_kPa)(travels)
        # The beginning of a curve follows its first resolved states, which are others with more steps.
        assert pressed.force_N == pytest.approx(force, rel=0.01, abs=2e-3)
        assert pressed.pressure_kPa - table.driving_pressure_kPa == pytest.approx(rise_kPa, rel=0.01, abs=2e-3)
        assert np.all(pressed.status == 0.0) and np.all(np.abs(pressed.speed_mm_per_s) < 1e-3)


def test_beyond_the_range_the_status_states_it(folder):
    end = 1e3 * module_of(folder).TABLE["states"][0]["indentation_m"][-1]
    assert press(folder, 0.0, np.array([0.5 * end, end + 0.2])).status.tolist() == [0.0, 1.0]


@pytest.mark.parametrize(("mass", "fall"), [(0.002, 0.02), (0.02, 0.3), (0.1, 0.05), (0.3, 0.01)])
def test_a_dropped_ball_comes_to_rest_and_the_energy_does_not_grow(folder, mass, fall):
    dropped = drop(folder, 22.0, mass, fall)
    assert dropped.energy.max() <= dropped.energy[0] * (1 + 1e-9)
    assert dropped.height.max() <= fall
    last = slice(-50, None)
    assert np.ptp(dropped.height[last]) < 1e-5
    # At rest the ball stands where the force of the dome is its weight.
    state = module_of(folder).TABLE["states"][-1]
    depth = float(np.interp(dropped.weight, state["force_N"], state["indentation_m"]))
    assert dropped.indentation[-1] == pytest.approx(depth, rel=0.02, abs=2e-5)


def test_without_contact_nothing_moves_in_any_attitude(folder):
    module = module_of(folder)
    for gravity in ([0, 0, -9.81], [0, 0, 9.81], [9.81, 0, 0]):
        clear()
        model = mujoco.MjModel.from_xml_path(str(folder / "paper-dome.xml"))
        model.opt.gravity[:] = gravity
        module.install(model, 12.0)
        data = mujoco.MjData(model)
        for _ in range(200):
            mujoco.mj_step(model, data)
        assert abs(float(data.qpos[0])) < 1e-9
        assert float(data.sensor("paper-dome_pressure_kPa").data[0]) == pytest.approx(12.0)
        assert float(data.sensor("paper-dome_force_N").data[0]) == pytest.approx(0.0, abs=1e-6)


def test_the_parameter_in_the_model_chooses_the_driving_pressure(folder):
    module = module_of(folder)
    text = (
        (folder / "paper-dome.xml")
        .read_text()
        .replace('_driving_pressure_kPa" data="0"', '_driving_pressure_kPa" data="22"')
    )
    (folder / "other.xml").write_text(text)
    model = mujoco.MjModel.from_xml_path(str(folder / "other.xml"))
    (folder / "other.xml").unlink()
    assert module.install(model).state["driving_pressure_kPa"] == 22.0
    assert model.body("paper-dome_dome").pos[2] == pytest.approx(
        module.TABLE["states"][-1]["apex_m"] - 0.01075, abs=1e-8
    )


def test_what_the_table_or_the_model_has_not_is_refused(folder):
    module = module_of(folder)
    model = mujoco.MjModel.from_xml_path(str(folder / "paper-dome.xml"))
    with pytest.raises(ValueError, match="the table has 0, 5, 12, 22 kPa"):
        module.install(model, 7.0)
    with pytest.raises(ValueError, match="has no left_paper-dome_indentation: is a prefix missing"):
        module.install(model, 5.0, prefix="left_")


def test_two_sensors_of_one_model_and_a_callback_of_the_user_work_together(folder):
    module, calls = module_of(folder), []
    clear()
    mujoco.set_mjcb_passive(lambda model, data: calls.append(1))
    child = mujoco.MjSpec.from_file(str(folder / "paper-dome.xml"))
    other = mujoco.MjSpec.from_file(str(folder / "paper-dome.xml"))
    parent = mujoco.MjSpec()
    for spec, prefix, x in ((child, "left_", -0.05), (other, "right_", 0.05)):
        parent.attach(spec, prefix=prefix, frame=parent.worldbody.add_frame(pos=[x, 0, 0]))
    mujoco.set_mjcb_passive(None)
    model = parent.compile()
    mujoco.set_mjcb_passive(lambda model, data: calls.append(1))
    module.install(model, 0.0, prefix="left_")
    module.install(model, 22.0, prefix="right_")
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data)
    pressures = [float(data.sensor(f"{side}_paper-dome_pressure_kPa").data[0]) for side in ("left", "right")]
    assert pressures == pytest.approx([0.0, 22.0]) and calls
