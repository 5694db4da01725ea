"""Measured data to figures, compared with the predicted ones."""

from pneutouch.workflows.characterize.load import CampaignData, Progress, load_curves, recognise
from pneutouch.workflows.characterize.predicted import answers
from pneutouch.workflows.characterize.reading import Reading, parse_columns, read_as, same_failures, undisputed
from pneutouch.workflows.characterize.run import CharacterizationResult, characterize, sound

__all__ = [
    "CampaignData",
    "CharacterizationResult",
    "Progress",
    "Reading",
    "answers",
    "characterize",
    "load_curves",
    "parse_columns",
    "read_as",
    "recognise",
    "same_failures",
    "sound",
    "undisputed",
]
