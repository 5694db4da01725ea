"""The numbers of docs/reference/materials.md are what the solid and the material files give."""

from __future__ import annotations

import pytest
from benchmarks.materials import hardness, law_words, materials, measure
from benchmarks.store import stored

KNOWN = stored("materials")


@pytest.mark.slow
def test_the_stored_numbers_are_those_of_today():
    found = measure()
    assert found["materials"] == KNOWN["materials"]
    for one, other in zip(found["laws"], KNOWN["laws"], strict=True):
        assert one["law_kPa_per_N"] == pytest.approx(other["law_kPa_per_N"], rel=1e-6)
        assert one["law_limits_kPa"] == pytest.approx(other["law_limits_kPa"], rel=1e-6)


def test_every_material_stands_in_them_with_its_law():
    rows = {row["material"]: row for row in KNOWN["materials"]}
    assert list(rows) == list(materials())
    for name, material in materials().items():
        assert (rows[name]["law"], rows[name]["misfit"], rows[name]["stretch"]) == law_words(material)


def test_moduli_at_small_strain_are_those_of_the_files():
    for one, other in zip(hardness(), KNOWN["hardness"], strict=True):
        assert one["young_MPa"] == pytest.approx(other["young_MPa"])
        assert one["over_gent"] == pytest.approx(other["over_gent"])
