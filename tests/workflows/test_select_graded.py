"""``select --graded`` and ``--mix`` as a user meets them."""

from __future__ import annotations

import json
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

import pneutouch as pt
from pneutouch.catalogue import Library
from pneutouch.cli.app import app
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.selection.graded import cost
from pneutouch.spec.target import Target
from pneutouch.spec.toml_text import toml_text
from pneutouch.workflows.select.document import graded
from pneutouch.workflows.select.graded import select_graded
from pneutouch.workflows.select.search import FoundChoice
from tests.conftest import ROOT

FLAT = [
    "select",
    "--graded",
    "--sensitivity",
    "1.9",
    "--tolerance",
    "2%",
    "--same-at",
    "0,22",
    "--wall",
    "1.2",
    "--profile",
    "j735",
    "--base",
    "paper-dome",
]
"""The command of docs/background/graded.md."""


def run(*arguments: str):
    return CliRunner().invoke(app, list(arguments))


@pytest.fixture(scope="module")
def shallow(tmp_path_factory):
    """The paper's sensor pressed to 4 mm alone, before its wall buckles: quickly solved."""
    path = tmp_path_factory.mktemp("base") / "shallow.toml"
    text = (ROOT / "designs" / "paper-dome.toml").read_text(encoding="utf-8")
    path.write_text(text.replace("[indentation]", "[indentation]\ndepth_mm = 4\nsteps = 6"), encoding="utf-8")
    return str(path)


@pytest.fixture(scope="module")
def short(shallow):
    """Few trials for a wish that is easily met."""
    content = {
        "target": {
            "sensitivity_kPa_per_N": 1.9,
            "same_sensitivity_at_kPa": [0.0, 22.0],
            "tolerance_percent": 25.0,
            "same_within_percent": 8.0,
        },
        "given": {"graded": True, "wall_thickness_mm": 1.2},
        "setting": {"base": shallow, "profile": "j735"},
    }
    return select_graded(Target.model_validate(content), "test", trials=4)


@pytest.mark.slow
def test_a_grade_is_set_beside_every_resin_and_the_nearest_mix_of_its_size(short, shallow):
    names = [constant.name for constant in short.constants]
    papers = ["FLX9940", "FLX9950", "FLX9960", "FLX9970", "FLX9985", "FLX9995"]
    assert names[:-1] == ["TangoPlus", "Agilus30", *papers]
    assert short.nearest.fraction is not None
    assert "NinjaFlex" in short.left_out and set(short.left_out.values()) == {"the Stratasys J735 cannot run it"}
    assert short.solves == len(short.search.trials) + 9
    plain = evaluate(shallow, {"membrane.material": "FLX9960", "membrane.wall_thickness_mm": 1.2}).prediction.states
    listed = next(constant.trial for constant in short.constants if constant.name == "FLX9960")
    assert listed.sensitivity[0] == pytest.approx(plain[0].figures.sensitivity, rel=1e-9)
    assert listed.sensitivity[1] == pytest.approx(plain[-1].figures.sensitivity, rel=1e-6)


@pytest.mark.slow
def test_the_nearest_mix_is_nearer_than_the_resins(short):
    least = min(cost(short.grade_target, constant.trial) for constant in short.constants[:-1])
    assert cost(short.grade_target, short.nearest.trial) <= least + 0.03


@pytest.mark.slow
def test_the_written_grade_is_the_one_found(short, tmp_path):
    path = FoundChoice("1", short.base, short.assignments()).write("flat", tmp_path)
    material = tomllib.loads(path.read_text(encoding="utf-8"))["membrane"]["material"]
    best = short.search.best
    assert material == {"from": "TangoPlus", "to": "VeroClear", "fraction": [best.pole, best.rim]}
    states = evaluate(str(path)).prediction.states
    assert [s.figures.sensitivity for s in states] == pytest.approx(list(best.sensitivity), rel=1e-9)


@pytest.mark.slow
def test_the_same_sensitivity_at_two_pressures_that_no_constant_membrane_has(tmp_path):
    result = run(*FLAT, "--json", "--write", "flat", "--out", str(tmp_path))
    assert result.exit_code == 0
    said = json.loads(result.stdout)
    low, high = said["design"]["sensitivity_kPa_per_N"]
    assert abs(high / low - 1) <= 0.02
    assert max(abs(low / 1.9 - 1), abs(high / 1.9 - 1)) <= 0.02
    assert not any(constant["meets"] for constant in said["constant"])
    assert said["cost"]["solid_solves"] <= 60
    states = evaluate(said["written"]).prediction.states
    assert [s.figures.sensitivity for s in states] == pytest.approx([low, high], rel=1e-9)


WIDEST = {
    "target": {"sensitivity_kPa_per_N": 1.9, "tolerance_percent": 2.0, "widest_range": True},
    "given": {"graded": True, "wall_thickness_mm": 1.5},
    "setting": {"base": "paper-dome", "profile": "j735"},
}
"""The third command of docs/background/graded.md."""


@pytest.mark.slow
def test_a_grade_widens_the_force_range_at_a_sensitivity():
    found = select_graded(Target.model_validate(WIDEST), "test")
    assert found.search.met
    assert found.search.best.reach > 1.01 * found.nearest.trial.reach
    assert found.meets(found.nearest.trial)


@pytest.mark.slow
def test_a_grade_widens_the_force_range_more_where_more_of_the_stiff_resin_may_be_used(tmp_path, library):
    """By the softer curve alone, as of a laboratory that measured it, a grade may go to 67 %."""
    found = select_graded(Target.model_validate(WIDEST), "test", library=measured_softer(library, tmp_path))
    assert found.search.met
    assert found.search.best.reach > 1.01 * found.nearest.trial.reach
    assert found.meets(found.nearest.trial)


def measured_softer(library: Library, folder: Path) -> Library:
    """The library with the softer mixing curve in front of the shipped ones."""
    shipped = library.load("mixing", "TangoPlus+VeroClear")
    content = shipped.model_dump(mode="json", exclude_none=True)
    content.pop("curves")
    for point in content["points"]:
        point["fraction"] = point.pop("fraction_high", point["fraction"])
        point.pop("fraction_low", None)
    path = folder / "printprofiles/mixing/TangoPlus+VeroClear.toml"
    path.parent.mkdir(parents=True)
    path.write_text(toml_text(content), encoding="utf-8")
    return Library((folder, *library.folders))


def test_an_unreachable_target_exits_1_with_the_nearest_and_why(shallow, monkeypatch):
    monkeypatch.setattr("pneutouch.workflows.select.graded._TRIALS", 3)
    monkeypatch.setattr("pneutouch.workflows.select.graded._catalogue", lambda *_: ([], {}))
    flags = [*FLAT[:3], "9", *FLAT[4:-1], shallow]
    result = run(*flags)
    assert result.exit_code == 1
    assert "no grade of this size meets the target; the nearest" in result.stdout
    assert "kPa/N instead of 9 within 2 %" in result.stdout
    assert "all grades tried of this size have" in result.stdout
    assert "solid solves in" in result.stderr


@pytest.mark.parametrize(
    ("flags", "said"),
    [
        (["--graded", "--sensitivity", "1.9"], "given.graded needs target.same_sensitivity_at_kPa"),
        (["--sensitivity", "1.9", "--same-at", "0,22"], "given.graded = true"),
        (["--graded", "--same-at", "0,22", "--force-range", "9"], "needs sensitivity_kPa_per_N"),
        (["--graded", "--sensitivity", "1.9", "--same-at", "22,0"], "two rising driving pressures"),
        (["--graded", "--sensitivity", "1.9", "--same-at", "some"], "--same-at some"),
        (["--graded", "--sensitivity", "1.9", "--same-at", "0,22", "--at", "5"], "contradict each other"),
        (
            ["--graded", "--sensitivity", "1.9", "--same-at", "0,22", "--material", "FLX9940"],
            "materials and a mix contradict",
        ),
        (
            ["--graded", "--sensitivity", "1.9", "--same-at", "0,22", "--pick", "2"],
            "--pick cannot be given with --graded",
        ),
        (
            ["--graded", "--sensitivity", "1.9", "--same-at", "0,22", "--profile", "abs-filament"],
            "the ABS filament printer, 0.4 mm nozzle cannot mix TangoPlus with VeroClear",
        ),
        (["--sensitivity", "1.9", "--mix", "TangoPlus"], "--mix TangoPlus: must be SOFT+STIFF"),
        (["--sensitivity", "1.9", "--mix", "TangoPlus+Vero"], "TangoPlus+Vero"),
        (
            ["--graded", "--sensitivity", "1.9", "--same-at", "0,22", "--wall", "0.2", "--profile", "j735"],
            "error: --wall 0.2: the printer's least wall is 0.6 mm",
        ),
        (
            [
                "--graded",
                "--sensitivity",
                "1.9",
                "--same-at",
                "0,22",
                "--base",
                "paper-dome",
                "--wall",
                "1.5",
                "--max-diameter",
                "20",
                "--profile",
                "j735",
            ],
            "error: --max-diameter 20: a dome of inner radius 9.25 mm and wall 1.5 mm is 21.5 mm wide; give a smaller "
            "given.inner_radius_mm (--inner-radius)",
        ),
    ],
)
def test_bad_input_is_named(flags, said):
    result = run("select", *flags)
    assert result.exit_code == 2, result.output
    assert said in result.stderr
    assert "Traceback" not in result.output


def test_a_wall_that_nobody_gave_is_not_blamed_on_the_target(monkeypatch, tmp_path):
    """The atlas finds no wall here, and that of the base is thinner than the printer's least."""
    monkeypatch.setattr("pneutouch.workflows.select.graded.middle_wall", lambda *_: None)
    base = tmp_path / "thin.toml"
    base.write_text("[membrane]\nwall_thickness_mm = 0.5\n", encoding="utf-8")
    result = run(
        "select", "--graded", "--sensitivity", "1.9", "--same-at", "0,22", "--profile", "j735", "--base", str(base)
    )
    assert result.exit_code == 2, result.output
    assert (
        "the base's own wall is 0.5 mm; the printer's least wall is 0.6 mm; give given.wall_thickness_mm (--wall)"
        in (result.stderr)
    )
    assert "given.wall_thickness_mm = " not in result.stderr


def _rejected(short, monkeypatch):
    """The search of ``short``, whose grade `check` rejects."""
    found = replace(short, search=replace(short.search, met=True), rejected="plate: too small")
    monkeypatch.setattr("pneutouch.workflows.select.search.select_graded", lambda *_, **__: found)


@pytest.mark.slow
@pytest.mark.parametrize(("plate_mm", "passes", "said"), [(30, True, None), (4, None, "reaches the plate's edge")])
def test_a_grade_that_meets_the_target_is_judged_as_check_does(short, monkeypatch, plate_mm, passes, said):
    """A search that has met its target: its grade passes with the base's plate and not with one that digs in."""
    found = replace(short.search, met=True)
    for name, answer in (("grade_search", found), ("_catalogue", ([], {})), ("_nearest", short.nearest)):
        monkeypatch.setattr(f"pneutouch.workflows.select.graded.{name}", lambda *_, answer=answer: answer)
    plate = {"assignments": [f"indentation.plate_diameter_mm={plate_mm}"]}
    setting = short.target.setting.model_copy(update=plate)
    judged = graded(select_graded(short.target.model_copy(update={"setting": setting}), "test"))
    assert judged.met and judged.design.passes_check is passes
    assert judged.rejected is None if said is None else said in judged.rejected


@pytest.mark.slow
def test_a_rejected_grade_is_shown_and_neither_saved_nor_returned(short, monkeypatch, tmp_path):
    _rejected(short, monkeypatch)
    for more in ((), ("--write", "flat", "--out", str(tmp_path))):
        result = run(*FLAT, "--json", *more)
        assert result.exit_code == 1
        assert "the grade meets the target and is rejected by `check`: plate: too small" in result.stderr
        said = json.loads(result.stdout)
        assert (said["design"]["passes_check"], said["rejected"], said["written"]) == (None, "plate: too small", None)
    assert list(tmp_path.iterdir()) == []
    found = pt.select(sensitivity_kPa_per_N=1.9, same_sensitivity_at_kPa=[0, 22], graded=True, profile="j735")
    assert not found.met and found.designs == () and found.to_dict()["rejected"] == "plate: too small"


@pytest.mark.slow
def test_a_mix_chosen_is_written_as_one(tmp_path):
    flags = [
        "--sensitivity",
        "1.8",
        "--at",
        "12",
        "--inner-radius",
        "9.25",
        "--wall",
        "1.5",
        "--base",
        "paper-dome",
        "--profile",
        "j735",
    ]
    result = run("select", *flags, "--mix", "TangoPlus+VeroClear", "--write", "mine", "--out", str(tmp_path), "--json")
    assert result.exit_code == 0, result.output
    said = json.loads(result.stdout)
    material = tomllib.loads((tmp_path / "mine.toml").read_text(encoding="utf-8"))["membrane"]["material"]
    assert material == said["designs"][0]["mix"]
    assert isinstance(material["fraction"], float)
    state = evaluate(str(tmp_path / "mine.toml")).prediction.states[-1]
    assert state.figures.sensitivity == pytest.approx(1.8, rel=0.012)
