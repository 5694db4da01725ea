"""The measured datasheet: what a campaign found, beside what was predicted."""

from pneutouch.report.measured.beside import CampaignReport, GroupComparison, Verdict

__all__ = ["CampaignReport", "GroupComparison", "Verdict"]
