"""The charts of pages that are written by hand are what the code draws today, and the pages state what they show."""

from __future__ import annotations

import re

import pytest
from pictures.background import CHARTS, DOCS, shares

from tests.drawings import same_drawing

_SLOW = {"graded"}


@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.slow) if n in _SLOW else n for n in CHARTS])
def test_the_stored_chart_is_that_of_today(name):
    page = (DOCS / f"{name}.md").read_text(encoding="utf-8")
    assert page.count(f"]({name}.svg)") == 1
    assert same_drawing(DOCS / f"{name}.svg", CHARTS[name]())


def test_the_page_on_the_uncertainty_begins_with_the_shares_of_its_chart():
    text = " ".join((DOCS / "uncertainty.md").read_text(encoding="utf-8").split())
    parts, low, high = shares()["sensitivity_kPa_per_N"]
    assert f"from {low:.2f} to {high:.2f}" in text
    assert (
        f"{parts['ageing']:.0%} of the variance is ageing, {parts['model']:.0%} the error of the model".replace(
            "%", " %"
        )
        in text
    )
    assert re.search(
        r"far less certain, 39\.6 kPa with {:.1f} to {:.1f} kPa".format(*shares()["limit_pressure_kPa"][1:]), text
    )
