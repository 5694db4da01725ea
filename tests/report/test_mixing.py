"""The numbers of the pages on mixes and hard resins are what the code gives today, and the designs shown work."""

from __future__ import annotations

import json
import re
import tomllib

import numpy as np
import pytest
from benchmarks import mixing
from benchmarks.mixing import RESINS, STIFF
from benchmarks.store import stored

from pneutouch.catalogue import load_scene
from tests.conftest import ROOT


@pytest.fixture(scope="module")
def text():
    return (ROOT / "docs" / "background" / "mixing.md").read_text(encoding="utf-8")


def close(one, other):
    """Whether two documents are the same up to rounding."""
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(close(one[key], other[key]) for key in one)
    if isinstance(one, list):
        return len(one) == len(other) and all(map(close, one, other))
    return one == pytest.approx(other, rel=1e-6) if isinstance(one, float) else one == other


@pytest.mark.slow
def test_the_stored_numbers_are_those_of_today(library):
    found = json.loads(json.dumps(mixing.measure(library)))
    assert close(found, stored("mixing"))


@pytest.mark.parametrize("name", RESINS)
def test_the_range_in_a_hard_resins_file_is_that_of_the_published_values(name, library):
    modulus = library.load("materials", name).shear_modulus_MPa
    entries = mixing.published(name, library)
    assert modulus.low == pytest.approx(min(entry.low for entry in entries), rel=5e-3)
    assert modulus.high == pytest.approx(max(entry.high for entry in entries), rel=5e-3)
    assert modulus.low <= modulus.value <= modulus.high


def test_a_secant_undoes_the_neo_hookean_stress():
    stretch = 1.4
    assert mixing.secant(2.0 * (stretch - stretch**-2), stretch - 1) == pytest.approx(2.0)


def test_the_fits_that_are_quoted_begin_near_zero_stress_and_rise():
    """What their reading as stress over strain rests on."""
    for name in RESINS:
        stress = [mixing.fitted_stress(name, x) for x in np.linspace(0.05, 0.45, 9)]
        assert 0 < stress[0] < 0.35 * stress[-1]
        assert (np.diff(stress) > 0).all()


def test_the_designs_of_the_page_are_mixes(text, tmp_path, library):
    blocks = re.findall(r"```toml\n(.*?)```", text, re.S)
    assert blocks
    for block in blocks:
        assert "membrane" in tomllib.loads(block)
        path = tmp_path / "mix.toml"
        path.write_text(block)
        assert load_scene(str(path), None, library).membrane_material.mix.fractions[STIFF] == 0.1


def test_the_curves_are_listed(command, root):
    listed = json.loads(command("list", "mixing", "--json", cwd=root).stdout)["mixing"]
    assert [entry["name"] for entry in listed] == ["TangoPlus+VeroClear"]
    assert "fractions assumed" in listed[0]["title"]
