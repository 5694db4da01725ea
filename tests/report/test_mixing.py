"""The mixing page and its chart say what the code gives today, and what they show a user to write works."""

from __future__ import annotations

import json
import re
import tomllib

import numpy as np
import pytest
from benchmarks.mixing_chart import mixing_chart, mixing_data
from benchmarks.mixing_laws import fraction_of, placings
from benchmarks.mixing_page import DOCS, STIFF, WHERE, measure, page
from benchmarks.mixing_theory import hashin_shtrikman_low

from pneutouch.catalogue import load_scene


@pytest.fixture(scope="module")
def found(library):
    return measure(library)


@pytest.fixture(scope="module")
def text():
    return (DOCS / "mixing.md").read_text(encoding="utf-8")


def test_the_page_is_what_the_code_gives(found, text):
    assert text == page(*found)


def test_the_chart_names_every_line_and_repeats_its_bytes(found):
    chart = mixing_data(*found)
    drawn = mixing_chart(chart, (178, 110))
    assert drawn == mixing_chart(chart, (178, 110))
    assert drawn == (DOCS / "mixing.svg").read_text(encoding="utf-8")


def test_the_pages_sentences_hold(found, text):
    law, stiff, _ = found
    f = np.array(WHERE)
    ratio = law.modulus_at(f) / hashin_shtrikman_low(f, law.modulus[0], stiff[0])
    assert ratio.min() > 1.2
    assert "FLX9985 would be at 80 %, and FLX9995 would have no fraction" in text
    series = np.array([(0.5, 5.34 / 0.30), (1.0, 8.47 / 0.30)])
    at = np.interp(np.log(4.0 / 0.17), np.log(series[:, 1]), series[:, 0])
    assert at == pytest.approx(0.80, abs=0.005)
    assert series[1, 1] < 5.33 / 0.17
    assert placings(0.17, 0.17, stiff[0]) == pytest.approx(
        dict.fromkeys(placings(0.17, 0.17, stiff[0]), 0.0), abs=1e-12
    )
    assert fraction_of(hashin_shtrikman_low, 5.33, 0.17, stiff[0]) > 0.9


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
