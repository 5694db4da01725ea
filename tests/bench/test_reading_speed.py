"""Long files: how much memory they take. Their time: ``tests.ratios``."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from pneutouch.units import KPA
from tests.bench.rig import HEADER, Faults, record, write

MEASURE = """
import sys
from pathlib import Path
from pneutouch.bench.curve import curve_of
from pneutouch.bench.reading import PLATE, read_blocks
from pneutouch.bench.source import identify
from pneutouch.spec.campaign import CampaignRun, ColumnMap, Rig
run = CampaignRun(file="x", sensor="A", resin="r", driving_pressure_kPa=12)
points = curve_of(run, read_blocks(identify(Path(sys.argv[1]), ColumnMap(), PLATE), Rig()), Rig()).indentation.size
status = Path("/proc/self/status").read_text()
print(1024 * int(status.split("VmHWM:")[1].split()[0]), points)
"""


def measure(path):
    """Peak bytes of a process of its own from a file to a curve, and its points.

    The peak is that of /proc: the one of getrusage begins with the parent's. Blocks beyond 64 kB go back to the system
    when they are freed: kept ones, more of them the more chunks there are, are no memory that the reader needs.
    """
    if not Path("/proc/self/status").is_file():
        pytest.skip("needs /proc")
    done = subprocess.run(
        [sys.executable, "-c", MEASURE, str(path)],
        env={**os.environ, "MALLOC_MMAP_THRESHOLD_": "65536"},
        capture_output=True,
        text=True,
        check=True,
    )
    return tuple(map(float, done.stdout.split()))


def long_file(path: Path, rest):
    from pneutouch.bench.indents import protocol

    samples = record(faults=Faults(rate=10_000.0), what=protocol("steps", 9.25).quicker(rest))
    with path.open("w") as stream:
        stream.write(",".join(HEADER) + "\n")
        samples[3] /= KPA
        for part in np.array_split(samples, 1 + samples.shape[1] // 100_000, axis=1):
            stream.write(("%.4f,%.6f,%.8f,%.8f\n" * part.shape[1]) % tuple(part.T.ravel()))
    return path


@pytest.mark.slow
def test_memory_does_not_grow_with_the_file(tmp_path):
    path = write(tmp_path / "a.csv", record(faults=Faults(rate=3000.0)), decimals=(12, 16, 18, 18))
    header, _, body = path.read_bytes().partition(b"\n")
    assert len(body) > 30e6
    third = tmp_path / "third.csv"
    third.write_bytes(header + b"\n" + body[: body.rfind(b"\n", 0, len(body) // 3) + 1])
    whole, _ = measure(path)
    part, points = measure(third)
    assert points >= 4
    assert whole < part + 0.25 * (len(body) * 2 / 3)


@pytest.mark.slow
def test_300_megabytes_in_500_megabytes(tmp_path):
    path = long_file(tmp_path / "long.csv", 46.0)
    assert path.stat().st_size > 290e6
    peak, points = measure(path)
    assert points == 15
    assert peak < 500e6
