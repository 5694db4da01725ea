"""The command line: one module a command, loaded where the command is used."""

from pneutouch.cli.app import run

__all__ = ["run"]
