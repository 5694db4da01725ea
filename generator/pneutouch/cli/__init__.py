"""The command line. Importing a module of commands registers them with the app."""

from pneutouch.cli import select, sweep
from pneutouch.cli.app import run

__all__ = ["run", "select", "sweep"]
