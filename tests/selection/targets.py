"""Targets that several tests share."""

from __future__ import annotations

import json
from functools import cache
from typing import Any

from pneutouch.results.record import plain
from pneutouch.spec.target import Given, Setting, Target, TargetFigures, Weights
from pneutouch.workflows.select.document import selected
from pneutouch.workflows.select.select import SelectionRun, select

FINGERTIP = {"sensitivity_kPa_per_N": 1.9, "driving_pressure_kPa": 12.0, "force_range_N": 15.0, "max_diameter_mm": 25.0}
"""The first thing people ask for."""


def target(wanted: dict[str, Any], **tables: dict[str, Any]) -> Target:
    return Target(
        target=TargetFigures(**wanted),
        given=Given(**tables.get("given", {})),
        setting=Setting(**tables.get("setting", {})),
        weights=Weights(**tables.get("weights", {})),
    )


def answer(wanted: dict[str, Any], **tables: dict[str, Any]) -> SelectionRun:
    """The answer to a target, searched for once in a process: nobody changes it."""
    return _answer(json.dumps([wanted, tables]))


@cache
def _answer(text: str) -> SelectionRun:
    wanted, tables = json.loads(text)
    return select(target(wanted, **tables), "test")


def document(run: SelectionRun) -> dict[str, Any]:
    """A selection as ``select`` prints it."""
    return plain(selected(run))
