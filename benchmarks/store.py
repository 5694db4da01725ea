"""Stored measurements: docs/background/NAME.json, of which the pages are filled."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from pneutouch.catalogue import Library

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs" / "background"
T = TypeVar("T")
LIBRARY = Library((ROOT,))
"""The shipped files, without those of a user."""


def stored(name: str) -> Any:
    """A stored measurement."""
    return json.loads((DOCS / f"{name}.json").read_text(encoding="utf-8"))


def timed(work: Callable[[], T]) -> tuple[T, float]:
    """What ``work`` gives, and its processor time in s."""
    start = time.process_time()
    return work(), time.process_time() - start


def store(name: str, data: Any, indent: int | None = 1) -> None:
    """Store a measurement."""
    (DOCS / f"{name}.json").write_text(json.dumps(data, indent=indent) + "\n", encoding="utf-8")
