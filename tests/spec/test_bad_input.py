"""Bad input: exit 2, one clear message with file, key, value and what would be right, nothing written."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.catalogue import Library, load_scene
from pneutouch.errors import InputError
from pneutouch.evaluation import evaluate
from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import table_of
from pneutouch.spec.read import parse_changes, validate
from tests.refusals import refused

ROOT = Path(__file__).resolve().parents[2]

CASES = [
    ("[membrane]\ninner_radius_mm = -3", ["membrane.inner_radius_mm = -3", "from 1 to 100 mm"]),
    ("[membrane]\ninner_radius_mm = 0", ["inner_radius_mm = 0", "from 1 to 100 mm"]),
    ("[membrane]\ninner_radius_mm = 1e9", ["1000000000.0", "from 1 to 100 mm"]),
    ("[membrane]\ninner_radius_mm = nan", ["nan", "finite number", "from 1 to 100 mm"]),
    ("[membrane]\ninner_radius_mm = inf", ["inf", "from 1 to 100 mm"]),
    ('[membrane]\ninner_radius_mm = "9"', ['"9"', "a number from 1 to 100 mm"]),
    ("[membrane]\ninner_radius_mm = true", ["= true", "a number from 1 to 100 mm"]),
    ("[membrane]\ninner_radius_mm = [9]", ["[9]", "a number from 1 to 100 mm"]),
    (
        "[membrane]\ninner_radius_mm = 5\nwall_thickness_mm = 5",
        ["wall_thickness_mm = 5", "less than", "inner_radius_mm = 5"],
    ),
    ('[contact]\nfriction = "grip"', ['contact.friction = "grip"', "must be a number: Coefficient of friction"]),
    ("[membrane]\nmaterial = 3", ["membrane.material = 3", "text"]),
    ('[membrane]\nmaterial = "TangoPlsu"', ['membrane.material = "TangoPlsu"', "Did you mean TangoPlus?"]),
    ('[membrane]\nmaterial = "ABS"', ["membrane.material", "ABS", "elastomer"]),
    ('[connector]\nmaterial = "TangoPlus"', ["connector.material", "rigid"]),
    ('[membrane]\nmaterial = "Agilus30"', ['print.profile = "objet260-connex"', "cannot run Agilus30", "TangoPlus"]),
    ('[connector]\nport = "barb"', ['connector.port = "barb"', "no such name among the ports", "Did you mean barb-"]),
    (
        "[membrane]\nwall_thikness_mm = 1",
        ["membrane.wall_thikness_mm", "unknown key", "Did you mean wall_thickness_mm?"],
    ),
    ('[membran]\nmaterial = "x"', ["membran", "unknown table", "Did you mean membrane?"]),
    ('[print]\norientation = "sideways"', ['print.orientation = "sideways"', 'must be "dome-up" or "dome-down"']),
    ("membrane = 3", ["membrane = 3", "a table"]),
    ("[pneumatics]\ndriving_pressures_kPa = []", ["driving_pressures_kPa = []", "at least one"]),
    ("[pneumatics]\ndriving_pressures_kPa = [0, -105]", ["driving_pressures_kPa", "from -100 to 1000 kPa"]),
    ("[pneumatics]\ndriving_pressures_kPa = [5, 5]", ["driving_pressures_kPa", "once only"]),
    ("[pneumatics]\ndriving_pressures_kPa = [0, nan]", ["driving_pressures_kPa[1]", "finite"]),
    (
        "[pneumatics]\ndriving_pressures_kPa = [0, 5, 1200]",
        ["driving_pressures_kPa[2] = 1200", "from -100 to 1000 kPa"],
    ),
    ("[connector]\nfinger_diameter_mm = 20", ["finger_diameter_mm = 20", "goes over no finger", "finger-16"]),
    ("[pneumatics]\ndriving_pressures_kPa = [0, 'a']", ['driving_pressures_kPa[1] = "a"', "a number"]),
    (
        "[pneumatics]\ndriving_pressures_kPa = [0, 42]",
        ["driving_pressures_kPa[1] = 42", "limit point", "at most 39.59 kPa"],
    ),
    ("[pneumatics]\ndead_volume_mL = -1", ["dead_volume_mL = -1", "from 0 to 1000 mL"]),
    ("[indentation]\nsteps = 1.5", ["steps = 1.5", "whole number"]),
    ("[indentation]\ndepth_mm = 9.2", ["depth_mm = 9.2", "0.95"]),
    ("[membrane]\ninner_radius_mm = 1.2\nwall_thickness_mm = 0.5", ["inner_radius_mm = 1.2", "too small for"]),
    ("[membrane\n", ["line 1"]),
    ("[indentation]\nplate_diameter_mm = 4", ["plate_diameter_mm = 4", "plate's edge", "wider", "18.5 mm"]),
    ("[contact]\nfriction = -0.1", ["contact.friction", "-0.1", "from 0 to 10", "inf for a surface that grips"]),
    ("[contact]\nfriction = nan", ["contact.friction", "nan", "from 0 to 10"]),
    ('[contact]\nfriction = "rough"', ["contact.friction", '"rough"']),
    ('[contact]\nobject = "bal"', ['contact.object = "bal"', '"plate", "ball", "cone"']),
    ('[contact]\nobject = "ball"', ["contact", "needs ball_radius_mm"]),
    ("[contact]\nball_radius_mm = 3", ["ball_radius_mm", "another object", 'object = "ball"']),
    ('[contact]\nobject = "ball"\nball_radius_mm = 900', ["contact.ball_radius_mm = 900", "from 0.05 to 250 mm"]),
    (
        '[contact]\nobject = "ball"\nball_radius_mm = 0.2',
        ["contact.ball_radius_mm = 0.2", "mesh of 338 cells", "192 at most", "at least 0.36 mm"],
    ),
    (
        '[contact]\nobject = "ring"\nring_radius_mm = 11\nring_section_radius_mm = 1',
        ["contact.ring_radius_mm = 11", "at first touch", "nearer to its axis"],
    ),
    ('[contact]\nobject = "ring"\nring_radius_mm = 2\nring_section_radius_mm = 3', ["less than ring_radius_mm = 2"]),
    ('[contact]\nobject = "profile"\nprofile_mm = [[0, 0]]', ["profile_mm has 1 points", "2 to 40"]),
    ('[contact]\nobject = "profile"\nprofile_mm = [[0, 0], [3]]', ["contact.profile_mm[1] = [3.0]", "[r, z, radius]"]),
    (
        '[contact]\nobject = "profile"\nprofile_mm = [[0, 0], [3, 0], [5, 1, 1]]',
        ["contact.profile_mm[1] = [3.0, 0.0]", "a sharp edge", "radius in mm"],
    ),
    (
        "[indentation]\nplate_diameter_mm = 30\n[contact]\nplate_diameter_mm = 20",
        ["contact.plate_diameter_mm = 20", "indentation.plate_diameter_mm = 30", "take one out"],
    ),
    ("[indentation]\ndepth_mm = 20", ["depth_mm = 20", "0.95"]),
    ('[document]\ntitle = "a\\u0007b"', ["document.title", "cannot be printed"]),
    ('[document]\ndate = "yesterday"', ["document.date", "yesterday", "a date such as 2026-11-21"]),
]


@pytest.mark.parametrize(("text", "words"), CASES, ids=[text.replace("\n", " ")[:50] for text, _ in CASES])
def test_a_wrong_design_says_what_is_wrong_and_what_would_be_right(text, words, tmp_path):
    path = tmp_path / "bad.toml"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        evaluate(str(path), library=Library((ROOT,)))
    message = str(caught.value)
    for word in (str(path), *words):
        assert word in message
    assert "Traceback" not in message


@pytest.mark.parametrize(
    ("assignment", "words"),
    [
        ("membrane.material", ["table.key=value"]),
        ("material=FLX9960", ["table.key=value"]),
        ("membran.material=FLX9960", ["unknown table membran", "Did you mean membrane?"]),
        ("membrane.materiel=FLX9960", ["unknown key membrane.materiel", "Did you mean material?"]),
        ("membrane.inner_radius_mm=5\n[zz]\na=1", ["membrane.inner_radius_mm", "a number from 1 to 100 mm"]),
        ("membrane.inner_radius_mm=wide", ['membrane.inner_radius_mm = "wide"', "a number from 1 to 100 mm"]),
    ],
)
def test_a_wrong_override_says_so(assignment, words):
    with pytest.raises(InputError) as caught:
        load_scene("paper-dome", parse_changes([assignment]), Library((ROOT,)))
    assert all(word in str(caught.value) for word in words)


def test_overrides_take_words_numbers_and_lists():
    scene = load_scene(
        "paper-dome",
        {"membrane.material": "FLX9960", "membrane.inner_radius_mm": 8.5, "pneumatics.driving_pressures_kPa": [1, 3]},
        Library((ROOT,)),
    )
    assert scene.membrane_material.title == "FLX9960-DM"
    assert scene.design.membrane.inner_radius_mm == 8.5
    assert scene.design.pneumatics.driving_pressures_kPa == [1.0, 3.0]


def test_a_folder_a_missing_file_and_a_binary_file_are_named(tmp_path):
    library = Library((ROOT,))
    folder = tmp_path / "folder.toml"
    folder.mkdir()
    binary = tmp_path / "binary.toml"
    binary.write_bytes(b"\xff\xfe\x00")
    for path, word in ((folder, "folder"), (tmp_path / "none.toml", "no such file"), (binary, "UTF-8")):
        with pytest.raises(InputError, match=word):
            evaluate(str(path), library=library)
    with refused("design", "paper-doom"):
        evaluate("paper-doom", library=library)


def test_a_byte_order_mark_and_a_file_without_ending_are_read(tmp_path):
    path = tmp_path / "mine"
    path.write_bytes(b"\xef\xbb\xbf[membrane]\ninner_radius_mm = 8\n")
    assert load_scene(str(path), None, Library((ROOT,))).design.membrane.inner_radius_mm == 8


anything = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=5), st.lists(st.floats(), max_size=3)
)
tables = {key: table for key in DesignFile.model_fields if (table := table_of(DesignFile, key))}


@given(st.sampled_from(sorted(tables)), st.data())
def test_no_value_of_any_field_gets_past_validation_unbounded_or_ends_in_another_error(table, data):
    key = data.draw(st.sampled_from(sorted(tables[table].model_fields)))
    value = data.draw(anything)
    try:
        design = validate(DesignFile, {table: {key: value}}, "x.toml")
    except InputError as error:
        assert f"{table}" in str(error)
        return
    accepted = getattr(getattr(design, table), key)
    numbers = accepted if isinstance(accepted, list) else [accepted]
    assert all(math.isfinite(n) for n in numbers if isinstance(n, float))


@pytest.mark.parametrize("words", [["build"], ["predict"], ["check"]])
def test_commands_exit_2_without_traceback_and_write_nothing(words, command, tmp_path):
    bad = tmp_path / "bad.toml"
    bad.write_text("[membrane]\ninner_radius_mm = -3\n")
    result = command(*words, str(bad))
    assert result.returncode == 2
    assert result.stdout == ""
    assert "membrane.inner_radius_mm = -3" in result.stderr
    assert "Traceback" not in result.stderr
    assert list(tmp_path.iterdir()) == [bad]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("value = 0.49", "value = 0.5"), ["poisson_ratio = 0.5", "between 0 and 0.5"]),
        (
            (
                'title = "TangoPlus"',
                'law = { name = "yeoh", constants = [-0.1, 0, 0], source = "made up here" }\ntitle = "TangoPlus"',
            ),
            ["law", "positive"],
        ),
        (
            (
                'title = "TangoPlus"',
                'law = { name = "yeo", constants = [1.0], source = "made up here" }\ntitle = "TangoPlus"',
            ),
            ["Did you mean yeoh?"],
        ),
        (
            (
                'title = "TangoPlus"',
                'law = { name = "ogden", constants = [1.0], source = "made up here" }\ntitle = "TangoPlus"',
            ),
            ["cannot take the constants [1.0]"],
        ),
    ],
)
def test_a_resin_that_makes_no_solid_is_refused(change, words, tmp_path):
    folder = tmp_path / "printprofiles/materials"
    folder.mkdir(parents=True)
    text = (ROOT / "printprofiles/materials/TangoPlus.toml").read_text().replace(*change)
    (folder / "TangoPlus.toml").write_text(text)
    with pytest.raises(InputError) as caught:
        evaluate("paper-dome", library=Library((tmp_path, ROOT)))
    for word in ('membrane.material = "TangoPlus"', *words):
        assert word in str(caught.value)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("value = 0.17", "value = -0.17"), "shear_modulus_MPa: -0.17 must be more than 0 and at most 1e+06"),
        (("low = 0.10", "low = 0.0"), "shear_modulus_MPa: 0 must be more than 0 and at most 1e+06"),
        (("value = 1.15", "value = 1e300"), "density_g_per_cm3.value = 1e+300: must be from 0.5 to 3 g/cm3"),
    ],
)
def test_a_resin_of_no_matter_is_refused(change, said, tmp_path):
    folder = tmp_path / "printprofiles/materials"
    folder.mkdir(parents=True)
    text = (ROOT / "printprofiles/materials/TangoPlus.toml").read_text()
    assert change[0] in text
    (folder / "TangoPlus.toml").write_text(text.replace(*change))
    with pytest.raises(InputError, match=re.escape(f"TangoPlus.toml: {said}")):
        evaluate("paper-dome", library=Library((tmp_path, ROOT)), model="membrane")


def test_a_source_that_says_nothing_is_refused(tmp_path):
    folder = tmp_path / "printprofiles/materials"
    folder.mkdir(parents=True)
    law = 'law = { name = "yeoh", constants = [0.1, 0, 0], source = "me" }\n'
    (folder / "TangoPlus.toml").write_text(law + (ROOT / "printprofiles/materials/TangoPlus.toml").read_text())
    with pytest.raises(InputError, match=r'law\.source = "me": .*at least 8 characters'):
        evaluate("paper-dome", library=Library((tmp_path, ROOT)))


@pytest.mark.slow
def test_a_resin_with_a_law_of_its_own_is_predicted_with_it(tmp_path):
    folder = tmp_path / "printprofiles/materials"
    folder.mkdir(parents=True)
    law = 'law = { name = "mooney-rivlin", constants = [0.06, 0.025], source = "made up for this test" }\n'
    (folder / "TangoPlus.toml").write_text(law + (ROOT / "printprofiles/materials/TangoPlus.toml").read_text())
    own = evaluate("paper-dome", library=Library((tmp_path, ROOT))).prediction
    plain = evaluate("paper-dome", library=Library((ROOT,))).prediction
    assert own.limit_point is None or own.limit_point.driving_pressure > 1.1 * plain.limit_point.driving_pressure
    assert own.states[0].figures.sensitivity == pytest.approx(plain.states[0].figures.sensitivity, rel=0.1)
    assert any("c10(I1-3)+c01(I2-3)" in line for line in own.assumptions)
