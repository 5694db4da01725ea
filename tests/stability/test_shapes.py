"""Failure: other shapes. Shallow caps that may snap, discs without stiffness at first order, thimbles that lean away.

Emptied shallow caps snap at the pressures of shallow-shell theory (tests/mechanics/solid/test_shapes_references.py).
"""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.catalogue import load_scene
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.mechanics.models.solid import solid_result
from pneutouch.parts import assemble


def pressed(driving_kPa=0.0, cells=None, **changes):
    """State at one driving pressure of the paper's dome with changes of its membrane, and its depth."""
    depth = changes.pop("depth", None)
    more = {f"membrane.{key}": value for key, value in changes.items()}
    sensor = sensor_of(assemble(load_scene("paper-dome", {**more, "indentation.depth_mm": depth})))
    return solid_result(sensor, np.array([1e-3 * driving_kPa]), cells=cells).states[0], sensor.protocol.depth


@pytest.mark.parametrize("gas", [1.0, 100.0])
@pytest.mark.parametrize(("rise", "wall"), [(1.0, 0.3), (2.0, 0.3), (3.0, 0.3), (4.0, 0.6)])
def test_a_wide_plate_snaps_no_shallow_cap(rise, wall, gas):
    """The plate holds the pole level, and the ring of contact widens: the force rises to nine tenths of the rise."""
    sensor = sensor_of(
        assemble(
            load_scene(
                "paper-dome",
                {
                    "membrane.shape": "cap",
                    "membrane.rise_mm": rise,
                    "membrane.wall_thickness_mm": wall,
                    "pneumatics.dead_volume_mL": gas,
                    "indentation.depth_mm": 0.9 * rise,
                },
            )
        )
    ).replace(gauge_limit=np.inf)
    state = solid_result(sensor, np.zeros(1)).states[0]
    assert state.range_end == pytest.approx(0.9 * rise) and (np.diff(state.force) > 0.0).all()


@pytest.mark.parametrize("wall", [0.3, 1.0, 2.0])
def test_a_level_disc_with_a_boss_is_pressed_without_driving_pressure(wall):
    """Flat and unstrained, a thin disc has little stiffness but its bending's; it grows as it is stretched."""
    disc = {"shape": "disc", "boss_radius_mm": 3.0, "boss_height_mm": 2.5, "wall_thickness_mm": wall}
    coarse, depth = pressed(**disc)
    fine, _ = pressed(cells=96, **disc)
    assert coarse.range_end == pytest.approx(depth)
    assert (np.diff(coarse.force) > 0.0).all()
    assert coarse.figures.sensitivity == pytest.approx(fine.figures.sensitivity, rel=0.011)


@pytest.mark.parametrize(("side", "wall"), [(9.0, 0.6), (9.0, 1.5), (18.0, 1.5)])
def test_a_high_thimble_sways_before_it_buckles_inwards(side, wall):
    state, depth = pressed(3.0, shape="thimble", side_mm=side, wall_thickness_mm=wall)
    events = {event.kind: event.indentation for event in state.events}
    assert events["sway"] < 0.8 * depth
    if side > 10.0:
        assert events["sway"] < events["inward buckling"] == pytest.approx(state.range_end, rel=1e-6)


def test_a_cap_that_is_pressed_is_the_same_on_a_finer_mesh():
    coarse, fine = (pressed(5.0, cells, shape="cap", rise_mm=2.5, wall_thickness_mm=0.5)[0] for cells in (None, 96))
    assert coarse.figures.sensitivity == pytest.approx(fine.figures.sensitivity, rel=0.011)
    assert coarse.figures.force_high == pytest.approx(fine.figures.force_high, rel=0.011)
