"""The command line. Importing a module of commands registers them with the app."""

from pneutouch.cli import build, coupons, scan, select, show, sweep, tray
from pneutouch.cli.app import run

__all__ = ["build", "coupons", "run", "scan", "select", "show", "sweep", "tray"]
