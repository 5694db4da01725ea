"""The faults that are drawn: where they are drawn, what they change, and the interval of a share."""

from __future__ import annotations

import ast

import pytest
from benchmarks.hardening import wilson

from tests.mutants.sites import PACKAGE, changed, sites

MODULE = '''
from typing import TYPE_CHECKING

LIMIT: float = 2.0
if TYPE_CHECKING:
    from a import b


class Box:
    def width(self, factor: float = 1.5) -> float:
        """Width over 3."""
        if self.side < LIMIT:
            raise ValueError(f"{self.side + 1} is less")
        inner = [side for side in self.sides if side is not None]

        def half(value: float) -> float:
            return value / 2

        return half(factor) + len(inner)
'''


def drawn(tmp_path):
    path = tmp_path / "box.py"
    path.write_text(MODULE)
    return list(sites(path))


def test_faults_are_in_what_is_computed_and_not_in_types_words_and_refusals(tmp_path):
    found = {changed(site)[1].partition(": ")[2] for site in drawn(tmp_path)}
    assert found == {
        "2.0 -> 3.0",
        "1.5 -> 2.25",
        "self.side < LIMIT -> self.side <= LIMIT",
        "if self.side < LIMIT: -> if not self.side < LIMIT:",
        "side is not None -> side is None",
        "value / 2 -> value * 2",
        "2 -> 3",
        "return value / 2 -> return None",
        "half(factor) + len(inner) -> half(factor) - len(inner)",
        "return half(factor) + len(inner) -> return None",
    }


def test_a_fault_changes_one_node_and_knows_its_function(tmp_path):
    functions = set()
    for site in drawn(tmp_path):
        tree, _ = changed(site)
        assert ast.dump(tree) != ast.dump(ast.parse(MODULE))
        compile(tree, "box.py", "exec")
        functions.add((site.function, site.outer[0]))
    # A default belongs to what is around its function.
    assert functions == {("", ""), ("Box.width", "Box.width"), ("Box.width.<locals>.half", "Box.width")}


def test_names_and_first_lines_are_those_of_the_compiled_code():
    path = PACKAGE / "bench" / "record.py"
    code = compile(path.read_text(encoding="utf-8"), str(path), "exec")
    known, stack = set(), [code]
    while stack:
        each = stack.pop()
        known.add((each.co_qualname, each.co_firstlineno))
        stack += [const for const in each.co_consts if hasattr(const, "co_code")]
    assert {site.outer for site in sites(path) if site.function} <= known


@pytest.mark.parametrize(("part", "whole", "low", "high"), [(81, 100, 0.7222, 0.8749), (0, 10, 0.0, 0.2775)])
def test_the_interval_is_wilson_s(part, whole, low, high):
    assert wilson(part, whole) == pytest.approx((low, high), abs=1e-4)
