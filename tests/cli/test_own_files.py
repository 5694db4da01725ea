"""A file of a person in an output folder: every command leaves it as it is, names it, and writes nothing."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from pneutouch.output.files import with_manifest, write_folder

LINES = {
    "plan paper-dome": "paper-dome-plan",
    "simulate paper-dome --specimens 1": "paper-dome-campaign",
    "build paper-dome": "paper-dome",
    "build texture-specimen": "texture-specimen",
    "characterize campaign --model atlas": "campaign-measured",
    "calibrate campaign --fit modulus --save mine": "paper-dome-TangoPlus-1-calibration",
    "compare paper-dome soft-pad --model atlas": "compare-paper-dome-soft-pad",
    "scan texture-specimen --design paper-dome": "texture-specimen-paper-dome-scan",
    "respond paper-dome --step 2N": "paper-dome-response",
    "coupons --only puck": "coupons-objet260-connex",
    "tray paper-dome soft-pad": "paper-dome-tray",
    "export-reader paper-dome": "paper-dome-reader",
    "export-reader paper-dome --simulator mujoco": "paper-dome-mujoco",
    "fit-material tension.csv --name Ours --like DragonSkin20": "fit-Ours",
}
"""Commands, and the folders that they write."""


def everything(folder: Path) -> dict[str, bytes | None]:
    paths = [path for path in folder.rglob("*") if path.relative_to(folder).parts[0] != "campaign"]
    return {str(path.relative_to(folder)): path.read_bytes() if path.is_file() else None for path in paths}


def annotated(folder: Path) -> Path:
    """A file of an output folder that a person has changed since."""
    write_folder(folder, with_manifest({"sheet.md": b"written"}, "x", {}))
    (folder / "sheet.md").write_bytes(b"annotated")
    return folder / "sheet.md"


def pulled(path: Path) -> None:
    """A tensile test of a neo-Hookean rubber."""
    rows = [f"{1 + k / 50:.3f},{0.15 * (1 + k / 50 - (1 + k / 50) ** -2):.6f}" for k in range(1, 101)]
    path.write_text("\n".join(["stretch,stress (MPa)", *rows]) + "\n")


def given(campaign: Path, folder: Path) -> None:
    """What the commands read."""
    shutil.copytree(campaign, folder / "campaign")
    pulled(folder / "tension.csv")


@pytest.mark.parametrize(
    "line", [*list(LINES)[:3], *(pytest.param(line, marks=pytest.mark.slow) for line in list(LINES)[3:])]
)
def test_a_command_replaces_no_file_that_a_person_changed(line, campaign_of_steps, command, tmp_path):
    sheet = annotated(tmp_path / "made" / LINES[line])
    given(campaign_of_steps, tmp_path)
    before = everything(tmp_path)
    done = command(*line.split(), "--out", "made")
    assert done.returncode == 2, done.stderr
    last = done.stderr.splitlines()[-1]
    assert str(sheet.relative_to(tmp_path)) in last and "--out" in last
    assert everything(tmp_path) == before


@pytest.mark.slow
@pytest.mark.parametrize("line", LINES)
def test_a_command_writes_the_same_again_over_its_own_output(line, campaign_of_steps, command, tmp_path):
    given(campaign_of_steps, tmp_path)
    first = command(*line.split(), "--out", "made")
    before = everything(tmp_path)
    assert before.keys() > {f"made/{LINES[line]}", f"made/{LINES[line]}/manifest.json"}, first.stderr
    again = command(*line.split(), "--out", "made")
    assert (again.returncode, again.stdout) == (first.returncode, first.stdout), again.stderr
    assert everything(tmp_path) == before


@pytest.mark.parametrize(
    ("line", "work"),
    [
        ("plan paper-dome", "plan.plated_tests"),
        ("simulate paper-dome --specimens 1", "simulate.pressed"),
        ("build paper-dome", "build.refuse"),
    ],
)
def test_it_is_found_before_the_work(line, work, command, tmp_path, monkeypatch):
    def worked(*_, **__):
        raise AssertionError("computed")

    monkeypatch.setattr(f"pneutouch.workflows.{work}", worked)
    sheet = annotated(tmp_path / "outputs" / LINES[line])
    done = command(*line.split())
    assert done.returncode == 2 and str(sheet.relative_to(tmp_path)) in done.stderr


def test_no_material_is_written_without_the_folder_of_its_fit(command, tmp_path):
    folder = annotated(tmp_path / "outputs/fit-Ours").parent
    (folder / "sheet.md").rename(folder / "fit.svg")
    pulled(tmp_path / "tension.csv")
    before = everything(tmp_path)
    done = command("fit-material", "tension.csv", "--name", "Ours", "--like", "DragonSkin20")
    assert done.returncode == 2 and "outputs/fit-Ours/fit.svg" in done.stderr
    assert everything(tmp_path) == before


@pytest.mark.slow
def test_a_measured_run_in_a_simulated_campaign_survives(command, tmp_path):
    """The run under the name of a simulated one, and one that the next simulation would write for the first time."""
    words = ["simulate", "paper-dome", "--runs", "1", "--kinds", "steps", "--pressures", "0", "--model", "atlas"]
    assert command(*words, "--specimens", "1").returncode == 0
    folder = tmp_path / "outputs/paper-dome-campaign"
    first, second = (folder / f"runs/TangoPlus-{k}-0kPa-steps-1.csv" for k in (1, 2))
    whole = everything(folder)
    assert command(*words, "--specimens", "1").returncode == 0
    assert everything(folder) == whole
    for path, specimens in ((first, "1"), (second, "2")):
        simulated = whole.get(str(path.relative_to(folder)))
        path.write_bytes(b"measured")
        before = everything(tmp_path)
        done = command(*words, "--specimens", specimens)
        assert done.returncode == 2 and path.name in done.stderr, done.stderr
        assert everything(tmp_path) == before
        path.unlink() if simulated is None else path.write_bytes(simulated)
    (folder / "runs/mine.csv").write_bytes(b"measured")
    assert command(*words, "--specimens", "2").returncode == 0
    assert (folder / "runs/mine.csv").read_bytes() == b"measured" and second.is_file()


@pytest.mark.slow
def test_an_annotated_plan_survives(command, tmp_path):
    words = ["plan", "paper-dome", "--specimens", "1"]
    assert command(*words).returncode == 0
    sheet = tmp_path / "outputs/paper-dome-plan/plan.md"
    sheet.write_text(sheet.read_text() + "\nThe gauge was changed after run 3.\n")
    before = everything(tmp_path)
    done = command(*words)
    assert done.returncode == 2 and "outputs/paper-dome-plan/plan.md" in done.stderr
    assert everything(tmp_path) == before
