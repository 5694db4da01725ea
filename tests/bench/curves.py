"""Records of known sensors as curves, and what the curves warn of."""

from __future__ import annotations

from pathlib import Path

from pneutouch.bench.curve import curve_of
from pneutouch.spec.campaign import Rig
from tests.bench.reads import blocks_of
from tests.bench.rig import Dome, Sensor, run_of

FILE = Path("run.csv")
LAWS = [Sensor(0.6, 1.0), Sensor(0.25, 1.5), Sensor(0.12, 1.8), Dome()]


def curve(samples, kind="steps", sensor=LAWS[1], rig=None, **more):
    return curve_of(run_of(kind, sensor), blocks_of(FILE, *samples, **more), rig or Rig())


def whys(result, used=None):
    return [warning.why for warning in result.warnings if used is None or warning.used == used]
