"""One name has one meaning and one unit in the whole package; held by reading every file."""

from __future__ import annotations

import ast
from collections import defaultdict
from pathlib import Path

import pytest

import pneutouch
from tests.trees import nodes_of, tree_of
from tests.unit_names import places

PACKAGE = Path(pneutouch.__file__).parent


def public_classes(folder: Path) -> dict[str, list[str]]:
    """Public classes by name, with the places where they are defined; nested classes count."""
    places = defaultdict(list)
    for path in sorted(folder.rglob("*.py")):
        for node in nodes_of(path):
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                places[node.name].append(f"{path.relative_to(folder)}:{node.lineno}")
    return places


def type_aliases(folder: Path) -> dict[str, dict[str, str]]:
    """Names in capitals and small letters that a module binds to anything but a class: by name, places by what they mean."""
    meanings = defaultdict(dict)
    for path in sorted(folder.rglob("*.py")):
        for node in tree_of(path).body:
            for target in node.targets if isinstance(node, ast.Assign) else []:
                if isinstance(target, ast.Name) and target.id[0].isupper() and not target.id.isupper():
                    meanings[target.id][ast.unparse(node.value)] = f"{path.relative_to(folder)}:{node.lineno}"
    return meanings


def test_no_two_public_classes_share_a_name():
    classes = public_classes(PACKAGE)
    assert len(classes) > 300
    assert not {name: places for name, places in classes.items() if len(places) > 1}


def test_no_type_alias_has_the_name_of_a_class():
    classes, aliases = public_classes(PACKAGE), type_aliases(PACKAGE)
    assert len(aliases) > 30
    assert not {name: [*aliases[name].values(), *classes[name]] for name in classes.keys() & aliases.keys()}


def test_no_type_alias_has_two_meanings():
    assert not {name: meanings for name, meanings in type_aliases(PACKAGE).items() if len(meanings) > 1}


def test_a_name_that_two_classes_share_is_found(tmp_path):
    (tmp_path / "one.py").write_text("class Plan:\n    pass\n")
    (tmp_path / "two.py").write_text("def make():\n    class Plan:\n        pass\n\n\nclass _Plan:\n    pass\n")
    assert public_classes(tmp_path) == {"Plan": ["one.py:1", "two.py:2"]}


def test_every_name_holds_the_unit_that_it_states():
    assert not places()


@pytest.mark.parametrize(
    ("code", "name"),
    [
        ("pressure = curve.pressure / KPA", "pressure"),
        ("pressure_kPa = 2 * at[0] * KPA", "pressure_kPa"),
        ("pressure_kPa = curve.pressure", "pressure_kPa"),
        ("sensitivity = rise_kPa * KPA", "sensitivity"),
        ("slope_kPa = found.sensitivity / KPA", "sensitivity"),
        ("rise = float(found.rise_kPa[0])", "rise"),
        ("first, stated = 0.0, design.dead_volume_mL", "stated"),
        ("inner = stated * ML + tube", "stated"),
        ("inner = [p * KPA for p in pressures]", "p"),
        ("for pressure in design.driving_pressures_kPa:\n    pass", "pressure"),
        ("document = {'pressure_kPa': state.pressure}", "pressure_kPa"),
        ("document = {'pressure': state.pressure / KPA}", "pressure"),
        ("def press(depth, pressure): ...\n\n\npress(1.0, given.pressure_kPa)", "pressure"),
        ("def press(depth, pressure): ...\n\n\npress(1.0, pressure=given / KPA)", "pressure"),
        ("def rated(limit):\n    return 0.9 * limit / KPA", "rated"),
        ("class Run:\n    '''A run at a driving pressure (kPa).'''\n\n    pressure: float", "pressure"),
        (
            "class Run:\n    '''A run.\n\n    Attributes:\n        low, high: Ends in kPa.\n    '''\n\n    low: float",
            "low",
        ),
    ],
)
def test_a_name_with_two_units_is_found(tmp_path, code, name):
    (tmp_path / "one.py").write_text(code + "\n")
    assert [place.name for place in places(tmp_path)] == [name]


@pytest.mark.parametrize(
    "code",
    [
        "pressure_kPa = curve.pressure / KPA",
        "pressure = design.driving_pressure_kPa * KPA",
        "pressures = [p * KPA for p in design.driving_pressures_kPa]",
        "document = {'pressure_kPa': state.pressure / KPA, 'note': f'{state.pressure / KPA:g} kPa'}",
        "sensitivity, slope = found.sensitivity_kPa_per_N, found.sensitivity * KPA",
        "class Run:\n    '''A run of some sensitivity (kPa/N).'''\n\n    sensitivity: float",
        "def rated_kPa(limit):\n    return 0.9 * limit / KPA",
        "class Excess:\n    '''What was measured, in kPa or mm.'''\n\n    measured: float\n    unit: str\n\n\nExcess(p / KPA, 'kPa')",
    ],
)
def test_a_name_that_states_its_unit_is_left_alone(tmp_path, code):
    (tmp_path / "one.py").write_text(code + "\n")
    assert places(tmp_path) == []
