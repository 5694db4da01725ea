"""Curves for a campaign off the axis: few plate steps, the cubics between them, and a rating without such a press."""

import numpy as np
import pytest

from pneutouch.bench.simulate import curve as curve_module
from pneutouch.bench.simulate.curve import press_curves
from pneutouch.catalogue.scene import load_scene
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.evaluation.resins import rating_of
from pneutouch.mechanics import Sensor
from pneutouch.mechanics.harmonic.press import OffAxisPress
from pneutouch.mechanics.models import harmonic as harmonic_states
from pneutouch.mechanics.models import solid as solid_states
from pneutouch.parts import assemble

BALL: dict[str, object] = {"contact.object": "ball", "contact.ball_radius_mm": 6.0, "contact.offset_mm": 3.0}
PLATE: dict[str, object] = {"contact.tilt_deg": 10.0}
HELD: dict[str, object] = {"contact.friction": 0.6, "contact.offset_mm": 2.0}


def _sensor(changes: dict[str, object]) -> Sensor:
    return sensor_of(assemble(load_scene("paper-dome", changes)))


@pytest.mark.slow
@pytest.mark.parametrize(("changes", "ends"), [(BALL, "object edge"), (HELD, None)], ids=["ball", "held plate"])
def test_few_steps_and_cubics_are_the_curve_of_many(changes, ends, monkeypatch):
    monkeypatch.setattr(harmonic_states, "ORDERS", (2, 2))
    monkeypatch.setattr(solid_states, "object_cells", lambda sensor: 8)
    presses = []
    run = OffAxisPress.run
    monkeypatch.setattr(OffAxisPress, "run", lambda press, order: presses.append(order) or run(press, order))
    sensor = _sensor(changes)
    few = press_curves(sensor, [0.0], 6.94, "harmonic").curves[0]
    # The range of the ball ends early, and the press is not repeated to its end.
    assert len(presses) == (2 if "contact.friction" in changes else 1)
    monkeypatch.setattr(curve_module, "OFF_AXIS_STEPS", curve_module.STEPS)
    many = press_curves(sensor, [0.0], 6.94, "harmonic").curves[0]
    assert (None if few.ends is None else few.ends[0]) == ends
    assert few.reach == pytest.approx(many.reach, abs=0.01) and few.indentation.size == many.indentation.size == 57
    travel = np.linspace(0.0, min(few.reach, many.reach), 200)
    for ours, theirs in zip(few.at(travel), many.at(travel), strict=True):
        assert np.abs(ours - theirs).max() < 0.01 * theirs.max()


@pytest.mark.parametrize(
    "changes", [BALL, PLATE, {"contact.object": "edge", "contact.edge_radius_mm": 3.0}], ids=["ball", "plate", "edge"]
)
def test_the_rated_pressure_is_the_central_plates_and_nothing_is_pressed(changes, monkeypatch):
    monkeypatch.setattr(OffAxisPress, "run", lambda *_: pytest.fail("a press off the axis"))
    central, there = (load_scene("paper-dome", given) for given in ({}, changes))
    assert rating_of(there, _sensor(changes)) == rating_of(central, _sensor({}))
