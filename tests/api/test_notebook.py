"""A notebook whose cells show the objects: short text, and a table with a picture."""

from __future__ import annotations

import os

import nbformat
import pytest
from nbclient import NotebookClient

from tests.conftest import ROOT

CELLS = (
    'import pneutouch as pt\ndesign = pt.load("paper-dome"); design',
    'prediction = design.predict([0, 12], model="atlas"); prediction',
    "prediction.at(12)",
    "prediction.at(12).sensitivity",
    "design.check()",
    "design.bodies",
    'pt.compare(design, design.replace("thin", wall_thickness_mm=1.2), model="atlas")',
    "pt.select(sensitivity_kPa_per_N=1.9, driving_pressure_kPa=12)",
    "pt.materials()",
    'prediction.plot().figure.savefig("drawn.svg")',
)
PICTURES = {0, 1, 7}
"""Cells that draw a section."""


@pytest.fixture(scope="module")
def shown(tmp_path_factory):
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in CELLS])
    folder = tmp_path_factory.mktemp("notebook")
    kept = os.environ.get("PYTHONPATH", "")
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [str(ROOT / "generator"), kept]))
    os.environ.setdefault("MPLBACKEND", "agg")
    try:
        NotebookClient(book, timeout=300, resources={"metadata": {"path": str(folder)}}).execute()
    finally:
        os.environ["PYTHONPATH"] = kept
    assert (folder / "drawn.svg").is_file()
    return [[output.get("data", {}) for output in cell.outputs] for cell in book.cells]


@pytest.mark.slow
def test_every_object_shows_itself_in_at_most_ten_lines(shown):
    for cell, outputs in zip(CELLS[:-1], shown[:-1], strict=True):
        (data,) = outputs
        lines = data["text/plain"].splitlines()
        assert 0 < len(lines) <= 10, cell
        assert max(map(len, lines)) <= 250, cell


@pytest.mark.slow
def test_designs_and_predictions_show_their_section_and_a_table(shown):
    for number, outputs in enumerate(shown[:-1]):
        html = outputs[0].get("text/html", "")
        assert ("<svg" in html) == (number in PICTURES), CELLS[number]
        assert not html or "<table>" in html
    assert "9.25" in shown[0][0]["text/html"] and "membrane.inner_radius_mm" in shown[0][0]["text/html"]
