"""The uncertainty of a prediction: stated sources, their shares, expanded uncertainties with k = 2 (JCGM 100)."""

from pneutouch.mechanics.uncertainty.document import (
    GasNotes,
    budget,
    document,
    gas_notes,
    gas_text,
    monte_carlo,
    shares,
    text,
)
from pneutouch.mechanics.uncertainty.propagate import COVERAGE, Budget
from pneutouch.mechanics.uncertainty.source import UncertaintySource
from pneutouch.mechanics.uncertainty.sources.model_error import ModelErrors, measured_errors, model_errors

__all__ = [
    "COVERAGE",
    "Budget",
    "GasNotes",
    "ModelErrors",
    "UncertaintySource",
    "budget",
    "document",
    "gas_notes",
    "gas_text",
    "measured_errors",
    "model_errors",
    "monte_carlo",
    "shares",
    "text",
]
