"""Random faults in the code, one at a time, and whether the tests notice: ``python -m tests.mutants --count 200 --seed 1``.

A fault is a node of the syntax tree of a module of mechanics, printability or bench, each drawn with the same chance. The
tests are the everyday ones of `TESTS` that call the function, then the others of their files, those that take least first. Each runs
in a process that is forked from one that has collected them: one that starts by itself needs 3 s of processor time before its first test, this one none.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import random
from pathlib import Path
from typing import Any

import pytest

from tests.mutants.runs import MOST, Calls, Driver, cold
from tests.mutants.sites import PACKAGE, ROOT, Site, changed, every_site

DOCS = ROOT / "docs" / "background"
FOLDERS = "mechanics bench printability selection evaluation texture stability api catalogue cli export workflows"
TESTS = [f"tests/{part}" for part in FOLDERS.split()]
LIBRARIES = ("pydantic", "scipy.optimize", "scipy.stats", "manifold3d", "trimesh", "xarray")


def callers(site: Site, calls: Calls) -> list[str]:
    """The tests that call a function."""
    return [name for name, (_, called) in calls.items() if f"{site.path}:{site.function}" in called]


def chosen(site: Site, calls: Calls, most: float) -> tuple[list[str], float]:
    """Names of the tests of a change, and their processor time."""
    inside = callers(site, calls)
    if not inside:
        inside = [
            name for name, (_, called) in calls.items() if any(each.startswith(f"{site.path}:") for each in called)
        ]
    if not inside:
        inside = [name for name in calls if _imports(name.split("::")[0], site.path)]
    files = {name.split("::")[0] for name in inside}
    others = [name for name in calls if name.split("::")[0] in files and name not in set(inside)]
    names, total = [], 0.0
    for group in (inside, others):
        for name in sorted(group, key=lambda each: calls[each][0]):
            if total + calls[name][0] <= most:
                names.append(name)
                total += calls[name][0]
    return names, total


def _imports(test: str, path: Path) -> bool:
    """Whether a test file names the folder of a module: of one that no test calls a function of."""
    folder = ".".join(("pneutouch", *path.relative_to(PACKAGE).parent.parts))
    return folder in (ROOT / test).read_text(encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    for option in ("--count", "--seed"):
        parser.add_argument(option, type=int, required=True)
    parser.add_argument(
        "--calls", type=Path, default=Path("calls.json"), help="which test calls what; made where there is none"
    )
    parser.add_argument("--most", type=float, default=MOST, help="processor time of the unchanged tests of a change, s")
    parser.add_argument("--only", type=int, nargs="*", help="numbers of the draw, from 0; all where not given")
    parser.add_argument("--tests", nargs="*", default=TESTS, help="files and folders of tests")
    parser.add_argument("--out", type=Path, help="docs/background/mutants-SEED.json where it is not given")
    given = parser.parse_args()
    given.out = given.out or DOCS / f"mutants-{given.seed}.json"
    given.out.unlink(missing_ok=True)
    for library in LIBRARIES:
        importlib.import_module(library)
    every = every_site()
    drawn = random.Random(given.seed).sample(every, given.count)
    numbers = range(given.count) if given.only is None else given.only
    rows: dict[int, dict[str, Any]] = {}

    def note(k: int, outcome: str, seconds: float, tests: int) -> None:
        words = {"module": str(drawn[k].path.relative_to(PACKAGE)), "function": drawn[k].function}
        rows[k] = {"number": k, **words, "change": changed(drawn[k])[1], "outcome": outcome, "tests": tests}
        print(json.dumps(rows[k] | {"seconds": round(seconds, 1)}), flush=True)
        ordered = [rows[each] for each in sorted(rows)]
        head = {"sites": len(every), "seed": given.seed, "count": given.count}
        given.out.write_text(json.dumps(head | {"drawn": ordered}, indent=1) + "\n", encoding="utf-8")

    def warm(driver: Driver) -> None:
        if not given.calls.is_file():
            driver.calls(given.calls)
        calls: Calls = json.loads(given.calls.read_text())
        for k in numbers:
            if callers(drawn[k], calls):
                names, seconds = chosen(drawn[k], calls, given.most)
                note(k, *driver.outcome(drawn[k], names, seconds), len(names))
        # The rows go through the file: this process ends here.

    words = ["-q", "-p", "no:cacheprovider", *given.tests]
    if os.fork() == 0:
        os._exit(int(pytest.main(words, plugins=[Driver(warm)])))
    os.wait()
    rows |= {row["number"]: row for row in json.loads(given.out.read_text())["drawn"]} if given.out.is_file() else {}
    calls = json.loads(given.calls.read_text())
    for k in numbers:
        # Outside of functions, or of one that is called while modules are imported and never by a test.
        if not callers(drawn[k], calls):
            names, seconds = chosen(drawn[k], calls, given.most)
            note(k, *cold(drawn[k], changed(drawn[k])[0], names, seconds), len(names))


if __name__ == "__main__":
    main()
