"""The files of a tray: closed bodies apart from one another, a strict 3MF, a list and a view that agree with the parts."""

from __future__ import annotations

import hashlib
import json
import xml.etree.ElementTree as ElementTree
import zipfile
from pathlib import Path

import numpy as np
import pytest
import trimesh

from pneutouch.workflows.tray.lay import lay
from pneutouch.workflows.tray.order import order_of_file
from pneutouch.workflows.tray.write import write_tray
from tests.export.threemf_files import MODEL, read_strictly
from tests.workflows.tray.laid import EXAMPLE, RESINS, flags, table

SPACE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"


def content(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_the_folder_holds_what_is_promised(folder):
    labels = [f"{letter}{copy}" for letter in "ABCDEFG" for copy in (1, 2, 3)]
    assert set(content(folder)) == {
        "seven.3mf".replace("seven", "seven-resins"),
        "labels.csv",
        "labels.md",
        "tray.svg",
        "manifest.json",
        *(f"stl/{label}-membrane.stl" for label in labels),
    }
    manifest = json.loads((folder / "manifest.json").read_text())
    for name, said in manifest["files"].items():
        assert hashlib.sha256((folder / name).read_bytes()).hexdigest() == said["sha256"]


def test_the_same_tray_gives_the_same_bytes(seven, folder, library, tmp_path):
    again = Path(write_tray(lay(order_of_file(EXAMPLE), library), tmp_path / "again").folder)
    assert content(again) == content(folder)


@pytest.mark.slow
@pytest.mark.parametrize("which", ["seven", "seats"])
def test_stl_and_3mf_are_closed_apart_positive_and_the_same(which, request):
    laid, where = (request.getfixturevalue("seven"), request.getfixturevalue("folder"))
    if which == "seats":
        laid, where = request.getfixturevalue("seats")
    (path,) = where.glob("*.3mf")
    model, reader = read_strictly(path)
    assert reader.GetWarningCount() == 0
    scene = placed_boxes(path)
    boxes = {}
    for part in laid.parts:
        meshes = [trimesh.load_mesh(where / f"stl/{body.name}.stl") for body in part.bodies]
        assert all(mesh.is_watertight and mesh.is_winding_consistent for mesh in meshes)
        low = np.min([mesh.bounds[0] for mesh in meshes], axis=0)
        high = np.max([mesh.bounds[1] for mesh in meshes], axis=0)
        assert low.min() >= 0.0
        assert low[2] == 0.0
        room, margin = laid.printer.envelope_mm, laid.order.tray.tray.margin_mm
        assert (low[:2] >= margin - 1e-4).all()
        assert (high <= [room.x - margin + 1e-4, room.y - margin + 1e-4, room.z]).all()
        boxes[part.name] = (low, high)
        assert np.allclose(scene[part.name], (low, high), atol=1e-3)
        for mesh, body in zip(meshes, part.bodies, strict=True):
            assert mesh.volume == pytest.approx(body.volume, rel=1e-5)
    names = list(boxes)
    for k, one in enumerate(names):
        for other in names[:k]:
            apart = np.maximum(boxes[one][0] - boxes[other][1], boxes[other][0] - boxes[one][1])[:2].max()
            assert apart >= laid.order.tray.tray.spacing_mm - 1e-3
    items = model.GetBuildItems()
    assert items.Count() == len(laid.parts)


def placed_boxes(path):
    """Part number to the box of its item, from the XML alone."""
    with zipfile.ZipFile(path) as archive:
        root = ElementTree.fromstring(archive.read(MODEL))
    objects = {thing.get("id"): thing for thing in root.iter(f"{SPACE}object")}

    def vertices(thing):
        parts = [objects[c.get("objectid")] for c in thing.iter(f"{SPACE}component")] or [thing]
        return np.array([[float(v.get(k)) for k in "xyz"] for part in parts for v in part.iter(f"{SPACE}vertex")])

    found = {}
    for item in root.iter(f"{SPACE}item"):
        matrix = np.array([float(x) for x in item.get("transform", "1 0 0 0 1 0 0 0 1 0 0 0").split()]).reshape(4, 3)
        points = vertices(objects[item.get("objectid")]) @ matrix[:3] + matrix[3]
        found[item.get("partnumber")] = (points.min(axis=0), points.max(axis=0))
    return found


def test_the_3mf_gives_every_part_its_material_and_every_uuid_once(folder):
    (path,) = folder.glob("*.3mf")
    with zipfile.ZipFile(path) as archive:
        text = archive.read(MODEL)
    root = ElementTree.fromstring(text)
    bases = [base.get("name") for base in root.iter(f"{SPACE}base")]
    assert len(bases) == len(set(bases)) == 7
    objects = {thing.get("name"): thing for thing in root.iter(f"{SPACE}object")}
    assert len(objects) == 21
    for name, thing in objects.items():
        assert bases[int(thing.get("pindex"))].startswith(RESINS["ABCDEFG".index(name[0])])
    uuids = [value for thing in root.iter() for key, value in thing.attrib.items() if key.endswith("}UUID")]
    assert len(uuids) == len(set(uuids)) == 21 + 21 + 1


def test_copies_without_marks_share_their_mesh(library, tmp_path):
    laid = flags(library, ["paper-dome"], ["membrane.material=TangoPlus,FLX9940"], 4, marks="none")
    where = Path(write_tray(laid, tmp_path / "plain").folder)
    model, _ = read_strictly(next(where.glob("*.3mf")))
    assert model.GetMeshObjects().Count() == 2
    assert model.GetBuildItems().Count() == 8
    assert {row["mark"] for row in table(where)} == {"none"}


def test_the_list_agrees_with_the_parts(seven, folder):
    rows = table(folder)
    for row, part in zip(rows, seven.parts, strict=True):
        (body,) = part.on_tray()
        low, high = body.bounds
        middle = 0.5 * (low + high)
        assert (float(row["x_mm"]), float(row["y_mm"])) == pytest.approx(tuple(middle[:2]), abs=2e-3)
        density = part.solids[0].material.density_g_per_cm3.nominal
        assert float(row["mass_g"]) == pytest.approx(body.volume * density * 1e-3, abs=1e-3)
        assert (row["label"], row["value"]) == (part.label, part.value.value)
    assert "counter-clockwise from the longest stroke" in (folder / "labels.md").read_text()


def test_the_view_names_every_part(folder):
    """Text is drawn as outlines: parts are found by their ids, other text by its comment."""
    text = (folder / "tray.svg").read_text()
    ElementTree.fromstring(text)
    assert all(f'id="{letter}{copy}-membrane"' in text for letter in "ABCDEFG" for copy in (1, 2, 3))
    assert all(f"<!-- {words} -->" in text for words in ("x, mm", "y, mm", "FLX9940-DM"))
