"""Rules on the sensor's working: driving pressures, and the wall in whole layers and pixels."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from pneutouch.mechanics.prediction import DeformedShape
from pneutouch.printability import PrintSubject, check
from pneutouch.printability.rules import working as rules
from pneutouch.printability.rules.working import WallStep
from pneutouch.printability.view import PrintView
from pneutouch.units import UM
from tests.printability.gallery import box, cup, item
from tests.printability.working import WORKING, dome, working


def of(found, rule):
    return [finding for finding in found if finding.rule == rule]


def test_driving_well_below_the_limit_is_no_finding():
    assert of(working([0, 12]), "driving") == []


def test_driving_near_a_limit_is_a_warning():
    (near,) = of(working([0, 39]), "driving")
    assert near.severity == "warning"
    assert near.excess.measured == 39
    assert "limit point" in near.message


def test_driving_above_the_rated_pressure_is_a_warning_with_the_nominal_limit_beside_it_and_a_remedy():
    """By the membrane the limit point is at 41.3 kPa; the modulus of TangoPlus is known to a factor of 1.8."""
    (above,) = of(working([0, 22]), "driving")
    assert above.severity == "warning"
    assert above.excess.limit == pytest.approx(20.4, abs=0.4)
    assert "41.3 kPa nominal" in above.message and "coupons" in above.fix and "calibrate" in above.fix


def test_a_measured_modulus_is_no_fix_for_a_pressure_that_it_does_not_reach():
    """With the modulus measured the dome is rated at 32.5 kPa by the membrane."""
    (above,) = of(working([0, 36]), "driving")
    assert above.severity == "warning"
    assert "coupons" not in above.fix and "lower pneumatics.driving_pressures_kPa to at most 20" in above.fix


def test_a_stiff_dome_is_rated_by_the_gauge_alone():
    (above,) = of(working([0, 95], resin="FLX9985"), "driving")
    assert above.severity == "warning"
    assert above.excess.limit == pytest.approx(90.0)
    assert "gauge range" in above.message and "coupons" not in above.fix


def test_driving_beyond_the_gauge_is_an_error():
    (beyond,) = of(working([0, 120], resin="FLX9970"), "driving")
    assert beyond.severity == "error"
    assert "gauge range" in beyond.message


def test_a_wall_of_whole_layers_is_no_finding_at_the_pole():
    assert not any("pole" in finding.message for finding in of(working([0, 12]), "layers"))


def test_a_wall_between_layers_says_what_it_prints_as_and_what_it_reads_then():
    (found,) = of(working([0, 12], wall=1.5), "layers")
    assert found.severity == "note"
    assert "93.8 layers of 16 um at the pole, where it prints as 1.488 or 1.504 mm" in found.message
    assert "at the rim, where it prints as 1.482 or 1.524 mm" in found.message
    least, most = map(float, re.search(r"reads ([\d.]+) to ([\d.]+) kPa/N", found.message).groups())
    # A pixel of 42 um is a thirtieth of the wall.
    assert 0 < most / least - 1 < 0.03


@pytest.mark.parametrize(("share", "found"), [(0.0, False), (0.08, False), (-0.08, False), (0.12, True), (-0.12, True)])
def test_a_wall_may_miss_whole_layers_by_a_tenth_of_one(share, found):
    messages = [finding.message for finding in rules.check_layers(PrintView(*dome([0], wall=(93 + share) * 0.016)))]
    assert any("at the pole" in message for message in messages) is found


@pytest.mark.parametrize(("depth", "expected"), [(0.04, []), (0.06, [0.06])])
def test_a_dome_meets_a_body_from_a_twentieth_of_a_millimetre_on(depth, expected):
    """One point of the predicted wall, inside a block at that distance from its corner."""
    subject, context = dome([0])
    place = np.array([20.0, 0.0]) + depth / np.sqrt(2)
    (state,) = context.prediction.states
    shape = DeformedShape(None, place.reshape(1, 1, 2), np.ones(1))
    prediction = replace(context.prediction, states=(replace(state, shapes=(shape,)),))
    block = item(box(5, 5, 5, (20.0, 0.0, 0.0)), "block")
    view = PrintView(PrintSubject((*subject.items, block)), replace(context, prediction=prediction))
    assert [finding.excess.measured for finding in rules.check_freedom(view)] == pytest.approx(expected, abs=1e-3)


@pytest.mark.parametrize("wall", [1.5, 0.6, *(pytest.param(t, marks=pytest.mark.slow) for t in (1.488, 0.73, 2.345))])
def test_the_wall_that_is_advised_is_no_finding_any_more(wall):
    """One wall for the pole and the rim, near the drawn one."""
    for finding in of(working([0], wall=wall), "layers"):
        advised = float(re.fullmatch(r"draw the wall ([\d.]+) mm thick: .*", finding.fix)[1])
        assert abs(advised - wall) <= 2 * 0.0424
        assert not of(working([0], wall=advised), "layers")


def test_the_wall_that_is_advised_has_whole_layers():
    """1.522 mm suit both, but are 95.1 layers of 16 um."""
    (found,) = of(working([0, 12], wall=1.5), "layers")
    assert found.fix == "draw the wall 1.520 mm thick: 95 layers and 35.9 pixels"


@pytest.mark.parametrize("printer", ["objet260-connex", "j735", "abs-filament"])
def test_each_printer_has_a_near_wall_of_whole_layers_that_suits_its_pixels(printer, library):
    machine = library.load("printers", printer)
    pixel = WallStep("pixels", "rim", UM * max(machine.resolution.x_um, machine.resolution.y_um))
    for mode in machine.mode:
        layer = WallStep("layers", "pole", UM * mode.layer_height_um)
        for wall in np.linspace(0.5, 3.0, 101):
            advised = rules._advised(wall, layer, pixel)
            assert layer.off(advised) < 1e-9
            assert pixel.off(advised) <= 0.1 + 1e-9
            assert abs(advised - wall) <= 4 * max(pixel.size, layer.size)


def test_the_wall_of_a_calibrated_sensor_is_printed_already():
    assert of(working([0, 12], wall=1.5), "layers")
    assert not of(working([0, 12], wall=1.5, calibrated=True), "layers")


def test_outside_the_atlas_the_note_gives_the_thickness_alone():
    found = of(working([0], wall=0.105, radius=9.3), "layers")
    assert found
    assert all("kPa/N" not in finding.message for finding in found)


def test_without_a_prediction_these_rules_say_nothing():
    found = check(PrintSubject((item(cup(10.0, 1.5), "membrane", "TangoPlus"),)))
    assert not [finding for finding in found if finding.rule in WORKING]
