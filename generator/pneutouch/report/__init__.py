"""The datasheet, its figures, and the sheet that goes to the printer."""

from pneutouch.report.datasheet import datasheet
from pneutouch.report.print_sheet import print_sheet
from pneutouch.report.sheet import Datasheet

__all__ = ["Datasheet", "datasheet", "print_sheet"]
