"""docs/reference/materials.md is made from the material files, and its figures are what the solid gives."""

from __future__ import annotations

import pytest
from benchmarks.materials_page import PAGE, hardness, law_words, materials, page


@pytest.mark.slow
def test_the_page_is_what_the_program_gives():
    assert PAGE.read_text(encoding="utf-8") == page()


def test_every_material_stands_on_it_with_its_law():
    text = PAGE.read_text(encoding="utf-8")
    assert hardness() in text
    for name, material in materials().items():
        (row,) = [line for line in text.splitlines() if line.startswith(f"| `{name}` | {material.kind_shown} ")]
        assert all(cell in row for cell in law_words(material))
