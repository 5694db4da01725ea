"""Pads from `new` to the folder: sizes that fit the pitch, findings, files, and cells as sensors of their own."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pneutouch.catalogue import Library
from pneutouch.errors import InputError
from pneutouch.evaluation import evaluate
from pneutouch.export.threemf_read import read_threemf
from pneutouch.output.new_pad import new_pad
from pneutouch.parts.pad.solids import line_volume
from pneutouch.units import ML
from pneutouch.workflows.pad.build_pad import build_pad
from pneutouch.workflows.pad.findings import pad_findings, widest
from pneutouch.workflows.pad.load import load_pad
from pneutouch.workflows.pad.pad_sheet import pad_record, sheet


@pytest.fixture
def home(tmp_path, monkeypatch):
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path))
    return tmp_path


def started(home, layout="ring:7", pitch=6.0, **more):
    new_pad("tip", home / "designs", layout, pitch, **more)
    return load_pad("tip")


@pytest.mark.parametrize("process", ["polyjet", "filament", "resin"])
def test_a_new_pad_breaks_no_rule(home, process):
    pad = started(home, "grid:2x2", 14.0, process=process)
    assert not [one for one in pad_findings(pad) if one.severity == "error"]


@pytest.mark.parametrize("shape", ["cap", "disc", "torus"])
def test_a_new_cell_of_another_shape_has_sizes_for_the_pitch(home, shape):
    pad = started(home, "row:3", 24.0, shape=shape)
    assert pad.scene.design.membrane.shape == shape
    assert 2.0 * pad.layout.cell.outer_radius < 24.0
    assert not [one for one in pad_findings(pad) if one.severity == "error" and one.rule != "driving"]


@pytest.mark.slow
@settings(max_examples=15, deadline=None)
@given(layout=st.sampled_from(["ring:4", "row:3", "hex:7", "grid:2x3"]), pitch=st.floats(6.0, 30.0))
def test_a_new_pad_of_any_pitch_breaks_no_rule(tmp_path_factory, layout, pitch):
    folder = tmp_path_factory.mktemp("pads")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PNEUTOUCH_HOME", str(folder))
        pad = started(folder, layout, round(pitch, 2))
        assert not [one for one in pad_findings(pad) if one.severity == "error"]


def test_a_pitch_too_small_for_the_printer_says_which_is_not(home):
    with pytest.raises(InputError) as caught:
        started(home, pitch=3.0)
    assert caught.value.key == "pitch"
    least = float(str(caught.value.remedy).split("at least ")[1].split()[0])
    new_pad("tip", home / "designs", "ring:7", least)


def test_neither_pad_nor_cell_replaces_a_file(home):
    started(home)
    for left in ("pads/tip.toml", "tip-cell.toml"):
        other = home / "designs" / ("tip-cell.toml" if left.startswith("pads") else "pads/tip.toml")
        text = other.read_bytes()
        other.unlink()
        with pytest.raises(InputError):
            started(home)
        assert not other.exists()
        other.write_bytes(text)


def test_neighbours_that_meet_when_pressed_break_a_rule(home):
    started(home, "row:2", 17.0)
    changes = {"membrane.inner_radius_mm": 6.8}
    pad = load_pad("tip", changes)
    assert 2.0 * widest(pad)[0] > 17.0
    (found,) = [one for one in pad_findings(pad) if one.rule == "neighbours"]
    assert found.severity == "error" and found.excess.limit == pytest.approx(2.0 * widest(pad)[0])
    raised = load_pad("tip", changes | {"pad.pitch_mm": round(found.excess.limit + 0.1, 1)})
    assert not [one for one in pad_findings(raised) if one.rule == "neighbours"]


def test_a_cell_is_the_sensor_of_its_design_behind_its_own_channel(home):
    pad = started(home)
    alone = evaluate("tip-cell", {"pneumatics.dead_volume_mL": pad.dead_volumes_mL[3]}, clamp="flange")
    ours = pad.evaluations[pad.kinds[3]].prediction.states[1]
    assert np.array_equal(ours.force, alone.prediction.states[1].force)
    tube = np.pi * (0.5 * pad.scene.tube.inner_diameter) ** 2 * pad.scene.design.pneumatics.tube_length_mm
    assert pad.dead_volumes_mL[3] == pytest.approx((line_volume(pad.layout, 3) + tube) / ML, abs=1e-4)
    stated = load_pad("tip", {"pneumatics.dead_volume_mL": 0.5})
    assert stated.dead_volumes_mL == (0.5,) * 7


def test_a_built_pad_is_read_strictly_and_has_the_same_bytes_again(home, tmp_path):
    started(home)
    folder, _ = build_pad("tip", tmp_path / "one")
    again, _ = build_pad("tip", tmp_path / "two")
    files = sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
    assert [path.read_bytes() for path in map(folder.joinpath, files)] == [
        path.read_bytes() for path in map(again.joinpath, files)
    ]
    assert {body.name for body in read_threemf(folder / "tip.3mf").bodies} == {"membrane", "manifold"}
    record = json.loads((folder / "pad.json").read_text())
    assert [cell["number"] for cell in record["cells"]] == list(range(1, 8))
    assert record["pressed_diameter_mm"] < record["pitch_mm"] <= record["port_pitch_mm"]
    manifest = json.loads((folder / "manifest.json").read_text())
    for mesh in manifest["mesh"].values():
        assert mesh["volume_mm3"] == pytest.approx(mesh["exact_volume_mm3"], rel=1e-3)


def test_a_command_of_one_sensor_names_the_cell_of_a_pad(home):
    started(home)
    with pytest.raises(InputError) as caught:
        Library.default().design_file("tip")
    assert "tip-cell" in caught.value.remedy


def test_a_pad_without_its_cell_says_which_key_is_wrong(home):
    started(home)
    (home / "designs" / "tip-cell.toml").unlink()
    with pytest.raises(InputError) as caught:
        load_pad("tip")
    assert caught.value.key == "pad.cell" and caught.value.value == "tip-cell"


def test_a_pad_is_not_cast(home):
    with pytest.raises(InputError) as caught:
        started(home, process="casting")
    assert caught.value.key == "process"


GROUPS = [
    {"cells": [2, 5], "driving_pressure_kPa": 5.0},
    {"cells": [1], "assignments": ["membrane.inner_radius_mm=1.6"]},
]


def test_groups_have_pressures_and_domes_of_their_own(home, tmp_path):
    started(home)
    folder, _ = build_pad("tip", tmp_path, {"pad.groups": GROUPS})
    cells = json.loads((folder / "pad.json").read_text())["cells"]
    held = [[state["driving_pressure_kPa"] for state in cell["states"]] for cell in cells]
    assert held[1] == held[4] == [5.0] and held[0] == held[2] != [5.0]
    # A smaller dome moves less of as much gas behind it.
    assert cells[0]["states"][0]["sensitivity_kPa_per_N"] < cells[2]["states"][0]["sensitivity_kPa_per_N"]
    corners = load_pad("tip", {"pad.groups": GROUPS}).bodies[0].corners.reshape(-1, 3)
    lowest = corners[corners[:, 2] < corners[:, 2].min() + 1e-6, :2]
    assert np.hypot(*(lowest - cells[0]["place_mm"]).T).min() == pytest.approx(1.6, abs=0.02)


@pytest.mark.parametrize(
    ("group", "key", "words"),
    [
        ({"cells": [8]}, "groups", "1 to 7"),
        ({"cells": [2, 2]}, "groups", "each once"),
        ({"cells": list(range(1, 8))}, "groups", "leave out"),
        ({"cells": [2], "assignments": ["membrane.material=FLX9950"]}, "pad.groups", "of all cells"),
        ({"cells": [2], "assignments": ["pneumatics.driving_pressures_kPa=[5]"]}, "pad.groups[0]", "of all cells"),
        ({"cells": [2], "assignments": ["connector.port=luer-female"]}, "pad.groups", "of all cells"),
        ({"cells": [2], "assignments": ["membrane.inner_radius_mm"]}, "pad.groups[0]", "table.key=value"),
        ({"cells": [2], "assignments": ["membrane.inner_radius_mm=-1"]}, "pad.groups[0]", "membrane.inner_radius_mm"),
    ],
)
def test_a_group_that_cannot_be_is_refused(home, group, key, words):
    started(home)
    with pytest.raises(InputError) as caught:
        load_pad("tip", {"pad.groups": [group]})
    assert key in str(caught.value) and words in str(caught.value)


def test_the_sheet_tells_the_pressures_of_groups(home, tmp_path):
    """A thicker wall is rated for more, and its leak test fills it to what it holds."""
    started(home, "row:2", 14.0)
    group = {"cells": [2], "driving_pressure_kPa": 40.0, "assignments": ["membrane.wall_thickness_mm=2"]}
    pad = load_pad("tip", {"pad.groups": [group]})
    thin, thick = (cell.rating.pressure_kPa for cell in pad.worst)
    told = re.findall(r"([\d.]+) \(cells 2: ([\d.]+)\)", sheet(pad, pad_record(pad), [], (), "0", {}))
    (fill, own_fill), (rated, own) = ([float(number) for number in pair] for pair in told)
    assert [rated, own] == pytest.approx([thin, thick], rel=0.01) and thick > thin + 1.0
    assert own_fill == 40.0 and fill < thin


def test_a_group_beyond_the_limit_point_is_named(home):
    started(home, "row:2", 9.0)
    pad = load_pad("tip", {"pad.groups": [{"cells": [2], "driving_pressure_kPa": 500.0}]})
    with pytest.raises(InputError) as caught:
        pad_findings(pad)
    assert caught.value.file.endswith("tip.toml: pad.groups[0]")


def test_the_pitch_that_is_named_has_space_for_every_pair(home):
    started(home, "row:3", 9.0)
    groups = [{"cells": [1], "assignments": ["membrane.inner_radius_mm=6"]}]
    groups += [{"cells": [2], "assignments": ["membrane.inner_radius_mm=9"]}]
    with pytest.raises(InputError) as caught:
        _ = load_pad("tip", {"pad.groups": groups}).layout
    least = float(caught.value.remedy.split("at least ")[1].split()[0])
    assert load_pad("tip", {"pad.groups": groups, "pad.pitch_mm": least}).layout


def test_neighbours_of_different_groups_meet_by_the_sum_of_their_radii(home):
    started(home, "row:2", 17.0)
    pad = load_pad("tip", {"pad.groups": [{"cells": [2], "assignments": ["membrane.inner_radius_mm=7.2"]}]})
    (found,) = [one for one in pad_findings(pad) if one.rule == "neighbours"]
    assert found.excess.limit == pytest.approx(sum(widest(pad))) and widest(pad)[0] < widest(pad)[1]


def test_cells_that_meet_across_a_grid_name_the_pitch_at_which_they_do_not(home):
    started(home, "grid:2x2", 24.0)
    sizes = "membrane.inner_radius_mm=13.8", "membrane.wall_thickness_mm=2.4", "indentation.plate_diameter_mm=60"
    group = {"cells": [1, 4], "assignments": list(sizes)}
    changes = {"pad.groups": [group], "membrane.inner_radius_mm": 3.5, "membrane.wall_thickness_mm": 0.8}
    pad = load_pad("tip", changes)
    (found,) = [one for one in pad_findings(pad) if one.rule == "neighbours"]
    assert found.excess.limit == pytest.approx(2.0 * widest(pad)[1])
    named = float(re.search(r"pitch_mm to ([\d.]+)", found.fix)[1])
    assert named == pytest.approx(found.excess.limit / np.sqrt(2.0), abs=0.11)
