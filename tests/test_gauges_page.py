"""docs/reference/gauges.md is made from the files of the gauges, and states the source of every number."""

from benchmarks.gauges_page import PAGE, gauges, page

from pneutouch.spec.gauge import FIGURES


def test_the_page_is_that_of_the_files():
    assert PAGE.read_text(encoding="utf-8") == page()


def test_every_source_and_every_unknown_figure_stands_on_the_page():
    text = PAGE.read_text(encoding="utf-8")
    for gauge in gauges().values():
        assert all(getattr(gauge, key).source in text for key in FIGURES if getattr(gauge, key) is not None)
        assert all(why in text for why in gauge.unknown.values())
    assert text.count("**unknown**") >= sum(len(gauge.unknown) for gauge in gauges().values())
