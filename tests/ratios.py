"""Processor time of single jobs over that of something else done in the same run: ``python -m tests.ratios [NAME ...]``.

Work and measure run in turn, each once for the caches and then three times; the least of each is compared. So a ratio
holds on a slow or a loaded machine too. Exits 1 where one is above its bound. With ``start-up [RUNS]`` the
processor time of every command over that of importing its libraries: each runs in turn in a process of its own with one
thread, and the medians are compared, so that a slow minute of the machine counts for all.
"""

from __future__ import annotations

import os

# One thread, as in the tests: set before NumPy is loaded.
for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[_name] = "1"

import resource  # noqa: E402
import statistics  # noqa: E402
import subprocess  # noqa: E402
import sys  # noqa: E402
import tempfile  # noqa: E402
from collections.abc import Callable, Iterator  # noqa: E402
from contextlib import contextmanager  # noqa: E402
from functools import partial  # noqa: E402
from pathlib import Path  # noqa: E402

from benchmarks.store import timed  # noqa: E402

from tests import ratio_cases as cases  # noqa: E402

RUNS = 3
RATIOS: dict[str, tuple[Callable[[Path], cases.Pair], float]] = {
    "check of a sensor / its bodies and their booleans": (cases.check_of_a_sensor, 4.0),
    "tray of 21 sensors / tray of 3": (cases.trays, 4.0),
    "1,000 struts / one batch boolean of them": (cases.struts, 0.2),
    "10,000 bars cut out / one batch boolean of them": (cases.bars, 0.3),
    "500 bars of the family / by hand": (cases.family, 20.0),
    "wavelet transform of 300,000 samples / plain transform": (cases.wavelets, 20.0),
    "budgets of 200 sensors / their responses": (cases.budgets, 40.0),
    "relaxation and two loops / one response": (cases.relaxation_and_loops, 40.0),
    "harmonic model of order 0 / the solid": (cases.order_zero, 4.0),
    "the same with friction": (partial(cases.order_zero, friction=0.5), 4.0),
    "1,000 responses of the atlas / one of the solid": (cases.atlas_batch, 2.0),
    "one response of the atlas / one of the solid": (cases.atlas_single, 0.1),
    "solid with the check for sway and lobes / without": (cases.sway, 1.3),
    "reading 100 MB to a curve / pandas reading it": (cases.reading, 4.0),
    "fit of 40 curves / 100 responses of each": (cases.fit_of_curves, 0.6),
    "voxels of the graded dome / a random number each": (cases.voxels, 5.0),
}
"""Maker of work and measure, given an empty folder, and the ratio that must not be passed."""

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


@contextmanager
def empty_folder() -> Iterator[Path]:
    """An empty folder that is the current one."""
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as name:
        os.chdir(name)
        try:
            yield Path(name)
        finally:
            os.chdir(before)


def measure(make: Callable[[Path], cases.Pair]) -> tuple[float, float]:
    """Least processor times of the work and of what it is measured by, s."""
    with empty_folder() as folder:
        work, by = make(folder)
        times = [(timed(work)[1], timed(by)[1]) for _ in range(1 + RUNS)][1:]
    return min(time for time, _ in times), min(time for _, time in times)


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


def start_up(runs: int) -> dict[str, float]:
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


def start_up_table(seconds: dict[str, float]) -> str:
    """The ratios as text, one command a line."""
    rows = [
        f"{name:24}{seconds[name]:8.3f}{seconds[over]:8.3f}{seconds[name] / seconds[over]:8.2f}{most:8.1f}"
        for name, (_, over, most) in COMMANDS.items()
    ]
    return "\n".join([f"{'':24}{'s':>8}{'imports':>8}{'ratio':>8}{'at most':>8}", *rows])


def main(names: list[str]) -> int:
    """Print one line a ratio, or the table of the commands; 1 where a ratio is above its bound."""
    if names[:1] == ["start-up"]:
        sys.stdout.write(f"{start_up_table(start_up(int(names[1]) if len(names) > 1 else 7))}\n")
        return 0
    worst = 0
    sys.stdout.write(f"{'':58}{'s':>9}{'over s':>9}{'ratio':>9}{'at most':>9}\n")
    for name, (make, most) in RATIOS.items():
        if names and not any(part in name for part in names):
            continue
        taken, base = measure(make)
        worst |= taken > most * base
        sys.stdout.write(f"{name:58}{taken:9.4f}{base:9.4f}{taken / base:9.3g}{most:9.3g}\n")
        sys.stdout.flush()
    return worst


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
