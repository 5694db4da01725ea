"""Every public name of the package says what it is; what takes or gives arrays of the interface states their units."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

import pneutouch
from tests.trees import tree_of

PACKAGE = Path(pneutouch.__file__).parent
QUANTITIES = ("pressure", "force", "indentation", "depth", "sensitivity", "stiffness", "radius", "thickness", "volume")
UNITS = ("_kPa", "_N", "_mm", "_mL", "_N_per_mm", "_kPa_per_N", "_percent")


def public(tree: ast.Module) -> Iterator[tuple[str, ast.AST]]:
    """The module, its public classes and functions, and the public methods of its public classes."""
    yield "module", tree
    for node in tree.body:
        if isinstance(node, ast.ClassDef | ast.FunctionDef) and not node.name.startswith("_"):
            yield node.name, node
            if isinstance(node, ast.ClassDef):
                methods = (m for m in node.body if isinstance(m, ast.FunctionDef) and not m.name.startswith("_"))
                yield from ((f"{node.name}.{m.name}", m) for m in methods)


def undocumented(tree: ast.Module) -> list[str]:
    """Public names whose documentation is missing or does not begin with a sentence."""
    wrong = []
    for name, node in public(tree):
        paragraph = (ast.get_docstring(node) or "").split("\n\n")[0].strip()
        if not paragraph.endswith((".", ":", "?", "::")):
            wrong.append(name)
    return wrong


def without_unit(tree: ast.Module) -> list[str]:
    """Parameters of public functions that are quantities, documented in no unit and named with none."""
    wrong = []
    for name, node in public(tree):
        if isinstance(node, ast.FunctionDef):
            for argument in (*node.args.args, *node.args.kwonlyargs):
                quantity = any(argument.arg.removesuffix("s").endswith(word) for word in QUANTITIES)
                if quantity and not argument.arg.endswith(UNITS):
                    wrong.append(f"{name}({argument.arg})")
    return wrong


def trees(folder: Path) -> list[tuple[Path, ast.Module]]:
    return [(path, tree_of(path)) for path in sorted(folder.rglob("*.py"))]


def test_every_public_name_is_documented():
    wrong = [f"{path}: {name}" for path, tree in trees(PACKAGE) for name in undocumented(tree)]
    assert not wrong, "\n".join(wrong)


def texts(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Every string that stands alone, with its line: docstrings, and the descriptions below names."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            yield node.lineno, node.value.value.strip()


def test_a_docstring_names_a_thing_or_an_action():
    wrong = [
        f"{path}:{line}: {text.splitlines()[0]}"
        for path, tree in trees(PACKAGE)
        for line, text in texts(tree)
        if text.split(maxsplit=1)[0].rstrip(",:") in {"What", "Whether", "Where", "How", "That", "Which"}
    ]
    assert not wrong, "\n".join(wrong)


def test_every_quantity_that_the_interface_takes_is_named_with_its_unit():
    wrong = [f"{path}: {name}" for path, tree in trees(PACKAGE / "api") for name in without_unit(tree)]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize(
    ("source", "names"),
    [
        ("def f(): pass", ["module", "f"]),
        ('"""A module."""\ndef f():\n    """no sentence"""', ["f"]),
        ('"""A module."""\nclass A:\n    """A."""\n    def m(self): pass\n    def _n(self): pass', ["A.m"]),
        ('"""A module."""\ndef _f(): pass', []),
    ],
)
def test_what_is_not_documented_is_found(source, names):
    assert undocumented(ast.parse(source)) == names


def test_a_quantity_without_a_unit_is_found():
    tree = ast.parse('"""A module."""\ndef f(pressure, pressure_kPa, depths, name): pass')
    assert without_unit(tree) == ["f(pressure)", "f(depths)"]
