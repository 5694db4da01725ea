"""The page has the tables and the chart that the code gives."""

from __future__ import annotations

from benchmarks import dynamics

from tests.drawings import same_drawing


def test_the_tables_and_the_chart_are_those_of_today():
    page = (dynamics.DOCS / "dynamics.md").read_text(encoding="utf-8")
    known = dynamics.states()
    assert "\n".join(dynamics.peaks()) in page
    assert "\n".join(dynamics.tubes(known)) in page
    assert same_drawing(dynamics.DOCS / "dynamics.svg", dynamics.chart(known))
