"""A target as the page asks it, and its answer."""

from __future__ import annotations

from pneutouch.results.record import plain
from pneutouch.studio.form import Question
from pneutouch.studio.search import search
from pneutouch.studio.server import bases_of

FIELDS = {
    "target.sensitivity_kPa_per_N": "1.9",
    "target.driving_pressure_kPa": "12",
    "target.force_range_N": "15",
    "target.max_diameter_mm": "25",
}
"""The first command of docs/howto/select.md."""


def asked(values, base="paper-dome", report=lambda done, total, what: None):
    bases, _ = bases_of(None)
    return plain(search({"base": base, "values": values, "files": [], "bases": bases}, None, report))


def opened(state, library):
    """The design file that the page has in a state."""
    bases, _ = bases_of(None)
    return Question.of(state).source(bases, library).changed({})
