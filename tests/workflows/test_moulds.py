"""Files of a mould, and coupons of a material that is cast."""

from __future__ import annotations

import io
import json
import re
import zipfile
from pathlib import Path

import numpy as np
import pytest
import trimesh

from pneutouch.catalogue import load_scene
from pneutouch.parts.mould import mould_of
from pneutouch.report.mould import mould_rows, mould_section
from pneutouch.spec.read import parse_changes
from pneutouch.workflows.build import exploded, mould_files, mould_record
from pneutouch.workflows.coupons.make import build_coupons
from pneutouch.workflows.coupons.order import CouponOptions


@pytest.fixture(scope="module")
def mould(library):
    return mould_of(load_scene("cast-dome", parse_changes(["mould.cavities=2"]), library))


@pytest.fixture(scope="module")
def files(mould):
    return mould_files(mould)[0]


def test_each_part_is_a_closed_stl_on_its_plate(mould, files):
    for solid in mould.solids:
        mesh = trimesh.load(io.BytesIO(files[f"mould/{solid.name}.stl"]), file_type="stl")
        assert mesh.is_watertight
        assert mesh.volume == pytest.approx(solid.volume, rel=1e-3)
        assert mesh.bounds[0] == pytest.approx([0, 0, 0], abs=1e-5)


def test_the_cap_is_printed_with_its_pockets_up(mould):
    cap = next(body for body in mould.printed if body.name == "mould-cap").manifold()
    low, high = np.array(cap.bounding_box()).reshape(2, 3)
    x, y = -mould.bodies[0].bounds[0][0], mould.bodies[0].bounds[1][1]
    (hit, *_) = cap.ray_cast((x, y, high[2] + 1.0), (x, y, low[2] - 1.0))
    assert hit.position[2] == pytest.approx(mould.size.shape.wall, abs=mould.tolerance)


def test_the_plates_hold_every_part_as_often_as_it_is_made(mould, files):
    (name,) = [name for name in files if name.endswith(".3mf")]
    assert name == "mould/cast-dome-mould.3mf"
    assert mould.counts == {"mould-cap": 1, "mould-ring": 2, "mould-core": 2, "mould-base": 1}
    with zipfile.ZipFile(io.BytesIO(files[name])) as package:
        model = package.read("3D/3dmodel.model").decode()
    labels = re.findall(r'partnumber="([^"]+)"', model)
    assert sorted(labels) == ["mould-base", "mould-cap", "mould-core-1", "mould-core-2", "mould-ring-1", "mould-ring-2"]
    assert len(re.findall(r"<mesh>", model)) == len(mould.solids)
    assert {"mould/cast-dome-mould.glb", "mould/cast-dome-mould.svg"} < set(files)


def test_same_input_same_bytes(mould, files, library):
    again = mould_files(mould_of(load_scene("cast-dome", parse_changes(["mould.cavities=2"]), library)))[0]
    assert again == files


def test_the_exploded_view_keeps_parts_apart(mould):
    bodies = exploded(mould)
    assert len(bodies) == 6
    heights = {name: next(b.bounds[:, 2] for b in bodies if b.name.startswith(name)) for name in mould.counts}
    order = ["mould-base", "mould-core", "mould-ring", "mould-cap"]
    assert [heights[name][0] for name in order] == sorted(heights[name][0] for name in order)
    assert heights["mould-base"][1] < heights["mould-core"][0]


def test_the_record_and_the_sheet_state_what_to_weigh(mould):
    record, rows = mould_record(mould), dict(mould_rows(mould))
    assert sum(record.silicone.parts_g) == pytest.approx(record.silicone.mass_g, abs=2e-3)
    assert f"{record.silicone.mass_g:.1f} g" in rows["Silicone to mix"]
    assert record.parts["mould-core"] == 2 and "2 x core" in rows["Parts"]
    assert "M3" in rows["Closed by"]
    drawing = mould_section(mould)
    for word in ("cap", "ring", "core", "base", "silicone", "vents", "pour channel"):
        assert word in drawing


def test_coupons_of_a_cast_material_are_open_moulds(tmp_path, library):
    options = CouponOptions(profile="silicone-casting", materials=["DragonSkin20"])
    folder = Path(build_coupons(options, tmp_path, library).folder)
    coupons = json.loads((folder / "manifest.json").read_text())["coupons"]
    assert {(each["coupon"], each["printer"], each["material"]) for each in coupons} == {
        ("puck", "abs-filament", "ABS"),
        ("dumbbell", "abs-filament", "ABS"),
    }
    sheet = (folder / "measure.md").read_text()
    assert "open moulds" in sheet and "Print flat" not in sheet and "strike it off" in sheet
    assert "[puck.DragonSkin20]" in (folder / "results.toml").read_text()
