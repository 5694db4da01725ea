"""A target as the page sends it: fields with texts, as in a question about a design."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from pneutouch.errors import InputError, PneutouchError, shown
from pneutouch.spec.design import DesignFile
from pneutouch.spec.read import override, parse_changes, validate
from pneutouch.spec.target import Target
from pneutouch.studio.question import PAGE, Question

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

_CHANGES = "setting.assignments"


def target_of(question: Question, bases: Mapping[str, str]) -> Target:
    """The target that the fields of a question state, with the base that the page has by that name.

    Raises InputError naming key and value.
    """
    given = [f"{name}={text}" for name, text in question.values.items() if text is not None]
    content = override({"target": {}}, parse_changes(given), Target)
    base = content.get("setting", {}).get("base")
    if isinstance(base, str):
        # The page has designs by name alone: no path of a request is opened.
        if base not in bases:
            raise InputError("unknown design", key="setting.base", value=base)
        content["setting"]["base"] = bases[base]
    return validate(Target, content, PAGE)


@contextmanager
def at_its_fields() -> Iterator[None]:
    """Put an error about a field of the base to the field of the form that changes it, which its words then name."""
    try:
        yield
    except PneutouchError as error:
        for each in (error, *error.others):
            if each.key is not None and each.key.partition(".")[0] in DesignFile.model_fields:
                value = "" if each.value is None else f" = {shown(each.value)}"
                each.problem, each.key, each.value = f"{each.key}{value}: {each.problem}", _CHANGES, None
        raise
