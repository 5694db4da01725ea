"""Measured data to figures, beside the predicted ones."""

from pneutouch.pipeline.characterize.load import Loaded, load_curves
from pneutouch.pipeline.characterize.run import Outcome, characterize

__all__ = ["Loaded", "Outcome", "characterize", "load_curves"]
