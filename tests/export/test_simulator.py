"""A sensor for simulators: inertia against trimesh, frames and meshes of the link, the tree of the MJCF."""

from __future__ import annotations

import io
import json
import sys
from xml.etree import ElementTree

import numpy as np
import pytest
import trimesh

from pneutouch.errors import InputError
from pneutouch.export.simulator.model import ball_inertia, inertia_of, moving_share
from pneutouch.shape.hemisphere import Hemisphere
from pneutouch.workflows.export_reader import make_simulator, write_simulator


@pytest.fixture(scope="module")
def evaluation(evaluated):
    return evaluated("paper-dome", model="atlas")


@pytest.fixture(scope="module")
def link(evaluation):
    return make_simulator(evaluation, "urdf")


def trimesh_inertia(assembly):
    """Mass (kg), centre (m) and inertia about it (kg m2) as trimesh has them, scaled to the exact masses."""
    parts = []
    for body, solid in zip(assembly.bodies, assembly.solids, strict=True):
        mesh = trimesh.Trimesh(1e-3 * body.vertices, body.triangles, process=False)
        mesh.density = 1e-3 * solid.mass / mesh.volume
        parts.append(mesh.mass_properties)
    mass = sum(part["mass"] for part in parts)
    centre = sum(part["mass"] * part["center_mass"] for part in parts) / mass
    about = np.zeros((3, 3))
    for part in parts:
        arm = part["center_mass"] - centre
        about += part["inertia"] + part["mass"] * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return mass, centre, about


@pytest.mark.parametrize("name", ["paper-dome", "fingertip-dome"])
def test_mass_centre_and_inertia_are_those_of_trimesh(evaluated, name):
    assembly = evaluated(name, model="atlas").assembly
    inertia = inertia_of(assembly.bodies, assembly.solids)
    mass, centre, about = trimesh_inertia(assembly)
    assert inertia.mass == pytest.approx(mass, rel=1e-9)
    assert inertia.mass == pytest.approx(1e-3 * sum(solid.mass for solid in assembly.solids), rel=1e-12)
    assert inertia.centre == pytest.approx(centre, abs=1e-9)
    assert inertia.about_centre == pytest.approx(about, rel=1e-6, abs=1e-12)


def test_the_inertia_of_parts_adds_up_and_a_part_can_be_taken_away():
    one = ball_inertia(0.2, np.array([0.0, 0.01, 0.02]), 0.004)
    other = ball_inertia(0.1, np.array([0.03, 0.0, -0.01]), 0.002)
    both = one + other
    assert both.mass == pytest.approx(0.3)
    left = both.without(other)
    assert left.centre == pytest.approx(one.centre)
    assert left.about_centre == pytest.approx(0.2 * 0.004**2 * np.eye(3), abs=1e-15)


def test_the_moving_mass_is_a_third_of_a_thin_shell_at_half_its_radius():
    share = moving_share(Hemisphere(10.0, 1e-3), 1000.0)
    assert share.mass == pytest.approx(1000.0 * 2 * np.pi * 0.01**2 * 1e-6 / 3, rel=1e-3)
    assert share.centre[2] == pytest.approx(0.005, rel=1e-3)


def test_the_link_has_the_mass_the_meshes_and_the_frames(link, evaluation):
    root = ElementTree.fromstring(link.files["paper-dome.urdf"])
    mass, centre, about = trimesh_inertia(evaluation.assembly)
    inertial = root.find("link/inertial")
    assert float(inertial.find("mass").get("value")) == pytest.approx(mass, rel=1e-8)
    assert [float(x) for x in inertial.find("origin").get("xyz").split()] == pytest.approx(centre, abs=1e-8)
    moments = {key: float(value) for key, value in inertial.find("inertia").attrib.items()}
    expected = {f"i{'xyz'[i]}{'xyz'[j]}": about[i, j] for i in range(3) for j in range(i, 3)}
    assert moments == pytest.approx(expected, rel=1e-6, abs=1e-12)
    for mesh in root.iter("mesh"):
        read = trimesh.load_mesh(io.BytesIO(link.files[mesh.get("filename")]), file_type="stl")
        assert read.is_watertight and mesh.get("scale") == "0.001 0.001 0.001"
        assert read.is_convex or not mesh.get("filename").endswith("-contact.stl")
    frames = {joint.find("child").get("link"): joint.find("origin").get("xyz") for joint in root.iter("joint")}
    lowest = 1e-3 * min(body.bounds[0, 2] for body in evaluation.assembly.bodies)
    assert float(frames["paper-dome_mount"].split()[2]) == pytest.approx(lowest)
    apex = 1e-3 * evaluation.prediction.states[0].apex_outer
    assert float(frames["paper-dome_contact"].split()[2]) == pytest.approx(apex)


def test_base_and_moving_share_together_have_the_inertia_of_the_bodies(evaluation):
    root = ElementTree.fromstring(make_simulator(evaluation, "mujoco").files["paper-dome.xml"])
    base, dome = root.find("worldbody/body"), root.find("worldbody/body/body")

    def numbers(element, key):
        return np.array([float(word) for word in element.get(key).split()])

    def about_origin(element, offset):
        at = numbers(element, "pos") + offset
        mass = float(element.get("mass"))
        full = (
            numbers(element, "fullinertia")
            if element.get("fullinertia")
            else [*numbers(element, "diaginertia"), 0, 0, 0]
        )
        xx, yy, zz, xy, xz, yz = full
        tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        return mass, mass * at, tensor + mass * (at @ at * np.eye(3) - np.outer(at, at))

    parts = [
        about_origin(base.find("inertial"), np.zeros(3)),
        about_origin(dome.find("inertial"), numbers(dome, "pos")),
    ]
    mass, moment, tensor = (sum(column) for column in zip(*parts, strict=True))
    exact, centre, about = trimesh_inertia(evaluation.assembly)
    assert mass == pytest.approx(exact, rel=1e-8)
    assert moment / mass == pytest.approx(centre, abs=1e-8)
    shifted = about + exact * (centre @ centre * np.eye(3) - np.outer(centre, centre))
    assert tensor == pytest.approx(shifted, rel=1e-6, abs=1e-12)


def test_the_same_input_gives_the_same_bytes_and_a_manifest(evaluation, link, tmp_path):
    again = make_simulator(evaluation, "urdf")
    assert again.files == link.files
    folder = write_simulator(link, tmp_path)
    assert folder.name == "paper-dome-urdf"
    listed = json.loads((folder / "manifest.json").read_text())["files"]
    assert set(listed) == set(link.files)


def test_the_module_imports_mujoco_and_the_standard_library_alone(evaluation):
    text = make_simulator(evaluation, "mujoco").files["dome_force.py"].decode()
    imports = {line.split()[1].split(".")[0] for line in text.splitlines() if line.startswith(("import ", "from "))}
    assert imports - set(sys.stdlib_module_names) == {"mujoco"}
    compile(text, "dome_force.py", "exec")


@pytest.mark.parametrize("kind", ["gazebo", "mujoko"])
def test_an_unknown_simulator_is_refused(evaluation, kind):
    with pytest.raises(InputError, match="mujoco"):
        make_simulator(evaluation, kind)


def test_the_command_writes_the_folder_and_names_the_simulators(command, tmp_path):
    done = command("export-reader", "paper-dome", "--simulator", "urdf", "--model", "atlas")
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == "outputs/paper-dome-urdf"
    assert (tmp_path / "outputs/paper-dome-urdf/paper-dome.urdf").is_file()
    wrong = command("export-reader", "paper-dome", "--simulator", "urdff")
    assert wrong.returncode == 2
    assert wrong.stderr.splitlines()[-1] == "error: --simulator urdff: unknown. Did you mean urdf?"
