"""What measured coupons make of the profiles."""

from __future__ import annotations

import datetime

import numpy as np
import pytest

from pneutouch.bench.coupons import smallest_sound
from pneutouch.catalogue import Library, load_scene
from pneutouch.errors import InputError
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.parts import assemble
from pneutouch.spec.coupon import GaugeSize, read_results
from pneutouch.spec.toml_text import toml_text
from pneutouch.workflows.coupons.order import CouponOptions, order, results_template
from pneutouch.workflows.coupons.results import HEAD, enter_results
from tests.conftest import ROOT

LIBRARY = Library((ROOT,))


MU = 0.21


def specimen(mu, noise=0.0):
    extension = np.linspace(0.5, 5, 10)
    stretch = 1 + extension / 25
    force = mu * (stretch - stretch**-2) * 6.1 * 2.05 + noise * np.cos(7 * extension)
    return {
        "width_mm": [6.1] * 3,
        "thickness_mm": [2.05] * 3,
        "extension_mm": extension.tolist(),
        "force_N": force.tolist(),
    }


def sizes(nominals, less=0.0, lost=()):
    return [
        {"nominal_mm": n, "came_out": False}
        if n in lost
        else {"nominal_mm": n, "measured_mm": [n - less, n - less - 0.02]}
        for n in nominals
    ]


def measured():
    """Readings of TangoPlus and of both machines of the paper's sensor."""
    gauge = {
        "x": sizes((5.0, 20.0), -0.03),
        "y": sizes((20.0,), 0.05),
        "z": sizes((10.0,)),
        "wall": sizes((0.5, 0.6, 0.8, 1.0), lost=(0.5,)),
        "hole": sizes((0.8, 1.0, 2.0), 0.1),
        "slot": sizes((0.3, 0.4, 0.5), lost=(0.4,)),
    }
    return {
        "lab": "Soft lab",
        "date": datetime.date(2026, 11, 21),
        "puck": {
            "TangoPlus": {
                "shore_a": [30.0, 31.0, 29.0, 30.0],
                "mass_g": [1.09, 1.10],
                "diameter_mm": [20.0, 20.0],
                "thickness_mm": [3.0, 3.0],
            }
        },
        "dumbbell": {"TangoPlus": {"specimen": [specimen(MU - 0.01), specimen(MU), specimen(MU + 0.01)]}},
        "gauge": {"objet260-connex": {"TangoPlus": gauge}, "abs-filament": {"ABS": {"x": sizes((20.0,), 0.3)}}},
        "leak-cap": {"paper-dome": {"start_kPa": [20.0, 20.4], "end_kPa": [19.9, 20.1], "pressure_kPa": [59.0, 58.8]}},
        "volume-plug": {"paper-dome": {"pressure_kPa": [17.7, 17.8], "water_g": [0.99, 1.0]}},
    }


@pytest.fixture
def lab(tmp_path):
    """Enter readings in a folder of a lab's own, and the library it then has."""

    def enter(content, out=None):
        path = tmp_path / "results.toml"
        path.write_text(toml_text(content))
        return enter_results(path, out or tmp_path, Library((tmp_path, ROOT)))

    return enter


def test_measured_quantities_replace_the_shipped_ones_with_their_source(lab, tmp_path):
    report = lab(measured())
    mine = Library((tmp_path, ROOT))
    ours, theirs = mine.load("materials", "TangoPlus"), LIBRARY.load("materials", "TangoPlus")
    assert ours.shore_a.value == 30.0
    assert ours.shore_a.spread == pytest.approx(np.std([30, 31, 29, 30], ddof=1), rel=1e-3)
    assert ours.shore_a.source.startswith("measured on coupons")
    assert ours.shore_a.source.endswith("n = 4; Soft lab, 2026-11-21")
    assert ours.shore_a_one_year.value == pytest.approx(30.0 + 29.5 - 27.6)
    assert ours.density_g_per_cm3.value == pytest.approx(1.095 / (np.pi * 0.3), rel=1e-3)
    mu = ours.shear_modulus_MPa
    assert (mu.value, mu.low, mu.high) == (pytest.approx(MU), pytest.approx(MU - 0.01), pytest.approx(MU + 0.01))
    assert mu.spread == pytest.approx(0.01)
    kept = {"poisson_ratio", "tensile_strength_MPa", "measured", "title", "base_resins", "elongation_at_break_percent"}
    assert all(getattr(ours, key) == getattr(theirs, key) for key in kept)
    printer = mine.load("printers", "objet260-connex")
    assert printer.accuracy_mm.value == pytest.approx(0.06)
    assert printer.hole_undersize_mm.value == pytest.approx(0.11)
    assert printer.smallest.wall_soft_mm.least == 0.6
    assert printer.smallest.gap_mm.least == 0.5
    assert printer.smallest.gap_mm.recommended == 0.5
    assert printer.smallest.wall_rigid_mm == LIBRARY.load("printers", "objet260-connex").smallest.wall_rigid_mm
    assert printer.mode == LIBRARY.load("printers", "objet260-connex").mode
    assert len(report.written) == 3
    assert {change.key for change in report.changes} >= {"shear_modulus_MPa", "accuracy_mm", "smallest.hole_mm"}


def test_pucks_weighed_in_milligrams_are_asked_about(lab, tmp_path):
    content = measured()
    content["puck"]["TangoPlus"]["mass_g"] = [1090.0, 1100.0]
    with pytest.raises(InputError, match=r"puck 1: mass_g = 1090.*from 0\.5 to 3 g/cm3; is mass_g in mg\?"):
        lab(content)
    assert not (tmp_path / "printprofiles").exists()


def test_the_new_profiles_change_clearance_and_modulus(lab, tmp_path):
    before = load_scene("paper-dome", None, LIBRARY)
    lab(measured())
    after = load_scene("paper-dome", None, Library((tmp_path, ROOT)))
    assert before.fit_clearance == pytest.approx(0.1 + 0.2)
    assert after.fit_clearance == pytest.approx(0.06 + 0.31)
    assert material_sensor(before.membrane_material).wall.shear_modulus == pytest.approx(0.17)
    assert material_sensor(after.membrane_material).wall.shear_modulus == pytest.approx(MU)


def test_leak_and_dead_volume_are_told(lab):
    report = lab({**measured(), "gauge": {}})
    told = {figure.name: figure for figure in report.figures}
    assert told["leak, kPa/min"].value == pytest.approx((0.1 + 0.3) / 2 / 10)
    cavity = 0.995 / 0.9982
    assert told["dead volume, mL"].value == pytest.approx(cavity * 17.75 / (58.9 - 17.75))
    assert told["dead volume, mL"].spread > 0
    assert any("dead_volume_mL = 0.43" in note for note in report.notes)
    drawn_mL = assemble(load_scene("paper-dome", None, LIBRARY)).drawn_volume / 1e3
    assert told["dead volume as drawn, mL"].value == pytest.approx(drawn_mL, rel=1e-3) == pytest.approx(1.5, abs=0.1)


def test_entering_again_gives_the_same_bytes_and_keeps_what_was_measured_before(lab, tmp_path):
    lab(measured())
    path = tmp_path / "printprofiles/materials/TangoPlus.toml"
    first = path.read_bytes()
    lab(measured())
    assert path.read_bytes() == first
    lab({"lab": "Soft lab", "date": datetime.date(2027, 1, 1), "puck": {"TangoPlus": {"shore_a": [32.0, 33.0]}}})
    ours = Library((tmp_path,)).load("materials", "TangoPlus")
    assert ours.shore_a.value == 32.5
    assert ours.shear_modulus_MPa.value == pytest.approx(MU)
    assert not list(path.parent.glob(".*"))


def test_the_hardness_farthest_from_the_shipped_one_is_questioned(lab):
    """It may lie below, where it is the smaller number."""
    puck = {"TangoPlus": {"shore_a": [1.0, 30.0]}}
    report = lab({"lab": "Soft lab", "date": datetime.date(2026, 11, 21), "puck": puck})
    assert any(note.startswith("TangoPlus: shore_a = 1 is 26.6 points off") for note in report.notes)


def test_a_profile_of_the_labs_own_is_never_overwritten(lab, tmp_path):
    path = tmp_path / "printprofiles/objet260-connex.toml"
    path.parent.mkdir()
    path.write_text((ROOT / "printprofiles/objet260-connex.toml").read_text())
    before = path.read_bytes()
    with pytest.raises(InputError, match="was not written by pneutouch coupons") as error:
        lab(measured())
    assert "accuracy_mm, hole_undersize_mm" in str(error.value)
    assert path.read_bytes() == before
    assert not (tmp_path / "printprofiles/materials").exists()
    lab(measured(), tmp_path / "elsewhere")
    assert (tmp_path / "elsewhere/printprofiles/objet260-connex.toml").read_text().startswith(HEAD)


def changed(*keys_and_value):
    *keys, last, value = keys_and_value
    content = measured()
    owner = content
    for key in keys:
        owner = owner[key]
    owner[last] = value
    return content


PUCK, PULLED = ("puck", "TangoPlus"), ("dumbbell", "TangoPlus")
GAUGE = ("gauge", "objet260-connex", "TangoPlus")
BAD = [
    (changed(*PUCK, "shore_a", [30.0, 130.0]), "puck.TangoPlus.shore_a: reading 2 = 130: must be from 0 to 100"),
    (changed(*PUCK, "shore_a", [30.0]), "puck.TangoPlus.shore_a: [30.0]: at least 2 readings"),
    (changed(*PUCK, "mass_g", [1.0, -1.0]), "reading 2 = -1: must be from 0.0001 to 10000 g"),
    (changed(*PUCK, "mass_g", [1.0, 1.0, 1.0]), "have 3, 2 and 2 readings"),
    (changed(*PUCK, "mass_g", [1090.0, 1100.0]), "puck 1: mass_g = 1090"),
    (changed(*PUCK, "shore", [1.0]), "puck.TangoPlus.shore: unknown key. Did you mean shore_"),
    (changed(*PUCK, "shore_a", "30"), 'puck.TangoPlus.shore_a = "30"'),
    (changed("puck", "TangoPlu", {"shore_a": [30.0, 30.0]}), 'puck = "TangoPlu": no such name among the materials'),
    (changed("pucks", {}), "pucks: unknown coupon. Did you mean puck"),
    (changed("lab", ""), 'lab = ""'),
    (changed("date", "soon"), 'date = "soon"'),
    (changed(*PULLED, "specimen", [specimen(0.2)]), "1 specimen with a curve; at least 2"),
    (changed(*PULLED, "largest_strain", 0.02), "specimen[1]: 1 points up to a strain of 0.02"),
    (changed(*PULLED, "specimen", [{**specimen(0.2), "force_N": [1.0, 2.0, 3.0]}] * 2), "must have as many"),
    (
        changed(*PULLED, "specimen", [{**specimen(0.2), "width_mm": [-6.0, 6.0]}] * 2),
        "specimen[1].width_mm: reading 1 = -6",
    ),
    (changed("dumbbell", "VeroClear", {"specimen": [specimen(0.2)] * 2}), "is rigid"),
    (changed(*GAUGE, "hole", sizes((0.45, 0.5))), "hole: nominal_mm = 0.45: not on the gauge, which has 0.4, 0.5"),
    (changed(*GAUGE, "hole", sizes((0.5, 0.5))), "there twice"),
    (changed(*GAUGE, "x", [{"nominal_mm": 20.0, "measured_mm": [2.0, 2.0]}]), "more than a tenth off"),
    (changed(*GAUGE, "wall", [{"nominal_mm": -1.0}]), "wall[1].nominal_mm = -1.0"),
    (changed("gauge", "objet", {"TangoPlus": {}}), 'gauge = "objet": no such name among the printers'),
    (changed("gauge", "abs-filament", {"TangoPlus": {}}), "cannot run TangoPlus"),
    (changed("volume-plug", "paper-dome", "pressure_kPa", [60.0, 61.0]), "less over the plug than over the cap"),
    (changed("leak-cap", "paper-dome", "end_kPa", []), "one each a run"),
    (changed("leak-cap", "nowhere", {}), "no such name among the designs"),
]


@pytest.mark.parametrize(("content", "said"), BAD, ids=[said[:40] for _, said in BAD])
def test_bad_results_name_file_key_and_what_would_be_right(lab, tmp_path, content, said):
    with pytest.raises(InputError) as error:
        lab(content)
    assert said in str(error.value)
    assert "results.toml" in str(error.value)
    assert not (tmp_path / "printprofiles").exists()


def test_no_lab_and_no_reading_are_said(lab, tmp_path):
    with pytest.raises(InputError, match="nothing measured"):
        lab({"lab": "x", "date": datetime.date(2026, 1, 1)})
    path = tmp_path / "empty.toml"
    path.write_text(results_template(order(CouponOptions(), LIBRARY)))
    with pytest.raises(InputError, match="lab: missing; give who measured"):
        read_results(path)


def test_the_smallest_sound_feature_has_only_sound_ones_above_it():
    def row(*told):
        return [GaugeSize(nominal_mm=float(k), came_out=one) for k, one in enumerate(told, start=1)]

    assert smallest_sound(row(True, False, True, True)) == 3
    assert smallest_sound(row(True, None, True)) == 1
    assert smallest_sound(row(True, True, False)) is None
    assert smallest_sound(row(None, None)) is None
