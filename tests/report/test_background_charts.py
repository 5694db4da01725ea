"""The page on the uncertainty states the shares that its chart shows."""

from __future__ import annotations

import pytest
from pictures.background import DOCS, shares
from pictures.charts import CHARTS


@pytest.mark.parametrize("name", CHARTS)
def test_every_chart_stands_on_a_page(name):
    assert any(f"]({name}.svg)" in page.read_text(encoding="utf-8") for page in DOCS.glob("*.md"))


def test_the_page_on_the_uncertainty_begins_with_the_shares_of_its_chart():
    text = " ".join((DOCS / "uncertainty.md").read_text(encoding="utf-8").split())
    parts, low, high = shares()["sensitivity_kPa_per_N"]
    assert f"{low:.2f} to {high:.2f}" in text
    assert f"{100 * parts['ageing']:.0f} %" in text and f"{100 * parts['model']:.0f} %" in text
    assert "{:.1f} to {:.1f} kPa".format(*shares()["limit_pressure_kPa"][1:]) in text
