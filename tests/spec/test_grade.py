"""A membrane of two resins: what a wrong one is told, and how a right one reads."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.catalogue import Library, load_scene
from pneutouch.errors import InputError
from pneutouch.spec.grade import MOST_KNOTS, Grade
from tests.conftest import ROOT
from tests.refusals import refused

LIBRARY = Library((ROOT,))
PAIR = 'from = "TangoPlus", to = "VeroClear"'
LONG = ", ".join(["0.1"] * (MOST_KNOTS + 1))

CASES = [
    (f"{PAIR}, fraction = 1.2", ["membrane.material", "fraction = 1.2", "from 0 to 1"]),
    (f"{PAIR}, fraction = -0.1", ["fraction = -0.1", "from 0 to 1"]),
    (f"{PAIR}, fraction = [0.1, 1.5]", ["fraction = 1.5", "from 0 to 1"]),
    (f"{PAIR}, fraction = nan", ["membrane.material.fraction = nan", "finite number"]),
    (f'{PAIR}, fraction = "0.2"', ['membrane.material.fraction = "0.2"', "a number"]),
    (f"{PAIR}, fraction = true", ["membrane.material.fraction = true", "a number"]),
    (f'{PAIR}, fraction = [0.1, "a"]', ['membrane.material.fraction[1] = "a"', "a number"]),
    (f"{PAIR}, fraction = [0.1]", ["1 values", "one number or 2 to 12 values"]),
    (f"{PAIR}, fraction = []", ["0 values", "one number or 2 to 12 values"]),
    (f"{PAIR}, fraction = [{LONG}]", ["13 values", "one number or 2 to 12 values"]),
    (PAIR, ["membrane.material.fraction: missing", "volume fraction of the stiff one"]),
    ('to = "VeroClear", fraction = 0.1', ["membrane.material.from: missing"]),
    (f"{PAIR}, fractoin = 0.1", ["membrane.material.fractoin: unknown key", "Did you mean fraction?"]),
    ('from = 3, to = "VeroClear", fraction = 0.1', ["membrane.material.from = 3", "must be text"]),
    (f"{PAIR}, fraction = 0.1, at = [0]", ["at: knots need a fraction at each"]),
    (f"{PAIR}, fraction = [0, 0.1, 0.2], at = [0, 1]", ["2 knots for 3 fractions"]),
    (
        f"{PAIR}, fraction = [0, 0.1], at = [0.1, 1]",
        ["at = [0.1, 1.0]", "begin with 0 (the pole) and end with 1 (the rim)"],
    ),
    (f"{PAIR}, fraction = [0, 0.1, 0.2, 0.1], at = [0, 0.7, 0.6, 1]", ["at = [0.0, 0.7, 0.6, 1.0]: out of order"]),
    (f"{PAIR}, fraction = [0, 0.1, 0.2, 0.1], at = [0, 0.7, 0.7, 1]", ["out of order"]),
    ('from = "TangoPlus", to = "TangoPlus", fraction = 0.1', ['to = "TangoPlus"', "another resin than from"]),
    (
        'from = "TangoPlsu", to = "VeroClear", fraction = 0.1',
        ['material.from = "TangoPlsu"', "Did you mean TangoPlus?"],
    ),
    ('from = "TangoPlus", to = "VeroClera", fraction = 0.1', ['material.to = "VeroClera"', "Did you mean VeroClear?"]),
    (
        'from = "TangoPlus", to = "ABS", fraction = 0.1',
        ["no mixing curve of ABS in TangoPlus", "known: TangoPlus+VeroClear"],
    ),
    (
        'from = "VeroClear", to = "TangoPlus", fraction = 0.1',
        ["no mixing curve", "the soft resin goes first: TangoPlus"],
    ),
    (f"{PAIR}, fraction = 0.7", ["fraction = 0.7", "no modulus is known beyond 0.356 of VeroClear in TangoPlus"]),
    (f"{PAIR}, fraction = [0, 0.7]", ["fraction = 0.7", "at most"]),
]


def design(tmp_path, grade, rest=""):
    path = tmp_path / "design.toml"
    path.write_text(f"[membrane]\nmaterial = {{ {grade} }}\n{rest}\n")
    return str(path)


@pytest.mark.parametrize(("grade", "words"), CASES, ids=[grade.replace(PAIR, "..")[:60] for grade, _ in CASES])
def test_a_wrong_grade_says_what_is_wrong_and_what_would_be_right(tmp_path, grade, words):
    path = design(tmp_path, grade)
    with pytest.raises(InputError) as error:
        load_scene(path, None, LIBRARY)
    for word in (path, *words):
        assert word in str(error.value)


@pytest.mark.parametrize("fraction", ["0.1", "[0, 0.2]"])
def test_a_printer_that_does_not_hold_both_resins_is_refused(tmp_path, fraction):
    path = design(tmp_path, f"{PAIR}, fraction = {fraction}", '[print]\nprofile = "abs-filament"')
    with pytest.raises(InputError, match=r'print\.profile = "abs-filament".*cannot run TangoPlus \+ .* VeroClear'):
        load_scene(path, None, LIBRARY)


def test_a_printer_of_one_resin_at_once_mixes_none(tmp_path):
    text = (ROOT / "printprofiles/objet260-connex.toml").read_text()
    lines = [line.replace("resins_at_once = 2", "resins_at_once = 1") for line in text.splitlines()]
    assert lines != text.splitlines()
    folder = tmp_path / "printprofiles"
    folder.mkdir()
    (folder / "single.toml").write_text("\n".join(lines))
    path = design(tmp_path, f"{PAIR}, fraction = 0.1", '[print]\nprofile = "single"')
    with refused("print.profile", "single"):
        load_scene(path, None, Library((tmp_path, ROOT)))


def test_even_knots_and_labels():
    grade = Grade.model_validate({"from": "A", "to": "B", "fraction": [0.0, 0.1, 0.3]})
    assert grade.knots == (0.0, 0.5, 1.0)
    assert grade.label == "A + 0 to 30 % B"
    assert not grade.is_constant
    same = Grade.model_validate({"from": "A", "to": "B", "fraction": [0.2, 0.2]})
    assert same.is_constant
    assert same.label == Grade.model_validate({"from": "A", "to": "B", "fraction": 0.2}).label == "A + 20 % B"


def test_the_grade_of_a_design_is_its_fractions_at_the_knots(tmp_path):
    path = design(tmp_path, f"{PAIR}, fraction = [0, 0.08, 0.25], at = [0, 0.25, 1]", '[print]\nprofile = "j735"')
    along = load_scene(path, None, LIBRARY).membrane_material.along
    found = np.interp([0, 0.25, 1], along.arc, along.stiff_fraction)
    assert found == pytest.approx([0, 0.08, 0.25], abs=1e-12)
