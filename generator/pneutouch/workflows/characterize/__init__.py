"""Measured data to figures, beside the predicted ones."""

from pneutouch.workflows.characterize.load import Loaded, load_curves
from pneutouch.workflows.characterize.run import Outcome, characterize

__all__ = ["Loaded", "Outcome", "characterize", "load_curves"]
