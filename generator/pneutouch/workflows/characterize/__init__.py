"""Characterization: measured data reduced to figures and compared with predictions."""

from pneutouch.workflows.characterize.campaign import CharacterizationResult, characterize, sound
from pneutouch.workflows.characterize.load import (
    CampaignData,
    Progress,
    Reading,
    load_curves,
    parse_columns,
    read_as,
    recognise,
    same_failures,
    undisputed,
)
from pneutouch.workflows.characterize.predicted import answers

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
