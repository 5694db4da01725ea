"""The import order of the house, held by reading every import statement."""

from __future__ import annotations

import ast
import graphlib
from pathlib import Path

import pneutouch
from tests.trees import nodes_of, tree_of

PACKAGE = Path(pneutouch.__file__).parent

LAYERS = [
    {"errors", "formats", "wording", "stopping", "units", "arrays", "packing", "tables"},
    {"shape"},
    {"spec"},
    {"results"},
    {"catalogue"},
    {"body"},
    {"parts", "mechanics"},
    {"printability", "selection", "bench", "texture"},
    {"export"},
    {"evaluation"},
    {"report"},
    {"output"},
    {"workflows"},
    {"schemas"},
    {"api"},
    {"cli", "studio"},
]
RANK = {name: rank for rank, names in enumerate(LAYERS) for name in names}
APART = [{"parts", "mechanics"}]


def imports(path: Path):
    """Own packages a file imports, with the line."""
    for node in nodes_of(path):
        names = []
        if isinstance(node, ast.ImportFrom) and node.module:
            names = [node.module] if node.module != "pneutouch" else [f"pneutouch.{a.name}" for a in node.names]
            assert node.level == 0, f"{path}:{node.lineno}: relative import"
            assert all(alias.name != "*" for alias in node.names), f"{path}:{node.lineno}: star import"
        elif isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        for name in names:
            yield name, node.lineno


def test_imports_run_one_way():
    wrong = []
    for path in PACKAGE.rglob("*.py"):
        own = path.relative_to(PACKAGE).parts[0].removesuffix(".py")
        if own not in RANK:
            continue
        for name, line in imports(path):
            part = name.split(".")[1] if name.startswith("pneutouch.") else None
            if part in RANK and (RANK[part] > RANK[own] or {part, own} in APART):
                wrong.append(f"{path}:{line}: {own} imports {part}")
    assert not wrong, "\n".join(wrong)


DRAWN_FROM = {"pneutouch.mechanics.prediction", "pneutouch.evaluation.sheet_data"}
"""Modules of records, which is all that `report` may import of the layers that compute."""


def test_report_computes_nothing():
    """It imports neither a solver nor a search, at the top, under TYPE_CHECKING or inside functions."""
    computing, wrong, known = {"mechanics", "selection", "evaluation"}, [], modules()
    for path in (PACKAGE / "report").rglob("*.py"):
        wrong += [
            f"{path}: {name}"
            for name in dependencies(path, known)
            if name not in DRAWN_FROM and len(name.split(".")) > 1 and name.split(".")[1] in computing
        ]
        outside = {name.split(".")[0] for name, _ in imports(path)}
        wrong += [f"{path}: {name}" for name in outside & {"scipy", "skfem", "xarray"}]
    assert not wrong, "\n".join(wrong)


def test_modules_of_records_define_classes_alone():
    results = {name for name in modules() if name.startswith("pneutouch.results.")} - {"pneutouch.results.record"}
    assert len(results) > 10
    for name in DRAWN_FROM | results:
        tree = tree_of(modules()[name])
        assert not [node.name for node in tree.body if isinstance(node, ast.FunctionDef)], name


def test_every_folder_has_its_place_in_the_order():
    found = {path.name for path in PACKAGE.iterdir() if path.is_dir() and (path / "__init__.py").is_file()}
    assert found <= set(RANK), found - set(RANK)


def test_files_and_functions_stay_short():
    long = []
    for path in PACKAGE.rglob("*.py"):
        text = path.read_text()
        if text.count("\n") > 400:
            long.append(f"{path}: {text.count(chr(10))} lines")
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.FunctionDef) and node.end_lineno - node.lineno > 60:
                long.append(f"{path}:{node.lineno}: {node.name}")
    assert not long, "\n".join(long)


def test_no_print_and_no_mutable_state_at_module_level():
    wrong = []
    for path in PACKAGE.rglob("*.py"):
        tree = tree_of(path)
        for node in ast.walk(tree):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "print":
                wrong.append(f"{path}:{node.lineno}: print")
            if isinstance(node, ast.Global):
                wrong.append(f"{path}:{node.lineno}: global")
    assert not wrong, "\n".join(wrong)


def modules() -> dict[str, Path]:
    names = {}
    for path in PACKAGE.rglob("*.py"):
        parts = ("pneutouch", *path.relative_to(PACKAGE).with_suffix("").parts)
        names[".".join(parts).removesuffix(".__init__")] = path
    return names


def dependencies(path: Path, known: dict[str, Path]) -> set[str]:
    """Own files that a file imports anywhere in it: at the top, under TYPE_CHECKING and inside functions."""
    found = set()
    for node in nodes_of(path):
        if isinstance(node, ast.ImportFrom) and node.module:
            found |= {
                f"{node.module}.{a.name}" if f"{node.module}.{a.name}" in known else node.module for a in node.names
            }
        elif isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
    return found & set(known)


def circle(graph: dict[str, set[str]]) -> list[str]:
    """Nodes of one circle of a graph, in order; empty where there is none."""
    order = graphlib.TopologicalSorter(graph)
    try:
        order.prepare()
    except graphlib.CycleError as error:
        return list(error.args[1])
    return []


def test_no_two_files_import_each_other():
    known = modules()
    # A package's __init__ offers what its files define; they may import it no more than one another.
    graph = {name: dependencies(path, known) - {name} for name, path in known.items() if name != "pneutouch"}
    assert not circle({name: {d for d in own if d != "pneutouch"} for name, own in graph.items()})


def test_a_circle_is_found_wherever_its_imports_stand(tmp_path):
    top, function, checking = (tmp_path / f"{name}.py" for name in "abc")
    top.write_text("import b")
    function.write_text("def f():\n    from c import x")
    checking.write_text("from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import a")
    known = {path.stem: path for path in (top, function, checking)}
    assert set(circle({name: dependencies(path, known) for name, path in known.items()})) == {"a", "b", "c"}


def test_a_workflow_imports_no_other_workflow_s_inside():
    wrong, folder = [], PACKAGE / "workflows"
    for path in folder.rglob("*.py"):
        own = path.relative_to(folder).parts[0]
        for name, line in imports(path):
            parts = name.split(".")
            if parts[:2] == ["pneutouch", "workflows"] and len(parts) > 3 and parts[2] != own:
                wrong.append(f"{path}:{line}: {own} imports {name}")
    assert not wrong, "\n".join(wrong)
