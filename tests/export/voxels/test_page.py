"""What docs/background/voxels.md states is what the code gives today; times are left alone."""

from __future__ import annotations

import json

import pytest
from benchmarks import voxels as dither
from benchmarks.voxels import CONTAINED, OURS, SLICED, TRIMESH, boundary, exact

from pneutouch.body.section import SolidSection
from pneutouch.catalogue import load_scene
from pneutouch.export.voxels.raster import raster
from pneutouch.parts import assemble
from tests.conftest import ROOT


@pytest.fixture(scope="module")
def stored():
    return json.loads((ROOT / "docs/background/voxels.json").read_text())


@pytest.mark.parametrize("fraction", [0.1, 0.5])
@pytest.mark.parametrize("method", ["blue noise", "white noise"])
def test_stored_dithers_are_today(stored, method, fraction):
    row = next(row for row in stored["dithers"] if (row["method"], row["fraction"]) == (method, fraction))
    block = dither.METHODS[method](fraction)
    assert dither.worst_cube(block, fraction) == pytest.approx(row["cube"], rel=1e-9)
    frequency, power = dither.spectrum(block)
    assert power[frequency < 1 / dither.COARSE].mean() == pytest.approx(row["clumps"], rel=1e-6)


def test_blue_noise_is_evener_than_the_others(stored):
    """Fewer clumps and a smaller greatest wave at every fraction; a truer cube where droplets are not rare."""
    for fraction in dither.FRACTIONS:
        rows = {row["method"]: row for row in stored["dithers"] if row["fraction"] == fraction}
        for key in ("clumps", "peak", *(["cube"] if 0.1 <= fraction <= 0.9 else [])):
            assert rows["blue noise"][key] < min(rows["error diffusion"][key], rows["white noise"][key])
        assert rows["blue noise"]["cube"] <= 0.005


def test_stored_rasters_are_today_and_ours_is_nearest(stored, library):
    solid = assemble(load_scene("graded-dome", None, library)).solids[0]
    rows = {(row["method"], row["layer_um"], row["coarser"]): row for row in stored["rasters"]}
    row = rows[OURS, 27.0, 4.0]
    grid = raster([SolidSection(solid)], (600, 300), 27.0, coarser=4.0)
    box = exact(solid, grid)
    assert int(box.sum()) == row["voxels"]
    mean, most = boundary(box, (grid.x, grid.y, grid.z), solid)
    assert (mean, most) == pytest.approx((row["mean"], row["most"]), rel=1e-6)
    for coarser in (2.0, 4.0, 8.0):
        assert rows[OURS, 27.0, coarser]["mean"] <= 1.01 * rows[CONTAINED, 27.0, coarser]["mean"]
        assert rows[OURS, 27.0, coarser]["seconds"] < rows[SLICED, 27.0, coarser]["seconds"]
    assert any(row["method"] == TRIMESH for row in stored["rasters"])


def test_the_whole_dome_kept_its_limits(stored):
    fast = next(row for row in stored["stacks"] if row["mode"] == "High Mix")
    assert fast["seconds"] < 30
    assert fast["peak_MB"] < 300
    for row in stored["stacks"]:
        membrane = row["bodies"]["membrane"]
        assert membrane["worst_cube"] < 0.005
        assert abs(membrane["fraction_realised"] - membrane["fraction_requested"]) < 1e-3
        for body in row["bodies"].values():
            assert body["volume_mm3"] == pytest.approx(body["exact_volume_mm3"], rel=0.003)
