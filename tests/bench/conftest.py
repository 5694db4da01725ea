"""A short run as samples and as a file, and the paper's sensor with its curves; a test may change none of them."""

from __future__ import annotations

import pytest

from pneutouch.bench.simulate.curve import PressCurves
from pneutouch.mechanics import Sensor
from tests.bench.rig import small, write
from tests.bench.truths import paper_pressed, paper_sensor


@pytest.fixture(scope="module")
def samples():
    return small()


@pytest.fixture(scope="module")
def file(tmp_path_factory, samples):
    return write(tmp_path_factory.mktemp("run") / "run.csv", samples)


@pytest.fixture(scope="module")
def sensor() -> Sensor:
    return paper_sensor()


@pytest.fixture(scope="module")
def pressed() -> PressCurves:
    return paper_pressed()
