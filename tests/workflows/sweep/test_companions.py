"""The table and the pictures next to a dataset: what they hold is what the dataset holds."""

from __future__ import annotations

import csv
import io
import re

import numpy as np
import pytest

from pneutouch.cli.sweep import sweep_text
from pneutouch.errors import InputError
from pneutouch.report.style import HATCHES
from pneutouch.report.swept import SweptAxis, SweptFigure, pictures
from pneutouch.workflows.sweep import plan_of_file, sweep
from pneutouch.workflows.sweep.dataset import stored_dataset, swept_figure, table_csv, table_rows, write_companions
from pneutouch.workflows.sweep.execute import ComputeResources
from tests.workflows.sweep.conftest import load, small

ALONE = ComputeResources(workers=1)


@pytest.fixture(scope="module")
def swept(tmp_path_factory, library):
    """Two resins, three walls, two pressures; the highest is beyond the limit of the thinnest soft wall."""
    out = tmp_path_factory.mktemp("swept") / "x.nc"
    over = [
        "membrane.material=TangoPlus,FLX9960",
        "membrane.wall_thickness_mm=0.7,1.1,1.5",
        "pneumatics.driving_pressures_kPa=0,22",
    ]
    sweep(small(over, model="atlas"), out, ALONE, library=library)
    return out


def test_the_table_is_the_dataset_row_by_row(swept):
    data = load(swept)
    rows = list(csv.DictReader(io.StringIO(b"".join(table_csv(table_rows(data))).decode(), newline="")))
    assert len(rows) == data.status.size == 12
    assert list(rows[0])[:3] == ["membrane_material", "membrane_wall_thickness_mm", "driving_pressure_kPa"]
    for row in rows:
        place = {
            "membrane_material": row["membrane_material"],
            "membrane_wall_thickness_mm": float(row["membrane_wall_thickness_mm"]),
            "driving_pressure_kPa": float(row["driving_pressure_kPa"]),
        }
        point = data.sel(place)
        assert row["status"] == str(point.status.values)
        assert row["message"] == str(point.message.values)
        for name in ("sensitivity_kPa_per_N", "sensitivity_low_kPa_per_N", "limit_point_kPa"):
            value = float(point[name])
            assert row[name] == ("" if np.isnan(value) else f"{value:.12g}")
    assert [row["status"] for row in rows].count("refused") == 1


def test_bands_hold_the_figure_and_resins_are_categories(swept):
    figure = swept_figure(load(swept))
    words = [(axis.label, axis.numeric) for axis in figure.axes]
    assert words == [
        ("membrane material", False),
        ("membrane wall thickness  (mm)", True),
        ("driving pressure  (kPa)", True),
    ]
    known = np.isfinite(figure.value)
    assert known.sum() == 11
    assert (figure.low[known] < figure.value[known]).all() and (figure.value[known] < figure.high[known]).all()


@pytest.mark.slow
def test_pictures_are_written_for_each_field_the_same_twice(swept, tmp_path):
    again = tmp_path / "x.nc"
    again.write_bytes(swept.read_bytes())
    _, files = write_companions(swept)
    _, others = write_companions(again)
    fields = ("membrane_material", "membrane_wall_thickness_mm", "driving_pressure_kPa")
    assert [path.name for path in files] == [
        "x.csv",
        *(f"x-over-{name}.{kind}" for name in fields for kind in ("svg", "png")),
    ]
    assert [path.read_bytes() for path in files] == [path.read_bytes() for path in others]
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(
        ["x-manifest.json", "x.nc", *(path.name for path in others)]
    )


def test_two_numbers_give_a_map_and_one_value_gives_no_picture():
    axes = SweptAxis("a_mm", "a", "mm", (1.0, 2.0, 3.0)), SweptAxis("b_mm", "b", "mm", (4.0, 5.0))
    value = np.array([[1.0, 2.0], [3.0, np.nan], [5.0, 6.0]])
    drawn = pictures(
        SweptFigure("S", (*axes, SweptAxis("driving_pressure_kPa", "p", "kPa", (0.0,))), *[value[..., None]] * 3)
    )
    assert list(drawn) == ["over-a_mm", "over-b_mm", "map"]
    for text, image in drawn.values():
        assert '<rect width="100%" height="100%" fill="#ffffff"/>' in text
        assert image.startswith(b"\x89PNG")
    alone = SweptFigure("S", (SweptAxis("a_mm", "a", "mm", (1.0,)),), *[np.array([1.0])] * 3)
    assert pictures(alone) == {}


def test_a_list_is_drawn_over_its_only_field(library, tmp_path):
    points = "".join(f"[[point]]\nmembrane.wall_thickness_mm = {wall}\n" for wall in (1.5, 1.0, 1.2))
    (tmp_path / "list.toml").write_text(f'design = "paper-dome"\nmodel = "membrane"\n{points}')
    sweep(plan_of_file(tmp_path / "list.toml"), tmp_path / "y.nc", ALONE, library=library)
    figure = swept_figure(load(tmp_path / "y.nc"))
    assert figure.axes[0].key == "membrane_wall_thickness_mm" and figure.axes[0].values == (1.0, 1.2, 1.5)
    rows = list(table_rows(load(tmp_path / "y.nc")))
    assert [row["membrane_wall_thickness_mm"] for row in rows[::4]] == [1.5, 1.0, 1.2]
    value = {row["membrane_wall_thickness_mm"]: row["sensitivity_kPa_per_N"] for row in rows[::4]}
    assert figure.value[:, 0].tolist() == [value[wall] for wall in (1.0, 1.2, 1.5)]


DAMAGED = r"\.nc: the dataset is damaged: its content is not what the sweep wrote; move it"


def test_a_finished_sweep_that_lacks_a_column_is_refused(library, tmp_path):
    out = tmp_path / "x.nc"
    sweep(small(), out, ALONE, library=library)
    for name in ("status", "r_squared"):
        load(out).drop_vars(name).to_netcdf(tmp_path / "y.nc", engine="scipy")
        with pytest.raises(InputError, match=DAMAGED):
            sweep(small(), tmp_path / "y.nc", ALONE, library=library)
        with pytest.raises(InputError, match=DAMAGED):
            write_companions(tmp_path / "y.nc")
        (tmp_path / "y.nc").unlink()
    assert [path.name for path in tmp_path.iterdir()] == ["x.nc"]


def test_a_dataset_without_its_hash_is_refused(swept, tmp_path):
    content = load(swept)
    del content.attrs["content_hash"]
    content.to_netcdf(tmp_path / "x.nc", engine="scipy")
    with pytest.raises(InputError, match=DAMAGED):
        write_companions(tmp_path / "x.nc")


@pytest.mark.parametrize("name", ["sensitivity_high_kPa_per_N", "membrane_wall_thickness_mm", "status", "message"])
def test_a_dataset_with_one_changed_value_is_refused(swept, tmp_path, name):
    content = load(swept)
    kept = content[name]
    values = kept.values.copy()
    values[(0,) * values.ndim] = "ok " if values.dtype.kind == "O" else np.nan
    changed = content.assign_coords if name in content.coords else content.assign
    content = changed({name: (kept.dims, values, kept.attrs)})
    content.to_netcdf(tmp_path / "x.nc", engine="scipy")
    with pytest.raises(InputError, match=DAMAGED):
        write_companions(tmp_path / "x.nc")
    assert [path.name for path in tmp_path.iterdir()] == ["x.nc"]


@pytest.mark.slow
def test_no_changed_byte_of_a_dataset_is_reported_as_a_result(swept, tmp_path):
    """200 bytes in turn, each replaced by another: refused, or the content is the same (padding)."""
    whole, out = swept.read_bytes(), tmp_path / "x.nc"
    content, rng, refused = load(swept), np.random.default_rng(7), 0
    for at in rng.integers(len(whole), size=200):
        out.write_bytes(whole[:at] + bytes([whole[at] ^ int(rng.integers(1, 256))]) + whole[at + 1 :])
        try:
            same = stored_dataset(out)
        except InputError:
            refused += 1
        else:
            assert same.identical(content)
    assert refused > 150


def test_bands_of_several_lines_are_hatched_apart():
    """In grayscale shades of one lightness run together: each band has a hatch of its own, in the legend too."""
    numbers, names = SweptAxis("a_mm", "a", "mm", (1.0, 2.0)), SweptAxis("resin", "resin", "", ("A", "B", "C"))
    value = np.array([[1.0, 1.1, 1.2], [2.0, 2.1, 2.2]])
    text, _ = pictures(SweptFigure("S", (numbers, names), value, 0.8 * value, 1.2 * value))["over-a_mm"]
    patterns = re.findall(r'<pattern id="(h[0-9a-f]+)".*?<path d="([^"]*)"', text, re.DOTALL)
    assert len(patterns) == len(set(patterns)) == len({lines for _, lines in patterns}) == 3
    assert {name for name, _ in patterns} == set(re.findall(r"url\(#(h[0-9a-f]+)\)", text))
    assert len(set(HATCHES)) == 6


def test_the_printed_table_has_the_rated_pressure_and_one_number_of_decimals_a_column(swept):
    rows = list(table_rows(load(swept)))
    head, *lines = sweep_text(rows, len(rows), swept).splitlines()
    names = re.split(" {2,}", head)
    assert names[-4:] == ["range mm", "limit kPa", "rated kPa", "status"]
    shown = [dict(zip(names, re.split(" {2,}", line), strict=True)) for line in lines[: len(rows)]]
    for name, decimals in (("S kPa/N", 3), ("N/mm", 3), ("range mm", 2), ("limit kPa", 1), ("rated kPa", 1)):
        cells = [row[name] for row in shown if row[name] != "-"]
        assert cells and all(len(cell.partition(".")[2]) == decimals for cell in cells), name
    for row, cells in zip(rows, shown, strict=False):
        if row["rated_pressure_kPa"] is not None:
            assert 0 <= row["rated_pressure_kPa"] - float(cells["rated kPa"]) < 0.1


@pytest.mark.slow
def test_friction_to_grip_objects_and_flags_are_swept_as_categories(tmp_path, library):
    """The membrane's closed form refuses them all; what counts here is that table, dataset and axes hold them."""
    over = ["contact.friction=0,0.3,inf", "contact.object=plate,ball", "contact.base=true,false"]
    plan = small(over, settings=["contact.ball_radius_mm=10"])
    sweep(plan, out := tmp_path / "x.nc", ALONE, library=library)
    data = load(out)
    assert data.contact_friction.values.tolist() == [0.0, 0.3, np.inf]
    assert data.contact_object.values.tolist() == ["plate", "ball"]
    assert data.contact_base.values.tolist() == ["true", "false"]
    rows = list(table_rows(data))
    ok = {(row["contact_friction"], row["contact_object"]) for row in rows if row["status"] == "ok"}
    assert ok == {(0.0, "plate")} and {row["contact_base"] for row in rows} == {"true", "false"}
    assert "inf" in b"".join(table_csv(rows)).decode().splitlines()[-1].split(",")
    friction = next(axis for axis in swept_figure(data).axes if axis.key == "contact_friction")
    assert not friction.numeric and [friction.text(k) for k in range(3)] == ["0", "0.3", "inf"]
    assert "over-contact_friction" in pictures(swept_figure(data))
