"""A column given with a unit that is none: the unit is at fault, not the column."""

from __future__ import annotations

from pathlib import Path

import pytest

from pneutouch.errors import InputError
from pneutouch.tables.layout import TableFormat, TableLayout, places


@pytest.mark.parametrize(("name", "meant"), [("Load:Nn", " N?"), ("Load:kpaa", " kPa?"), ("Lood", " Load?")])
def test_the_nearest_unit_or_column_is_named(name, meant):
    layout = TableLayout(("Time", "Load"), ("s", ""), TableFormat())
    with pytest.raises(InputError) as refused:
        places(Path("x.csv"), layout, [name])
    assert meant in str(refused.value)
