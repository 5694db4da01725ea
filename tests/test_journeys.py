"""The files that docs/background/journeys.md names are there."""

from __future__ import annotations

import re

from tests.budgets import PACKAGE, ROOT

PAGE = ROOT / "docs" / "background" / "journeys.md"


def test_every_file_named_is_there():
    named = re.findall(r"`([\w/.]+\.(?:py|js|j2|typ))`", PAGE.read_text(encoding="utf-8"))
    assert len(named) > 30
    # `solid/...` are those of the mechanics.
    missing = [
        name for name in named if not any((folder / name).is_file() for folder in (PACKAGE, PACKAGE / "mechanics"))
    ]
    assert not missing


def test_the_page_is_one_page():
    assert len(PAGE.read_text(encoding="utf-8").split()) < 600
