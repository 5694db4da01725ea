"""Processor time of single jobs over that of something else done in the same run: ``python -m benchmarks.ratios [NAME ...]``.

Work and measure run in turn, each once for the caches and then three times; the least of each is compared. So a ratio
holds on a slow or a loaded machine too. Exits 1 where one is above its bound. Start-up: ``benchmarks.start_up``.
"""

from __future__ import annotations

import os

# One thread, as in the tests: set before NumPy is loaded.
for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[_name] = "1"

import sys  # noqa: E402
import tempfile  # noqa: E402
import time  # noqa: E402
from collections.abc import Callable, Iterator  # noqa: E402
from contextlib import contextmanager  # noqa: E402
from pathlib import Path  # noqa: E402

from benchmarks import ratio_cases as cases  # noqa: E402

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
    "1,000 responses of the atlas / one of the solid": (cases.atlas_batch, 2.0),
    "one response of the atlas / one of the solid": (cases.atlas_single, 0.1),
    "solid with the check for sway and lobes / without": (cases.sway, 1.3),
    "reading 100 MB to a curve / pandas reading it": (cases.reading, 4.0),
    "fit of 40 curves / 100 responses of each": (cases.fit_of_curves, 0.6),
    "voxels of the graded dome / a random number each": (cases.voxels, 5.0),
}
"""Maker of work and measure, given an empty folder, and the ratio that must not be passed."""


def seconds(job: Callable[[], object]) -> float:
    start = time.process_time()
    job()
    return time.process_time() - start


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
        times = [(seconds(work), seconds(by)) for _ in range(1 + RUNS)][1:]
    return min(time for time, _ in times), min(time for _, time in times)


def main(names: list[str]) -> int:
    """Print one line a ratio; 1 where one is above its bound."""
    worst = 0
    print(f"{'':58}{'s':>9}{'over s':>9}{'ratio':>9}{'at most':>9}")
    for name, (make, most) in RATIOS.items():
        if names and not any(part in name for part in names):
            continue
        taken, base = measure(make)
        worst |= taken > most * base
        print(f"{name:58}{taken:9.4f}{base:9.4f}{taken / base:9.3g}{most:9.3g}", flush=True)
    return worst


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
