"""The datasheet, its figures, and the sheet that goes to the printer."""

from pneutouch.report.datasheet import datasheet
from pneutouch.report.print_sheet import print_sheet

__all__ = ["datasheet", "print_sheet"]
