"""The atlas against the solid it was asked from, at sensors that took no part in making it, and against other programs."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.atlas.respond import ENDS, respond
from pneutouch.mechanics.atlas.table import shipped
from pneutouch.mechanics.events import range_end
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.membrane import RISING_BRANCH
from pneutouch.mechanics.models.solid import solid_result
from pneutouch.mechanics.prediction import ModelResult
from pneutouch.mechanics.sensor import Dome, GasCircuit, IndentationProtocol, RigidBase, Sensor, WallMaterial
from pneutouch.mechanics.solid.inflate import at_volume, inflate
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.shape.hemisphere import Hemisphere
from pneutouch.units import KPA, STANDARD_ATMOSPHERE

# Radius mm, wall/R0, mu MPa, dead volume/R0^3, depth/R0, driving pressure kPa, gauge limit MPa, break stretch.
SENSORS = {
    "paper, 0 kPa": (9.25, 0.1622, 0.17, 0.0, 0.75, 0.0, 0.1, None),
    "paper, 22 kPa": (9.25, 0.1622, 0.17, 0.0, 0.75, 22.0, 0.1, None),
    "paper, near its limit": (9.25, 0.1622, 0.17, 0.0, 0.5, 38.0, 0.2, None),
    "thinnest, dead volume": (15.0, 0.06, 0.27, 1.2, 0.6, 10.0, 0.1, None),
    "thin and stiff": (20.0, 0.071, 1.64, 0.2, 0.4, 60.0, 0.5, None),
    "thin, high pressure": (12.0, 0.083, 0.5, 3.0, 0.7, 50.0, 0.5, None),
    "stiff, 0 kPa": (9.25, 0.1622, 4.0, 0.0, 0.5, 0.0, 0.5, None),
    "ends at the gauge": (9.25, 0.13, 0.9, 0.0, 0.75, 60.0, 0.1, None),
    "ends at the break": (9.25, 0.11, 0.3, 2.0, 0.7, 45.0, 0.5, 1.51),
    "buckles": (9.25, 0.1622, 1.64, 0.0, 0.75, 0.0, 0.5, None),
    "thick": (6.0, 0.3, 0.55, 0.0, 0.4, 40.0, 0.2, None),
    "thickest, dead volume": (5.0, 0.35, 0.91, 0.8, 0.55, 100.0, 0.5, None),
}


def sensor(name: str) -> Sensor:
    """One of the sensors under a plate that is wide enough for any contact."""
    radius, wall, mu, dead, depth, _, gauge, tear = SENSORS[name]
    return Sensor(
        Dome(Hemisphere(radius, wall * radius)),
        WallMaterial(mu, 0.49, break_stretch=tear),
        GasCircuit(ambient_pressure=STANDARD_ATMOSPHERE, dead_volume=dead * radius**3, gauge_limit=gauge),
        IndentationProtocol(plate_radius=3.0 * radius, depth=depth * radius, steps=14),
    )


@cache
def solved(name: str) -> ModelResult:
    return solid_result(sensor(name), np.array([SENSORS[name][5] * KPA]))


@pytest.mark.parametrize("name", SENSORS)
def test_curve_sensitivity_end_and_limit_are_the_solids(name):
    one, found = sensor(name), solved(name)
    (state,) = found.states
    said = respond(batch_of(one, np.array([SENSORS[name][5] * KPA])))
    kind = next((event.kind for event in state.events if event.ends_range), "depth")
    assert ENDS[int(said.ends[0])] == kind
    # The solid itself locates a jump to 5e-4 R0; near one the curves are steep.
    assert said.range_end[0] == pytest.approx(state.range_end, abs=0.01 * one.dome.inner_radius)
    assert state.figures is not None and found.limit_point is not None
    assert said.lines.sensitivity[0] == pytest.approx(state.figures.sensitivity, rel=5e-3)
    assert said.limit_pressure[0] == pytest.approx(found.limit_point.driving_pressure, rel=5e-4)
    assert said.apex_outer[0] == pytest.approx(state.apex_outer, abs=1e-3 * one.dome.inner_radius)
    assert said.cavity_volume[0] == pytest.approx(state.cavity_volume, rel=1e-3)
    common = state.indentation <= min(said.range_end[0], range_end(list(state.events), one.protocol.depth)) + 1e-9
    for ours, theirs in ((said.force, state.force), (said.rise, state.pressure_rise)):
        on = CubicSpline(said.indentation[0], ours[0])(state.indentation[common])
        assert np.abs(on - theirs[common]).max() < 5e-3 * theirs[common].max()


def test_the_fixed_sensors_meet_every_end_but_the_edge():
    kinds = [next((e.kind for e in solved(name).states[0].events if e.ends_range), "depth") for name in SENSORS]
    assert set(kinds) == {"depth", "gauge range", "break strain", "inward buckling"}


@pytest.mark.parametrize("wall", [0.065, 0.1622, 0.33])
def test_free_inflation_to_the_limit_point_is_the_solids(wall):
    solid = SolidModel(dome(Hemisphere(1.0, wall)), neo_hookean(1.0, 0.49), base=RigidBase())
    run, probe = inflate(solid, past_limit=1.2), StrainProbe(solid)
    assert run.limit is not None
    nu = np.array([0.02, 0.1, 0.3, 0.6, 0.8, 0.9, 0.95, 0.98, 1.0])
    volumes = run.states[0].volume + nu * (run.limit.volume - run.states[0].volume)
    free = [at_volume(solid, [s for s in run.states if s.volume < volume][-1:], volume) for volume in volumes]
    slices, k = shipped().slices(np.array([wall])), np.zeros(nu.size, dtype=np.intp)
    apex = slices.free_apex(k, nu)[:, 0]
    assert apex == pytest.approx([state.outer_apex for state in free], abs=3e-4)
    gap = slices.point(k, nu, apex).pressure - [state.pressure for state in free]
    assert np.abs(gap).max() < 1e-3 * run.limit.pressure
    stretch = slices.field("stretch", k, nu, apex)
    assert stretch == pytest.approx([probe.peak(state.unit.x).stretch for state in free], rel=0.02)


def test_limit_pressures_of_an_independent_program():
    """Q1 quadrilaterals with mean dilatation, 4 x 60, nu 0.49: 39.61 kPa for 9.25 to 10.75 mm, 42.85 for 8.5 to 10."""
    found = shipped().slices(np.array([1.5 / 9.25, 1.5 / 8.5])).limit_pressure * 0.17 / KPA
    assert found == pytest.approx([39.61, 42.85], rel=2e-3)


def test_limit_point_tends_to_that_of_the_exact_membrane_as_the_wall_thins():
    """Thick walls have p (R0 + t0/2)/(mu t0) of second order in t0/R0; its value at no wall is the membrane's.

    The membrane is incompressible; nu 0.49 lowers the pressure by about 2 %.
    """
    walls = np.geomspace(0.06, 0.2, 12)
    slices = shipped().slices(walls)
    k = np.arange(walls.size)
    scaled = slices.limit_pressure * (1 + 0.5 * walls) / walls
    height = slices.field("inner_apex", k, np.ones(k.size), slices.free_apex(k, np.ones(k.size))[:, 0])
    pressure = np.polynomial.Polynomial.fit(walls, scaled, 2)(0.0)
    apex = np.polynomial.Polynomial.fit(walls, height / (1 + 0.5 * walls), 2)(0.0)
    exact_pressure, exact_height = RISING_BRANCH[-1]
    assert 0.965 * exact_pressure < pressure < exact_pressure
    assert apex == pytest.approx(exact_height, rel=0.02)
