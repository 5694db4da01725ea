"""The command line. Importing a module of commands registers them with the app."""

from pneutouch.cli import build, calibrate, characterize, coupons, plan, scan, select, show, simulate, sweep, tray
from pneutouch.cli.app import run

__all__ = [
    "build",
    "calibrate",
    "characterize",
    "coupons",
    "plan",
    "run",
    "scan",
    "select",
    "show",
    "simulate",
    "sweep",
    "tray",
]
