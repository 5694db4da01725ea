"""A curve off the axis in boundary units, and with the factors that a calibration puts on force and pressure rise."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.evaluation.result import off_axis
from pneutouch.mechanics.harmonic.press import OffAxisCurve, RangeCurve, ShearCurve
from pneutouch.results.record import plain as data

TRAVEL = np.array([0.0, 0.5, 1.0])
SHEAR = ShearCurve(
    travel=TRAVEL,
    force=np.array([5.0, 4.9, 4.8]),
    sideways=np.array([0.0, -0.7, -1.4]),
    moment=np.array([0.0, -6.0, -12.0]),
    rise=np.array([0.010, 0.011, 0.012]),
    sliding=np.array([0.1, 0.4, 1.0]),
    stiffness=1.5,
    peak=-1.4,
    slips_from=1.0,
    ended=None,
)
CURVE = OffAxisCurve(
    order=6,
    last_change=0.004,
    sideways=np.array([0.0, 0.3]),
    moment=np.array([0.0, 2.0]),
    to_end=RangeCurve(np.array([0.0, 2.0]), np.array([0.0, 5.0]), np.array([0.0, 0.010])),
    shear=SHEAR,
)


def test_forces_take_the_factor_of_force_and_rises_that_of_rise() -> None:
    scaled, force, rise = CURVE.scaled(1.2, 0.9), 1.2, 0.9
    assert scaled.shear is not None and SHEAR.peak is not None and SHEAR.stiffness is not None
    for one, before in ((scaled, CURVE), (scaled.shear, SHEAR)):
        for name in ("sideways", "moment"):
            np.testing.assert_allclose(getattr(one, name), force * getattr(before, name), rtol=1e-15)
    for one, before in ((scaled.to_end, CURVE.to_end), (scaled.shear, SHEAR)):
        np.testing.assert_allclose(one.force, force * before.force, rtol=1e-15)
        np.testing.assert_allclose(one.rise, rise * before.rise, rtol=1e-15)
    assert (scaled.shear.peak, scaled.shear.stiffness) == pytest.approx((force * SHEAR.peak, force * SHEAR.stiffness))
    np.testing.assert_array_equal(scaled.shear.travel, TRAVEL)
    np.testing.assert_array_equal(scaled.shear.sliding, SHEAR.sliding)
    np.testing.assert_array_equal(scaled.to_end.indentation, CURVE.to_end.indentation)


def test_the_document_has_percent_and_kPa() -> None:
    document = data(off_axis(CURVE))
    assert (document["harmonics"], document["last_change_percent"]) == (6, pytest.approx(0.4))
    assert document["sideways_force_N"] == [0.0, 0.3] and document["moment_N_mm"] == [0.0, 2.0]
    shear = document["shear"]
    assert shear["sliding_percent"] == pytest.approx([10.0, 40.0, 100.0])
    assert shear["pressure_rise_kPa"] == pytest.approx([10.0, 11.0, 12.0])
    assert shear["contact_force_N"] == [5.0, 4.9, 4.8] and shear["shear_mm"] == TRAVEL.tolist()
    assert (shear["stiffness_N_per_mm"], shear["peak_sideways_force_N"], shear["slips_throughout_mm"]) == (1.5, -1.4, 1)
