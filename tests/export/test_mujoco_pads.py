"""A pad in MuJoCo: a board that lies on its domes, and a ball over one of them, against the pad's own answers."""

from __future__ import annotations

from xml.etree import ElementTree

import numpy as np
import pytest

from pneutouch.api.pad import PadTouch
from pneutouch.export.simulator.model import inertia_of
from pneutouch.output.new_pad import new_pad
from pneutouch.spec.pad import PadCalibration
from pneutouch.workflows.pad.campaign import plan_pad, simulate_pad
from pneutouch.workflows.pad.export import write_pad_simulator
from pneutouch.workflows.pad.load import load_pad
from pneutouch.workflows.pad.measured_files import save_calibration
from pneutouch.workflows.pad.touch import pad_model
from tests.pads import coarse_home
from tests.running import in_process

mujoco = pytest.importorskip("mujoco", reason="mujoco is not installed; the development lock has it")

from benchmarks.simulators import clear, module_of  # noqa: E402

GRAVITY, HELD_KPA = 9.81, np.array([12.0, 5.0, 12.0])
CHANGES = {"pneumatics.driving_pressures_kPa": [0.0, 12.0], "pad.groups": [{"cells": [2], "driving_pressure_kPa": 5.0}]}


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
        return np.array(read[0]) - HELD_KPA, np.array(read[1]), 1e3 * np.array(read[2])

    yield at_rest
    clear()


def test_a_board_that_lies_on_the_domes_is_carried_by_them_all(put_down):
    rises_kPa, forces, travels = put_down(mujoco.mjtGeom.mjGEOM_BOX, [0.02, 0.01, 0.002], [0, 0, 0.02], 0.12)
    assert forces.sum() == pytest.approx(0.12 * GRAVITY, rel=1e-3)
    pad = pad_model(load_pad("tip", CHANGES), 12.0)
    high, low = (float(table.plates.first[0, 0]) for table in pad.tables)
    known = PadTouch(pad).plate(0.0, 0.0, travels[0] + pad.top - high)
    # A board of MuJoCo's own softness does not yield either.
    assert high > low + 0.05 and np.add(travels, [0.0, high - low, 0.0]) == pytest.approx(travels[0], abs=1e-4)
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
    written = ElementTree.parse(write_pad_simulator(pad, None, "urdf", tmp_path) / "tip.urdf")
    links = {link.get("name") for link in written.iter("link")}
    assert links == {"tip", "tip_mount", "tip-1_contact", "tip-2_contact", "tip-3_contact"}
    frames = [joint for joint in written.iter("joint") if joint.find("child").get("link").endswith("_contact")]
    at = np.array([joint.find("origin").get("xyz").split() for joint in frames], dtype=float)
    tops = [float(table.plates.first[0, 0]) for table in pad_model(pad, 12.0).tables]
    assert 1e3 * at == pytest.approx(np.column_stack([pad.layout.places, np.array(tops)[[0, 1, 0]]]), abs=1e-6)


def test_simulated_gauges_rest_at_the_pressures_of_their_cells(folder, tmp_path):
    made = simulate_pad(plan_pad(load_pad("tip", CHANGES)), tmp_path, 1, CHANGES)
    text = (made / "runs/stage.csv").read_text().split("\n", 1)
    at = dict(zip(text[0].split(","), np.loadtxt(text[1].splitlines(), delimiter=",").T, strict=True))
    free = at["depth_mm"] < 0.0
    assert [at[f"pressure_{k}_kPa"][free].mean() for k in (1, 2, 3)] == pytest.approx(HELD_KPA, abs=0.01)


def test_a_calibrated_pad_has_its_factors(folder, tmp_path):
    pad, factors = load_pad("tip", CHANGES), [1.1, 1.0, 0.9]
    calibration = PadCalibration(
        pad="tip",
        places_mm=[list(place) for place in pad.layout.places],
        groups=pad.file.pad.groups,
        driving_pressure_kPa=12.0,
        force_factor=1.2,
        force_factor_uncertainty=0.01,
        rise_factors=factors,
        rise_factor_uncertainties=[0.01] * 3,
        model_error=0.02,
        readings=9,
        digest="0",
    )
    save_calibration(calibration, "mine", replace=True)
    tables = [module_of(one).TABLES for one in (folder, write_pad_simulator(pad, "mine", "mujoco", tmp_path))]
    ends = [[dome["states"][0] for dome in one] for one in tables]
    for key, scale in (("force_N", 1.2), ("pressure_kPa", np.array(factors))):
        before, after = (np.array([state[key][-1] for state in one]) for one in ends)
        rest = 0.0 if key == "force_N" else HELD_KPA
        assert after - rest == pytest.approx(scale * (before - rest), rel=1e-6)


def test_the_command_writes_it_and_an_unknown_simulator_is_refused(folder, tmp_path):
    sets = ["pneumatics.driving_pressures_kPa=[0,12]", "pad.groups=[{cells=[2],driving_pressure_kPa=5}]"]
    given = ["export-reader", "tip", *(word for one in sets for word in ("--set", one)), "--out", "."]
    made = in_process([*given, "--simulator", "mujoco"], tmp_path)
    assert made.returncode == 0 and (tmp_path / "tip-mujoco" / "README.md").is_file()
    assert (tmp_path / "tip-mujoco" / "tip.xml").read_bytes() == (folder / "tip.xml").read_bytes()
    refused = in_process([*given, "--simulator", "gazebo"], tmp_path)
    assert refused.returncode == 2 and not (tmp_path / "tip-gazebo").exists()
