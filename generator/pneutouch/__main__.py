"""The command line as ``python -m pneutouch``."""

from pneutouch.cli import run

run()
