"""The valid files that the cases damage, made once for all of them."""

from __future__ import annotations

import shutil
from pathlib import Path
from unittest import mock

from pneutouch.workflows.sweep.journal import WorkFolder
from tests.running import in_process
from tests.stability.fuzz.cases import LINES, RESULTS, RIG

SIGNAL = "time_s,pressure_kPa,force_N\n" + "".join(f"{0.01 * k:.2f},{1 + 0.01 * (k % 7)},0\n" for k in range(400))


_STRETCHES = [1 + k / 40 for k in range(1, 60)]
TENSION = "stretch,stress (MPa)\n" + "".join(f"{s:.4f},{0.15 * (s - s**-2):.6f}\n" for s in _STRETCHES)
PRESS = "Compression (mm),Force (N)\n" + "".join(
    f"{0.1 * k:.1f},{60 * ((1 - 0.01 * k) ** -2 - 1 + 0.01 * k):.4f}\n" for k in range(30)
)


ABOUT = {
    "name": "small",
    "input_hash": "",
    "printer": "a printer",
    "mode": "fine",
    "orientation": "upright",
    "versions": {},
    "print_frame_offset_mm": [0.0, 0.0, 0.0],
}
"""What a voxel stack says of its design."""


def make_base(folder: Path, built: Path) -> None:
    """Fill ``folder``; ``built`` is the output folder of the paper's sensor."""
    run("new", "mine", cwd=folder)
    (folder / "designs/mine.toml").rename(folder / "mine.toml")
    for example, name in (("fingertip", "target"), ("wall-and-resin", "sweep"), ("seven-resins", "tray")):
        run("new", name, "--from", example, cwd=folder)
    (folder / "rig.toml").write_text(RIG)
    (folder / "results.toml").write_text(RESULTS)
    (folder / "signal.csv").write_text(SIGNAL)
    (folder / "tension.csv").write_text(TENSION)
    (folder / "press.csv").write_text(PRESS)
    (folder / "built").mkdir()
    for name in ("manifest.json", "prediction.json"):
        shutil.copy(built / name, folder / "built")
    shutil.copy(built / "paper-dome.3mf", folder / "built.3mf")
    _campaign(folder)
    _sweep(folder)
    _stack(folder / "stack")


def run(*words: str, cwd: Path) -> None:
    done = in_process(words, cwd)
    assert done.returncode == 0, (words, done.stderr)


def _campaign(folder: Path) -> None:
    options = "--model atlas --pressures 0,22 --kinds steps,leak,injection --runs 1 --rest 2 --specimens 1 --rate 20"
    run("simulate", "paper-dome", *options.split(), cwd=folder)
    (folder / "outputs/paper-dome-campaign").rename(folder / "campaign")
    run("calibrate", "campaign", "--save", "mine", cwd=folder)
    shutil.copy(folder / "calibrations/mine.toml", folder / "mine-calibration.toml")
    for name in ("outputs", "calibrations"):
        shutil.rmtree(folder / name)
    first = sorted((folder / "campaign").rglob("*.csv"))[0]
    (folder / "campaign/runs").mkdir(exist_ok=True)
    shutil.copy(first, folder / "campaign/runs/run.csv")


def _sweep(folder: Path) -> None:
    """A finished sweep's dataset, and its journal as it was before the end."""
    finish = WorkFolder.finish

    def keep(self: WorkFolder, content: bytes | None) -> None:
        shutil.copy(self.journal, folder / "journal")
        finish(self, content)

    with mock.patch.object(WorkFolder, "finish", keep):
        run("sweep", *LINES["sweep"][1].split(), cwd=folder)


def _stack(folder: Path) -> None:
    from pneutouch.workflows.build_voxels import plan_voxels, write_stack
    from tests.export.voxels.small import small_assembly

    write_stack(plan_voxels(small_assembly(), coarser=4.0).job, folder, "small_", ABOUT)
