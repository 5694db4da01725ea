"""The datasheet: every section, figures that match the prediction, self-contained, repeatable, readable as PDF."""

from __future__ import annotations

import json
import re

import numpy as np
import pypdfium2
import pytest

SECTIONS = [
    "Performance", "Absolute maximum ratings", "Operating conditions", "What limits the driving pressure", "Environment",
    "Mechanical drawing", "Material and print", "Reliability", "Ordering code", "How to measure it", "Handling",
    "Assumptions of the prediction", "Definitions", "Revisions",
]  # fmt: skip


@pytest.fixture(scope="module")
def html(built):
    return (built("paper-dome") / "datasheet.html").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def pdf_text(built):
    document = pypdfium2.PdfDocument(built("paper-dome") / "datasheet.pdf")
    return [page.get_textpage().get_text_range() for page in document]


@pytest.mark.parametrize("section", SECTIONS)
def test_page_and_pdf_have_every_section(section, html, pdf_text):
    assert f"<h2>{section}</h2>" in html
    assert section in "\n".join(pdf_text)


def test_page_is_self_contained_and_holds_the_3d_view(html):
    addresses = re.findall(r"""(?:src|href)=["']?(https?://[^"'>]+)""", html)
    assert addresses == []
    assert "<iframe" in html
    assert "THREE" in html
    assert "url(data:font/otf;base64," in html
    assert html.count("<svg") == 6


def test_sheet_states_the_predicted_figures(built, html, pdf_text):
    prediction = json.loads((built("paper-dome") / "prediction.json").read_text())
    text = "\n".join(pdf_text)
    for state in prediction["states"]:
        for value in (state["sensitivity_kPa_per_N"], state["apex_height_inner_mm"], state["apex_height_outer_mm"]):
            assert f"{value:.2f}" in html
            assert f"{value:.2f}" in text
    for word in (
        f"{prediction['limit_point']['driving_pressure_kPa']:.2f}",
        "limit point",
        "PNT-R0925-T150-TP-B4-GF-M3",
    ):
        assert word in html
        assert word in text


def test_what_was_not_tested_says_so(html, pdf_text):
    assert "Predicted. No unit has been built or tested." in html
    assert html.count("not tested") >= 8
    assert "Predicted. No unit has been built or tested." in pdf_text[0]


def test_published_measurements_stand_beside_the_prediction_only_for_the_papers_sensor(built, html):
    assert "2.547" in html
    assert "1.923" in html
    other = (built("fingertip-dome") / "datasheet.html").read_text(encoding="utf-8")
    assert "2.417" not in other


def test_zero_drift_is_that_of_the_gas_in_a_dome_that_yields(evaluated):
    """By brute force: the volume at which the warmed gas and the dome's own curve balance."""
    from pneutouch.report import Sheet

    evaluation = evaluated("paper-dome")
    sheet = Sheet(evaluation.scene, evaluation.assembly, evaluation.prediction, [], "", {})
    state, curve = evaluation.prediction.states[3], evaluation.prediction.inflation
    volume = np.linspace(0.9 * state.cavity_volume, 1.1 * state.cavity_volume, 200001)
    dome = np.interp(volume, curve.volume, curve.pressure) + 0.101325
    content = (0.022 + 0.101325) * state.cavity_volume
    warmed = volume[np.argmin(np.abs(dome - content * (1 + 2 / 293.15) / volume))]
    before = volume[np.argmin(np.abs(dome - content / volume))]
    rise = np.interp(warmed, volume, dome) - np.interp(before, volume, dome)
    assert sheet.zero_drift(state) == pytest.approx(1e3 * rise / 2, rel=0.1)
    assert sheet.zero_drift(state) < 0.5 * 123.3 / 293.15


def test_rating_stays_below_the_limit_that_binds(evaluated, built):
    limit = evaluated("paper-dome").prediction.limits.lowest
    html = (built("paper-dome") / "datasheet.html").read_text(encoding="utf-8")
    assert f"{int(10 * 0.9e3 * limit) / 10:.1f}" in html


def test_a_resin_that_cannot_be_solved_does_not_stop_the_sheet(evaluated, library, monkeypatch):
    from pneutouch.errors import ComputationError
    from pneutouch.report import variants
    from pneutouch.spec.material import Material

    def fail(*words, **options):
        raise ComputationError("no equilibrium")

    monkeypatch.setattr(variants, "predict", fail)
    materials = library.all("materials", Material)
    assert variants.resin_curves(evaluated("paper-dome").sensor, materials, 0.02, "solid", None) == {}


def test_pdf_is_a_few_a4_pages_with_text_on_each(built):
    document = pypdfium2.PdfDocument(built("paper-dome") / "datasheet.pdf")
    assert 3 <= len(document) <= 5
    for page in document:
        assert page.get_size() == (pytest.approx(595.28, abs=0.1), pytest.approx(841.89, abs=0.1))
        assert len(page.get_textpage().get_text_range()) > 300


def test_pdf_pages_keep_text_inside_the_margins(built):
    """A column that is too narrow or a figure that is too wide shows as ink beyond the margin."""
    document = pypdfium2.PdfDocument(built("fingertip-dome") / "datasheet.pdf")
    for number, page in enumerate(document):
        image = page.render(scale=1).to_numpy()
        body = image[100:-60, :, :3] if number == 0 else image[:, :, :3]
        assert (body[:, -28:] > 245).all(), number
        assert (body[:, :28] > 245).all(), number


def test_axes_carry_quantities_and_units(evaluated):
    from matplotlib.figure import Figure

    from pneutouch.report import curves

    seen = []
    original = Figure.savefig

    def record(self, *words, **options):
        seen.extend((ax.get_xlabel(), ax.get_ylabel()) for ax in self.axes)
        return original(self, *words, **options)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Figure, "savefig", record)
        evaluation = evaluated("paper-dome")
        curves.inflation(evaluation.sensor, evaluation.prediction)
        curves.response(evaluation.prediction)
        curves.indentation(evaluation.prediction)
    assert len(seen) == 3
    assert all(re.search(r"\w+  \((kPa|N|mm|kPa/N)\)$", label) for pair in seen for label in pair)


def test_print_sheet_names_files_resins_machines_and_the_measured_deviation(built):
    text = (built("fingertip-dome") / "print-sheet.md").read_text()
    for word in (
        "stl/membrane.stl", "FLX9940-DM (TangoPlus + VeroClear)", "Objet260", "Digital Material", "dome up",
        "choose the resin of each body by hand", "greatest measured distance",
    ):  # fmt: skip
        assert word in text


def test_seven_resins_are_compared_and_stop_at_their_own_limits(evaluated, library):
    from pneutouch.mechanics.limits import limits
    from pneutouch.report.variants import resin_curves
    from pneutouch.spec.material import Material

    sensor = evaluated("paper-dome").sensor
    materials = library.all("materials", Material)
    found = resin_curves(sensor, materials, 0.060, "membrane", "variational")
    assert set(found) == {m.title for m in materials.values() if m.kind == "elastomer"}
    assert found["TangoPlus"][0][-1] <= 1e3 * limits(sensor).limit_point
    assert found["FLX9970-DM"][0][-1] == pytest.approx(60.0)
