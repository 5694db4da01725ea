"""Selections, sweeps, comparisons and listings: those of the command line, as objects."""

from __future__ import annotations

from dataclasses import replace

import pytest
import xarray

import pneutouch as pt
from pneutouch.api.search import unmet_lines
from pneutouch.results.selection import FoundGrade, GradedRecord, SearchCost


@pytest.mark.slow
def test_a_selection_is_the_command_lines_and_its_designs_meet_the_target(printed):
    found = pt.select(sensitivity_kPa_per_N=1.9, driving_pressure_kPa=12, base="paper-dome")
    said = printed("select", "--sensitivity", 1.9, "--at", 12, "--base", "paper-dome")
    assert found.to_dict() == {key: value for key, value in said.items() if key != "written"}
    assert found.met and len(found.designs) == len(said["designs"])
    first = found.designs[0]
    assert first.material == said["designs"][0]["material"]
    assert first.predict(model="atlas").at(12).sensitivity_kPa_per_N == pytest.approx(1.9, rel=0.05)


@pytest.mark.slow
def test_a_target_file_is_taken_and_keywords_come_first(tmp_path):
    (tmp_path / "target.toml").write_text("[target]\nsensitivity_kPa_per_N = 1.9\n")
    found = pt.select(tmp_path / "target.toml", sensitivity_kPa_per_N=900.0)
    assert found.to_dict()["target"]["target"]["sensitivity_kPa_per_N"] == 900.0
    assert not found.met and found.designs == ()


@pytest.mark.slow
def test_the_best_of_each_process_is_a_design_named_after_it(printed):
    given = {"inner_radius_mm": 9.25, "wall_thickness_mm": 1.5, "materials": ["TangoPlus", "DragonSkin20"]}
    found = pt.select(sensitivity_kPa_per_N=1.9, processes=["polyjet", "casting"], **given)
    words = "--inner-radius 9.25 --wall 1.5 --material TangoPlus,DragonSkin20 --process polyjet,casting"
    said = printed("select", "--sensitivity", 1.9, *words.split())
    assert found.to_dict() == {key: value for key, value in said.items() if key != "written"}
    assert [design.name for design in found.designs] == ["selected-polyjet", "selected-casting"]
    assert [design.material for design in found.designs] == ["TangoPlus", "DragonSkin20"]
    for design, process in zip(found.designs, ("polyjet", "casting"), strict=True):
        assert design.profile == said["processes"][process]["profile"]
    with pytest.raises(pt.InputError) as caught:
        pt.select(sensitivity_kPa_per_N=1.9, processes=["cast"])
    assert (caught.value.file, caught.value.key) == (None, "processes[0]")


@pytest.mark.parametrize(
    ("fields", "key"), [({"sensitivity": 1.9}, "sensitivity"), ({"force_range_N": -1.0}, "force_range_N")]
)
def test_errors_of_a_target_name_the_keyword(fields, key):
    with pytest.raises(pt.InputError) as caught:
        pt.select(**fields)
    assert (caught.value.file, caught.value.key) == (None, key)


@pytest.mark.slow
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
    assert found.labels == ("paper-dome", "thick")
    frame = found.to_frame()
    for own in (design, thick):
        state = own.predict([0, 12], model="atlas").at(12)
        row = frame.loc[(12, "sensitivity_kPa_per_N")]
        assert row[own.name, "value"] == pytest.approx(state.sensitivity_kPa_per_N, rel=1e-5)
        assert row[own.name, "low"] == pytest.approx(state.sensitivity.interval[0], rel=1e-5)
    assert frame.loc[(None, "limit_pressure_kPa")][("thick", "exceeds")] is True
    assert found.to_dict()["inputs"] == {"membrane.wall_thickness_mm": [1.5, 2.0]}


def test_a_comparison_shows_names_that_differ_and_a_figure_shows_itself():
    design = pt.Design(inner_radius_mm=6)
    found = pt.compare(design, design.replace(wall_thickness_mm=1.2), model="membrane")
    assert found.labels == ("design (1)", "design (2)")
    assert "<th>design (1)</th><th>design (2)</th>" in found._repr_html_()
    figure = design.predict([0], model="atlas").at(0).sensitivity
    assert f"<td>{figure.value:.4g}</td>" in figure._repr_html_() and "kPa/N" in figure._repr_html_()
    with pytest.raises(pt.InputError, match="paper-dome is given twice"):
        pt.compare("paper-dome", "paper-dome", model="membrane")


def test_listings_are_the_command_lines(printed):
    for kind in ("designs", "materials", "printers", "gauges"):
        assert getattr(pt, kind)() == {entry["name"]: entry["title"] for entry in printed("list", kind)[kind]}


def test_a_misspelt_table_of_a_target_file_is_named_first(tmp_path):
    path = tmp_path / "misspelt.toml"
    path.write_text("[targets]\nsensitivity_kPa_per_N = 1.9\n")
    with pytest.raises(pt.InputError, match="Did you mean target") as caught:
        pt.select(path)
    assert (caught.value.file, caught.value.key) == (str(path), "targets")


@pytest.mark.slow
def test_a_design_is_a_base_as_its_file_is(tmp_path):
    asked = {"sensitivity_kPa_per_N": 1.9, "driving_pressure_kPa": 12}
    base = pt.load("paper-dome").replace("mine", tube_length_mm=90, plate_diameter_mm=40)
    file = base.save(tmp_path / "mine.toml")
    by_object, by_file = pt.select(**asked, base=base), pt.select(**asked, base=str(file))
    ours, theirs = by_object.to_dict(), by_file.to_dict()
    assert (ours.pop("base"), theirs.pop("base")) == ("mine", str(file))
    assert ours.pop("target")["setting"]["base"] == "mine" and theirs.pop("target")["setting"]["base"] == str(file)
    assert ours == theirs and ours["met"]
    assert by_object.designs == by_file.designs
    assert by_object.designs[0].tube_length_mm == 90
    assert pt.select(**asked, setting={"base": base}).designs == by_file.designs


def test_an_error_on_a_base_given_as_an_object_names_the_key_and_no_file():
    base = pt.Design("leaning", offset_mm=2.0)
    with pytest.raises(pt.InputError, match="central") as caught:
        pt.select(sensitivity_kPa_per_N=1.9, base=base)
    assert (caught.value.file, caught.value.key, caught.value.value) == (None, "contact.offset_mm", 2.0)


@pytest.mark.parametrize("target", [{"sensitivity_kPa_per_N": 1.9}, 5, pt.Design()])
def test_a_target_that_is_no_path_is_refused(target):
    with pytest.raises(pt.InputError, match="must be a path; give the path of a target file") as caught:
        pt.select(target)
    assert (caught.value.key, caught.value.value) == ("target", target)


@pytest.mark.slow
def test_one_resin_is_a_list_of_one():
    asked = {"sensitivity_kPa_per_N": 1.9, "driving_pressure_kPa": 12}
    one, listed = pt.select(**asked, materials="TangoPlus"), pt.select(**asked, materials=["TangoPlus"])
    assert one.to_dict() == listed.to_dict() and one.met


@pytest.mark.slow
def test_a_selection_without_a_design_shows_what_to_drop():
    found = pt.select(sensitivity_kPa_per_N=1.9, force_range_N=150, max_diameter_mm=25)
    said, lines = found.to_dict(), repr(found).splitlines()
    assert lines[0] == "Selection: 0 designs meet the target"
    assert lines[1].startswith(f"  nearest: {said['nearest']['material']}, R0 ")
    assert all(name in lines[1] for name in said["nearest"]["misses_percent"])
    assert lines[2:] == [
        f"  drop the requirement on {each['requirement']}: {each['attainable']}"
        for each in said["dropped_requirements"]
    ]
    assert len(lines) > 2


def test_a_grade_that_misses_shows_by_how_much_and_why():
    used = {"sensitivity": 1.25, "force range": 0.4}
    best = FoundGrade(
        driving_pressures_kPa=(),
        sensitivity_kPa_per_N=(),
        difference_percent=None,
        force_range_end_N=(),
        range_ends_with=(),
        rated_pressure_kPa=None,
        above_rated_pressure=False,
        meets=False,
        reason=None,
        material={},
        inner_radius_mm=9.25,
        wall_thickness_mm=1.5,
        dead_volume_mL=0.0,
        share_used=used,
        passes_check=None,
        set=(),
    )
    record = GradedRecord(
        target={},
        base="x",
        met=False,
        design=best,
        rejected=None,
        constant=(),
        nearest_constant_mix="x",
        cost=SearchCost(0, 0),
        model="solid",
        left_out={},
    )
    assert unmet_lines(record) == ["nearest grade: beyond what is allowed: sensitivity by 25 %"]
    assert unmet_lines(replace(record, rejected="it does not fit")) == ["rejected: it does not fit"]
    unsolved = replace(record, design=replace(best, reason="no figures"))
    assert unmet_lines(unsolved) == ["nearest grade: no figures"]


@pytest.mark.parametrize(
    ("key", "value"),
    [("base", "paper-dom"), ("fits", "finger:200"), ("materials", "Tango"), ("profile", "connex"), ("gauge", "none")],
)
def test_errors_of_what_a_selection_names_have_the_keyword_and_no_file(key, value):
    with pytest.raises(pt.InputError) as caught:
        pt.select(sensitivity_kPa_per_N=1.9, **{key: value})
    assert (caught.value.file, caught.value.key, caught.value.value) == (None, key, value)
