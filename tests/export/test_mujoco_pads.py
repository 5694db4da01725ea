"""A pad in MuJoCo: a board that lies on its domes, and a ball over one of them, against the pad's own answers."""

from __future__ import annotations

from xml.etree import ElementTree

import numpy as np
import pytest

from pneutouch.api.pad import PadTouch
from pneutouch.export.simulator.model import inertia_of
from pneutouch.output.new_pad import new_pad
from pneutouch.workflows.pad.export import write_pad_simulator
from pneutouch.workflows.pad.load import load_pad
from pneutouch.workflows.pad.touch import pad_model
from tests.pads import coarse_home
from tests.running import in_process

mujoco = pytest.importorskip("mujoco", reason="mujoco is not installed; the development lock has it")

from benchmarks.simulators import clear, module_of  # noqa: E402

GRAVITY, CHANGES = 9.81, {"pneumatics.driving_pressures_kPa": [0.0, 12.0]}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    with coarse_home(tmp_path_factory) as home:
        new_pad("tip", home / "designs", "row:3", 9.0)
        yield write_pad_simulator(load_pad("tip", CHANGES), None, "mujoco", tmp_path_factory.mktemp("mujoco"))


@pytest.fixture
def put_down(folder):
    """Puts a body of a mass, kg, down onto the pad; returns the rises of the cells, kPa, their forces and travels."""

    def at_rest(kind, size, place, mass):
        module = module_of(folder)
        spec = mujoco.MjSpec.from_file(str(folder / "tip.xml"))
        body = spec.worldbody.add_body(pos=place)
        body.add_joint(type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[0, 0, 1])
        body.add_geom(type=kind, size=size, mass=mass, friction=[0, 0, 0], condim=1)
        model = spec.compile()
        module.install(model)
        data = mujoco.MjData(model)
        for _ in range(2000):
            mujoco.mj_step(model, data)
        read = [
            [float(data.sensor(f"tip-{k}_{what}").data[0]) for k in (1, 2, 3)]
            for what in ("pressure_kPa", "force_N", "indentation_m", "status")
        ]
        assert not any(read[3])
        return np.array(read[0]) - 12.0, np.array(read[1]), 1e3 * np.array(read[2])

    yield at_rest
    clear()


def test_a_board_that_lies_on_the_domes_is_carried_by_them_all(put_down):
    rises_kPa, forces, travels = put_down(mujoco.mjtGeom.mjGEOM_BOX, [0.02, 0.01, 0.002], [0, 0, 0.02], 0.12)
    assert forces.sum() == pytest.approx(0.12 * GRAVITY, rel=1e-3)
    known = PadTouch(pad_model(load_pad("tip", CHANGES), 12.0)).plate(0.0, 0.0, travels[0])
    assert travels == pytest.approx(travels[0], abs=1e-4)
    assert forces == pytest.approx(known.forces_N[0], rel=0.02)
    assert rises_kPa == pytest.approx(known.pressure_rises_kPa[0], rel=0.02)


def test_a_ball_presses_the_dome_on_which_it_lies(put_down):
    rises_kPa, forces, _ = put_down(mujoco.mjtGeom.mjGEOM_SPHERE, [0.006, 0, 0], [0.009, 0, 0.02], 0.05)
    assert forces[2] == pytest.approx(0.05 * GRAVITY, rel=1e-3) and rises_kPa[2] > 0.02
    assert not rises_kPa[:2].any() and np.abs(forces[:2]).max() < 1e-6


def test_mass_is_that_of_the_print_and_every_dome_has_its_frame_in_urdf(folder, tmp_path):
    model = mujoco.MjModel.from_xml_path(str(folder / "tip.xml"))
    pad = load_pad("tip", CHANGES)
    assert float(model.body_mass.sum()) == pytest.approx(1e-3 * sum(solid.mass for solid in pad.solids), rel=1e-6)
    inertia = inertia_of(pad.bodies, pad.solids)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    parts = zip(model.body_mass, data.xipos, data.ximat.reshape(-1, 3, 3), model.body_inertia, strict=True)
    found = sum(
        turn @ np.diag(own) @ turn.T + mass * (at @ at * np.eye(3) - np.outer(at, at)) for mass, at, turn, own in parts
    )
    assert found == pytest.approx(inertia.about_origin, rel=1e-5, abs=1e-12)
    places = np.array([model.body(f"tip-{k}_dome").pos[:2] for k in (1, 2, 3)])
    assert 1e3 * places == pytest.approx(np.array(pad.layout.places), abs=1e-6)
    written = write_pad_simulator(pad, None, "urdf", tmp_path)
    links = {link.get("name") for link in ElementTree.parse(written / "tip.urdf").iter("link")}
    assert links == {"tip", "tip_mount", "tip-1_contact", "tip-2_contact", "tip-3_contact"}


def test_the_command_writes_it_and_an_unknown_simulator_is_refused(folder, tmp_path):
    given = ["export-reader", "tip", "--set", "pneumatics.driving_pressures_kPa=[0,12]", "--out", "."]
    made = in_process([*given, "--simulator", "mujoco"], tmp_path)
    assert made.returncode == 0 and (tmp_path / "tip-mujoco" / "README.md").is_file()
    assert (tmp_path / "tip-mujoco" / "tip.xml").read_bytes() == (folder / "tip.xml").read_bytes()
    refused = in_process([*given, "--simulator", "gazebo"], tmp_path)
    assert refused.returncode == 2 and not (tmp_path / "tip-gazebo").exists()
