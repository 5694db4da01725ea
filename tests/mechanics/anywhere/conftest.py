"""The paper's sensor, which several files of this folder look up."""

import pytest

from pneutouch.mechanics.paper_sensor import material_sensor


@pytest.fixture(scope="session")
def paper_sensor(library):
    return material_sensor(library.load("materials", "TangoPlus"))
