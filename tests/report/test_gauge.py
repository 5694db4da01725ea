"""The gauge's row of the datasheet: an order code is one long word, and its column is narrow."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from pneutouch.report.conditions import gauge_range
from pneutouch.spec.gauge import Gauge

_COLUMN = 12
"""Letters that the column takes on a line."""


@pytest.mark.parametrize("name", ["honeywell-abp2-5psi", "honeywell-mpr-25psi", "te-ms5837-30ba"])
def test_an_order_code_can_be_broken_and_reads_the_same(library, name):
    gauge = library.load("gauges", name)
    assert isinstance(gauge, Gauge)
    reading = SimpleNamespace(title=gauge.title, reads_from_kPa=0.0, reads_to_kPa=34.474)
    pressures, unit, note = gauge_range(SimpleNamespace(scene=SimpleNamespace(gauge=gauge), gauge=reading))
    assert (pressures, unit) == ("0 to 34.47", "kPa gauge")
    assert f"({gauge.order_code})" in note.replace("\u200b", "")
    assert max(len(part) for word in note.split() for part in word.split("\u200b")) <= _COLUMN
