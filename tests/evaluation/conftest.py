"""The library that holds a calibration of the paper's sensor."""

from __future__ import annotations

import pytest

from tests.evaluation.calibrated import library_of


@pytest.fixture
def place(library, tmp_path):
    return library_of(tmp_path, library)
