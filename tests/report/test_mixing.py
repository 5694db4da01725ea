"""The mixing page and its chart say what the code gives today, and what they show a user to write works."""

from __future__ import annotations

import json
import re
import tomllib

import numpy as np
import pytest
from benchmarks import hard_resins
from benchmarks.mixing_chart import mixing_chart
from benchmarks.mixing_page import DOCS, STIFF, measure, page

from pneutouch.catalogue import load_scene
from tests.drawings import same_drawing


@pytest.fixture(scope="module")
def chart(library):
    return measure(library)


@pytest.fixture(scope="module")
def text():
    return (DOCS / "mixing.md").read_text(encoding="utf-8")


def test_the_page_is_what_the_code_gives(chart, text, library):
    assert text == page(chart, library)


def test_the_chart_names_every_curve_and_repeats_its_bytes(chart):
    drawn = mixing_chart(chart, (178, 105))
    assert drawn == mixing_chart(chart, (178, 105))
    assert same_drawing(DOCS / "mixing.svg", drawn)


def test_the_page_on_the_hard_resins_is_what_the_code_gives(library):
    assert hard_resins.PAGE.read_text(encoding="utf-8") == hard_resins.page(library)
    assert same_drawing(hard_resins.PAGE.with_suffix(".svg"), hard_resins.draw(library))


@pytest.mark.parametrize("name", hard_resins.RESINS)
def test_the_range_in_a_hard_resins_file_is_that_of_the_published_values(name, library):
    modulus = library.load("materials", name).shear_modulus_MPa
    entries = hard_resins.published(name, library)
    assert modulus.low == pytest.approx(min(entry.low for entry in entries), rel=5e-3)
    assert modulus.high == pytest.approx(max(entry.high for entry in entries), rel=5e-3)
    assert modulus.low <= modulus.value <= modulus.high


def test_a_secant_undoes_the_neo_hookean_stress():
    stretch = 1.4
    assert hard_resins.secant(2.0 * (stretch - stretch**-2), stretch - 1) == pytest.approx(2.0)


def test_the_fits_that_are_quoted_begin_near_zero_stress_and_rise():
    """What their reading as stress over strain rests on."""
    for name in hard_resins.RESINS:
        stress = [hard_resins.fitted_stress(name, x) for x in np.linspace(0.05, 0.45, 9)]
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
