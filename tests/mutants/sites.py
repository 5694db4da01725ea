"""Where a fault can be put into a module, and the module with it: `tests.mutants`."""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "generator" / "pneutouch"
PARTS = ("mechanics", "printability", "bench")

PAIRS = "Lt LtE,Gt GtE,Eq NotEq,Is IsNot,In NotIn,Add Sub,Mult Div,And Or,USub UAdd"
SWAPS = {getattr(ast, a): getattr(ast, b) for pair in PAIRS.split(",") for a, b in (pair.split(), pair.split()[::-1])}


class Site(NamedTuple):
    """A node that can be changed: its index in `ast.walk`, how, and the function that holds it, "" outside of all.

    ``outer`` is the outermost function around it: name as ``co_qualname`` has it, and first line.
    """

    path: Path
    index: int
    way: str
    function: str
    outer: tuple[str, int]


def every_site() -> list[Site]:
    paths = sorted(path for part in PARTS for path in (PACKAGE / part).rglob("*.py"))
    return [site for path in paths for site in sites(path)]


def sites(path: Path) -> Iterator[Site]:
    """Comparisons, sums, products, signs, and, or, numbers, conditions and results; not in types, words and refusals."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    skipped = [node for node in ast.walk(tree) if isinstance(node, ast.JoinedStr | ast.Raise | ast.Assert)]
    skipped += [
        note for node in ast.walk(tree) for key in ("annotation", "returns") if (note := getattr(node, key, None))
    ]
    words = {id(part) for node in skipped for part in ast.walk(node)}
    scopes = dict(_scopes(tree, "", "", ("", 0)))
    for k, node in enumerate(ast.walk(tree)):
        if id(node) not in words and (way := _way(node)):
            yield Site(path, k, way, *scopes[id(node)])


def _way(node: ast.AST) -> str:
    operator = node.ops[0] if isinstance(node, ast.Compare) else getattr(node, "op", None)
    if type(operator) in SWAPS:
        return "operator"
    if isinstance(node, ast.Constant) and type(node.value) in (int, float, bool):
        return "constant"
    if isinstance(node, ast.If | ast.IfExp | ast.While) and ast.unparse(node.test) != "TYPE_CHECKING":
        return "condition"
    return "return" if isinstance(node, ast.Return) and node.value is not None else ""


def _scopes(
    node: ast.AST, prefix: str, function: str, outer: tuple[str, int]
) -> Iterator[tuple[int, tuple[str, tuple[str, int]]]]:
    """The function of every node, by its identity: defaults and decorators belong to what is around a function."""
    yield id(node), (function, outer)
    inside: list[ast.AST] = []
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
        inside = list(node.body)
    for child in ast.iter_child_nodes(node):
        if child in inside:
            name = f"{prefix}{node.name}"  # type: ignore[attr-defined]
            first = min([node.lineno, *(each.lineno for each in node.decorator_list)])  # type: ignore[attr-defined]
            yield from _scopes(child, f"{name}.<locals>.", name, outer if outer[0] else (name, first))
        elif isinstance(node, ast.ClassDef) and child in node.body:
            yield from _scopes(child, f"{prefix}{node.name}.", function, outer)
        else:
            yield from _scopes(child, prefix, function, outer)


def changed(site: Site) -> tuple[ast.Module, str]:
    """The module with the node changed, and the change in words."""
    tree = ast.parse(site.path.read_text(encoding="utf-8"))
    node: Any = list(ast.walk(tree))[site.index]
    before = copy.deepcopy(node)
    if site.way == "operator" and isinstance(node, ast.Compare):
        node.ops[0] = SWAPS[type(node.ops[0])]()
    elif site.way == "operator":
        node.op = SWAPS[type(node.op)]()
    elif site.way == "constant":
        old = node.value
        node.value = not old if isinstance(old, bool) else old + 1 if isinstance(old, int) else old * 1.5 or 1.0
    elif site.way == "condition":
        node.test = ast.UnaryOp(ast.Not(), node.test)
    else:
        node.value = ast.Constant(None)
    ast.fix_missing_locations(tree)
    return tree, f"line {node.lineno}: {_first_line(before)} -> {_first_line(node)}"


def _first_line(node: ast.AST) -> str:
    return ast.unparse(node).split("\n")[0]
