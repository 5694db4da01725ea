"""The paper's Table S1 stands in one small file, and the materials say the same."""

from __future__ import annotations

import csv

import pytest

from pneutouch.spec.material import Material
from tests.conftest import ROOT


def test_the_materials_hold_what_the_table_says(library):
    lines = (ROOT / "designs" / "paper-table-s1.csv").read_text(encoding="utf-8").splitlines()
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    assert len(rows) == 7 and any("10.1089/soro.2021.0074" in line for line in lines)
    for row in rows:
        material: Material = library.load("materials", row.pop("resin"))
        assert material.measured is not None
        for key, text in row.items():
            quantity = getattr(material.measured, key)
            assert (quantity is None) == (text == "")
            if text:
                assert quantity.nominal == pytest.approx(float(text))
    measured = [m for m in library.all("materials", Material).values() if m.measured is not None]
    assert len(measured) == len(rows)
