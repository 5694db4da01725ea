"""Selections, sweeps, comparisons and listings: those of the command line, as objects."""

from __future__ import annotations

import pytest
import xarray

import pneutouch as pt


def test_a_selection_is_the_command_lines_and_its_designs_meet_the_target(printed):
    found = pt.select(sensitivity_kPa_per_N=1.9, driving_pressure_kPa=12, base="paper-dome")
    said = printed("select", "--sensitivity", 1.9, "--at", 12, "--base", "paper-dome")
    assert found.to_dict() == {key: value for key, value in said.items() if key != "written"}
    assert found.met and len(found.designs) == len(said["designs"])
    first = found.designs[0]
    assert first.material == said["designs"][0]["material"]
    assert first.predict(model="atlas").at(12).sensitivity_kPa_per_N == pytest.approx(1.9, rel=0.05)


def test_a_target_file_is_taken_and_keywords_come_first(tmp_path):
    (tmp_path / "target.toml").write_text("[target]\nsensitivity_kPa_per_N = 1.9\n")
    found = pt.select(tmp_path / "target.toml", sensitivity_kPa_per_N=900.0)
    assert found.to_dict()["target"]["target"]["sensitivity_kPa_per_N"] == 900.0
    assert not found.met and found.designs == ()


@pytest.mark.parametrize(
    ("fields", "key"), [({"sensitivity": 1.9}, "sensitivity"), ({"force_range_N": -1.0}, "force_range_N")]
)
def test_errors_of_a_target_name_the_keyword(fields, key):
    with pytest.raises(pt.InputError) as caught:
        pt.select(**fields)
    assert (caught.value.file, caught.value.key) == (None, key)


def test_a_sweep_is_the_command_lines_dataset(printed, tmp_path):
    design = pt.load("paper-dome")
    ours = pt.sweep(
        design, wall_thickness_mm=[1, 1.2], material=["TangoPlus", "FLX9950"], tube_length_mm=200, model="membrane"
    )
    words = ("--over", "membrane.wall_thickness_mm=1,1.2", "--over", "membrane.material=TangoPlus,FLX9950")
    more = ("--set", "pneumatics.tube_length_mm=200", "--model", "membrane", "--workers", 1, "--out", tmp_path / "s.nc")
    printed("sweep", "--design", "paper-dome", *words, *more)
    xarray.testing.assert_identical(ours, xarray.load_dataset(tmp_path / "s.nc", engine="scipy"))
    one = design.replace(wall_thickness_mm=1.2, material="FLX9950", tube_length_mm=200).predict(model="membrane")
    place = {"membrane_wall_thickness_mm": 1.2, "membrane_material": "FLX9950", "driving_pressure_kPa": 12}
    assert float(ours["sensitivity_kPa_per_N"].sel(place)) == one.at(12).sensitivity_kPa_per_N


def test_a_sweep_takes_ranges_and_designs_without_a_file():
    found = pt.sweep(pt.Design(inner_radius_mm=6), wall_thickness_mm={"from": 1, "to": 2, "count": 3}, model="membrane")
    assert found["membrane_wall_thickness_mm"].values.tolist() == [1, 1.5, 2]


def test_a_comparison_lists_what_differs_and_the_figures_of_each():
    design = pt.load("paper-dome")
    thick = design.replace(name="thick", wall_thickness_mm=2.0)
    found = pt.compare(design, thick, driving_pressures_kPa=[0, 12], model="atlas")
    assert found.inputs == {"wall_thickness_mm": (1.5, 2.0)}
    frame = found.to_frame()
    for k, own in enumerate((design, thick), start=1):
        state = own.predict([0, 12], model="atlas").at(12)
        assert frame.loc["sensitivity_kPa_per_N", (12, f"{k}: {own.name}")] == state.sensitivity_kPa_per_N
    assert pt.compare("paper-dome", "paper-dome", model="membrane").inputs == {}


def test_listings_are_the_command_lines(printed):
    for kind in ("designs", "materials", "printers"):
        assert getattr(pt, kind)() == {entry["name"]: entry["title"] for entry in printed("list", kind)[kind]}
