"""A design that was found, as a state of the page, and the command that saves it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pneutouch.cli.select_fields import saving_command
from pneutouch.errors import InputError
from pneutouch.output.new import free_name
from pneutouch.spec.design import DesignFile
from pneutouch.spec.read import validate
from pneutouch.studio.question import PAGE, Question
from pneutouch.studio.state import state_of
from pneutouch.workflows.select.passing import assigned

if TYPE_CHECKING:
    from collections.abc import Mapping

    from pneutouch.catalogue import Library, ResolvedDesign
    from pneutouch.spec.target import Target


class CandidateStates:
    """Maker of page states from designs that were found, and of the commands that save them under a free name."""

    def __init__(self, question: Question, bases: Mapping[str, str], library: Library, target: Target) -> None:
        self._bases, self._library, self._target, self._name = bases, library, target, free_name()
        if question.base not in bases:
            raise InputError("unknown design", key="base", value=question.base)
        named = (name for name, design in bases.items() if design == target.setting.base)
        self._base = question.base if target.setting.base is None else next(named)

    def state(self, base: ResolvedDesign, changes: list[str]) -> dict[str, Any]:
        """The state of the page that is the design that ``select`` saves: a base with assignments."""
        design = validate(DesignFile, assigned(base.design, changes, self._name), PAGE)
        return state_of(design, self._base, self._bases, self._library)

    def command(self, rank: int) -> str:
        """The command that saves the design of a rank."""
        return saving_command(self._target, rank, self._name)
