"""Meaning of the keys of written documents: one key, one meaning, unless a record has its own."""

import tomllib
from functools import cache
from pathlib import Path

_FILE = Path(__file__).with_name("helps.toml")


def help_of(key: str, record: str = "") -> str:
    """The meaning of a key, that of the record if it has its own."""
    known = _helps()
    return known.get(f"{record}.{key}") or known[key]


@cache
def _helps() -> dict[str, str]:
    return tomllib.loads(_FILE.read_text(encoding="utf-8"))
