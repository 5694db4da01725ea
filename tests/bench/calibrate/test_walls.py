"""Campaigns of walls that the atlas does not cover: a silicone's law, a soft wall, a grade, a ring around the flange."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.bench.calibrate.fit import fit
from pneutouch.bench.calibrate.observations import Injection, Observations
from pneutouch.bench.calibrate.parameters import MODULUS, WALL, parameters
from pneutouch.catalogue import load_scene
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.mechanics.atlas.coverage import is_corrected, outside_fit, stand_in
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.corrected.curves import contact_ratio
from pneutouch.mechanics.models.solid import solid_result, solid_states
from pneutouch.parts import assemble
from pneutouch.units import KPA
from tests.bench.calibrate.sensors import disturbed

SOFTER, THICKER = 0.93, 1.04
"""The specimen's modulus and wall over the designed ones."""
DRAGON_SKIN_10 = {"membrane.material": "DragonSkin10", "pneumatics.driving_pressures_kPa": [0.0, 4.0]}
RING = {
    "connector.seat": "clamped-flange-M2",
    "membrane.wall_thickness_mm": 1.0,
    "pneumatics.dead_volume_mL": 1.0,
    "pneumatics.driving_pressures_kPa": [0.0, 8.0],
}


@pytest.mark.parametrize(
    ("design", "changes"),
    [
        ("cast-dome", {}),
        pytest.param("cast-dome", DRAGON_SKIN_10, marks=pytest.mark.slow),
        pytest.param("graded-dome", {}, marks=pytest.mark.slow),
        pytest.param("paper-dome", RING, marks=pytest.mark.slow),
    ],
    ids=["law", "soft", "grade", "ring"],
)
def test_modulus_and_wall_of_the_specimen_are_found(library, design, changes):
    scene = load_scene(design, changes, library)
    sensor = sensor_of(assemble(scene)).replace(waves=0)
    assert outside_fit(sensor) is None and is_corrected(sensor)
    modulus, wall = SOFTER * sensor.wall.shear_modulus, THICKER * sensor.dome.wall_thickness
    driven = np.array([0.0, 0.5 * max(scene.design.pneumatics.driving_pressures_kPa)])
    specimen = sensor.of_modulus(modulus).replace(wall_thickness=wall, break_stretch=None, gauge_limit=np.inf)
    rng = np.random.default_rng(5)
    states = solid_states(specimen, driven * KPA)
    runs = tuple(
        disturbed(state.indentation, state.force, state.pressure_rise, p, n, rng, 0.004)
        for p, state in zip(driven, states, strict=True)
        for n in (1, 2, 3)
    )
    shallow = sensor.replace(depth=min(sensor.protocol.depth, 0.75 * sensor.dome.inner_radius))
    chosen = parameters(shallow, scene.membrane_material, scene.printer, ("modulus", "wall"))
    fitted = fit(Observations(runs), shallow, chosen)
    off = np.abs(np.exp(fitted.full[[MODULUS, WALL]]) / [modulus, wall] - 1.0)
    assert off.max() < 0.02
    assert (np.abs(np.log([modulus, wall]) - fitted.full[[MODULUS, WALL]]) <= fitted.half_width).all()


@pytest.mark.slow
@pytest.mark.parametrize("design", ["cast-dome", "graded-dome"])
def test_modulus_and_wall_are_found_by_injected_air_alone(library, design):
    scene = load_scene(design, {"pneumatics.dead_volume_mL": 1.0}, library)
    sensor = sensor_of(assemble(scene)).replace(waves=0)
    modulus, wall = SOFTER * sensor.wall.shear_modulus, THICKER * sensor.dome.wall_thickness
    curve = solid_result(sensor.of_modulus(modulus).replace(wall_thickness=wall), np.zeros(0)).inflation
    gas = sensor.gas
    content = (curve.pressure + gas.ambient_pressure) * (curve.volume + gas.dead_volume)
    volumes = np.linspace(100.0, 1500.0, 12)
    pressure = np.interp(content[0] + gas.ambient_pressure * volumes, content, curve.pressure)
    blown = tuple(Injection(f"injection {k}", volumes, pressure * (1 + 0.001 * k)) for k in (-1, 0, 1))
    shallow = sensor.replace(depth=min(sensor.protocol.depth, 0.75 * sensor.dome.inner_radius))
    chosen = parameters(shallow, scene.membrane_material, scene.printer, ("modulus", "wall"))
    fitted = fit(Observations((), blown), shallow, chosen)
    # Pressure alone hardly tells modulus from wall: what it tells is their product.
    product = float(np.exp(fitted.full[MODULUS] + fitted.full[WALL]))
    assert product == pytest.approx(modulus * wall, rel=0.02)


@pytest.mark.slow
def test_the_ring_ends_the_ratio_at_a_finite_travel(library):
    """Between two driving pressures the end lies between theirs, also where one does not reach it."""
    sensor = sensor_of(assemble(load_scene("cast-dome", {}, library))).replace(waves=0)
    ratio = contact_ratio(sensor, (0.0,), np.array([0.0, 12.0]) * KPA, 7.2)
    assert np.isfinite(ratio.ends).all() and ratio.ends[0] < ratio.depths[-1]


def test_the_stand_in_is_what_the_atlas_covers(library):
    for design in ("cast-dome", "graded-dome"):
        sensor = stand_in(sensor_of(assemble(load_scene(design, {}, library))))
        assert np.isfinite(respond(batch_of(sensor, [0.0]), 8).lines.sensitivity).all()


def test_a_wall_softer_than_the_tables_is_not_fitted(library):
    sensor = sensor_of(assemble(load_scene("cast-dome", {"membrane.material": "Ecoflex0010"}, library)))
    assert outside_fit(sensor) is not None
