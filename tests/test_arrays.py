"""What the package's arrays share."""

import numpy as np
import pytest

from pneutouch.arrays import distinct


@pytest.mark.parametrize("values", [np.array([[3.0, 1.0], [1.0, -2.0]]), np.array([4, 4, 4]), np.zeros(0)])
def test_distinct_numbers_are_numpys(values):
    assert np.array_equal(distinct(values), np.unique(values))
    assert distinct(values).dtype == values.dtype
