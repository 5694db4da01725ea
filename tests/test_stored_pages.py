"""Pages that are filled from stored measurements are those of their templates, and their charts those of the numbers."""

from __future__ import annotations

import pytest
import stored_pages
from pictures.charts import CHARTS
from stored_pages import DOCS, change, fixed, hundredths, percent, render, short

from tests.drawings import same_drawing

_SLOW = {
    "contact",
    "dither",
    "graded",
    "hard-resins",
    "meshing",
    "speed-accuracy",
    "speed-against-accuracy",
    "texture",
    "texture-scan",
    "validity",
}


@pytest.mark.parametrize("path", stored_pages.paths())
def test_the_page_is_its_template_filled(path):
    assert (DOCS / path).read_text(encoding="utf-8") == render(path), "make pages"


def test_every_stored_measurement_belongs_to_a_template_or_a_reduction():
    """A file that nothing reads would be left behind by a page that has gone."""
    texts = [path.read_text(encoding="utf-8") for path in stored_pages.TEMPLATES.rglob("*.j2")]
    texts += [path.read_text(encoding="utf-8") for path in (DOCS.parent / "benchmarks").glob("*.py")]
    texts += [path.read_text(encoding="utf-8") for path in (DOCS / "_ext").rglob("*.py")]
    whole = "\n".join(texts)
    names = {path.stem for path in (DOCS / "background").glob("*.json")} - {f"mutants-{k}" for k in range(1, 10)}
    assert {name for name in names if f'"{name}"' not in whole and f'"{name}.json"' not in whole} == set()


@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.slow) if n in _SLOW else n for n in CHARTS])
def test_the_stored_chart_is_that_of_today(name):
    assert same_drawing(DOCS / "background" / f"{name}.svg", CHARTS[name]())


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        (fixed(1.005, 1), "1.0"),
        (fixed(None), "–"),
        (short(12345.6), "1.23e+04"),
        (percent(0.0875, 1), "8.8 %"),
        (change(-0.0004, 2), "-0.04 %"),
        (hundredths(0.5), "50"),
    ],
)
def test_numbers_are_written_with_their_digits(text, wanted):
    assert text == wanted


def test_a_key_that_no_measurement_has_is_an_error(monkeypatch, tmp_path):
    from jinja2 import FileSystemLoader
    from jinja2.exceptions import UndefinedError

    (tmp_path / "page.md.j2").write_text('{{ stored("friction").nothing }}\n')
    monkeypatch.setattr(stored_pages.environment(), "loader", FileSystemLoader(tmp_path))
    with pytest.raises(UndefinedError):
        render("page.md")
