"""A picture of a good and a bad case of every print rule, with what the rule finds: ``make rule-pictures``.

It writes ``docs/reference/rules/``, of which the page of the rules is made; with names of rules, theirs alone.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pictures.rules import EXHIBITS, Case
from pneutouch.report.style import BOLD, figure, svg
from pneutouch.results.record import plain

FOLDER = Path(__file__).resolve().parents[4] / "docs/reference/rules"
RECORD = FOLDER / "findings.json"
SIZE = (84.0, 50.0)
"""Width and height of a picture, mm: two stand side by side on a page, one on a phone."""

SIDES = ("good", "bad")


def main(names: Sequence[str]) -> None:
    """Write the pictures of some rules, or of all, and the record of the findings."""
    FOLDER.mkdir(exist_ok=True)
    known = json.loads(RECORD.read_text(encoding="utf-8")) if RECORD.is_file() else {}
    record: dict[str, Any] = {}
    for rule, make in EXHIBITS.items():
        if names and rule not in names:
            record[rule] = known[rule]
            continue
        pair = dict(zip(SIDES, make(), strict=True))
        record[rule] = {side: recorded(case) for side, case in pair.items()}
        for side, case in pair.items():
            path = FOLDER / picture_name(rule, side)
            path.write_text(picture(case, side) + "\n", encoding="utf-8")
            sys.stdout.write(f"{path}\n")
    RECORD.write_text(json.dumps(record, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def picture_name(rule: str, side: str) -> str:
    """The file of a picture."""
    return f"{rule.replace(' ', '-')}-{side}.svg"


def recorded(case: Case) -> dict[str, Any]:
    """What the page states of a case."""
    return {"case": case.label, "findings": [plain(finding.stated) for finding in case.findings]}


def picture(case: Case, side: str) -> str:
    """A case as SVG."""
    with figure(*SIZE) as drawn:
        ax = drawn.add_subplot()
        ax.set_aspect("equal")
        ax.axis("off")
        case.draw(ax)
        drawn.suptitle(f"{side}: {case.label}", x=0.02, ha="left", fontsize=8, **BOLD)
        return svg(drawn)


if __name__ == "__main__":
    main(sys.argv[1:])
