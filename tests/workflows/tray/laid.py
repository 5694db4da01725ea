"""The example tray, trays from options, and the table of a tray that was written."""

from __future__ import annotations

import csv
import io

from pneutouch.spec.read import parse_changes
from pneutouch.workflows.tray.lay import lay
from pneutouch.workflows.tray.order import order_of_flags
from tests.conftest import ROOT

EXAMPLE = ROOT / "docs/examples/seven-resins.toml"
RESINS = ["TangoPlus", "FLX9940", "FLX9950", "FLX9960", "FLX9970", "FLX9985", "FLX9995"]


def flags(library, designs, over=(), copies=1, overrides=(), **head):
    return lay(order_of_flags(designs, over, copies, parse_changes(overrides), **head), library)


def table(folder):
    return list(csv.DictReader(io.StringIO((folder / "labels.csv").read_text())))
