"""Fits of domes that are no hemisphere: the solid's expansion, and specimens that it finds again."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.bench.calibrate.fit import fit
from pneutouch.bench.calibrate.fitted_solid import SolidExpansion
from pneutouch.bench.calibrate.observations import Injection, Observations, points_of
from pneutouch.bench.calibrate.other_states import further_tests
from pneutouch.bench.calibrate.parameters import DEAD, MODULUS, WALL, parameters
from pneutouch.catalogue import load_scene
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.mechanics.corrected.curves import _after_injection
from pneutouch.mechanics.models.solid import solid_states
from pneutouch.parts import assemble
from pneutouch.units import KPA
from tests.bench.calibrate.sensors import disturbed
from tests.bench.calibrate.simulated import trial

SHAPES = {
    "cap": {"membrane.rise_mm": 4.6},
    "thimble": {"membrane.side_mm": 4.0},
    "disc": {"membrane.boss_radius_mm": 4.0, "membrane.boss_height_mm": 2.5},
}
OFF = 0.06


def seen(sensor, pressures, depth, rng, gain, volumes=()) -> Observations:
    """Two runs at each pressure (kPa) by the solid, and injected volumes (mm3)."""
    bare = sensor.replace(break_stretch=None, gauge_limit=np.inf, depth=depth, steps=60)
    states = solid_states(bare, np.array(pressures) * KPA)
    grid = np.linspace(0.0, depth, 12)
    rows = [
        (grid, np.interp(grid, s.indentation, s.force), np.interp(grid, s.indentation, s.pressure_rise)) for s in states
    ]
    runs = [disturbed(*row, p, n, rng, gain) for row, p in zip(rows, pressures, strict=True) for n in (1, 2)]
    blown = tuple(
        Injection("blown", np.array([0.0, *volumes]), np.array([0.0, *_after_injection(bare, np.array(volumes))]))
        for _ in range(bool(volumes))
    )
    return Observations(tuple(runs), blown)


@pytest.fixture(params=SHAPES)
def scene(request, library):
    return load_scene("paper-dome", {"membrane.shape": request.param, **SHAPES[request.param]}, library)


def test_the_expansion_holds_off_its_centre_and_is_exact_at_it(scene):
    sensor = sensor_of(assemble(scene)).replace(waves=0, dead_volume=800.0)
    truth = sensor.of_modulus((1 + OFF) * sensor.wall.shear_modulus)
    truth = truth.replace(wall_thickness=(1 + OFF) * sensor.dome.wall_thickness, dead_volume=900.0)
    depth, volumes = 0.2 * sensor.dome.inner_radius, (200.0, 500.0)
    for measured, within in ((sensor, 0.002), (truth, 0.006)):
        points = points_of(seen(measured, (0.0, 8.0), depth, Silent(), 0.0, volumes))
        full = np.zeros(5)
        full[[MODULUS, WALL]] = np.log([measured.wall.shear_modulus, measured.dome.wall_thickness])
        full[DEAD] = measured.gas.dead_volume
        values, ok = SolidExpansion(sensor, points, (MODULUS, WALL, DEAD)).values(full[None])
        assert ok.all()
        assert (np.abs(values[0] - points.values) / points.full_scale).max() < within


class Silent(np.random.Generator):
    """Noise of size 0."""

    def __init__(self) -> None:
        super().__init__(np.random.PCG64(0))

    def normal(self, loc=0.0, scale=1.0, size=None):
        return np.zeros(size if size is not None else ())


@pytest.mark.slow
def test_a_specimen_is_found_from_its_runs(scene):
    sensor = sensor_of(assemble(scene)).replace(waves=0)
    modulus, wall = 0.9 * sensor.wall.shear_modulus, 1.05 * sensor.dome.wall_thickness
    depth = 0.2 * sensor.dome.inner_radius
    observations = seen(
        sensor.of_modulus(modulus).replace(wall_thickness=wall), (0.0, 8.0), depth, np.random.default_rng(3), 0.004
    )
    chosen = parameters(
        sensor.replace(depth=depth), scene.membrane_material, scene.printer, ("modulus", "wall"), priors=False
    )
    found = fit(observations, sensor.replace(depth=depth), chosen)
    off = np.abs(found.full[[MODULUS, WALL]] - np.log([modulus, wall]))
    assert (off < found.half_width).all() and (off < 0.06).all()
    tests = further_tests(found, 0.02)
    assert tests and all(one.gain >= 1.0 for one in tests)


@pytest.mark.slow
@pytest.mark.parametrize(("shape", "expected"), [("cap", [0.13, 0.07]), ("disc", [0.11, 0.063])])
def test_intervals_hold_specimens_whose_wall_remembers_and_whose_contact_is_read_late(shape, expected, library):
    sizes = {"membrane.boss_radius_mm": 2.77, "membrane.boss_height_mm": 2.77} if shape == "disc" else {}
    changes = {"membrane.shape": shape, **sizes, "pneumatics.dead_volume_mL": 1.5}
    scene = load_scene("paper-dome", changes, library)
    sensor = sensor_of(assemble(scene)).replace(waves=0)
    depth = min(sensor.protocol.depth, 0.75 * sensor.dome.inner_radius)
    chosen = parameters(sensor.replace(depth=depth), scene.membrane_material, scene.printer)
    off, wide = [], []
    for seed in range(10):
        one = trial(sensor, (0.0, 8.0, 16.0), 3, np.random.default_rng(seed), "solid", sensor.protocol.depth)
        found = fit(one.seen, sensor.replace(depth=depth), chosen)
        truth = np.log([one.truth.wall.shear_modulus, one.truth.dome.wall_thickness])
        places = [found.parameters.fitted.index(k) for k in (MODULUS, WALL)]
        off.append(np.abs(found.solution.at[places] - truth) / found.half_width[places])
        wide.append(found.half_width[places])
    assert (np.mean(np.array(off) < 1.0, axis=0) >= 0.9).all()
    assert (np.sqrt(np.mean(np.square(off), axis=0)) < 0.6).all()
    assert np.mean(wide, axis=0) == pytest.approx(expected, rel=0.1)


def test_a_press_off_the_axis_of_another_shape_is_refused(library):
    from pneutouch.errors import InputError
    from pneutouch.evaluation.calibrated import check_fitted

    changes = {
        "membrane.shape": "cap",
        "contact.offset_mm": 1.0,
        "contact.object": "ball",
        "contact.ball_radius_mm": 5.0,
    }
    scene = load_scene("paper-dome", changes, library)
    with pytest.raises(InputError) as caught:
        check_fitted(scene, sensor_of(assemble(scene)))
    assert caught.value.key == "contact.offset_mm"
