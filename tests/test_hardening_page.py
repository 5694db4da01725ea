"""docs/background/hardening.md is made from the constants of the code."""

from benchmarks.hardening_page import DOCS, page


def test_the_page_is_that_of_the_constants():
    assert (DOCS / "hardening.md").read_text(encoding="utf-8") == page()
