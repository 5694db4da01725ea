"""Readings that no print can give are refused before they reach a profile; unlikely ones are noted."""

from __future__ import annotations

import datetime

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.catalogue import Library
from pneutouch.errors import InputError
from pneutouch.parts.coupons.gauge import rows
from pneutouch.spec.coupon import CouponResults
from pneutouch.spec.printer import HOLE_UNDERSIZE_MM
from pneutouch.spec.toml_text import toml_text
from pneutouch.workflows.coupons.results import enter_results, evaluate_results
from tests.conftest import ROOT

LIBRARY = Library((ROOT,))
PRINTER, RESIN, DESIGN = "objet260-connex", "TangoPlus", "paper-dome"
NOMINALS = {row.feature: row.sizes for row in rows()}


def entered(**tables):
    content = {
        "lab": "ours",
        "date": datetime.date(2026, 11, 21),
        **{k.replace("_", "-"): v for k, v in tables.items()},
    }
    return evaluate_results(CouponResults.model_validate(content), "results.toml", LIBRARY)


def refused(**tables):
    with pytest.raises(InputError) as error:
        entered(**tables)
    assert str(error.value).startswith("results.toml: ")
    return str(error.value)


def gauged(row, *sizes):
    sizes_read = [{"nominal_mm": nominal, "measured_mm": [reading, reading]} for nominal, reading in sizes]
    return {"gauge": {PRINTER: {RESIN: {row: sizes_read}}}}


def pulled(*forces):
    specimen = {
        "width_mm": [6.0, 6.0],
        "thickness_mm": [2.0, 2.0],
        "extension_mm": [float(k) for k in range(1, len(forces) + 1)],
        "force_N": list(forces),
    }
    return {"dumbbell": {RESIN: {"specimen": [specimen, specimen]}}}


def neo_hookean(mu):
    stretch = 1 + np.arange(1, 5) / 25
    return pulled(*(12.0 * mu * (stretch - stretch**-2)).tolist())


def capped(start, end, accuracy=None):
    plug = {} if accuracy is None else {"volume_plug": {DESIGN: {"gauge_accuracy_kPa": accuracy}}}
    return {"leak_cap": {DESIGN: {"start_kPa": start, "end_kPa": end}}, **plug}


@pytest.mark.parametrize(
    ("row", "nominal", "reading", "right"),
    [
        ("hole", 1.0, 9.0, "from 0.5 to 1.5 mm"),
        ("wall", 0.3, 50.0, "from 0 to 0.6 mm"),
        ("pin", 2.0, 0.9, "from 1 to 3 mm"),
        ("slot", 0.5, 50.0, "from 0.2 to 0.8 mm"),
    ],
)
def test_a_slip_in_a_row_of_the_gauge_is_refused(row, nominal, reading, right):
    message = refused(**gauged(row, (nominal, reading), (2.0, 2.0)))
    assert f"gauge.{PRINTER}.{RESIN}.{row}: nominal_mm = {nominal:g}: measured_mm = {reading:g}" in message
    assert right in message
    assert "unit" in message and "row" in message


@given(row=st.sampled_from(sorted(NOMINALS)), place=st.integers(0, 8), share=st.floats(-3, 3))
def test_the_slip_is_more_than_three_tenths_and_more_than_half(row, place, share):
    nominal = NOMINALS[row][place]
    reading = max(nominal + share * nominal, 0.01)
    off, limit = abs(reading - nominal), max(0.3, 0.5 * nominal)
    if abs(off - limit) < 1e-6:
        return
    sizes = [(nominal, reading), *((n, n) for n in NOMINALS[row] if n != nominal)]
    if off > limit:
        assert "measured_mm" in refused(**gauged(row, *sizes))
    elif row != "hole" or HOLE_UNDERSIZE_MM[0] <= nominal - reading <= HOLE_UNDERSIZE_MM[1]:
        entered(**gauged(row, *sizes))


def test_readings_at_the_limit_pass():
    for row, nominal, reading in (("wall", 0.5, 0.8), ("slot", 0.2, 0.5), ("pin", 0.8, 1.2), ("pin", 0.4, 0.1)):
        entered(**gauged(row, (nominal, reading)))


@pytest.mark.parametrize(("reading", "made"), [(4.2, -1.2), (1.6, 1.4)])
def test_holes_that_make_a_profile_no_printer_has_are_refused(reading, made):
    message = refused(**gauged("hole", (3.0, reading), (2.0, 2.0)))
    assert f"gauge.{PRINTER}.hole: nominal_mm = 3: mean of measured_mm = {reading:g}" in message
    assert f"hole_undersize_mm = {made:g}" in message
    assert "must be from -0.5 to 1 mm" in message


def test_nothing_is_written_of_what_is_refused(tmp_path):
    content = {"lab": "x", "date": datetime.date(2026, 11, 21), **gauged("hole", (1.0, 9.0), (2.0, 9.0))}
    (tmp_path / "results.toml").write_text(toml_text(content))
    with pytest.raises(InputError):
        enter_results(tmp_path / "results.toml", tmp_path, Library((tmp_path, ROOT)))
    assert not (tmp_path / "printprofiles").exists()


@pytest.mark.parametrize("forces", [(30000.0, 20000.0, 10000.0), (0.3, 0.6, 0.5, 1.0), (0.3, 0.3, 0.3)])
def test_force_must_rise_with_extension(forces):
    message = refused(**pulled(*forces))
    assert f"dumbbell.{RESIN}.specimen[1].force_N" in message
    assert "must rise" in message


def test_points_may_come_in_any_order_and_a_gauge_may_repeat_a_force():
    backwards = pulled(1.0, 0.9, 0.6, 0.3)
    backwards["dumbbell"][RESIN]["specimen"][0]["extension_mm"].reverse()  # Both specimens are one object.
    entered(**backwards)
    entered(**pulled(0.3, 0.6, 0.6, 0.9))


@pytest.mark.parametrize("mu", [0.009, 61.0, 5558.0])
def test_a_modulus_that_no_elastomer_has_is_refused(mu):
    message = refused(**neo_hookean(mu))
    assert f"dumbbell.{RESIN}.specimen[1]: force_N" in message
    assert f"{mu:g} MPa" in message
    assert "from 0.01 to 60 MPa" in message


@pytest.mark.parametrize(
    ("mu", "noted"), [(0.17 * 5.1, True), (0.17 / 5.1, True), (0.17 * 4.9, False), (0.17 / 4.9, False)]
)
def test_a_modulus_far_from_the_shipped_one_is_noted(mu, noted):
    result = entered(**neo_hookean(mu))
    notes = [note for note in result.notes if "shipped" in note]
    assert bool(notes) == noted
    assert all(RESIN in note and "shear_modulus_MPa" in note and "0.17" in note for note in notes)


@pytest.mark.parametrize(
    ("name", "key", "readings", "noted"),
    [
        ("TangoPlus", "shore_a", [52.0, 53.0], True),
        ("TangoPlus", "shore_a", [52.0, 52.5], False),
        ("FLX9995", "shore_a", [66.0, 66.0], True),
        ("VeroClear", "shore_d", [30.0, 31.0], True),
        ("VeroClear", "shore_d", [80.0, 81.0], False),
        ("VeroClear", "shore_a", [30.0, 31.0], False),
    ],
)
def test_a_hardness_far_from_the_shipped_one_is_noted(name, key, readings, noted):
    notes = entered(puck={name: {key: readings}}).notes
    assert bool(notes) == noted
    assert all(name in note and key in note and "resin" in note for note in notes)


def test_a_cap_that_gains_pressure_is_refused():
    message = refused(**capped([20.0, 20.0], [19.0, 21.0]))
    assert f"leak-cap.{DESIGN}.end_kPa: run 2: 21 kPa" in message
    assert "start_kPa = 20" in message
    assert "gauge_accuracy_kPa" in message


def test_a_rise_within_the_gauges_accuracy_is_noted():
    result = entered(**capped([20.0, 20.0], [19.9, 20.1], 0.1))
    (note,) = result.notes
    assert "run 2" in note and "0.1 kPa" in note
    assert result.figures[0].value == pytest.approx(0.0, abs=1e-9)
    refused(**capped([20.0, 20.0], [19.9, 20.3], 0.1))
    assert not entered(**capped([20.0, 20.0], [19.9, 20.0])).notes
