"""Contour maps of a sweep: what they draw is the dataset's, and what is missing is hatched with its reason."""

from __future__ import annotations

import json
from collections import Counter

import numpy as np
import pytest
from matplotlib.figure import Figure
from pictures.sweeps import OVER as DRAWN
from pictures.sweeps import sweep_map

import pneutouch as pt
from pneutouch.errors import InputError
from pneutouch.report import swept as drawing
from pneutouch.report.swept import MapPanel, SweptAxis, SweptMap, contour_levels, contour_map, missing_cells
from pneutouch.workflows.sweep import sweep
from pneutouch.workflows.sweep.dataset import stored_dataset, sweep_maps, write_maps
from pneutouch.workflows.sweep.execute import ComputeResources
from pneutouch.workflows.sweep.grid import is_dense
from pneutouch.workflows.sweep.variables import MAPPED, missing_reasons, reason_words
from tests.conftest import ROOT
from tests.drawings import same_drawing
from tests.workflows.sweep.conftest import load, small

ALONE = ComputeResources(workers=1)
WALL, RADIUS = "membrane.wall_thickness_mm", "membrane.inner_radius_mm"
OVER = [f"{WALL}=0.6:3:5", f"{RADIUS}=12,2,6,9", "pneumatics.driving_pressures_kPa=0,22"]
"""Radii that are not in order; small ones do not fit the connector, and thin walls snap at 22 kPa."""


@pytest.fixture(scope="module")
def mapped(tmp_path_factory, library):
    out = tmp_path_factory.mktemp("mapped") / "x.nc"
    sweep(small([*OVER, "membrane.material=TangoPlus,FLX9950"], model="atlas"), out, ALONE, library=library)
    return out


def test_a_map_holds_the_dataset_s_values_at_its_points(mapped):
    data, maps = load(mapped).sortby("membrane_inner_radius_mm"), sweep_maps(load(mapped))
    assert list(maps) == [f"{name}-{resin}" for resin in ("TangoPlus", "FLX9950") for name in MAPPED]
    relative = 100 * np.log(data.sensitivity_high_kPa_per_N / data.sensitivity_low_kPa_per_N) / 2
    read = {name: data.get(variable, relative) for name, (_, variable) in MAPPED.items()}
    for title, drawn in maps.items():
        name, resin = title.rsplit("-", 1)
        assert [axis.label for axis in drawn.axes] == ["membrane wall thickness  (mm)", "membrane inner radius  (mm)"]
        assert drawn.axes[1].values == (2.0, 6.0, 9.0, 12.0)
        assert len(drawn.panels) == (1 if name == "rated-pressure" else 2)
        for kPa, panel in zip((0, 22), drawn.panels, strict=False):
            for i, wall in enumerate(drawn.axes[0].values):
                for j, radius in enumerate(drawn.axes[1].values):
                    at = {"membrane_wall_thickness_mm": wall, "membrane_inner_radius_mm": radius}
                    point = read[name].sel(at, method="nearest").sel(membrane_material=resin)
                    value = point if name == "rated-pressure" else point.sel(driving_pressure_kPa=kPa)
                    assert panel.value[i, j] == pytest.approx(float(value), nan_ok=True)
                    assert (panel.reasons[i][j] == "") == np.isfinite(panel.value[i, j])


def test_reasons_are_counted_as_the_dataset_states_them(mapped):
    data = load(mapped).sel(membrane_material="TangoPlus")
    drawn = sweep_maps(load(mapped))["sensitivity-TangoPlus"]
    wanted = Counter(reason_words(text) for text in data.message.values.ravel().tolist() if text)
    assert drawn.counts == dict(wanted) and sum(wanted.values()) == int((data.status != "ok").sum())
    assert {"too small for the connector", "wall outside the atlas"} < set(drawn.counts)
    assert list(drawn.counts.values()) == sorted(wanted.values(), reverse=True)


@pytest.mark.parametrize(
    ("message", "words"),
    [
        ("driving pressure beyond the limit point, where the dome snaps: at most 21.96 kPa", "beyond the limit point"),
        ('model = "atlas": wall 0.05 R0, not 0.06 to 0.35; take `model` auto', "wall outside the atlas"),
        ("designs/a.toml: contact.depth_mm = 8: deeper than 7.5 mm; take less", "deeper than … mm"),
        ("no equilibrium at driving pressure 3 kPa: x; try a finer mesh", "no equilibrium found"),
        ("internal fault (ValueError: x); please report it with the design", "internal fault"),
        ("designs/a.toml: " + "a word " * 20, f"{('a word ' * 20)[:59].rstrip()}…"),
    ],
)
def test_messages_that_differ_in_numbers_have_the_same_short_words(message, words):
    assert reason_words(message) == words


AXES = SweptAxis("a_mm", "a", "mm", (1.0, 2.0, 3.0, 4.0)), SweptAxis("b_mm", "b", "mm", (1.0, 2.0, 3.0, 4.0))


def gap(*places, reason="beyond the limit point"):
    """A panel with the sum of both coordinates; missing at some places."""
    value = np.add.outer(np.arange(1.0, 5.0), np.arange(1.0, 5.0))
    for place in places:
        value[place] = np.nan
    messages = np.where(np.isnan(value), reason, "")[..., None]
    return MapPanel("p", value, missing_reasons(value, messages))


def drawn_figure(monkeypatch, swept):
    """The map as matplotlib holds it."""
    kept: list[Figure] = []
    monkeypatch.setattr(drawing, "_files", lambda drawn: kept.append(drawn) or ("", b""))
    contour_map(swept)
    return kept[0]


def test_missing_points_are_hatched_and_no_line_runs_there(monkeypatch):
    panel = gap((3, 3), (0, 0))
    cells = missing_cells(panel, "beyond the limit point")
    assert np.argwhere(cells).tolist() == [[0, 0], [2, 2]]
    (ax,) = drawn_figure(monkeypatch, SweptMap("c", AXES, (panel,))).axes
    (patch,) = ax.patches
    corners = {tuple(corner) for corner in patch.get_path().vertices.tolist()}
    assert corners == {(x, y) for low in (1.0, 3.0) for x in (low, low + 1) for y in (low, low + 1)}
    assert patch.get_hatch()
    shades, lines = ax.collections
    for place in ((1.2, 1.2), (3.8, 3.8)):
        assert not any(path.contains_point(place) for path in shades.get_paths())
    for level, path in zip(lines.levels, lines.get_paths(), strict=True):
        for x, y in path.vertices.tolist():
            assert x + y == pytest.approx(level), "the sum is linear, and so are its lines"
            assert not (x < 2 and y < 2 and x + y < 3) and not (x > 3 and y > 3 and x + y > 7)


def test_the_legend_names_every_reason_with_its_count(monkeypatch):
    value = gap((0, 0), (3, 3), (3, 2)).value
    words = np.full((4, 4), "", object)
    words[0, 0], words[3, 2:] = "snapped $", "too thin"
    panel = MapPanel("p", value, tuple(map(tuple, words.tolist())))
    figure = drawn_figure(monkeypatch, SweptMap("c", AXES, (panel, panel)))
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["too thin (4)", r"snapped \$ (2)"]
    assert len({handle.get_hatch() for handle in legend.get_patches()}) == 2
    assert not drawn_figure(monkeypatch, SweptMap("c", AXES, (gap(),))).legends


@pytest.mark.parametrize("values", [[0.91, 5.5], [1.0, 162.0], [3.0, 3.0], [0.0, 0.0], [-2.0, 7.0], [2e-3, 0.5], []])
def test_levels_ascend_enclose_all_values_and_are_few(values):
    levels = contour_levels(np.array(values))
    assert (np.diff(levels) > 0).all() and 2 <= len(levels) <= 20
    assert not values or levels[0] <= min(values) <= max(values) <= levels[-1]


def test_a_map_with_nothing_known_and_one_with_a_constant_are_drawn():
    nothing = gap(*np.ndindex(4, 4))
    assert nothing.heading == "p: not predicted"
    for panel in (nothing, MapPanel("", np.full((4, 4), 2.5), (("",) * 4,) * 4)):
        text, image = contour_map(SweptMap("caption", AXES, (panel,)))
        assert text.endswith("</svg>\n") and image.startswith(b"\x89PNG")


@pytest.mark.slow
def test_the_same_dataset_gives_the_same_bytes(mapped, tmp_path):
    first = pt.map_sweep(mapped, tmp_path / "a")
    again = write_maps(load(mapped), tmp_path / "b")
    assert [path.name for path in first] == [path.name for path in again] and len(first) == 16
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in again]


def test_the_interface_names_what_it_was_given(tmp_path):
    data = pt.sweep(pt.Design(inner_radius_mm=6), wall_thickness_mm=[1.0, 1.5], model="membrane")
    with pytest.raises(pt.InputError, match="membrane_wall_thickness_mm with 2"):
        pt.map_sweep(data, tmp_path / "maps")
    with pytest.raises(pt.InputError, match=r"y\.nc"):
        pt.map_sweep(tmp_path / "y.nc", tmp_path / "maps")
    assert list(tmp_path.iterdir()) == []


def test_a_theory_without_intervals_has_no_map_of_them(library, tmp_path):
    over = [f"{WALL}=1:1.6:4", f"{RADIUS}=8:10:4", "membrane.material=TangoPlus"]
    sweep(small(over, settings=["pneumatics.driving_pressures_kPa=[5]"]), tmp_path / "x.nc", ALONE, library=library)
    maps = sweep_maps(stored_dataset(tmp_path / "x.nc"))
    names = [name.removesuffix("-TangoPlus") for name in maps]
    assert "sensitivity" in names and "interval" not in names


@pytest.mark.parametrize(
    ("values", "dense"),
    [((1, 2, 3, 4), True), ((1, 2, 3), False), ((1, 2, 3, "inf"), False), ((1.0, 2.0, 3.0, np.inf), False)],
)
def test_numbers_are_dense_from_four_values_on(values, dense):
    assert is_dense(values) is dense


WORDS = ["--design", "paper-dome", "--over", f"{WALL}=1:1.6:4", "--over", f"{RADIUS}=8:10:4", "--model", "membrane"]


@pytest.mark.slow
def test_the_command_draws_maps_and_later_ones_without_computing(command, tmp_path):
    plain = command("sweep", *WORDS, "--fresh")
    assert plain.returncode == 0, plain.stderr
    assert plain.stderr.splitlines()[-1].endswith("--model membrane --charts outputs/paper-dome-sweep-maps")
    before = (tmp_path / "outputs/paper-dome-sweep.nc").read_bytes()
    result = command("sweep", *WORDS, "--charts", "maps", "--json")
    found = json.loads(result.stdout)
    assert found["computed"] == 0 and (tmp_path / "outputs/paper-dome-sweep.nc").read_bytes() == before
    assert sorted(found["maps"]) == sorted(f"maps/{path.name}" for path in (tmp_path / "maps").glob("*.[ps]*g"))
    assert {"maps/sensitivity.svg", "maps/rated-pressure.png", "maps/force-range.svg"} <= set(found["maps"])


@pytest.mark.parametrize(
    ("words", "has"),
    [
        (["--over", f"{WALL}=1:2:3", "--over", f"{RADIUS}=8:10:4"], f"{WALL} with 3, {RADIUS} with 4"),
        (["--over", f"{WALL}=1:2:9", "--over", "membrane.material=TangoPlus,FLX9950"], "membrane.material with 2"),
    ],
)
def test_a_map_without_two_dense_fields_is_refused_before_any_work(words, has, command, tmp_path):
    result = command("sweep", "--design", "paper-dome", *words, "--model", "membrane", "--charts", "maps")
    assert (result.returncode, result.stdout) == (2, "")
    assert "--charts: a map needs a grid over two fields" in result.stderr and has in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_sweep_that_has_no_map_does_not_offer_one(command):
    result = command("sweep", "--design", "paper-dome", "--over", f"{WALL}=1:2:5", "--model", "membrane")
    assert result.returncode == 0 and "--charts" not in result.stderr


def test_a_folder_of_charts_that_is_a_file_is_refused_first(command, tmp_path):
    (tmp_path / "maps").write_text("mine")
    result = command("sweep", *WORDS, "--charts", "maps")
    assert result.returncode == 2 and result.stderr.startswith("error: --charts: maps is a file")
    assert [path.name for path in tmp_path.iterdir()] == ["maps"]


def test_a_list_of_points_has_no_map(library):
    from pneutouch.workflows.sweep.grid import check_dense

    with pytest.raises(InputError, match="a list of points"):
        check_dense({})


@pytest.mark.slow
def test_the_page_shows_the_map_of_its_command():
    page = (ROOT / "docs/howto/sweep.md").read_text(encoding="utf-8")
    assert "](sweep-map.svg)" in page and all(f"--over {over}" in page for over in DRAWN)
    assert same_drawing(ROOT / "docs/howto/sweep-map.svg", sweep_map())
