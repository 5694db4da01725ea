"""The command line: with the studio, the only part that talks to a person."""

from pneutouch.cli.app import run

__all__ = ["run"]
