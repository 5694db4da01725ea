"""What is wrong with a sweep is said before any work starts, with file, key and value."""

from __future__ import annotations

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.catalogue import Library
from pneutouch.errors import InputError
from pneutouch.spec.tray import spread
from pneutouch.workflows.sweep import execute, plan_of_file, plan_of_flags, plan_of_grid, sweep, work
from pneutouch.workflows.sweep.execute import ComputeResources
from pneutouch.workflows.sweep.work import study
from tests.refusals import refused

BASE = 'design = "paper-dome"\nmodel = "membrane"\n'
WALL = '"membrane.wall_thickness_mm"'

BAD = {
    "unknown key": (
        f'{BASE}[grid]\n{WALL[:-4]}s_mm" = [1]',
        ["membrane.wall_thicknes", "unknown key", "Did you mean wall_thickness_mm?"],
    ),
    "unknown table": (
        f'{BASE}[grid]\n"membran.material" = ["TangoPlus"]',
        ["unknown table membran", "Did you mean membrane?"],
    ),
    "no table": (f"{BASE}[grid]\nwall = [1, 2]", ["wall", "write table.key"]),
    "out of bounds": (f"{BASE}[grid]\n{WALL} = [1, 60]", ["membrane.wall_thickness_mm = 60", "from 0.05 to 50 mm"]),
    "of another kind": (
        f'{BASE}[grid]\n{WALL} = [1, "thick"]',
        ['membrane.wall_thickness_mm = "thick"', "must be a number"],
    ),
    "fits no radius": (
        f'{BASE}[grid]\n{WALL} = [1, 12]\n"membrane.inner_radius_mm" = [5, 9.25]',
        ["wall_thickness_mm = 12", "no point of the sweep", "less than"],
    ),
    "no such resin": (
        f'{BASE}[grid]\n"membrane.material" = ["TangoPlus", "FLX9941"]',
        ['membrane.material = "FLX9941"', "Did you mean FLX9940?"],
    ),
    "rigid dome": (
        f'{BASE}[grid]\n"membrane.material" = ["TangoPlus", "VeroClear"]',
        ['membrane.material = "VeroClear"', "must be elastomer"],
    ),
    "no such printer": (
        f'{BASE}[grid]\n{WALL} = [1]\n[set]\n"print.profile" = "j736"',
        ['print.profile = "j736"', "Did you mean j735?"],
    ),
    "set and varied": (
        f"{BASE}[grid]\n{WALL} = [1]\n[set]\n{WALL} = 2",
        ["membrane.wall_thickness_mm = 2", "set for all points and varied too"],
    ),
    "pressures set and varied": (
        f'{BASE}[grid]\n"pneumatics.driving_pressures_kPa" = [1]\n[set]\n"pneumatics.driving_pressures_kPa" = [2]',
        ["driving_pressures_kPa", "varied too"],
    ),
    "grid and list": (f"{BASE}[grid]\n{WALL} = [1]\n[[point]]\n{WALL} = 1", ["either a grid or a list"]),
    "neither": (BASE, ["either a grid or a list"]),
    "twice": (
        f"{BASE}[grid]\n{WALL} = [1]\nmembrane.wall_thickness_mm = [2]",
        ["membrane.wall_thickness_mm is given twice"],
    ),
    "equal values": (f"{BASE}[grid]\n{WALL} = [1, 2, 1.0]", ["membrane.wall_thickness_mm[2] = 1.0", "once only"]),
    "empty axis": (f"{BASE}[grid]\n{WALL} = []", ["membrane.wall_thickness_mm = []", "1 to 10000 values"]),
    "one value": (f"{BASE}[grid]\n{WALL} = 1.5", ["membrane.wall_thickness_mm = 1.5", "must be a list"]),
    "infinite": (f"{BASE}[grid]\n{WALL} = [1, inf]", ["membrane.wall_thickness_mm[1] = inf", "finite number"]),
    "true": (f"{BASE}[grid]\n{WALL} = [true]", ["membrane.wall_thickness_mm[0] = true", "finite number"]),
    "no friction": (f'{BASE}[grid]\n"contact.friction" = [0, nan]', ["contact.friction[1] = nan", "finite number"]),
    "no flag": (f'{BASE}[grid]\n"contact.friction" = [true]', ["contact.friction[0] = true", "finite number"]),
    "infinite in a list": (
        f'{BASE}[grid]\n{WALL} = [1]\n[set]\n"contact.profile_mm" = [[0, 0], [4, inf]]',
        ["contact.profile_mm[1][1] = inf", "finite number"],
    ),
    "half a range": (f"{BASE}[grid]\n{WALL} = {{from = 1, to = 2}}", ["from, to and count"]),
    "range of one": (
        f"{BASE}[grid]\n{WALL} = {{from = 1, to = 2, count = 1}}",
        ["from 1 to 2 count 1", "from 2 to 10000"],
    ),
    "range of names": (f'{BASE}[grid]\n{WALL} = {{from = "a", to = 2, count = 3}}', ["finite numbers"]),
    "no range at all": (
        f"{BASE}[grid]\n{WALL} = {{from = 1, to = 1, count = 3}}",
        ["membrane.wall_thickness_mm[1] = 1", "once only"],
    ),
    "too many": (
        f'{BASE}[grid]\n{WALL} = {{from = 1, to = 2, count = 10000}}\n"membrane.inner_radius_mm" = {{from = 8, to = 9, count = 1001}}',
        ["10010000 points", "`yes` computes them all the same"],
    ),
    "bad point": (f"{BASE}[[point]]\n{WALL} = 1\n[[point]]\n{WALL} = 60", ["point[1]", "from 0.05 to 50 mm"]),
    "pressures out of bounds": (
        f'{BASE}[grid]\n{WALL} = [1]\n"pneumatics.driving_pressures_kPa" = [0, -105]',
        ["driving_pressures_kPa", "from -100 to 1000 kPa"],
    ),
    "title": (f'{BASE}[grid]\n"document.title" = ["a"]', ["document.title", "no prediction depends on it"]),
    "no design": (f"[grid]\n{WALL} = [1]", ["design: missing"]),
    "no such design": (f'design = "paper-doom"\n[grid]\n{WALL} = [1]', ["paper-doom", "Did you mean paper-dome?"]),
    "design missing beside": (f'design = "x.toml"\n[grid]\n{WALL} = [1]', ["x.toml: no such file"]),
    "design a list": (f"[[design]]\n{WALL} = [1]", ["design = [", "must be a name"]),
    "unknown model": (
        f'design = "paper-dome"\nmodel = "solit"\n[grid]\n{WALL} = [1]',
        ['model = "solit"', "Did you mean solid?"],
    ),
    "unknown clamp": (f'{BASE}clamp = "bases"\n[grid]\n{WALL} = [1]', ['clamp = "bases"', "Did you mean base?"]),
    "unknown word": (f"{BASE}grit = 1", ["grit: unknown key", "Did you mean grid?"]),
    "grid a number": (f"{BASE}grid = 1", ["grid = 1: must be a table"]),
    "points a table": (f"{BASE}[point]\n{WALL} = 1", ["point: must be a list of tables"]),
    "no TOML": ("design = ", ["line 1, column 10"]),
}


@pytest.mark.parametrize("case", BAD)
def test_a_bad_file_is_refused_before_any_work(case, library, tmp_path, monkeypatch):
    monkeypatch.setattr(work, "evaluate_drawn", None)
    text, words = BAD[case]
    path, out = tmp_path / "bad.toml", tmp_path / "out" / "x.nc"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        sweep(plan_of_file(path), out, library=library)
    for word in words:
        assert word in str(caught.value)
    if case not in ("no such design", "design missing beside"):
        assert "bad.toml" in str(caught.value)
    assert [p.name for p in tmp_path.iterdir()] == ["bad.toml"]


@pytest.mark.parametrize("out", ["x", "x.csv", "folder.nc", "file/x.nc", "link.nc"])
def test_an_output_that_cannot_be_is_refused(out, library, tmp_path):
    (tmp_path / "folder.nc").mkdir()
    (tmp_path / "file").write_text("x")
    (tmp_path / "link.nc").symlink_to(tmp_path / "file")
    plan = plan_of_flags("paper-dome", ["membrane.wall_thickness_mm=1"], model="membrane")
    with refused("out"):
        sweep(plan, tmp_path / out, library=library)
    assert len(list(tmp_path.iterdir())) == 3


def test_options_come_before_the_file_and_paths_lie_beside_it(tmp_path):
    (tmp_path / "s.toml").write_text(
        'design = "own.toml"\nmodel = "solid"\n[set]\nindentation.steps = 5\n[grid]\nmembrane.wall_thickness_mm = [1, 2]'
    )
    plan = plan_of_file(tmp_path / "s.toml", {"indentation.steps": 7}, model="membrane", clamp=None)
    assert (plan.model, plan.clamp, plan.design) == ("membrane", "base", str(tmp_path / "own.toml"))
    assert plan.settings == {"indentation.steps": 7}


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("TangoPlus,FLX9940", ["TangoPlus", "FLX9940"]),
        ("TangoPlus", ["TangoPlus"]),
        ("1, 2.5", [1, 2.5]),
        ("[1, 2.5]", [1, 2.5]),
        ("'a,b',\"c\"", ["a,b", "c"]),
        ("1.0:2.0:5", [1.0, 1.25, 1.5, 1.75, 2.0]),
        ("6:14:3", [6, 10, 14]),
        ("2:1:3", [2.0, 1.5, 1.0]),
        ("barb-4x2.5", ["barb-4x2.5"]),
        ("1,2,", [1, 2]),
    ],
)
def test_flags_are_read(text, values):
    (axis,) = plan_of_flags("x", [f"membrane.material={text}"]).axes
    assert list(axis.values) == values
    assert [type(v) for v in axis.values] == [type(v) for v in values]


@pytest.mark.parametrize(
    "text", ["", "membrane.material", "membrane.material=", "=1", "membrane.material=1:2", "membrane.material=a,,b:c:d"]
)
def test_flags_that_say_nothing_are_refused(text):
    with pytest.raises(InputError, match="over"):
        plan_of_flags("x", [text])


@given(st.text(max_size=60))
def test_any_text_is_a_plan_or_an_input_error(text):
    for words in ([text], [f"membrane.wall_thickness_mm={text}"]):
        try:
            plan = plan_of_flags("x", words)
        except InputError as error:
            assert "over" in str(error)
        else:
            assert plan.count == len(plan.axes[0].values)


ends = st.floats(-1e6, 1e6).map(lambda x: round(x, 6)) | st.integers(-1000, 1000)


@given(ends, ends, st.integers(2, 300))
def test_a_range_has_its_ends_its_count_and_equal_steps(start, stop, count):
    values = spread("", "", start, stop, count)
    assert (values[0], values[-1], len(values)) == (start, stop, count)
    step, size = (stop - start) / (count - 1), max(abs(start), abs(stop))
    assert all(abs(b - a - step) <= 2e-11 * size + 1e-300 for a, b in itertools.pairwise(values))
    assert len({type(v) for v in values}) == 1


KEYS = {
    "membrane.wall_thickness_mm": st.floats(0.1, 5),
    "membrane.inner_radius_mm": st.floats(6, 20),
    "indentation.steps": st.integers(2, 50),
    "membrane.material": st.sampled_from(["TangoPlus", "FLX9940", "FLX9950"]),
}
grids = st.lists(st.sampled_from(sorted(KEYS)), min_size=1, unique=True).flatmap(
    lambda keys: st.fixed_dictionaries({key: st.lists(KEYS[key], min_size=1, max_size=4, unique=True) for key in keys})
)


@given(grids)
def test_a_grid_is_its_outer_product_with_the_last_key_fastest(grid):
    """The same from flags and from a file, in whichever of its two spellings; every value comes back as it was."""
    plan = plan_of_flags("x", [f"{key}={','.join(map(str, values))}" for key, values in grid.items()])
    expected = [dict(zip(grid, values, strict=True)) for values in itertools.product(*grid.values())]
    assert [plan.overrides(k) for k in range(plan.count)] == expected
    assert plan.shape == tuple(len(values) for values in grid.values())
    assert len({plan.position(k) for k in range(plan.count)}) == plan.count


@pytest.mark.slow
@given(grids)
def test_a_file_says_the_same_in_both_spellings(tmp_path_factory, grid):
    path = tmp_path_factory.getbasetemp() / "grid.toml"
    plans = []
    for quote in ('"', ""):
        lines = [f"{quote}{key}{quote} = {list(values)!r}" for key, values in grid.items()]
        path.write_text("\n".join(['design = "x"', "[grid]", *lines]))
        plans.append(plan_of_file(path))
    assert {axis.key: list(axis.values) for axis in plans[0].axes} == grid
    assert {axis.key: axis.values for axis in plans[1].axes} == {axis.key: axis.values for axis in plans[0].axes}


def test_a_name_that_every_point_replaces_need_not_exist(library, tmp_path):
    (tmp_path / "own.toml").write_text(
        '[membrane]\nmaterial = "to-be-chosen"\n[pneumatics]\ndriving_pressures_kPa = [0]'
    )
    for varied in ('[grid]\nmembrane.material = ["FLX9940"]', '[[point]]\nmembrane.material = "FLX9940"'):
        (tmp_path / "s.toml").write_text(f'design = "own.toml"\nmodel = "membrane"\n{varied}')
        outcome = sweep(
            plan_of_file(tmp_path / "s.toml"),
            tmp_path / "x.nc",
            ComputeResources(workers=1),
            library=library,
            fresh=True,
        )
        assert outcome.states["ok"] == 1


@pytest.mark.parametrize(
    ("over", "settings", "model"),
    [
        (["membrane.wall_thickness_mm=1.4,1.5"], {}, "solid"),
        (["membrane.wall_thickness_mm=1.4,1.5"], {"contact.tilt_deg": 5.0}, "harmonic"),
        (["contact.tilt_deg=5,10"], {"contact.offset_mm": 0.0}, "harmonic"),
        (["contact.tilt_deg=0,5", "contact.offset_mm=1,2"], {}, "harmonic"),
        (["contact.tilt_deg=0,5"], {}, "usual"),
    ],
)
def test_a_sweep_that_names_no_model_takes_the_one_of_its_contact(over, settings, model):
    plan = plan_of_flags("paper-dome", over, settings)
    assert study(plan, Library.default()).plan.model == model
    named = plan_of_flags("paper-dome", over, settings, model="membrane")
    assert study(named, Library.default()).plan.model == "membrane"


def test_more_points_than_a_file_can_hold_are_refused_with_yes_too(library, tmp_path):
    grid = {
        f"membrane.{name}": {"from": 1, "to": 2, "count": 10000} for name in ("wall_thickness_mm", "inner_radius_mm")
    }
    with pytest.raises(InputError) as caught:
        sweep(plan_of_grid("paper-dome", grid | {"pneumatics.dead_volume_mL": list(range(22))}), tmp_path / "x.nc")
    assert str(2**31 - 1) in str(caught.value.remedy) and not list(tmp_path.iterdir())


def test_a_sweep_of_more_points_than_usual_is_computed_where_asked_for(library, tmp_path, monkeypatch):
    monkeypatch.setattr(execute, "MAX_POINTS", 1)
    plan = plan_of_flags("paper-dome", ["membrane.wall_thickness_mm=1.2,1.5"], model="membrane")
    with pytest.raises(InputError) as caught:
        sweep(plan, tmp_path / "x.nc", library=library)
    assert "yes" in str(caught.value.remedy) and not list(tmp_path.iterdir())
    assert sweep(plan, tmp_path / "x.nc", library=library, yes=True).computed == 2
