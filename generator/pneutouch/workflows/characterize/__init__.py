"""Measured data to figures, beside the predicted ones."""

from pneutouch.workflows.characterize.load import Loaded, Progress, load_curves
from pneutouch.workflows.characterize.predicted import answers
from pneutouch.workflows.characterize.run import Outcome, characterize, sound

__all__ = ["Loaded", "Outcome", "Progress", "answers", "characterize", "load_curves", "sound"]
