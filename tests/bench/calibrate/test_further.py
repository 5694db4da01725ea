"""The tests that are proposed after a fit."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from pneutouch.bench.calibrate.fitted_atlas import injected
from pneutouch.bench.calibrate.other_states import _volume
from pneutouch.mechanics.atlas.table import shipped
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.units import KPA


@pytest.mark.parametrize("dead", [0.0, 900.0])
@pytest.mark.parametrize("pressure_kPa", [5.0, 25.0])
def test_the_proposed_volume_gives_the_pressure_that_is_stated(library, pressure_kPa, dead):
    sensor = material_sensor(library.load("materials", "TangoPlus"))
    size, mu, wall = sensor.dome.inner_radius, sensor.wall.shear_modulus, sensor.dome.wall_thickness
    volume = _volume(SimpleNamespace(sensor=sensor), np.array([np.log(mu), np.log(wall), dead]), pressure_kPa * KPA)
    ambient = np.array([sensor.gas.ambient_pressure / mu])
    slices, scaled = shipped().slices(np.array([wall / size])), np.array([dead, volume]) / size**3
    pressure, covered = injected(slices, np.zeros(1, dtype=np.intp), ambient, scaled[:1], scaled[1:])
    assert covered.all()
    assert pressure[0, 0] * mu == pytest.approx(pressure_kPa * KPA, rel=2e-3)
