"""Voxel stacks as files: written whole or not at all, the same bytes each time, and every rule checked on the way back."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner

from pneutouch.catalogue import load_scene
from pneutouch.cli.app import app
from pneutouch.errors import InputError
from pneutouch.export.voxels.manifest import MANIFEST
from pneutouch.export.voxels.png import encode, table
from pneutouch.export.voxels.read import read_stack
from pneutouch.parts import assemble
from pneutouch.pipeline.files import digest
from pneutouch.pipeline.voxels import plan_voxels, write_voxels
from tests.export.voxels.small import SETS, small_assembly


@pytest.fixture(scope="module")
def written(tmp_path_factory, library):
    plan = plan_voxels(small_assembly(), mode="High Mix", library=library)
    folder, notes = write_voxels(plan, tmp_path_factory.mktemp("stack"), "abc")
    assert notes == []
    return plan, folder


@pytest.fixture
def stack(written, tmp_path):
    return Path(shutil.copytree(written[1], tmp_path / "graded-dome-voxels"))


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
    assert membrane["fraction_realised"] == pytest.approx(membrane["fraction_asked"], abs=1e-3)
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


def test_same_input_same_bytes_in_the_place_of_an_earlier_stack(written, stack):
    plan, folder = written
    (stack / "graded-dome_9999.png").write_bytes(b"left over from a taller one")
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
    with pytest.raises(InputError, match=r"graded-dome-voxels: No space left on device; no stack was written"):
        write_voxels(plan, stack.parent, "abc")
    monkeypatch.undo()
    assert {path.name: path.read_bytes() for path in stack.iterdir()} == before
    assert list(stack.parent.iterdir()) == [stack]


def test_somebody_elses_files_are_left_alone(written, stack):
    for name in ("notes.txt", "section.png"):
        (stack / name).write_text("mine")
        with pytest.raises(InputError, match=rf"{name} is not of the stack"):
            write_voxels(written[0], stack.parent, "abc")
        (stack / name).unlink()
    other = stack.parent / "other"
    other.mkdir()
    stack.rename(other / "kept")
    stack.mkdir()
    (stack / "a.png").write_text("mine")
    with pytest.raises(InputError, match=r"holds files but no stack\.json"):
        write_voxels(written[0], stack.parent, "abc")


def test_a_printer_without_voxels_is_refused_before_anything_is_written(library, tmp_path):
    scene = load_scene("paper-dome", [], library)
    plan = plan_voxels(assemble(scene), library=library)
    with pytest.raises(
        InputError, match=r"print\.profile = 'objet260-connex': the .* takes no voxel stacks .* such as j735"
    ):
        write_voxels(plan, tmp_path, "abc")
    assert list(tmp_path.iterdir()) == []


def test_too_large_too_low_and_too_many_colours_are_found(library, tmp_path):
    plan = plan_voxels(small_assembly(), mode="High Mix", library=library)
    from pneutouch.printability.rules.voxels import check_stack

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
    with pytest.raises(InputError, match=r"400\.0 x 1\.0 x 1\.0 mm; the machine builds 350 x 350 x 200 mm"):
        write_voxels(large, tmp_path, "abc")
    assert list(tmp_path.iterdir()) == []


def test_an_unknown_mode_is_named(library):
    with pytest.raises(InputError, match=r"--voxel-mode High Mixx: unknown\. Did you mean High Mix"):
        plan_voxels(small_assembly(), mode="High Mixx", library=library)


def test_a_catalogue_mix_takes_its_assumed_fraction_and_says_so(library):
    plan = plan_voxels(small_assembly("membrane.material=FLX9960"), mode="High Mix", library=library)
    blend = plan.job.bodies[0].blend
    assert blend.resins == ("TangoPlus", "VeroClear")
    assert blend.most == pytest.approx(0.229)
    assert blend.assumed.startswith("FLX9960 is 22.9% VeroClear: assumed")


def test_a_mix_on_no_curve_is_refused(library):
    scene = load_scene("graded-dome", [*SETS, "membrane.material=FLX9960"], library)
    other = scene.membrane_material.model_copy(update={"base_resins": ["Agilus30", "VeroClear"]})
    assembly = assemble(replace(scene, membrane_material=other))
    with pytest.raises(
        InputError, match=r"membrane\.material = 'FLX9960': nobody publishes how much VeroClear is in it"
    ):
        plan_voxels(assembly, library=library)


def other_slice(folder, number, change):
    path = folder / f"graded-dome_{number}.png"
    with Image.open(path) as picture:
        changed = change(picture.copy())
    changed.save(path, compress_level=1)
    return path


def repainted(folder, number, spoil=None, cut=None, dpi=(600, 300)):
    """The slice encoded anew by our own writer: a sound PNG with another content."""
    held = read_stack(folder)
    labels, colours = held.labels(number), held.colours
    if spoil is not None:
        colours = np.append(colours, table([(12, 200, 34, 255)]))
        labels[spoil] = len(colours) - 1
    (folder / f"graded-dome_{number}.png").write_bytes(encode(labels[:, :cut], colours, dpi))


def truncated(folder):
    path = folder / "graded-dome_40.png"
    path.write_bytes(path.read_bytes()[:-20])


def flipped(folder):
    path = folder / "graded-dome_40.png"
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


def altered(key, value):
    def change(folder):
        path = folder / MANIFEST
        content = json.loads(path.read_text())
        content[key] = value
        path.write_text(json.dumps(content))

    return change


def swapped(folder):
    one, other = (folder / f"graded-dome_{k}.png" for k in (40, 150))
    content = one.read_bytes()
    one.write_bytes(other.read_bytes())
    other.write_bytes(content)


SPOILED = {
    "palette": (lambda f: other_slice(f, 40, lambda p: p.convert("P")), r"_40\.png: the PNG is an indexed palette; a slice must be RGBA"),
    "RGB": (lambda f: other_slice(f, 40, lambda p: p.convert("RGB")), r"_40\.png: the PNG is RGB without alpha"),
    "stray": (lambda f: repainted(f, 40, spoil=(7, 9)), r"_40\.png: the pixel in column 9, row 7 is \(12, 200, 34, 255\), which stands for no resin"),
    "size": (lambda f: repainted(f, 40, cut=-1), r"_40\.png: \d+ x \d+ pixels; all slices must be"),
    "dpi": (lambda f: repainted(f, 40, dpi=(300, 600)), r"_40\.png: says 300 x 600 dpi; must be 600 x 300 dpi"),
    "gap": (lambda f: (f / "graded-dome_40.png").unlink(), r"graded-dome_40\.png is missing"),
    "last": (lambda f: shutil.copy(f / "graded-dome_0.png", f / "graded-dome_9999.png"), r"is missing; slices must be numbered without gaps"),
    "padded": (lambda f: (f / "graded-dome_4.png").rename(f / "graded-dome_04.png"), r"_04\.png: is no slice"),
    "truncated": (truncated, r"_40\.png: the PNG is cut off"),
    "damaged": (flipped, r"_40\.png: the PNG is damaged"),
    "swapped": (swapped, r"_40\.png: was changed after it was written"),
    "no manifest": (lambda f: (f / MANIFEST).unlink(), r"holds no stack\.json"),
    "broken manifest": (lambda f: (f / MANIFEST).write_text("{"), r"stack\.json: not JSON"),
    "other format": (altered("format", 99), r"format = 99"),
    "altered hash": (altered("slices", ["0" * 64]), r"sha256 is not that of its slices"),
    "missing key": (altered("dpi", None), r"stack\.json: dpi is missing"),
    "text": (lambda f: (f / "graded-dome_40.png").write_text("x"), r"_40\.png: not a PNG file"),
}  # fmt: skip


@pytest.mark.parametrize("case", SPOILED)
def test_what_is_wrong_with_a_stack_is_named(stack, case):
    spoil, said = SPOILED[case]
    spoil(stack)
    with pytest.raises(InputError, match=said):
        read_stack(stack)


def test_fewer_than_thirty_slices_are_refused(stack):
    manifest = json.loads((stack / MANIFEST).read_text())
    for number in range(29, manifest["layers"]):
        (stack / f"graded-dome_{number}.png").unlink()
    from pneutouch.export.voxels.manifest import whole_hash

    kept = manifest["slices"][:29]
    (stack / MANIFEST).write_text(json.dumps({**manifest, "layers": 29, "slices": kept, "sha256": whole_hash(kept)}))
    with pytest.raises(InputError, match="29 slices; the utility takes no fewer than 30"):
        read_stack(stack)


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


def test_build_puts_the_stack_beside_its_own_folder(tmp_path, monkeypatch):
    """The rest of the build stands in for itself: it has its own tests."""
    monkeypatch.setattr(
        "pneutouch.cli.build._build_sensor", lambda evaluation, out: ("graded-dome", out / "graded-dome", [])
    )
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


def test_check_and_build_refuse_a_printer_without_voxels(tmp_path):
    runner = CliRunner()
    result = runner.invoke(app, ["build", "paper-dome", "--model", "membrane", "--voxels", "--out", str(tmp_path)])
    assert result.exit_code == 2
    assert "print.profile = 'objet260-connex'" in result.stderr
    assert list(tmp_path.iterdir()) == []
    result = runner.invoke(app, ["check", "paper-dome", "--voxels"])
    assert result.exit_code == 1
    assert "voxels: membrane: the Stratasys Objet260 Connex takes no voxel stacks" in result.stdout


@pytest.mark.slow
def test_the_full_graded_dome_keeps_time_memory_and_volume(library, tmp_path):
    import resource
    import time

    plan = plan_voxels(assemble(load_scene("graded-dome", [], library)), mode="High Mix", library=library)
    before, start = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.process_time()
    folder, notes = write_voxels(plan, tmp_path, "abc")
    assert time.process_time() - start < 30
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 200_000
    assert notes == []
    bodies = read_stack(folder).manifest["bodies"]
    for body in bodies.values():
        assert body["volume_mm3"] == pytest.approx(body["exact_volume_mm3"], rel=0.003)
    assert abs(bodies["membrane"]["fraction_realised"] - bodies["membrane"]["fraction_asked"]) < 1e-3
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
