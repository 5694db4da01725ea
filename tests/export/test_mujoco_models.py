"""Several models and several exported sensors in one process of MuJoCo: each has its own dome, and no other model has one."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.workflows.export_reader import make_simulator, write_simulator

mujoco = pytest.importorskip("mujoco", reason="mujoco is not installed; the development lock has it")

from benchmarks.simulators import clear, module_of  # noqa: E402

PENDULUM = """<mujoco><worldbody><body><joint type="hinge" axis="0 1 0"/><geom size="0.1" pos="0.3 0 0"/></body></worldbody>
<sensor><user dim="1"/></sensor></mujoco>"""


@pytest.fixture(scope="module")
def folder(evaluated, tmp_path_factory):
    evaluation = evaluated("paper-dome", model="atlas")
    return write_simulator(make_simulator(evaluation, "mujoco"), tmp_path_factory.mktemp("mujoco"))


@pytest.fixture(scope="module")
def other_folder(evaluated, tmp_path_factory):
    evaluation = evaluated("fingertip-dome", model="atlas")
    return write_simulator(make_simulator(evaluation, "mujoco"), tmp_path_factory.mktemp("other"))


@pytest.fixture(autouse=True)
def _without_callbacks():
    clear()
    yield
    clear()


def load(folder):
    (path,) = folder.glob("*.xml")
    return mujoco.MjModel.from_xml_path(str(path))


def settings(module):
    return module.TABLE["name"], module.TABLE["states"][-1]["driving_pressure_kPa"]


def sensed(model, name, indentation_m=1e-3):
    """Force (N) and pressure (kPa) that the model states, and the force of its joint (N), at rest in an indentation."""
    model.opt.gravity[:] = 0.0
    data = mujoco.MjData(model)
    data.joint(f"{name}_indentation").qpos[0] = indentation_m
    mujoco.mj_forward(model, data)
    force, pressure = (float(data.sensor(f"{name}_{what}").data[0]) for what in ("force_N", "pressure_kPa"))
    return force, pressure, float(-data.joint(f"{name}_indentation").qfrc_passive[0])


def assert_has_dome(model, module, dome):
    name, _ = settings(module)
    force, pressure, passive = sensed(model, name)
    assert force > 0.0
    assert (force, pressure) == pytest.approx(dome.read(1e-3)[:2], rel=1e-12)
    assert passive == pytest.approx(force, rel=1e-12)


def swing(model):
    data = mujoco.MjData(model)
    for _ in range(100):
        mujoco.mj_step(model, data)
    return np.concatenate([data.qpos, data.qvel, data.sensordata])


def test_another_model_loads_and_moves_as_without_the_sensor(folder, tmp_path):
    """By all functions that compile a model; the callbacks are there again after it, and after a model with a mistake."""
    free = swing(mujoco.MjModel.from_xml_string(PENDULUM))
    module = module_of(folder)
    model = load(folder)
    dome = module.install(model, settings(module)[1])
    callbacks = mujoco.get_mjcb_passive(), mujoco.get_mjcb_sensor()
    (tmp_path / "pendulum.xml").write_text(PENDULUM)
    spec = mujoco.MjSpec.from_string(PENDULUM)
    compiled = spec.compile()
    others = [
        mujoco.MjModel.from_xml_string(PENDULUM),
        mujoco.MjModel.from_xml_path(str(tmp_path / "pendulum.xml")),
        compiled,
        spec.recompile(compiled, mujoco.MjData(compiled))[0],
    ]
    assert 'axis="0 1 0"' in spec.to_xml()
    with pytest.raises(ValueError, match="unrecognized attribute"):
        mujoco.MjModel.from_xml_string('<mujoco nothing="1"/>')
    for other in others:
        assert np.array_equal(swing(other), free)
    assert (mujoco.get_mjcb_passive(), mujoco.get_mjcb_sensor()) == callbacks
    assert_has_dome(model, module, dome)


def test_a_second_model_of_the_sensor_has_no_force_before_it_is_installed(folder):
    module = module_of(folder)
    name, pressure = settings(module)
    first = load(folder)
    module.install(first, pressure)
    second = load(folder)
    assert sensed(second, name) == (0.0, 0.0, 0.0)
    assert_has_dome(second, module, module.install(second, pressure))


def test_a_model_at_the_address_of_one_that_is_gone_has_no_dome(folder):
    module = module_of(folder)
    name, pressure = settings(module)
    model, other = load(folder), load(folder)
    module.install(model, pressure)
    registry = getattr(mujoco, module._SHARED)
    address = model._address
    # What is known of an address holds for one model alone.
    registry._domes[other._address] = registry._domes[address]
    assert sensed(other, name) == (0.0, 0.0, 0.0)
    del registry._domes[other._address]
    del model
    assert address not in registry._domes
    for _ in range(8):
        newer = load(folder)
        assert sensed(newer, name) == (0.0, 0.0, 0.0)
        module.install(newer, pressure)
        address = newer._address
        del newer
        assert address not in registry._domes


def test_two_exported_sensors_work_in_any_order_of_installation(folder, other_folder):
    one, other = module_of(folder), module_of(other_folder)
    model, other_model, calls = load(folder), load(other_folder), []
    mujoco.set_mjcb_passive(lambda model, data: calls.append(1))
    one.install(model, settings(one)[1])
    other_dome = other.install(other_model, settings(other)[1])
    dome = one.install(model, one.TABLE["states"][0]["driving_pressure_kPa"])
    calls.clear()
    assert_has_dome(model, one, dome)
    assert_has_dome(other_model, other, other_dome)
    assert len(calls) == 2
    # A model is loaded while both are there, and both go on.
    assert_has_dome(again := load(other_folder), other, other.install(again, settings(other)[1]))
    assert_has_dome(model, one, dome)


def test_a_callback_that_calls_the_one_before_it_ends(folder):
    """The user's callback is in front of the sensor's, which is then installed once more, twice."""
    module = module_of(folder)
    pressure = settings(module)[1]
    model, calls = load(folder), []
    mujoco.set_mjcb_passive(lambda model, data: calls.append("first"))
    module.install(model, pressure)
    before = mujoco.get_mjcb_passive()

    def newer(model, data):
        calls.append("newer")
        before(model, data)

    for _ in range(2):
        mujoco.set_mjcb_passive(newer)
        dome = module.install(model, pressure)
        calls.clear()
        assert_has_dome(model, module, dome)
        assert calls == ["newer", "first"]


def test_an_error_of_a_callback_that_was_set_before_reaches_the_caller(folder):
    module = module_of(folder)
    model = load(folder)

    def wrong(model, data):
        raise RuntimeError("of the user")

    mujoco.set_mjcb_passive(wrong)
    module.install(model, settings(module)[1])
    with pytest.raises(RuntimeError, match="of the user"):
        mujoco.mj_step(model, mujoco.MjData(model))
    clear()
    assert_has_dome(model, module, module.install(model, settings(module)[1]))
