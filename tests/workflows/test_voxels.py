"""Voxel stacks as files: written whole or not at all, the same bytes each time, and every rule checked on the way back."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner

from pneutouch.catalogue import load_scene
from pneutouch.cli.app import app
from pneutouch.errors import InputError, RuleBrokenError
from pneutouch.export.voxels.stack import MANIFEST, read_stack, slice_name, whole_hash
from pneutouch.output.files import digest
from pneutouch.parts import assemble
from pneutouch.spec.read import parse_changes
from pneutouch.workflows.build_voxels import plan_voxels, write_voxels
from pneutouch.workflows.show import show_stack
from tests.export.voxels.small import SETS, small_assembly
from tests.refusals import refused
from tests.running import files_of_at_most


@pytest.mark.slow
def test_slices_are_what_the_utility_asks_for(written):
    plan, folder = written
    manifest = json.loads((folder / MANIFEST).read_text())
    names = sorted((path.name for path in folder.glob("*.png")), key=lambda name: int(name[12:-4]))
    assert names == [f"graded-dome_{k}.png" for k in range(manifest["layers"])]
    assert len(names) >= 30
    known = {tuple(manifest["background_rgba"])} | {tuple(entry["rgba"]) for entry in manifest["resins"].values()}
    assert len(known) == 3
    for name in names[:: len(names) // 6]:
        with Image.open(folder / name) as picture:
            assert picture.mode == "RGBA"
            assert list(picture.size) == manifest["pixels"]
            assert picture.info["dpi"] == pytest.approx((600, 300), abs=0.01)
            assert {colour for _, colour in picture.getcolors()} <= known
    x, y, _ = plan.job.raster.pitch
    assert (x, y) == (25.4 / 600, 25.4 / 300)
    assert manifest["layer_um"] == plan.mode.layer_height_um == 27
    disc = 2 * plan.assembly.layout.plate_radius
    assert manifest["pixels"] == pytest.approx([disc / x, disc / y], abs=2)


def test_round_trip_counts_volumes_and_fractions(written):
    plan, folder = written
    stack = read_stack(folder)
    assert sum(stack.counts.values()) == sum(body["voxels"] for body in stack.manifest["bodies"].values())
    for body in plan.job.bodies:
        entry = stack.manifest["bodies"][body.solid.name]
        assert entry["voxels"] * stack.voxel == pytest.approx(body.solid.volume, rel=0.01)
    membrane = stack.manifest["bodies"]["membrane"]
    assert membrane["fraction_realised"] == pytest.approx(membrane["fraction_requested"], abs=1e-3)
    assert membrane["worst_cube"] <= 0.005
    soft = membrane["voxels"] * (1 - membrane["fraction_realised"])
    assert stack.counts["TangoPlus"] == pytest.approx(soft, abs=1)
    assert "resin" not in stack.manifest["bodies"]["connector"]


def test_the_picture_is_the_right_way_up(written):
    """The carrier is wide and lies below; the dome's pole is above; pixels are not square, the sides of the disc are."""
    stack = read_stack(written[1])
    wide = (stack.section > 0).sum(axis=1)
    assert wide[0] > 3 * wide[-1] > 0
    first = stack.labels(0) > 0
    columns, rows = first.any(axis=0).sum(), first.any(axis=1).sum()
    assert columns == pytest.approx(2 * rows, abs=2)


@pytest.mark.slow
def test_same_input_same_bytes_in_the_place_of_an_earlier_stack(written, stack):
    plan, folder = written
    # A taller one, with a slice more.
    manifest, content = json.loads((stack / MANIFEST).read_text()), b"a slice"
    slices = [*manifest["slices"], digest(content)]
    (stack / slice_name("graded-dome_", len(slices) - 1)).write_bytes(content)
    (stack / MANIFEST).write_text(json.dumps(manifest | {"slices": slices, "sha256": whole_hash(slices)}))
    again, _ = write_voxels(plan, stack.parent, "abc")
    assert again == stack
    assert list(stack.parent.iterdir()) == [stack]
    assert {path.name: digest(path.read_bytes()) for path in stack.iterdir()} == {
        path.name: digest(path.read_bytes()) for path in folder.iterdir()
    }


def test_a_dome_down_stack_starts_at_the_pole(library, tmp_path):
    plan = plan_voxels(
        small_assembly("print.orientation=dome-down", "membrane.material=TangoPlus"), mode="High Mix", library=library
    )
    folder, _ = write_voxels(plan, tmp_path, "abc")
    wide = (read_stack(folder).section > 0).sum(axis=1)
    assert wide[-1] > 3 * wide[0] > 0


def test_a_full_disk_leaves_nothing_and_keeps_the_earlier_stack(written, stack, monkeypatch):
    plan, _ = written
    before = {path.name: path.read_bytes() for path in stack.iterdir()}
    plain = Path.write_bytes

    def full(path, content):
        if path.name == "graded-dome_57.png":
            raise OSError(28, "No space left on device")
        return plain(path, content)

    monkeypatch.setattr(Path, "write_bytes", full)
    with refused("out"):
        write_voxels(plan, stack.parent, "abc")
    monkeypatch.undo()
    assert {path.name: path.read_bytes() for path in stack.iterdir()} == before
    assert list(stack.parent.iterdir()) == [stack]


def test_foreign_files_are_left_alone(written, stack):
    for name in ("notes.txt", "section.png"):
        (stack / name).write_text("mine")
        with refused(None, file=stack / name):
            write_voxels(written[0], stack.parent, "abc")
        (stack / name).unlink()
    other = stack.parent / "other"
    other.mkdir()
    stack.rename(other / "kept")
    stack.mkdir()
    (stack / "a.png").write_text("mine")
    with refused("out"):
        write_voxels(written[0], stack.parent, "abc")


@pytest.mark.parametrize("name", ["graded-dome_3.png", "graded-dome_100000.png"])
def test_a_slice_that_a_person_changed_or_added_is_left_alone(written, stack, name):
    (stack / name).write_bytes(b"mine")
    before = {path.name: path.read_bytes() for path in stack.iterdir()}
    with refused(None, file=stack / name):
        write_voxels(written[0], stack.parent, "abc")
    assert {path.name: path.read_bytes() for path in stack.iterdir()} == before


@pytest.mark.slow
def test_a_slice_that_is_changed_while_the_next_stack_is_made_is_left_alone(written, stack):
    def changed(done, total):
        (stack / "graded-dome_3.png").write_bytes(b"mine")

    with refused(None, file=stack / "graded-dome_3.png"):
        write_voxels(written[0], stack.parent, "abc", changed)
    assert (stack / "graded-dome_3.png").read_bytes() == b"mine"
    assert list(stack.parent.iterdir()) == [stack]


def test_a_printer_without_voxels_is_refused_before_anything_is_written(library, tmp_path):
    scene = load_scene("paper-dome", None, library)
    plan = plan_voxels(assemble(scene), library=library)
    with pytest.raises(
        RuleBrokenError, match=r'print\.profile = "objet260-connex": .* takes no voxel stacks .* such as j735'
    ):
        write_voxels(plan, tmp_path, "abc")
    assert list(tmp_path.iterdir()) == []


def test_too_large_too_low_and_too_many_colours_are_found(library, tmp_path):
    plan = plan_voxels(small_assembly(), mode="High Mix", library=library)
    from pneutouch.printability.rules.resins import check_stack

    printer, _ = plan.assembly.machine("membrane")

    def said(layers=100, size=(10.0, 10.0, 10.0), resins=("TangoPlus", "VeroClear"), mode=plan.mode):
        return [finding.message for finding in check_stack(printer, mode, resins, layers, size, "membrane")]

    assert said() == []
    assert "29 slices" in said(layers=29)[0]
    assert "350.1 x 10.0 x 10.0 mm" in said(size=(350.1, 10.0, 10.0))[0]
    assert "does not run ABS" in said(resins=("ABS",))[0]
    few = plan.mode.model_copy(update={"resins_at_once": 1})
    assert "has 1 colours at most" in said(mode=few)[0]
    large = replace(plan, findings=tuple(check_stack(printer, plan.mode, ("VeroClear",), 100, (400.0, 1.0, 1.0), "x")))
    with pytest.raises(RuleBrokenError, match=r"400\.0 x 1\.0 x 1\.0 mm; the machine builds 350 x 350 x 200 mm"):
        write_voxels(large, tmp_path, "abc")
    assert list(tmp_path.iterdir()) == []


def test_an_unknown_mode_is_named(library):
    with pytest.raises(InputError, match=r'voxel_mode = "High Mixx": unknown\. Did you mean High Mix'):
        plan_voxels(small_assembly(), mode="High Mixx", library=library)


def test_a_catalogue_mix_takes_its_assumed_fraction_and_says_so(library):
    plan = plan_voxels(small_assembly("membrane.material=FLX9960"), mode="High Mix", library=library)
    blend = plan.job.bodies[0].blend
    assert blend.resins == ("TangoPlus", "VeroClear")
    assert blend.most == pytest.approx(0.173)
    assert blend.assumed.startswith("FLX9960 is 17.3% VeroClear: assumed")


def test_a_mix_on_no_curve_is_refused(library):
    scene = load_scene("graded-dome", parse_changes([*SETS, "membrane.material=FLX9960"]), library)
    other = scene.membrane_material.model_copy(update={"base_resins": ["Agilus30", "VeroClear"]})
    assembly = assemble(replace(scene, membrane_material=other))
    with pytest.raises(
        InputError, match=r'membrane\.material = "FLX9960": no vendor publishes how much VeroClear is in it'
    ):
        plan_voxels(assembly, library=library)


def test_show_prints_and_draws_a_stack(written, tmp_path):
    _, folder = written
    result = CliRunner().invoke(app, ["show", str(folder), "--json", "--out", str(tmp_path / "section.png")])
    assert result.exit_code == 0, result.output
    document = json.loads(result.stdout)
    assert document["resins"]["VeroClear"]["voxels"] == read_stack(folder).counts["VeroClear"]
    assert sum(entry["share_of_the_print"] for entry in document["resins"].values()) == pytest.approx(1)
    with Image.open(tmp_path / "section.png") as picture:
        pixels = np.asarray(picture.convert("L"))
    filled = pixels < 250
    rows = np.flatnonzero(filled.any(axis=1))
    gap = rows[np.flatnonzero(np.diff(rows) > 5)[-1]]
    upper = filled[: gap + 1]
    tall, wide = upper.any(axis=1).sum(), upper.any(axis=0).sum()
    _, _, z = document["size_mm"]
    assert tall / wide == pytest.approx(z / (2 * small_assembly().layout.plate_radius), rel=0.02)
    text = CliRunner().invoke(app, ["show", str(folder)]).stdout
    assert "600 x 300 dpi, 27 um layers" in text
    assert "VeroClear" in text
    (tmp_path / "mine.png").write_bytes(b"mine")
    for name, code in (("section.png", 0), ("mine.png", 2)):
        assert CliRunner().invoke(app, ["show", str(folder), "--out", str(tmp_path / name)]).exit_code == code
    assert (tmp_path / "mine.png").read_bytes() == b"mine"


def test_build_puts_the_stack_beside_its_own_folder(tmp_path, monkeypatch):
    """The rest of the build stands in for itself: it has its own tests."""
    monkeypatch.setattr("pneutouch.cli.build._build_sensor", lambda evaluation, out: (out / "graded-dome", []))
    words = ["--set", "membrane.material=TangoPlus", "--model", "membrane", "--out", str(tmp_path)]
    sets = [word for pair in SETS for word in ("--set", pair)]
    result = CliRunner().invoke(app, ["build", "graded-dome", *sets, *words, "--voxel-mode", "high mix", "--json"])
    assert result.exit_code == 0, result.output
    document = json.loads(result.stdout)
    assert document["voxels"] == str(tmp_path / "graded-dome-voxels")
    stack = read_stack(Path(document["voxels"]))
    assert stack.manifest["mode"] == "High Mix"
    assert len(stack.manifest["input_hash"]) == 12


@pytest.mark.slow
def test_a_whole_build_and_its_stack_are_of_one_input(tmp_path):
    sets = [word for pair in SETS for word in ("--set", pair)]
    result = CliRunner().invoke(
        app, ["build", "graded-dome", *sets, "--voxel-mode", "High Mix", "--out", str(tmp_path), "--json"]
    )
    assert result.exit_code == 0, result.output
    document = json.loads(result.stdout)
    assert document["voxels"] == str(tmp_path / "graded-dome-voxels")
    stack = read_stack(Path(document["voxels"]))
    built = json.loads((tmp_path / "graded-dome/manifest.json").read_text())
    assert stack.manifest["input_hash"] == built["input_hash"]
    assert not any("voxel" in name for name in built["files"])


@pytest.mark.slow
def test_check_and_build_refuse_a_printer_without_voxels(tmp_path):
    runner = CliRunner()
    result = runner.invoke(app, ["build", "paper-dome", "--model", "membrane", "--voxels", "--out", str(tmp_path)])
    assert result.exit_code == 1
    assert 'print.profile = "objet260-connex"' in result.stderr
    assert list(tmp_path.iterdir()) == []
    result = runner.invoke(app, ["check", "paper-dome", "--voxels"])
    assert result.exit_code == 1
    assert "voxels: membrane: the Stratasys Objet260 Connex takes no voxel stacks" in result.stdout


@pytest.mark.slow
def test_the_full_graded_dome_keeps_memory_and_volume(library, tmp_path):
    import resource

    plan = plan_voxels(assemble(load_scene("graded-dome", None, library)), mode="High Mix", library=library)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    folder, notes = write_voxels(plan, tmp_path, "abc")
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 200_000
    assert notes == []
    bodies = read_stack(folder).manifest["bodies"]
    for body in bodies.values():
        assert body["volume_mm3"] == pytest.approx(body["exact_volume_mm3"], rel=0.003)
    assert abs(bodies["membrane"]["fraction_realised"] - bodies["membrane"]["fraction_requested"]) < 1e-3
    assert bodies["membrane"]["worst_cube"] < 0.005


def test_through_the_wall_the_fraction_is_the_one_asked_for(written):
    """Patches of the dome about 1 mm wide, the whole wall with both skins: what was asked for at the middle of the arc."""
    plan, folder = written
    stack, grid = read_stack(folder), plan.job.raster
    share = plan.job.bodies[0].blend.share
    radii = plan.assembly.layout.inner_radius + 0.5
    got, asked, held = (np.zeros((6, 40)) for _ in range(3))
    for number in np.flatnonzero(grid.z > 0):
        labels = stack.labels(int(number))
        row, column = np.nonzero(labels)
        x, y, z = grid.x[column], grid.y[row], grid.z[number]
        r = np.hypot(x, y)
        # The carrier's ring stands beside the dome below z = 0 alone.
        arc = np.minimum((6 * np.arctan2(r, z) / (0.5 * np.pi)).astype(int), 5)
        around = np.maximum(1, (2 * np.pi * radii * np.sin((arc + 0.5) / 6 * 0.5 * np.pi)).astype(int))
        sector = ((np.arctan2(y, x) / (2 * np.pi) % 1.0) * around).astype(int)
        stiff = labels[row, column] == list(stack.counts).index("VeroClear") + 1
        for totals, values in ((got, stiff), (asked, share(r, np.full(len(r), z))), (held, np.ones(len(r)))):
            np.add.at(totals, (arc, sector), values)
    full = held > 5000
    assert full.sum() > 60
    off = np.abs(got - asked)[full] / held[full]
    assert off.max() < 0.005
    assert off.mean() < 0.0015


def test_a_picture_that_cannot_be_written_leaves_nothing(written, tmp_path):
    _, folder = written
    picture = tmp_path / "sections.png"
    with files_of_at_most(100), pytest.raises(InputError, match="File too large"):
        show_stack(folder, picture)
    assert not list(tmp_path.iterdir())
    show_stack(folder, picture)
    assert picture.read_bytes().startswith(b"\x89PNG")
