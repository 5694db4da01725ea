"""Coupons of two resins mixed, and the mixing curve that a lab gets of them."""

from __future__ import annotations

import datetime
import itertools
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pneutouch.catalogue import Library
from pneutouch.catalogue.mixture import mixed_material, mixing
from pneutouch.errors import InputError
from pneutouch.mechanics.paper_sensor import shore_a
from pneutouch.spec.coupon import read_results
from pneutouch.spec.grade import Grade
from pneutouch.spec.toml_text import toml_text
from pneutouch.workflows.coupons.make import build_coupons, lay
from pneutouch.workflows.coupons.order import FRACTIONS, CouponOptions, order, results_template
from pneutouch.workflows.coupons.results import enter_results
from tests.conftest import ROOT
from tests.export.threemf_files import MODEL, parts_of, read_strictly
from tests.workflows.test_coupon_results import specimen

LIBRARY, PAIR = Library((ROOT,)), "TangoPlus+VeroClear"
BOTH = CouponOptions(profile="j735", mixing=(PAIR,), only=("puck", "dumbbell"))


def test_every_fraction_is_printed_of_its_own_mix(tmp_path):
    made = build_coupons(CouponOptions(profile="j735", mixing=(PAIR,)), tmp_path, LIBRARY)
    folder = Path(made.folder)
    assert [(c.coupon, c.copies) for c in made.coupons] == [("puck", 2)] * len(FRACTIONS)
    assert len({c.piece for c in made.coupons}) == 8
    manifest = json.loads((folder / "manifest.json").read_text())
    mixes = [item["material"]["mix"] for item in manifest["inputs"]["items"]]
    assert mixes[0] is None
    assert [mix["fractions"]["VeroClear"] for mix in mixes[1:]] == list(FRACTIONS[1:])
    _, reader = read_strictly(folder / f"{folder.name}.3mf")
    assert reader.GetWarningCount() == 0
    content = parts_of(folder / f"{folder.name}.3mf")[MODEL].decode()
    mixes = re.findall(r'<m:composite values="([^"]+)"', content)
    # Every composite lists all base materials of the file: its own two alone are not 0, the soft one first.
    shares = sorted([float(v) for v in values.split() if float(v)][1] for values in mixes)
    assert shares == pytest.approx([f for f in FRACTIONS[1:] for _ in range(2)], abs=1e-5)
    assert "voxel slices" in (folder / "measure.md").read_text()


def test_dumbbells_and_pucks_of_all_fractions_fit_a_large_tray():
    found = order(BOTH, LIBRARY)
    boxes = [body.bounds for piece in lay("j735", found.items) for body in piece.copies()]
    assert len(boxes) == 2 * 2 * len(FRACTIONS)
    for a, b in itertools.combinations(boxes, 2):
        assert np.maximum(a[0] - b[1], b[0] - a[1])[:2].max() >= 4.99
    with pytest.raises(InputError, match="no longer fits the tray"):
        small = found.items[0].printer.model_copy(update={"envelope_mm": LIBRARY.load("printers", "form3").envelope_mm})
        lay("j735", [replace(item, printer=small) for item in found.items])


def test_fractions_are_no_coupons_of_a_machine_without_voxel_print():
    with pytest.raises(InputError) as caught:
        order(CouponOptions(profile="objet260-connex", mixing=(PAIR,)), LIBRARY)
    assert caught.value.key == "mixing" and "j735" in str(caught.value.remedy)


def test_the_results_file_lists_every_fraction(tmp_path):
    path = tmp_path / "results.toml"
    path.write_text('lab = "x"\ndate = 2026-11-21\n' + results_template(order(BOTH, LIBRARY)))
    points = read_results(path).mixing[PAIR]
    assert [point.fraction for point in points] == list(FRACTIONS)
    assert [len(point.dumbbell.specimen) for point in points] == [2] * len(FRACTIONS)
    with pytest.raises(InputError, match="nothing measured"):
        enter_results(path, tmp_path, LIBRARY)


def pulled(fraction, modulus):
    return {"fraction": fraction, "dumbbell": {"specimen": [specimen(0.99 * modulus), specimen(1.01 * modulus)]}}


def read(fraction, *readings):
    return {"fraction": fraction, "shore_a": list(readings)}


@pytest.fixture
def enter(tmp_path):
    def run(points, pair=PAIR):
        path = tmp_path / "results.toml"
        content = {"lab": "Soft lab", "date": datetime.date(2026, 11, 21), "mixing": {pair: points}}
        path.write_text(toml_text(content))
        return enter_results(path, tmp_path, Library((tmp_path, ROOT)))

    return run


def mixed(library, fraction):
    grade = Grade.model_validate({"from": "TangoPlus", "to": "VeroClear", "fraction": fraction})
    return mixed_material(grade, library, file="here").shear_modulus_MPa


def test_the_labs_own_curve_comes_before_the_shipped_one(enter, tmp_path):
    moduli = {0.0: 0.2, 0.1: 0.5, 0.2: 1.5, 0.3: 6.0}
    report = enter([pulled(f, mu) for f, mu in moduli.items()])
    assert report.written == (str(tmp_path / f"printprofiles/mixing/{PAIR}.toml"),)
    mine = Library((tmp_path, ROOT))
    law = mixing("TangoPlus", "VeroClear", mine)
    assert not law.curve.is_assumed
    assert law.modulus_at(np.array(list(moduli))) == pytest.approx(list(moduli.values()), rel=1e-3)
    found = mixed(mine, 0.2)
    assert found.spread == pytest.approx(1.5 * 0.01 * np.sqrt(2), rel=1e-3)
    assert found.low is None
    assert "Soft lab" in found.source
    assert mixed(LIBRARY, 0.2).value != pytest.approx(1.5, rel=0.1)
    before = {change.key: change.before for change in report.changes}
    assert before["shear_modulus_MPa at 10 %"]["value"] == pytest.approx(mixed(LIBRARY, 0.1).value, rel=1e-3)


def test_hardness_gives_ratios_to_the_soft_resin(enter, tmp_path):
    """Hardnesses of 1, 2 and 6 times one Young's modulus: the same ratios of shear modulus, on TangoPlus's own."""
    young = 1.2
    points = [
        read(f, *(shore_a(k * young) + np.array([-0.2, 0.2])).tolist()) for f, k in ((0.0, 1), (0.1, 2), (0.3, 6))
    ]
    report = enter(points)
    curve = mixing("TangoPlus", "VeroClear", Library((tmp_path, ROOT)))
    assert curve.modulus == pytest.approx([0.17, 0.34, 1.02], rel=2e-3)
    assert (curve.spread[1:] > 0).all()
    assert "weaker than dumbbells" in curve.curve.points[1].source
    assert {figure.name for figure in report.figures} == {"shear modulus, MPa (hardness, by ratio)"}


def test_without_fraction_0_the_catalogues_soft_resin_begins_the_curve(enter, tmp_path):
    enter([pulled(0.1, 0.4), pulled(0.2, 0.9)])
    curve = mixing("TangoPlus", "VeroClear", Library((tmp_path, ROOT)))
    assert curve.curve.points[0].material == "TangoPlus"
    assert curve.modulus[0] == 0.17


def test_entering_again_gives_the_same_bytes_and_a_foreign_curve_stays(enter, tmp_path):
    path = tmp_path / f"printprofiles/mixing/{PAIR}.toml"
    points = [pulled(0.0, 0.2), pulled(0.1, 0.4)]
    enter(points)
    first = path.read_bytes()
    enter(points)
    assert path.read_bytes() == first
    path.write_text("\n".join(first.decode().splitlines()[2:]))
    with pytest.raises(InputError, match=r"was not written by pneutouch coupons.*points of 0, 0\.1"):
        enter(points)


SOFT = pulled(0.0, 0.2)
BAD = [
    ([SOFT, pulled(0.2, 0.5), pulled(0.1, 0.9)], "fraction = 0.1: after 0.2; the fractions must rise"),
    ([SOFT, pulled(0.1, 0.5), pulled(0.1, 0.9)], "fraction = 0.1: there twice"),
    ([SOFT, pulled(1.2, 0.5)], "[2].fraction = 1.2"),
    ([SOFT, pulled(0.1, 0.9), pulled(0.2, 0.5)], "0.5 MPa at fraction = 0.2 (dumbbells) after 0.9 MPa at 0.1"),
    ([pulled(0.1, 0.1), pulled(0.2, 0.5)], "after 0.17 MPa at 0 (the catalogue)"),
    ([SOFT, pulled(0.1, 90.0)], "makes a shear modulus of 89.1 MPa"),
    (
        [SOFT, {"fraction": 0.1, "dumbbell": {"specimen": [specimen(0.5)]}}],
        "mixing.TangoPlus+VeroClear[2].dumbbell: 1 specimen",
    ),
    ([SOFT, read(0.1, 40.0, 41.0)], "shore_a at fraction = 0 is missing"),
    ([read(0.0, 27.0, 28.0), read(0.1, 97.0, 98.0)], "97.5 on average"),
    ([SOFT, read(0.1, 40.0, 141.0)], "[2].shore_a: reading 2 = 141"),
    ([SOFT, {"fraction": 0.1, "shore": [1.0]}], "unknown key. Did you mean shore_a"),
    ([SOFT], "readings at fraction = 0 alone make no curve"),
]


@pytest.mark.parametrize(("points", "said"), BAD, ids=[said[:30] for _, said in BAD])
def test_bad_readings_name_what_would_be_right(enter, tmp_path, points, said):
    with pytest.raises(InputError) as error:
        enter(points)
    assert said in str(error.value)
    assert "results.toml" in str(error.value)
    assert not (tmp_path / "printprofiles").exists()


@pytest.mark.parametrize(
    ("pair", "said"),
    [
        ("TangoPlus", "write two resins, SOFT+STIFF"),
        ("TangoPlus+TangoPlus", "write two resins, SOFT+STIFF"),
        ("TangoPlus+Verro", '"Verro": no such name among the materials'),
        ("VeroClear+TangoPlus", "is rigid; write the soft resin first"),
    ],
)
def test_bad_pairs_are_said(enter, pair, said):
    with pytest.raises(InputError) as error:
        enter([SOFT, pulled(0.1, 0.5)], pair)
    assert said in str(error.value)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (CouponOptions(mixing=("TangoPlus",)), 'mixing = "TangoPlus": write two resins'),
        (CouponOptions(mixing=("TangoPlus+VeroBlue",)), "no such name among the materials"),
        (
            CouponOptions(mixing=("TangoPlus+ABS",)),
            "mixing: no mixing curve of ABS in TangoPlus; known: TangoPlus+VeroClear",
        ),
        (CouponOptions(mixing=(PAIR,), profile="abs-filament"), f'mixing = "{PAIR}": the'),
        (CouponOptions(mixing=(PAIR,), profile="j735", only=("gauge",)), 'only = "gauge"'),
    ],
)
def test_bad_orders_are_said(asked, said):
    with pytest.raises(InputError) as error:
        order(asked, LIBRARY)
    assert said in str(error.value)
