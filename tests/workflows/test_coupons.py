"""A set of coupons as a folder."""

from __future__ import annotations

import datetime
import itertools
import json
import tomllib
from pathlib import Path

import numpy as np
import pytest

from pneutouch.catalogue import Library
from pneutouch.errors import InputError
from pneutouch.parts.coupons import COUPONS
from pneutouch.spec.coupon import CouponResults
from pneutouch.workflows.coupons.make import build_coupons, lay
from pneutouch.workflows.coupons.order import CouponOptions, order, results_template
from tests.conftest import ROOT
from tests.export.threemf_files import read_strictly
from tests.refusals import refused

LIBRARY = Library((ROOT,))
WHOLE = CouponOptions(materials=("TangoPlus", "FLX9960"), design="paper-dome")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return Path(build_coupons(WHOLE, tmp_path_factory.mktemp("outputs"), LIBRARY).folder)


def test_the_folder_holds_what_its_manifest_says(folder):
    manifest = json.loads((folder / "manifest.json").read_text())
    there = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert there == {*manifest["files"], "manifest.json"}
    assert {"measure.md", "results.toml", f"{folder.name}.3mf", "abs-filament.3mf"} <= there
    for coupon in manifest["coupons"]:
        assert coupon["volume_mm3"] == pytest.approx(coupon["exact_volume_mm3"], rel=1e-3)
    assert {coupon["coupon"] for coupon in manifest["coupons"]} == set(COUPONS)


def test_the_same_input_gives_the_same_bytes(folder, tmp_path):
    again = Path(build_coupons(WHOLE, tmp_path, LIBRARY).folder)
    for path in folder.rglob("*"):
        if path.is_file():
            assert (again / path.relative_to(folder)).read_bytes() == path.read_bytes(), path


def test_readings_in_the_folder_are_not_lost(tmp_path):
    asked = CouponOptions(only=("puck",))
    path = Path(build_coupons(asked, tmp_path, LIBRARY).folder) / "results.toml"
    build_coupons(asked, tmp_path, LIBRARY)
    path.write_text(path.read_text().replace("mass_g = []", "mass_g = [1.1, 1.1]"))
    with refused(None, file=path):
        build_coupons(asked, tmp_path, LIBRARY)
    assert "1.1" in path.read_text()


def test_the_3mf_holds_every_copy_in_its_material(folder):
    read_strictly(folder / f"{folder.name}.3mf")


def test_coupons_lie_apart_and_inside_the_tray():
    for name, items in order(WHOLE, LIBRARY).machines().items():
        room = items[0].printer.envelope_mm
        boxes = [body.bounds for piece in lay(name, items) for body in piece.copies()]
        assert len(boxes) == sum(item.copies * len(item.coupon.draw(item.context)) for item in items)
        for box in boxes:
            assert box[0][:2].min() >= 4.9
            assert box[0][2] == pytest.approx(0, abs=1e-9)
            assert (box[1] <= [room.x - 4.9, room.y - 4.9, room.z]).all()
        for a, b in itertools.combinations(boxes, 2):
            gap = np.maximum(a[0] - b[1], b[0] - a[1])[:2].max()
            assert gap >= 4.99


def test_what_does_not_fit_is_refused():
    with pytest.raises(InputError, match="no longer fits the tray"):
        lay("objet260-connex", order(CouponOptions(copies={"dumbbell": 60}), LIBRARY).items)


@pytest.mark.slow
@pytest.mark.parametrize(
    "asked",
    [
        *(CouponOptions(design=name) for name in LIBRARY.paths("designs")),
        # The tray of the J55 takes no dumbbell besides the others, and its order says so.
        *(CouponOptions(profile=name, only=("puck",) if name == "j55" else ()) for name in LIBRARY.paths("printers")),
    ],
    ids=lambda asked: asked.design or asked.profile,
)
def test_the_coupons_of_every_shipped_design_and_profile_fit_its_trays(asked):
    for name, items in order(asked, LIBRARY).machines().items():
        envelope = items[0].printer.envelope
        boxes = [body.bounds for piece in lay(name, items) for body in piece.copies()]
        assert len(boxes) == sum(item.copies * len(item.solids()) for item in items)
        for box in boxes:
            assert (box >= -1e-9).all() and (box[1] <= (envelope.x, envelope.y, envelope.z)).all()
        for a, b in itertools.combinations(boxes, 2):
            assert np.maximum(a[0] - b[1], b[0] - a[1])[:2].max() >= 4.99


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (CouponOptions(profile="objet"), 'profile = "objet": no such name among the printers'),
        (CouponOptions(materials=("Tango",)), "Did you mean TangoPlus"),
        (CouponOptions(materials=("Agilus30",)), "cannot run Agilus30"),
        (CouponOptions(only=("pucks",)), 'only = "pucks": no such coupon. Did you mean puck'),
        (CouponOptions(only=("leak-cap",)), "give `design`"),
        (CouponOptions(only=("dumbbell",), materials=("VeroClear",)), "is for elastomer"),
        (CouponOptions(copies={"puck": 0}), 'copies = "puck=0"'),
        (CouponOptions(design="paper"), "no such design"),
    ],
)
def test_what_cannot_be_ordered_is_said(asked, said):
    with pytest.raises(InputError) as error:
        order(asked, LIBRARY)
    assert said in str(error.value)


def test_the_template_lists_every_nominal_and_is_valid_once_signed():
    text = results_template(order(WHOLE, LIBRARY))
    assert "lab" not in tomllib.loads(text)
    results = CouponResults.model_validate({**tomllib.loads(text), "lab": "ours", "date": datetime.date(2026, 11, 21)})
    assert set(results.puck) == set(results.dumbbell) == {"TangoPlus", "FLX9960"}
    assert len(results.dumbbell["TangoPlus"].specimen) == 5
    gauge = results.gauge["objet260-connex"]["TangoPlus"]
    listed = [(row, size.nominal_mm) for row in type(gauge).model_fields for size in getattr(gauge, row)]
    nominals = COUPONS["gauge"].nominals(order(WHOLE, LIBRARY).items[0].context)
    assert listed == [(nominal.feature, nominal.value) for nominal in nominals]
    assert set(results.leak_cap) == set(results.volume_plug) == {"paper-dome"}
