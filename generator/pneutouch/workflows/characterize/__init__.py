"""Characterization: measured data reduced to figures and compared with predictions."""

from pneutouch.workflows.characterize.campaign import sound
from pneutouch.workflows.characterize.load import (
    CampaignData,
    Progress,
    Reading,
    load_curves,
    read_as,
    same_failures,
    undisputed,
)
from pneutouch.workflows.characterize.predicted import answers

__all__ = [
    "CampaignData",
    "Progress",
    "Reading",
    "answers",
    "load_curves",
    "read_as",
    "same_failures",
    "sound",
    "undisputed",
]
