"""FreeCAD opens what is written: STEP as valid closed solids of the exact volumes, STL as closed surfaces."""

from __future__ import annotations

import json
import shutil
import subprocess

import pytest

from pneutouch.evaluation.evaluate import evaluate
from pneutouch.export.scene import stl
from pneutouch.export.step import step_files
from pneutouch.workflows.build import mould_files

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(shutil.which("freecadcmd") is None, reason="FreeCAD is not installed"),
]

TPU = {"print.profile": "tpu-filament", "membrane.material": "NinjaFlex"}
BOSS = {"membrane.boss_radius_mm": 2.5, "membrane.boss_height_mm": 2.0}
CASES = {
    "hemisphere": {},
    "Luer on a finger": {"connector.port": "luer-female", "connector.mount": "finger-16"},
    "clamped, robot flange": {
        "connector.port": "thread-M5",
        "connector.seat": "clamped-flange-M2",
        "connector.mount": "robot-50-4-M6",
    },
    "cap": {"membrane.shape": "cap", "membrane.root_fillet_mm": 0.5},
    "ellipsoid": {"membrane.shape": "ellipsoid", "membrane.wall_stations": [[0.0, 0.8], [1.0, 1.3]]},
    "thimble": {**TPU, "membrane.shape": "thimble", "connector.port": "push-in-4"},
    "disc": {"membrane.shape": "disc", **BOSS},
    "torus": {"membrane.shape": "torus"},
}

MACRO = """
import json, pathlib
import Mesh, Part
folder, found = pathlib.Path("@FOLDER@"), {}
for path in sorted(folder.glob("*.step")):
    shape = Part.Shape()
    shape.read(str(path))
    found[path.name] = [shape.isValid()] + [[s.isValid() and s.isClosed(), s.Volume] for s in shape.Solids]
for path in sorted(folder.glob("*.stl")):
    mesh = Mesh.Mesh(str(path))
    sound = mesh.isSolid() and not mesh.hasSelfIntersections() and not mesh.hasNonManifolds()
    found[path.name] = [sound, mesh.Volume]
(folder / "found.json").write_text(json.dumps(found))
"""


def opened(files, folder):
    """By file: what FreeCAD says of it."""
    for path, content in files.items():
        (folder / path.replace("/", "-")).write_bytes(content)
    (folder / "open.py").write_text(MACRO.replace("@FOLDER@", str(folder)))
    subprocess.run(["freecadcmd", str(folder / "open.py")], capture_output=True, check=True, timeout=300)
    return json.loads((folder / "found.json").read_text())


@pytest.mark.parametrize("case", CASES)
def test_a_design_opens_as_its_exact_solids(case, tmp_path):
    assembly = evaluate("paper-dome", CASES[case]).assembly
    exact, _ = step_files("dome", assembly.solids, assembly.print_offset)
    found = opened(exact | {f"{body.name}.stl": stl(body) for body in assembly.bodies}, tmp_path)
    whole, *solids = found["dome.step"]
    assert whole and all(sound for sound, _ in solids)
    volumes = sorted(solid.volume for solid in assembly.solids)
    assert sorted(volume for _, volume in solids) == pytest.approx(volumes, rel=1e-5)
    for body, solid in zip(assembly.bodies, assembly.solids, strict=True):
        sound, volume = found[f"{body.name}.stl"]
        assert sound and volume == pytest.approx(solid.volume, rel=3e-3)


def test_a_mould_opens_as_closed_solids(tmp_path):
    files, _ = mould_files(evaluate("cast-dome", {"mould.cavities": 3}).assembly.mould)
    kept = {path: content for path, content in files.items() if path.endswith((".step", ".stl"))}
    found = opened(kept, tmp_path)
    assert len(found) == len(kept) and all(sound for sound, *_ in found.values())
    assert all(solid[0] for name, (_, *solids) in found.items() if name.endswith(".step") for solid in solids)
