"""The state of the page that is a design from elsewhere."""

from collections.abc import Mapping
from typing import Any

from pneutouch.catalogue import DesignSource, Library
from pneutouch.errors import InputError, PneutouchError
from pneutouch.studio.question import Question
from pneutouch.studio.state import state_of


def nearest_state(source: DesignSource, bases: Mapping[str, str], library: Library) -> Question:
    """The state whose design is that of ``source``, in every field.

    Its base is the one of the same name, else the one from which the design differs in the fewest fields. Raises
    InputError where the design is wrong, and where no state of the page is this very design.
    """
    design = source.changed({})
    states: list[dict[str, Any]] = []
    for base in bases:
        try:
            states.append(state_of(design, base, bases, library))
        except PneutouchError:
            # A base whose file cannot be read is none to start from.
            continue
    if not states:
        raise InputError("no design of this page can be read", remedy="mend the design files that pneutouch list names")
    # By the same limits as what comes from a browser.
    question = Question.of(min(states, key=lambda state: (state["base"] != source.name, len(state["values"]))))
    if question.source(bases, library).changed({}).model_dump() != design.model_dump():
        remedy = "build it by its file with the commands"
        raise InputError("has values that the page cannot hold", file=source.where, remedy=remedy)
    return question
