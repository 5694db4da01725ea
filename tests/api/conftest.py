"""The command line's JSON, from within this process."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from pneutouch.cli.app import app


@pytest.fixture(scope="session")
def printed():
    def run(*words) -> dict:
        """What a command prints with ``--json``."""
        import pneutouch.cli  # noqa: F401  # registers the commands

        result = CliRunner().invoke(app, [*map(str, words), "--json"])
        assert result.stdout, result.output
        return json.loads(result.stdout)

    return run
