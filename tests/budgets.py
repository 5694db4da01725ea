"""How heavy the package is: ``python -m tests.budgets`` prints every count beside its bound.

A count may fall and never rise above its bound; the goal is what the project wants to come to.
"""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import NamedTuple

from tests.trees import nodes_of

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "generator" / "pneutouch"
KEY = "sensitivity_kPa_per_N"
COMPUTING = ("mechanics", "results", "evaluation", "report")
"""Folders that a sensitivity passes from the solver to the sheet."""
ELSEWHERE = ("results/driving.py", "results/selection.py")
"""Answers of other commands, which no sheet holds."""


class Budget(NamedTuple):
    """A count, its bound and the goal."""

    name: str
    count: Callable[[], int]
    bound: int
    goal: int


def sources(folder: Path) -> list[Path]:
    return sorted(folder.rglob("*.py"))


def lines_of(paths: list[Path]) -> int:
    return sum(path.read_text(encoding="utf-8").count("\n") for path in paths)


def package_lines() -> int:
    return lines_of(sources(PACKAGE))


def package_files() -> int:
    return len(sources(PACKAGE))


def benchmark_lines() -> int:
    return lines_of(sources(ROOT / "benchmarks"))


def dictionaries() -> int:
    """Functions of the package, waited for or not, that return a dictionary of anything, or that or nothing."""
    kinds = ast.FunctionDef | ast.AsyncFunctionDef
    functions = (node for path in sources(PACKAGE) for node in nodes_of(path) if isinstance(node, kinds))
    return sum(
        node.returns is not None and "dict[str, Any]" in ast.unparse(node.returns).split(" | ") for node in functions
    )


def files_with_the_key() -> int:
    return sum(KEY in path.read_text(encoding="utf-8") for path in sources(PACKAGE))


def classes_with_a_sensitivity() -> int:
    """Classes between solver and sheet that have a field of the sensitivity, by its name inside or outside."""
    paths = (path for name in COMPUTING for path in sources(PACKAGE / name))
    passed = (path for path in paths if path.relative_to(PACKAGE).as_posix() not in ELSEWHERE)
    classes = (node for path in passed for node in nodes_of(path) if isinstance(node, ast.ClassDef))
    return sum(
        any(isinstance(one, ast.AnnAssign) and ast.unparse(one.target) in (KEY, "sensitivity") for one in node.body)
        for node in classes
    )


@cache
def loaded() -> list[Path]:
    """Files of the package that ``predict paper-dome`` loads."""
    code = (
        "import contextlib, io, sys\n"
        "from pneutouch.cli import command_line\n"
        "from pneutouch.cli.stop import stop_signals\n"
        "sys.argv = ['pneutouch', 'predict', 'paper-dome']\n"
        "with contextlib.redirect_stdout(io.StringIO()), stop_signals() as stop:\n"
        "    assert command_line(stop) == 0\n"
        "names = [name for name in sys.modules if name.split('.')[0] == 'pneutouch']\n"
        "print(*(sys.modules[name].__file__ for name in names), sep='\\n')"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    return [Path(line) for line in done.stdout.splitlines()]


def loaded_modules() -> int:
    return len(loaded())


def loaded_lines() -> int:
    return lines_of(loaded())


def files_of_one_name() -> int:
    """Greatest number of files of the package that have one name."""
    names = Counter(path.name for path in sources(PACKAGE) if path.name != "__init__.py")
    return max(names.values())


_WORDING = re.compile(r"""assert .*["'][^"']* [^"']*["'] (not )?in |match=r?["'][^"']* """)


def wording_lines() -> int:
    """Lines of tests that assert a text of several words."""
    return sum(
        bool(_WORDING.search(line))
        for path in sources(ROOT / "tests")
        for line in path.read_text(encoding="utf-8").splitlines()
    )


BUDGETS = (
    Budget("lines of the package", package_lines, 96_583, 70_000),
    Budget("files of the package", package_files, 517, 450),
    Budget("lines of benchmarks", benchmark_lines, 7_944, 6_500),
    Budget("functions that return dict[str, Any]", dictionaries, 30, 30),
    Budget("modules that predict paper-dome loads", loaded_modules, 150, 150),
    Budget("lines in these", loaded_lines, 18_154, 18_000),
    Budget("classes that hold a sensitivity, solver to sheet", classes_with_a_sensitivity, 5, 5),
    Budget(f"files with the key {KEY}", files_with_the_key, 21, 30),
    Budget("files of one name", files_of_one_name, 3, 3),
    Budget("lines of tests that assert wording", wording_lines, 600, 600),
)


def main() -> None:
    sys.stdout.write(f"{'':<50} {'now':>7} {'bound':>7} {'goal':>7}\n")
    for budget in BUDGETS:
        sys.stdout.write(f"{budget.name:<50} {budget.count():>7} {budget.bound:>7} {budget.goal:>7}\n")


if __name__ == "__main__":
    main()
