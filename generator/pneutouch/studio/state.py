"""A design as the state of the page: a base that it has open, and the fields that differ from it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pneutouch.catalogue import DesignSource, Library
from pneutouch.errors import InputError
from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import Table
from pneutouch.spec.read import assignments

if TYPE_CHECKING:
    from collections.abc import Mapping


def state_of(design: DesignFile, base: str, bases: Mapping[str, str], library: Library) -> dict[str, Any]:
    """The state that is ``design``: ``base``, by the page's name for it, and by ``table.key`` the texts of its values
    that differ from the base's file, None if a key is left out.

    Raises InputError if the page has no such base, or its file is wrong.
    """
    if base not in bases:
        raise InputError("unknown design", key="base", value=base)
    before, after = _flat(DesignSource.of(bases[base], library).changed({})), _flat(design)
    values: dict[str, str | None] = {}
    for name in sorted(before | after):
        value = after.get(name)
        if value != before.get(name):
            values[name] = None if value is None else assignments({name: value})[0].partition("=")[2]
    return {"base": base, "values": values}


def _flat(design: DesignFile) -> dict[str, Any]:
    """The values of a design file by ``table.key``, those outside the tables by their key."""
    content: dict[str, Any] = {}
    for name, value in design.model_dump(by_alias=True).items():
        if isinstance(getattr(design, name), Table):
            content |= {f"{name}.{key}": each for key, each in value.items()}
        else:
            content[name] = value
    return content
