"""The paper's sensor is recognised within a tolerance, in any resin."""

from __future__ import annotations

import pytest

from pneutouch.catalogue import Library
from pneutouch.mechanics.paper_sensor import is_paper_sensor, material_sensor

SENSOR = material_sensor(Library.default().load("materials", "FLX9960"))


def test_rounding_and_the_resin_do_not_matter():
    assert is_paper_sensor(SENSOR)
    assert is_paper_sensor(SENSOR.replace(inner_radius=9.25 * (1 + 1e-9), depth=9.25 - 2.3125, shear_modulus=0.2))


@pytest.mark.parametrize(
    "change",
    [
        {"inner_radius": 9.2501},
        {"wall_thickness": 1.501},
        {"plate_radius": 14.9},
        {"depth": 6.9},
        {"ambient_pressure": 0.1013},
        {"dead_volume": 1.0},
    ],
)
def test_any_other_size_gas_or_press_is_not_the_papers(change):
    assert not is_paper_sensor(SENSOR.replace(**change))
