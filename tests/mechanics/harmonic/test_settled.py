"""What counts as the change by a raise of the order of the harmonics."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.mechanics.models.harmonic import _Curve, change

TRAVEL = np.linspace(0.0, 2.0, 15)
CURVE = _Curve(TRAVEL, TRAVEL**1.5, 0.004 * TRAVEL**1.5, -1.5)


def test_equal_curves_do_not_change() -> None:
    assert change(CURVE, CURVE) == 0.0


@pytest.mark.parametrize(("name", "factor"), [("force", 1.02), ("rise", 1.03), ("peak", 0.95)])
def test_each_of_force_rise_and_sideways_force_of_a_shear_counts(name: str, factor: float) -> None:
    """Force and rise change the sensitivity by their own factor too, so each change is that of its factor."""
    before = CURVE._replace(**{name: factor * getattr(CURVE, name)})
    assert change(before, CURVE) == pytest.approx(max(abs(factor - 1.0), abs(1.0 / factor - 1.0) * (name == "force")))


def test_without_a_shear_its_force_does_not_count() -> None:
    assert change(CURVE._replace(peak=None), CURVE) == 0.0


def test_a_range_that_ends_earlier_is_compared_to_its_end() -> None:
    assert change(_Curve(TRAVEL[:10], CURVE.force[:10], CURVE.rise[:10], CURVE.peak), CURVE) < 1e-12
