"""Rules on casting: the time to fill a wall, bubbles that stay, and what inhibits the cure."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from pneutouch.printability import PrintSubject
from pneutouch.printability.rules import mould
from pneutouch.printability.view import PrintView, WettedSurface
from pneutouch.spec.values import Quantity
from tests.printability.gallery import material, printer
from tests.printability.working import dome

SOURCE = "invented for a test"


def view(wall=1.5, radius=9.25, wetted=(), calibrated=False, **figures):
    """The dome cast in Dragon Skin 20 with figures of its casting changed."""
    subject, context = dome([0], wall=wall, radius=radius)
    silicone, profile = material("DragonSkin20"), printer("silicone-casting")
    quantities = {key: Quantity(value=value, source=SOURCE) for key, value in figures.items()}
    silicone = silicone.model_copy(update={"casting": silicone.casting.model_copy(update=quantities)})
    part = subject.items[0]
    part = replace(part, printer=profile, mode=profile.mode_for(silicone), body=replace(part.body, material=silicone))
    return PrintView(PrintSubject((part,)), replace(context, wetted=wetted, calibrated=calibrated))


def test_the_time_to_fill_goes_with_viscosity_and_the_square_of_the_wall():
    """A quarter of a circle of 9.25 mm, rho g t2 / (12 eta)."""
    (thin,) = mould.check_filling(view(wall=0.4))
    speed = 1080 * 9.81 * 0.4e-3**2 / (12 * 20)
    assert thin.severity == "warning" and "syringe" in thin.fix
    assert thin.excess.measured == pytest.approx(0.5 * math.pi * 9.25e-3 / speed / 60, rel=1e-9)
    assert thin.excess.limit == 25 - mould.PREPARED_MIN
    (thick,) = mould.check_filling(view(wall=0.8, mixed_viscosity_Pa_s=80.0))
    assert thick.excess.measured == pytest.approx(thin.excess.measured)


@pytest.mark.parametrize(("pot_life_min", "found"), [(12.9, 0), (12.8, 1), (5.0, 1)])
def test_filling_is_reported_from_half_of_the_time_that_is_left(pot_life_min, found):
    """The paper's dome in 20 Pa s fills in 2.44 min: the turn is at twice that and 8 min."""
    needed = 0.5 * math.pi * 9.25e-3 * 12 * 20 / (1080 * 9.81 * 1.5e-3**2) / 60
    assert needed == pytest.approx(2.438, abs=0.001)
    turn = 8 + 2 * needed
    assert (pot_life_min < turn) == bool(found)
    assert len(mould.check_filling(view(pot_life_min=pot_life_min))) == found


def test_the_bubble_that_stays_rises_by_the_height_of_the_dome_in_the_time_that_is_left():
    (found,) = mould.check_bubbles(view())
    radius = math.sqrt(4.5 * 20 * 10.75e-3 / (17 * 60) / (1080 * 9.81))
    assert found.severity == "note" and found.excess is None
    assert f"up to {2e3 * radius:.2f} mm" in found.message
    (weak,) = mould.check_bubbles(view(wall=1.0))
    assert weak.severity == "warning" and weak.excess.measured > weak.excess.limit == 0.5


def test_a_thin_liquid_leaves_small_bubbles():
    (found,) = mould.check_bubbles(view(wall=1.0, mixed_viscosity_Pa_s=3.0))
    assert found.severity == "note"


@pytest.mark.parametrize(("process", "found"), [("filament", 0), ("polyjet", 1), ("resin", 1)])
def test_photopolymer_that_the_silicone_touches_inhibits_it(process, found):
    surface = WettedSurface("mould", "VeroClear", process)
    findings = mould.check_inhibition(view(wetted=(surface,)))
    assert len(findings) == found
    assert all("mould, printed in VeroClear" in one.message and "seal" in one.fix for one in findings)


def test_nothing_is_found_of_a_printed_or_a_calibrated_dome():
    printed = PrintView(*dome([0], wall=0.3))
    for rule in (mould.check_filling, mould.check_bubbles, mould.check_inhibition):
        assert rule(printed) == []
        assert rule(view(wall=0.3, calibrated=True, wetted=(WettedSurface("mould", "x", "resin"),))) == []
