"""One side of an exhibit: what it is, what its rule finds in it, and how it is drawn."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from pneutouch.catalogue import Library, load_scene
from pneutouch.evaluation import Evaluation, evaluate
from pneutouch.evaluation.subject import subject_of
from pneutouch.parts import Assembly, assemble
from pneutouch.printability import Finding, PrintItem, PrintSubject
from pneutouch.printability.rulebook import RULES
from pneutouch.printability.view import PrintView
from pneutouch.spec.read import parse_changes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ROOT = Path(__file__).parents[4]
LIBRARY = Library((ROOT,))


class Case(NamedTuple):
    """A label, the findings of one rule, and what draws the case into axes whose lengths are mm."""

    label: str
    findings: Sequence[Finding]
    draw: Callable[[Axes], None]


Pair = tuple[Case, Case]
"""The case that passes a rule, then the one that is reported."""


@cache
def assembled(design: str, *changes: str) -> Assembly:
    """The bodies of a shipped design with fields changed."""
    return assemble(load_scene(design, parse_changes(changes), LIBRARY))


@cache
def evaluated(design: str, *changes: str, model: str = "solid") -> Evaluation:
    """A shipped design with fields changed, predicted."""
    return evaluate(design, parse_changes(changes), model=model, library=LIBRARY)


def item_of(assembly: Assembly, body: str) -> PrintItem:
    """A body of an assembly as it is printed."""
    return next(item for item in subject_of(assembly).items if item.body.name == body)


def of_rule(rule: str, *items: PrintItem) -> list[Finding]:
    """What one rule finds in bodies."""
    return RULES[rule](PrintView(PrintSubject(items)))


def of_sensor(rule: str, evaluation: Evaluation) -> list[Finding]:
    """What one rule finds in a predicted sensor."""
    return [finding for finding in evaluation.findings if finding.rule == rule]


def window(ax: Axes, left: float, right: float, low: float, high: float) -> None:
    """Show a part of the drawing."""
    ax.set_xlim(left, right)
    ax.set_ylim(low, high)
