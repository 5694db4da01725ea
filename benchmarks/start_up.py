"""Processor time of the commands over that of importing their libraries: ``python -m benchmarks.start_up [RUNS]``.

Every command and both imports run in turn, each in a process of its own with one thread; the medians are compared, so
that a slow minute of the machine counts for all of them.
"""

from __future__ import annotations

import os
import resource
import statistics
import subprocess
import sys
import tempfile

NUMERICS = "import numpy, scipy.linalg"
DRAWING = "import cadquery, matplotlib.pyplot, trimesh, numpy, scipy.linalg"
NOTHING = "import sys"
WORDS = "import typer, pydantic"
README_TARGET = "--sensitivity 1.9 --at 12 --force-range 15 --max-diameter 25"

COMMANDS: dict[str, tuple[list[str], str, float]] = {
    "build paper-dome": (["-m", "pneutouch", "build", "paper-dome", "--out", "{out}"], DRAWING, 2.0),
    "predict paper-dome": (["-m", "pneutouch", "predict", "paper-dome"], NUMERICS, 4.0),
    "predict --model atlas": (["-m", "pneutouch", "predict", "paper-dome", "--model", "atlas"], NUMERICS, 2.5),
    "select": (["-m", "pneutouch", "select", *README_TARGET.split()], NUMERICS, 5.0),
    "--help": (["-m", "pneutouch", "--help"], WORDS, 2.5),
    "import pneutouch": (["-c", "import pneutouch"], NOTHING, 1.5),
}
"""Arguments of Python by name, the imports each is compared with, and the ratio it must not pass."""


def processor_seconds(arguments: list[str], compiled: str) -> float:
    """User and system time of a Python process, s; ``compiled`` is the folder of compiled modules.

    Raises CalledProcessError where the process fails.
    """
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    environment |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "PYTHONPYCACHEPREFIX": compiled}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, *arguments], check=True, capture_output=True, env=environment)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def measure(runs: int) -> dict[str, float]:
    """Median processor time of every command and every import, s."""
    with tempfile.TemporaryDirectory() as out, tempfile.TemporaryDirectory() as compiled:
        jobs = {name: [word.format(out=out) for word in words] for name, (words, _, _) in COMMANDS.items()}
        jobs |= {text: ["-c", text] for text in (NUMERICS, DRAWING, NOTHING, WORDS)}
        for arguments in jobs.values():
            processor_seconds(arguments, compiled)  # compiles the modules, as an installed package is
        times = [
            {name: processor_seconds(arguments, compiled) for name, arguments in jobs.items()} for _ in range(runs)
        ]
    return {name: statistics.median(each[name] for each in times) for name in jobs}


def table(seconds: dict[str, float]) -> str:
    """The ratios as text, one command a line."""
    rows = [
        f"{name:24}{seconds[name]:8.3f}{seconds[over]:8.3f}{seconds[name] / seconds[over]:8.2f}{most:8.1f}"
        for name, (_, over, most) in COMMANDS.items()
    ]
    return "\n".join([f"{'':24}{'s':>8}{'imports':>8}{'ratio':>8}{'at most':>8}", *rows])


if __name__ == "__main__":
    print(table(measure(int(sys.argv[1]) if len(sys.argv) > 1 else 7)))
