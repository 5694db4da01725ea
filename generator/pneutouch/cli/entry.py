"""A command line taken apart and run, with every outcome turned into an exit code."""

import re
import sys
from typing import Any

from pneutouch.cli.app import app
from pneutouch.cli.bash_words import words_of_bash
from pneutouch.cli.terminal import notify, open_closed_streams


def invoked(words: list[str]) -> int:
    """Run the command of ``words`` and return its exit code; words that are no command end in one line and code 2."""
    open_closed_streams()
    try:
        with words_of_bash(sys.stdout.write):
            outcome = app(args=words or ["--help"], prog_name="pneutouch", standalone_mode=False)
    except Exception as error:
        # Typer has its own errors and click's, by its version; each formats its message.
        if not hasattr(error, "format_message"):
            raise
        notify(f"error: {_about(error)}")
        return getattr(error, "exit_code", 2)
    return outcome if isinstance(outcome, int) else 0


def _about(error: Any) -> str:
    """Problem with the words of a command line, and the command that lists its options."""
    message = re.sub(r"'(-[^' ]*)'", r"\1", error.format_message()).replace("'", '"').rstrip(".")
    message = re.sub(r"Input should be (a )?(valid )?", r"must be \1", message).split(", unable to parse")[0]
    message = message.replace("a integer", "a whole number")
    context = getattr(error, "ctx", None)
    command = context.command_path if context else "pneutouch"
    return f"{message[:1].lower()}{message[1:]}; {command} -h lists what it takes"
