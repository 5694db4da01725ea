"""One name has one meaning and one unit in the whole package; held by reading every file."""

from __future__ import annotations

import ast
from collections import defaultdict
from pathlib import Path

import pneutouch

PACKAGE = Path(pneutouch.__file__).parent


def public_classes(folder: Path) -> dict[str, list[str]]:
    """Public classes by name, with the places where they are defined; nested classes count."""
    places = defaultdict(list)
    for path in sorted(folder.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                places[node.name].append(f"{path.relative_to(folder)}:{node.lineno}")
    return places


def type_aliases(folder: Path) -> dict[str, list[str]]:
    """Names in capitals and small letters that a module binds to anything but a class, by name."""
    places = defaultdict(list)
    for path in sorted(folder.rglob("*.py")):
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            targets = node.targets if isinstance(node, ast.Assign) else []
            for target in targets:
                if isinstance(target, ast.Name) and target.id[0].isupper() and not target.id.isupper():
                    places[target.id].append(f"{path.relative_to(folder)}:{node.lineno}")
    return places


def test_no_two_public_classes_share_a_name():
    classes = public_classes(PACKAGE)
    assert len(classes) > 300
    assert not {name: places for name, places in classes.items() if len(places) > 1}


def test_no_type_alias_has_the_name_of_a_class():
    classes, aliases = public_classes(PACKAGE), type_aliases(PACKAGE)
    assert len(aliases) > 30
    assert not {name: aliases[name] + classes[name] for name in classes.keys() & aliases.keys()}


def test_a_name_that_two_classes_share_is_found(tmp_path):
    (tmp_path / "one.py").write_text("class Plan:\n    pass\n")
    (tmp_path / "two.py").write_text("def make():\n    class Plan:\n        pass\n\n\nclass _Plan:\n    pass\n")
    assert public_classes(tmp_path) == {"Plan": ["one.py:1", "two.py:2"]}
