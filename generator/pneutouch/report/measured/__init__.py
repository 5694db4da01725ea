"""The measured datasheet: what a campaign found, beside what was predicted."""

from pneutouch.report.measured.beside import Beside, Measured, Verdict

__all__ = ["Beside", "Measured", "Verdict"]
