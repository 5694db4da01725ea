"""PrusaSlicer slices every filament job as it is written, with the settings beside it, and lays down what is stated."""

from __future__ import annotations

import math
import re
import shutil
import subprocess
from collections import Counter

import pytest

from pneutouch.evaluation.evaluate import evaluate
from pneutouch.evaluation.subject import made_of
from pneutouch.printability.estimate import estimate
from pneutouch.workflows.build import job_files, mould_files

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(shutil.which("prusa-slicer") is None, reason="PrusaSlicer is not installed"),
]

TPU = {"print.profile": "tpu-filament", "indentation.plate_diameter_mm": 60.0}
CASES = {
    "push-in": {"connector.port": "push-in-4"},
    "clamped barb": {"connector.port": "barb-4x2.5", "connector.seat": "clamped-flange-M2"},
    "Luer on a finger": {"connector.port": "luer-female", "connector.mount": "finger-16"},
    "robot flange": {"connector.port": "thread-M5", "connector.mount": "robot-50-4-M6"},
    "inserts and O-ring": {
        "connector.port": "o-ring-9",
        "connector.seat": "clamped-flange-M2-insert",
        "connector.mount": "rear-4xM3-insert",
    },
    "NinjaFlex": {**TPU, "membrane.material": "NinjaFlex", "connector.port": "push-in-4"},
    "Filaflex, dome down": {**TPU, "membrane.material": "FilaFlex60A", "print.orientation": "dome-down"},
    "Cheetah, large": {**TPU, "membrane.material": "Cheetah", "membrane.inner_radius_mm": 14.0},
}


def laid(path, settings):
    """Volumes in mL by kind of line, without the extra flow, and the time in min."""
    text = path.read_text()
    flow = float((re.search(r"extrusion_multiplier = (.*)", settings) or ["", "1"])[1])
    volumes, kind, last, relative = Counter(), "", 0.0, "M83" in text
    for line in text.splitlines():
        if line.startswith(";TYPE:"):
            kind = line.removeprefix(";TYPE:").split()[0]
        elif line.startswith("G92"):
            last = 0.0
        elif line.startswith("G1") and (found := re.search(r"E(-?[\d.]+)", line)):
            length = float(found[1]) - (0.0 if relative else last)
            last = float(found[1])
            if length > 0 and re.search("[XY]", line):
                volumes[kind] += length * math.pi * 1.75**2 / 4 / flow / 1e3
    spent = re.search(r"estimated printing time \(normal mode\) = (.*)", text)[1]
    seconds = sum(int(n) * {"h": 3600, "m": 60, "s": 1}[unit] for n, unit in re.findall(r"(\d+)([hms])", spent))
    return volumes, seconds / 60


def sliced(model, kind, settings, folder):
    """What `laid` finds in a file sliced with settings."""
    source, config, gcode = folder / f"job.{kind}", folder / "job.ini", folder / "job.gcode"
    source.write_bytes(model)
    config.write_bytes(settings)
    words = ["prusa-slicer", "--export-gcode", "--load", config, "--output", gcode, source]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return laid(gcode, settings.decode())


@pytest.mark.parametrize("case", CASES)
def test_every_filament_job_is_sliced_and_takes_what_is_stated(case, tmp_path):
    evaluation = evaluate("paper-dome", CASES[case])
    stated = {f"jobs/paper-dome-{job.job}": job for job in estimate(made_of(evaluation.assembly))}
    files = job_files(evaluation.scene.name, evaluation.assembly, {})
    configured = [name for name in files if name.endswith(".ini")]
    assert len(configured) == len([job for job in stated.values() if "filament" in job.printer])
    for name in configured:
        volumes, minutes = sliced(files[name.replace(".ini", ".3mf")], "3mf", files[name], tmp_path)
        support = volumes.pop("Support", 0.0)
        volumes.pop("Skirt/Brim", None)
        job = stated[name.removesuffix(".ini")]
        assert sum(item.volume_mL for item in job.items) == pytest.approx(volumes.total(), rel=0.05)
        assert job.support_mL == pytest.approx(support, rel=0.25, abs=0.13)
        # Short outlines of a small ring are slower than a rate by volume tells.
        assert job.job == "ring" or job.time_min == pytest.approx(minutes, rel=0.25)


def test_a_mould_with_infill_takes_what_is_stated(tmp_path):
    evaluation = evaluate("cast-dome", {"mould.cavities": 3})
    mould = evaluation.assembly.mould
    stated = {job.job: job for job in estimate(made_of(evaluation.assembly))}
    files, _ = mould_files(mould)
    for body in mould.printed:
        volumes, minutes = sliced(files[f"mould/{body.name}.stl"], "stl", files["mould/cast-dome-mould.ini"], tmp_path)
        volumes.pop("Skirt/Brim", None)
        job = stated[body.name]
        assert sum(job.resins_mL.values()) == pytest.approx(volumes.total(), rel=0.25, abs=0.1)
        assert job.time_min == pytest.approx(minutes, rel=0.25, abs=4.0)
