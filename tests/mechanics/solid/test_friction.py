"""Coulomb friction between wall and plate."""

import numpy as np
import pytest

from pneutouch.mechanics.solid.indent import PressSettings


@pytest.mark.parametrize("friction", [-0.1, -np.inf, np.nan])
def test_a_friction_that_is_no_coefficient_is_refused(friction):
    with pytest.raises(ValueError, match="friction .* must not be negative"):
        PressSettings(1.0, friction=friction)
