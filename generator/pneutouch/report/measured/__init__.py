"""The measured datasheet: the measured figures compared with the predicted ones."""

from pneutouch.report.measured.tables import CampaignReport, GroupComparison

__all__ = ["CampaignReport", "GroupComparison"]
