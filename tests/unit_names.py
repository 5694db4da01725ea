"""Find names in the package that hold a quantity in another unit than the one they state.

Inside the package lengths are mm, forces N, pressures MPa, volumes mm3: a name without a unit is in these. A name in
kPa, mL or um says so (``pressure_kPa``), but for a sensitivity, which is in kPa/N everywhere. Three things tell what a name holds: a conversion (``x / KPA`` is kPa, and
``x`` in ``x * KPA`` is kPa), a name that states its unit on the other side, and the documentation of a field.

Run as ``python tests/unit_names.py``: one line for each place; exit code 1 where there is one.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from tests.trees import nodes_of, tree_of

PACKAGE = Path(__file__).parents[1] / "generator" / "pneutouch"
FACTORS = {"KPA": "kPa", "ML": "mL", "UM": "um"}
"""Constants of ``pneutouch.units`` and the unit of a number that is multiplied by one."""

_SUFFIX = re.compile(rf"(?:^|_)({'|'.join(FACTORS.values())})(?=_|$)", re.IGNORECASE)
_KEEP = frozenset(
    [
        "abs",
        "array",
        "asarray",
        "float",
        "list",
        "log10",
        "max",
        "maximum",
        "mean",
        "median",
        "min",
        "minimum",
        "nan_to_num",
        "round",
        "sorted",
        "tolist",
        "tuple",
        "where",
    ]
)
"""Functions whose result has the unit of their argument."""

_GENERIC = frozenset({"value", "values", "limit"})
"""Names of quantities of any kind."""

_LONG = 3
"""Shorter names are those of a formula, explained where they stand."""

_KNOWN = re.compile(r"(?:^|_)(?:pressures?|volumes?|rise|ambient|driving)$")
"""Names of quantities that are in MPa or mm3 where they state no unit."""

_SENSITIVITY = re.compile(r"(?:^|_)sensitivit(?:y|ies)$")
"""Names of the one quantity that is in kPa/N where they state no unit, in the package as outside it."""

_DOCUMENTED = re.compile(
    r"\b(sensitivit(?:y|ies)|(?:driving |ambient )?pressures?|(?:dead )?volumes?|pressure rise)\b"
    r"[^.;:,()]{0,24}[ (]+(kPa|mL)\b",
    re.IGNORECASE,
)
_ATTRIBUTE = re.compile(r"^( *)(\w+(?:, \w+)*): (.*(?:\n\1 +\S.*)*)", re.MULTILINE)


Signatures = dict[str, list[tuple[str, list[str]]]]
"""Of each name the files that define it, with parameters or fields."""


class Place(NamedTuple):
    """A name that holds a unit which it does not state, or states one which it does not hold."""

    file: str
    line: int
    name: str
    unit: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.name}: holds {self.unit or 'mm, N, MPa'}"


def stated(name: str) -> str:
    """The unit that a name ends in, with what is divided by; "" where it states none of `FACTORS`."""
    match = _SUFFIX.search(name)
    return match[1].casefold() if match else ""


def meant(name: str) -> str:
    """The unit that a name states, or that of the quantity it names."""
    return stated(name) or ("kpa" if _SENSITIVITY.search(name) else "")


def terminal(node: ast.expr) -> str:
    """The last name of an expression: of an attribute, an element or a call without a unit of its own."""
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Attribute):
        return node.attr
    if isinstance(node, ast.Subscript | ast.Starred):
        return terminal(node.value)
    if isinstance(node, ast.Call):
        return terminal(node.func)
    return ""


class File:
    """A file of the package with what its names are bound to."""

    def __init__(self, path: Path, signatures: Signatures) -> None:
        """``signatures`` are the parameters of all functions and classes."""
        self.name = str(path)
        self.tree = tree_of(path)
        self.signatures = signatures
        self.origins: dict[str, str] = {}
        for node in ast.walk(self.tree):
            if isinstance(node, ast.ImportFrom) and node.module:
                self.origins |= {a.asname or a.name: node.module.rpartition(".")[2] for a in node.names}
        self.loops: dict[ast.Name, ast.expr] = {}
        """What the names of comprehensions run over, by use."""
        self.options: set[str] = set()
        """Parameters of commands: named by their flags, and their help text states the unit."""

    def unit(self, node: ast.expr | None) -> str | None:
        """The unit of an expression as its conversion or its names tell: "" is mm, N, MPa; None where unknown."""
        match node:
            case ast.BinOp(op=ast.Div(), right=ast.Name(id=factor)) if factor in FACTORS:
                return FACTORS[factor].casefold()
            case ast.BinOp(op=ast.Mult(), right=ast.Name(id=factor)) if factor in FACTORS:
                return ""
            case ast.BinOp(op=ast.Add() | ast.Sub(), left=left, right=right):
                return self._first(left, right)
            case ast.IfExp(body=left, orelse=right):
                return self._first(left, right)
            case ast.UnaryOp(operand=inner) | ast.Subscript(value=inner) | ast.Starred(value=inner):
                return self.unit(inner)
            case ast.ListComp(elt=inner) | ast.GeneratorExp(elt=inner) | ast.SetComp(elt=inner):
                return self.unit(inner)
            case ast.Call(func=ast.Attribute(value=inner, attr=name), args=[]) if name in _KEEP:
                return self.unit(inner)
            case ast.Call(func=function, args=[*arguments]) if terminal(function) in _KEEP:
                return self._first(*arguments)
            case ast.Name(id=name) if name in self.options:
                return None
            case ast.Name(id=name) if node in self.loops and len(name) < _LONG:
                return self.unit(self.loops[node])
            case ast.Name() | ast.Attribute():
                name = terminal(node)
                return stated(name) or ("" if _KNOWN.search(name) else None)
            case ast.Call():
                return stated(terminal(node)) or None
        return None

    def _parameters(self, function: ast.expr) -> list[str] | None:
        """Parameters of what is called; None where several things of its name come into question."""
        found = self.signatures.get(terminal(function), [])
        if isinstance(function, ast.Name) and len(found) > 1:
            origin = self.origins.get(function.id, Path(self.name).stem)
            found = [one for one in found if one[0] == origin]
        return found[0][1] if len(found) == 1 else None

    def _first(self, *nodes: ast.expr) -> str | None:
        found = [one for one in map(self.unit, nodes) if one is not None]
        return found[0] if found else None

    def places(self) -> Iterator[Place]:
        """Every name that holds another unit than it states."""
        for node in ast.walk(self.tree):
            for loop in getattr(node, "generators", []):
                uses = [n for n in ast.walk(node) if isinstance(n, ast.Name) and n.id == terminal(loop.target)]
                self.loops |= dict.fromkeys(uses, loop.iter)
            if isinstance(node, ast.FunctionDef):
                self.options |= {
                    a.arg for a in _arguments(node) if a.annotation and "typer." in ast.unparse(a.annotation)
                }
        for node in ast.walk(self.tree):
            for name, value in self._bound(node):
                held = self.unit(value)
                if len(name) < _LONG or name in _GENERIC | self.options:
                    continue
                if held is not None and held != meant(name):
                    yield Place(self.name, value.lineno, name, held)
            yield from self._factors(node)
            yield from self._documented(node)

    def _bound(self, node: ast.AST) -> Iterator[tuple[str, ast.expr]]:
        """Names with the expressions that they are bound to."""
        match node:
            case ast.Assign(targets=targets, value=value):
                for target in targets:
                    yield from _pairs(target, value)
            case ast.AnnAssign(target=target, value=ast.expr() as value) | ast.NamedExpr(target=target, value=value):
                yield from _pairs(target, value)
            case ast.For(target=target, iter=value):
                yield from _pairs(target, value)
            case ast.comprehension(target=ast.Name(id=name), iter=value):
                yield name, value
            case ast.Dict(keys=keys, values=values):
                for key, value in zip(keys, values, strict=True):
                    name = str(key.value) if isinstance(key, ast.Constant) else ""
                    if stated(name) or _KNOWN.search(name):
                        yield name, value
            case ast.Call(func=function, args=arguments, keywords=keywords):
                known = self._parameters(function)
                if known is not None and "unit" not in known:
                    yield from ((k.arg, k.value) for k in keywords if k.arg in known)
                    if isinstance(function, ast.Name) and not any(isinstance(a, ast.Starred) for a in arguments):
                        yield from zip(known, arguments, strict=False)
            case ast.FunctionDef(name=name):
                for inner in ast.walk(node):
                    if isinstance(inner, ast.Return) and inner.value is not None:
                        yield name, inner.value

    def _factors(self, node: ast.AST) -> Iterator[Place]:
        """Names that are converted although they state to be converted already, or do not state their unit."""
        match node:
            case ast.BinOp(left=left, op=ast.Mult() | ast.Div(), right=ast.Name(id=factor)) if factor in FACTORS:
                name = "" if isinstance(left, ast.Call) else terminal(left)
                before = FACTORS[factor].casefold()
                held = self.unit(left)
                if held is None and len(name) >= _LONG:
                    held = meant(name)
                wanted = before if isinstance(node.op, ast.Mult) else ""
                if held is not None and held != wanted and name not in self.options:
                    yield Place(self.name, node.lineno, name, wanted)

    def _documented(self, node: ast.AST) -> Iterator[Place]:
        """Fields and parameters whose documentation gives a unit that their name does not state."""
        if not isinstance(node, ast.ClassDef | ast.FunctionDef):
            return
        text = ast.get_docstring(node, clean=False) or ""
        names = _fields(node) if isinstance(node, ast.ClassDef) else [a.arg for a in _arguments(node)]
        if "unit" in names:
            return
        for quantity, held in _DOCUMENTED.findall(text):
            words = quantity.lower().replace(" ", "_").removesuffix("s")
            for name in names:
                one = name.removesuffix("s")
                if len(name) >= _LONG and (one.endswith(words) or words.endswith(one)) and not meant(name):
                    yield Place(self.name, node.lineno, name, held)
        for _, listed, words in _ATTRIBUTE.findall(text):
            for name in listed.split(", "):
                held = re.search(r"\b(kPa|mL|um)\b", words)
                if name in names and held and not meant(name):
                    yield Place(self.name, node.lineno, name, held[1])


def _arguments(node: ast.FunctionDef) -> list[ast.arg]:
    return [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]


def _fields(node: ast.ClassDef) -> list[str]:
    return [m.target.id for m in node.body if isinstance(m, ast.AnnAssign) and isinstance(m.target, ast.Name)]


def _pairs(target: ast.expr, value: ast.expr) -> Iterator[tuple[str, ast.expr]]:
    if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple) and len(target.elts) == len(value.elts):
        for one, other in zip(target.elts, value.elts, strict=True):
            yield from _pairs(one, other)
    elif isinstance(target, ast.Tuple) and isinstance(value, ast.GeneratorExp | ast.ListComp):
        yield from ((terminal(one), value) for one in target.elts)
    elif isinstance(target, ast.Name | ast.Attribute):
        yield terminal(target), value


def signatures(paths: list[Path]) -> Signatures:
    """Parameters of functions and fields of classes by name, with the names of their files."""
    found: Signatures = {}
    for path in paths:
        for node in nodes_of(path):
            if isinstance(node, ast.FunctionDef):
                names = [a.arg for a in _arguments(node)]
                names = names[1:] if names[:1] in (["self"], ["cls"]) else names
            elif isinstance(node, ast.ClassDef):
                inits = [m for m in node.body if isinstance(m, ast.FunctionDef) and m.name == "__init__"]
                names = [a.arg for a in _arguments(inits[0])][1:] if inits else _fields(node)
            else:
                continue
            found.setdefault(node.name, []).append((path.stem, names))
    return found


def places(folder: Path = PACKAGE) -> list[Place]:
    """Every name of a folder that holds another unit than it states."""
    paths = sorted(folder.rglob("*.py"))
    known = signatures(paths)
    return sorted({place for path in paths for place in File(path, known).places()})


if __name__ == "__main__":
    hits = places(*map(Path, sys.argv[1:2]))
    sys.stdout.writelines(f"{hit}\n" for hit in hits)
    sys.exit(bool(hits))
