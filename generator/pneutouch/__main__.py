"""``python -m pneutouch``."""

from pneutouch.cli import run

run()
