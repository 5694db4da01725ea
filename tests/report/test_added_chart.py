"""A chart more on the datasheet: one function and one line of the table."""

from __future__ import annotations

import pytest

from pneutouch.evaluation.sheet import sheet_data
from pneutouch.report import datasheet, pages
from pneutouch.report.blocks import Plot, found
from pneutouch.report.chart import Panel, PlotLine, drawn_svg


def volumes(sheet):
    """Cavity volume over driving pressure."""
    curve = sheet.prediction.inflation
    panel = Panel(
        "driving pressure  (kPa)", "cavity volume  (mL)", (PlotLine(1e3 * curve.pressure, 1e-3 * curve.volume),)
    )
    return Plot(drawn_svg(panel), "Volume of the cavity & its <growth>.")


@pytest.fixture
def with_chart(monkeypatch):
    monkeypatch.setattr(datasheet, "CHARTS", (*datasheet.CHARTS, ("performance", volumes)))


@pytest.mark.slow
def test_an_added_chart_stands_on_page_and_pdf_with_its_caption(with_chart, evaluated):
    data = sheet_data(evaluated("paper-dome", model="atlas"), "0")
    drawn = volumes(data)
    sheet = datasheet.described(data)
    assert drawn in found(sheet.blocks, Plot)
    assert "Volume of the cavity &amp; its &lt;growth&gt;." in pages.html(sheet)
    files = pages.source(sheet)
    assert f'"{drawn.caption}"'.encode() in files["sheet.typ"]
    (name,) = [name for name, content in files.items() if content == drawn.svg.encode()]
    assert f'image("{name}"'.encode() in files["sheet.typ"]


@pytest.mark.slow
def test_without_it_the_sheet_does_not_have_it(evaluated):
    sheet = datasheet.described(sheet_data(evaluated("paper-dome", model="atlas"), "0"))
    assert not any("Volume of the cavity" in plot.caption for plot in found(sheet.blocks, Plot))
