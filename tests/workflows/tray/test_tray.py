"""A tray from file to parts: what is on it, what is left out, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from pneutouch.errors import InputError
from pneutouch.parts.connector import seat_area
from pneutouch.parts.lettering.mark import read
from pneutouch.workflows.tray.lay import fill, lay
from pneutouch.workflows.tray.order import TrayOrder, is_tray_file, order_of_file, order_of_flags
from pneutouch.workflows.tray.write import inputs, subject, tray_record, write_tray
from tests.conftest import ROOT
from tests.export.threemf_files import read_strictly
from tests.workflows.tray.laid import RESINS, flags, table


def test_the_example_is_21_membranes_in_one_job(seven):
    (job,) = seven.jobs
    assert [part.label for part in job.parts] == [f"{letter}{copy}" for letter in "ABCDEFG" for copy in (1, 2, 3)]
    assert [part.solids[0].material.title.removesuffix("-DM") for part in job.parts[::3]] == RESINS
    assert seven.resin_note == "one job, no resin change"
    assert (job.mode.name, job.resins) == ("Digital Material", ("TangoPlus", "VeroClear"))
    assert job.layers == 434  # 13 mm at 30 um


def test_fill_is_the_area_of_boxes_and_discs(seven):
    shares = fill(seven.jobs[0], seven.printer)
    box, disc = 26.0**2, np.pi * 13.0**2
    assert shares["bounding_boxes"] == pytest.approx(21 * box / (255 * 252), rel=3e-3)
    assert shares["outlines"] == pytest.approx(21 * disc / (255 * 252), rel=1e-3)


def test_the_tallies_on_the_tray_read_as_their_labels(seven):
    """Grooves found again on the printed mesh: the section through the flange, walked round."""

    layout = seven.parts[0].value.assembly.layout
    for part in seven.parts:
        (body,) = part.bodies
        middle = 0.5 * part.size[:2]
        section = body.manifold().slice(layout.flange_thickness - 0.3)
        sectors = []
        for line in section.to_polygons():
            points = line - middle
            radius = np.hypot(*points.T)
            if radius.min() > layout.outer_radius + 0.3 and radius.max() < layout.flange_radius - 0.3:
                angle = np.unwrap(np.arctan2(points[:, 1], points[:, 0]))
                sectors.append((angle.min(), angle.max()))
        assert read(sectors) == ("ABCDEFG".index(part.label[0]) + 1, int(part.label[1]))


@pytest.mark.slow
def test_a_one_piece_sensor_stays_one_assembly(seats):
    laid, where = seats
    parts = {part.name: part for part in laid.parts}
    assert [body.name for body in parts["B1-membrane"].bodies] == ["B1-membrane", "B1-connector"]
    assert [mark.kind for mark in parts["B1-membrane"].marks] == ["none", "text"]
    assert {"B1-plug", "C1-ring", "A1-connector", "A1-membrane"} <= set(parts)
    model, _ = read_strictly(next(where.glob("*.3mf")))
    assert model.GetComponentsObjects().Count() == 2


@pytest.mark.slow
def test_shared_faces_of_an_assembly_keep_their_triangles(seats):
    from pneutouch.printability.rules.bodies import shared_area

    laid, _ = seats
    part = next(part for part in laid.parts if len(part.bodies) == 2)
    assert shared_area(*part.bodies) == pytest.approx(
        seat_area(part.value.assembly.scene.seat, part.value.assembly.solid("connector")), rel=1e-3
    )


def test_what_another_printer_prints_is_left_out_and_said(library, tmp_path):
    laid = flags(library, ["paper-dome", "agilus-dome"], copies=1, profile="abs-filament")
    assert [part.name for part in laid.parts] == ["A1-connector"]
    said = " ".join(laid.expanded.left_out)
    assert "membrane of paper-dome: for the Stratasys Objet260 Connex" in said
    assert "connector of agilus-dome: for the Stratasys J735" in said
    where = Path(write_tray(laid, tmp_path / "abs").folder)
    assert "Not on this tray: membrane of paper-dome" in (where / "labels.md").read_text()


@pytest.mark.slow
def test_resins_that_do_not_fit_at_once_make_more_jobs(library, tmp_path):
    """A J735 cut down to one resin at a time."""
    own = (ROOT / "printprofiles/j735.toml").read_text()
    (tmp_path / "printprofiles").mkdir()
    (tmp_path / "printprofiles/j735.toml").write_text(own.replace("resins_at_once = 6", "resins_at_once = 1", 1))
    small = type(library)((tmp_path, ROOT))
    order = order_of_flags(["agilus-dome"], ["membrane.material=Agilus30,TangoPlus"], 2)
    laid = lay(order, small)
    assert [job.resins for job in laid.jobs] == [("Agilus30",), ("VeroClear",), ("TangoPlus",)] or len(laid.jobs) == 3
    assert "3 jobs in this order, 2 resins loaded between" in laid.resin_note
    where = Path(write_tray(laid, tmp_path / "out").folder)
    assert {path.name for path in where.glob("*.3mf")} == {f"agilus-dome-tray-{k}.3mf" for k in (1, 2, 3)}
    assert {path.name for path in where.glob("*.svg")} == {"tray-1.svg", "tray-2.svg", "tray-3.svg"}
    assert {row["job"] for row in table(where)} == {"1", "2", "3"}


def test_the_mesh_is_as_fine_as_the_mode_s_finest_step(seven):
    (job,) = seven.jobs
    tolerance = seven.printer.finest_step(job.mode)
    assert tolerance == pytest.approx(0.03)
    solid = seven.parts[0].solids[0]
    plain = solid.mesh(tolerance)
    assert solid.distance(plain.surface_points()).max() <= tolerance


def test_the_recipe_says_all_that_the_tray_follows_from(seven):
    said = inputs(seven)
    assert set(said["values"]) == set("ABCDEFG")
    assert all(name is None or name in said["things"] for scene in said["values"].values() for name in scene.values())
    assert said["things"][said["values"]["B"]["membrane_material"]]["title"] == "FLX9940-DM"
    assert tray_record(seven, Path("x")).parts == 21


def test_a_part_is_a_subject_for_the_print_rules(laid_seats):
    (job,) = laid_seats.jobs
    part = next(part for part in job.parts if len(part.bodies) == 2)
    found = subject(part, laid_seats.printer, job.mode)
    assert [item.body.name for item in found.items] == ["B1-membrane", "B1-connector"]
    assert {item.job for item in found.items} == {"B1"}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[tray]\n", "entry: missing"),
        ('[[entry]]\ndesign = "paper-dome"\ncopies = 0\n', "copies.* must be from 1 to 200"),
        (
            '[tray]\nmarks = "etched"\n[[entry]]\ndesign = "x"\n',
            'tray.marks = "etched": must be "engraved", "raised" or "none"',
        ),
        ('[tray]\nspacing_mm = 0\n[[entry]]\ndesign = "x"\n', "tray.spacing_mm = 0: must be from 0.5 to 50 mm"),
        ('[tray]\nmargins = 1\n[[entry]]\ndesign = "x"\n', "Did you mean margin_mm"),
        ('[[entry]]\ndesign = "x"\nover = {"a.b" = [1], "c.d" = [2]}\n', "it must vary one key"),
        ('[[entry]]\ndesign = "x"\nover = {"a.b" = [1, 1]}\n', "there twice; raise copies instead"),
        ('[[entry]]\ndesign = "x"\nover = {"a.b" = [1]}\nset = {"a.b" = 2}\n', "must be in one of them"),
        ('[[entry]]\ndesign = "paper-dom"\n', "Did you mean paper-dome"),
        ('[[entry]]\ndesign = "paper-dome"\nover = {"membrane.material" = ["TangoPlus", "FLX994"]}\n', "FLX9940"),
        ('[tray]\nprofile = "objet"\n[[entry]]\ndesign = "paper-dome"\n', "Did you mean objet260-connex"),
        ('[tray]\nbodies = ["plug"]\n[[entry]]\ndesign = "paper-dome"\n', "nothing is left for the Stratasys"),
        ('[[entry]]\ndesign = "paper-dome"\ncopies = 100\n', "64 of 100 parts fit"),
    ],
)
def test_what_is_wrong_is_said_with_the_file_s_name(text, message, library, tmp_path):
    path = tmp_path / "my.toml"
    path.write_text(text)
    assert is_tray_file(path)
    with pytest.raises(InputError, match=message) as caught:
        lay(order_of_file(path), library)
    assert str(caught.value).startswith(str(path))


def test_keys_may_be_written_as_tables_and_designs_lie_beside_the_file(library, tmp_path):
    (tmp_path / "mine.toml").write_text((ROOT / "designs/paper-dome.toml").read_text())
    path = tmp_path / "t.toml"
    path.write_text('[[entry]]\ndesign = "mine.toml"\nover = { membrane.wall_thickness_mm = [1.0, 2.0] }\n')
    laid = lay(order_of_file(path), library)
    assert [part.value.assembly.layout.wall for part in laid.parts] == [1.0, 2.0]
    assert isinstance(laid.order, TrayOrder)
