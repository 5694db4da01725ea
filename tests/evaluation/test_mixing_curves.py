"""A mix by every curve of its pair: the figures are those of the design that names the curve, and a measured curve ends it."""

from __future__ import annotations

import pytest

from pneutouch.evaluation.evaluate import evaluate
from pneutouch.evaluation.sheet import sheet_data
from pneutouch.evaluation.subject import by_mixing_curve
from pneutouch.report.blocks import Items, SheetTable, found
from pneutouch.report.conditions import mixing_section
from pneutouch.results.record import plain as data
from pneutouch.spec.read import parse_changes

SHALLOW = ["indentation.depth_mm=3", "indentation.steps=6", "pneumatics.driving_pressures_kPa=[0, 12]"]
MEASURED = """
title = "measured"
soft = "TangoPlus"
stiff = "VeroClear"
assumption = "measured on coupons of known fractions"
[[points]]
fraction = 0.0
shear_modulus_MPa = 0.17
shear_modulus_spread_MPa = 0.01
source = "our dumbbells"
[[points]]
fraction = 0.3
shear_modulus_MPa = 2.9
shear_modulus_spread_MPa = 0.1
source = "our dumbbells"
"""


def mixed(*more: str, fraction: str = "[0.0, 0.06, 0.19]", curve: str = "", **options):
    name = f', curve = "{curve}"' if curve else ""
    material = f'membrane.material={{from = "TangoPlus", to = "VeroClear", fraction = {fraction}{name}}}'
    return evaluate("graded-dome", parse_changes([*SHALLOW, material, *more]), **options)


@pytest.fixture(scope="module")
def graded():
    return mixed()


def finding(evaluation):
    return [one for one in evaluation.findings if one.rule == "mixing curve"]


@pytest.mark.slow
@pytest.mark.parametrize("curve", ["mixture-tool", "j750-hardness"])
def test_another_curve_does_what_the_design_that_names_it_does(graded, curve):
    named = mixed(curve=curve)
    outcome = next(one for one in graded.curves if one.by_curve.curve == curve)
    assert outcome.rated == pytest.approx(named.rating.pressure, rel=1e-9)
    for state, there in zip(outcome.states, named.prediction.states, strict=True):
        assert state.driving_pressure == there.driving_pressure
        assert state.figures.sensitivity == pytest.approx(there.figures.sensitivity, rel=1e-9)
        assert state.figures.force_range == pytest.approx(there.figures.force_range, rel=1e-9)


def test_a_stiffer_wall_reads_less_at_a_newton(graded):
    softer, used, stiffer = (one.states[0].figures.sensitivity for one in graded.curves)
    assert softer > used > stiffer
    assert used == graded.prediction.states[0].figures.sensitivity


@pytest.mark.slow
def test_check_and_datasheet_set_the_curves_side_by_side(graded):
    (note,) = finding(graded)
    assert note.severity == "note"
    (table,) = found(mixing_section(sheet_data(graded, "")), SheetTable)
    assert table.head[1:-1] == ["mixture-tool: softer", "j750-tension: in use", "j750-hardness: stiffer"]
    assert [len(row) for row in table.rows] == [5] * 6
    for one in graded.curves:
        assert one.by_curve.curve in note.message
        assert f"{one.states[-1].figures.sensitivity:.2f} kPa/N" in note.message
    document = data(by_mixing_curve(graded.curves))
    assert [entry["place"] for entry in document] == ["softer", "in use", "stiffer"]
    assert document[1]["rated_pressure_kPa"] == pytest.approx(1e3 * graded.rating.pressure, rel=1e-5)


@pytest.mark.slow
def test_a_fraction_beyond_the_stiffest_curve_is_a_warning():
    evaluation = mixed(fraction="0.25")
    (warning,) = finding(evaluation)
    assert warning.severity == "warning"
    assert "j750-hardness: stiffer than any resin that it states, perhaps rigid there" in warning.message
    (notes,) = found(mixing_section(sheet_data(evaluation, "")), Items)
    assert any("j750-hardness" in line for line in notes.lines[1:])


@pytest.mark.slow
def test_a_measured_curve_and_a_resin_have_no_other_curves(tmp_path, library):
    folder = tmp_path / "printprofiles/mixing"
    folder.mkdir(parents=True)
    (folder / "TangoPlus+VeroClear.toml").write_text(MEASURED, encoding="utf-8")
    measured = mixed(fraction="0.1", library=type(library)((tmp_path, *library.folders)))
    resin = evaluate("paper-dome", parse_changes(SHALLOW))
    for evaluation in (measured, resin):
        assert evaluation.curves == ()
        assert finding(evaluation) == []
        assert mixing_section(sheet_data(evaluation, "")) == []
    assert "mixing fraction" not in str(measured.uncertainty)
