"""Run cases in a process with bounded memory and processor time; what fails goes to a file, one JSON document a line.

``python -m tests.stability.fuzz.run BASE REPORT SEED FIRST LAST`` runs the cases FIRST to LAST - 1 on the valid files of
the folder BASE. The number of the case at work stands in REPORT.at, so that a process that is killed names its case.
"""

from __future__ import annotations

import contextlib
import json
import os
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from unittest import mock

import typer

from pneutouch.cli.app import app
from pneutouch.errors import ComputationError
from tests.running import in_process
from tests.stability.fuzz.cases import Case, make

MEMORY = 1_000_000_000
"""Bytes that a case may take."""
SECONDS = 60
"""Of processor time for a case."""
WHOLE = 0.002
"""Share of the cases that compute everything; the others end where the computing of seconds begins."""

LEFT_OUT = (
    "pneutouch.mechanics.models.solid.solid_states",
    "pneutouch.mechanics.models.solid.solid_result",
    "pneutouch.mechanics.models.local.build",
    "pneutouch.workflows.build.refuse",
    "pneutouch.workflows.calibrate.calibrate.calibrate",
    "pneutouch.report.comparison_sheet.comparison_sheet",
    "pneutouch.workflows.characterize.campaign.answers",
    "pneutouch.report.measured.sheet.measured_datasheet",
    "pneutouch.workflows.coupons.make.lay",
    "pneutouch.workflows.export_reader.reader_grid",
    "pneutouch.workflows.respond.run_respond",
    "pneutouch.workflows.scan.draw",
    "pneutouch.workflows.select.select.choose",
    "pneutouch.workflows.select.shapes.solid_states",
    "pneutouch.workflows.export_reader._simulated",
    "pneutouch.workflows.specimen.build.draw",
    "pneutouch.workflows.sweep.execute._compute",
    "pneutouch.workflows.tray.order.assemble",
    "pneutouch.evaluation.resins.press_curves",
)
"""What takes seconds: reading, checking and drawing come before."""

_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")


def left_out(*_: object, **__: object) -> None:
    """In place of what takes seconds."""
    raise ComputationError("left out in this test")


@contextlib.contextmanager
def cheap(active: bool) -> Iterator[None]:
    """Leave out what takes seconds."""
    with contextlib.ExitStack() as stack:
        for name in LEFT_OUT if active else ():
            stack.enter_context(mock.patch(name, left_out))
        yield


def judge(case: Case, done: subprocess.CompletedProcess[str], folder: Path) -> str | None:
    """What is wrong with the end of a case, or None."""
    said = done.stdout + done.stderr
    if done.returncode not in (0, 1, 2, 3):
        return f"exit code {done.returncode}"
    for words in ("internal fault", "Traceback", "not enough memory", "RuntimeWarning"):
        if words in said:
            return words
    # A path that was given is shown as it is, so that a program can read it.
    given = done.returncode == 0 and any(map(_CONTROL.search, case.words))
    if _CONTROL.search(said) and not given:
        return "a control character in the output"
    if len(done.stderr) > 20_000:
        return f"{len(done.stderr)} characters on stderr"
    if done.returncode and not done.stderr and not done.stdout:
        return "fails without a word"
    if done.returncode == 0 and _asks_json(case.words) and not _is_json(done.stdout):
        return "no JSON"
    hidden = [path for path in folder.rglob(".*") if path.name not in (".", "..")]
    return f"left behind: {hidden[0].name}" if hidden else None


def _asks_json(words: list[str]) -> bool:
    """Whether ``--json`` is an option there, and not the value of ``--out`` before it."""
    option = any(word == "--json" and words[k] != "--out" for k, word in enumerate(words[1:]))
    return option and "--help" not in words


def _is_json(text: str) -> bool:
    try:
        json.loads(text)
    except ValueError:
        return False
    return True


def one(seed: int, number: int, base: Path, options: dict[str, list[str]]) -> str | None:
    """Run one case; what is wrong with it, in words, or None."""
    rng = random.Random(f"{seed} {number}")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        case = make(rng, base, folder, options)
        spent = resource.getrusage(resource.RUSAGE_SELF)
        resource.setrlimit(
            resource.RLIMIT_CPU, (int(spent.ru_utime + spent.ru_stime) + SECONDS, resource.RLIM_INFINITY)
        )
        try:
            with cheap(rng.random() > WHOLE):
                done = in_process(case.words, folder)
        except BaseException as error:
            return f"{case.kind}: {_short(case.words)}: {type(error).__name__}: {error}"[:2000]
        fault = judge(case, done, folder)
        shutil.rmtree(folder / "outputs", ignore_errors=True)
        return None if fault is None else f"{case.kind}: {_short(case.words)}: {fault}: {done.stderr[-600:]}"


def _short(words: list[str]) -> str:
    return " ".join(word if len(word) < 80 else f"{word[:80]}..." for word in words)


def options_of() -> dict[str, list[str]]:
    """The options of every command, as a user types them."""
    group = typer.main.get_command(app)
    context = typer.Context(group)
    commands = {name: group.get_command(context, name) for name in group.list_commands(context)}
    return {
        name: sorted(word for parameter in command.params for word in parameter.opts if word.startswith("-"))
        for name, command in commands.items()
    }


def peak() -> int:
    """Most memory in bytes that this process has held; the figure of getrusage begins with the parent's."""
    status = Path("/proc/self/status")
    if not status.is_file():
        return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return 1024 * int(status.read_text().split("VmHWM:")[1].split()[0])


def main() -> None:
    base, report = Path(sys.argv[1]), Path(sys.argv[2])
    seed, first, last = map(int, sys.argv[3:])
    resource.setrlimit(resource.RLIMIT_DATA, (2 * MEMORY, 2 * MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    # Typer makes all commands anew for each call: that is most of the time of a case that is refused.
    group = typer.main.get_command(app)
    options = options_of()
    for name in LEFT_OUT:
        __import__(name.rpartition(".")[0])
    with report.open("a", encoding="utf-8") as file, mock.patch("typer.main.get_command", lambda _: group):
        for number in range(first, last):
            Path(f"{report}.at").write_text(str(number))
            before = resource.getrusage(resource.RUSAGE_SELF)
            fault = one(seed, number, base, options)
            after = resource.getrusage(resource.RUSAGE_SELF)
            took = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            if fault is None and peak() > MEMORY:
                fault = f"{peak() // 2**20} MB"
            file.write(json.dumps({"case": number, "fault": fault, "seconds": round(took, 3)}) + "\n")
            file.flush()


if __name__ == "__main__":
    os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", PYTHONHASHSEED="0")
    main()
