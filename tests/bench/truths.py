"""The paper's dome pressed, once for all tests of the simulated rig, and a curve that is straight."""

from __future__ import annotations

from functools import cache

import numpy as np

from pneutouch.bench.indents import RunProtocol
from pneutouch.bench.simulate.curve import PressCurve, PressCurves, press_curves
from pneutouch.bench.simulate.rig import WallMemory
from pneutouch.catalogue import Library, load_scene
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.mechanics import Sensor
from pneutouch.parts import assemble
from pneutouch.units import KPA
from tests.conftest import ROOT

R0 = 9.25
NO_WALL = WallMemory((), (), ())


def rng(seed: int = 0) -> np.random.Generator:
    return np.random.default_rng(seed)


def line(stiffness: float = 2.0, slope: float = 3 * KPA, driving: float = 0.0, reach: float = 9.0) -> PressCurve:
    """A curve that is straight: N/mm, MPa/mm."""
    depth = np.linspace(0.0, reach, 10)
    return PressCurve(driving, depth, stiffness * depth, slope * depth)


def ends(test: RunProtocol, rate: float) -> np.ndarray:
    """The last samples of the holds."""
    return np.floor(test.knots()[0][3::4] * rate + 1e-6).astype(int)


@cache
def paper_sensor() -> Sensor:
    return sensor_of(assemble(load_scene("paper-dome", None, Library((ROOT,)))))


@cache
def paper_pressed() -> PressCurves:
    """At 0 and 22 kPa."""
    return press_curves(paper_sensor(), [0.0, 22 * KPA], 0.75 * R0, "solid", steps=14)
