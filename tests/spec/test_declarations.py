"""Every field is declared once, with help, and numbers with unit and bounds; the template follows from that."""

from __future__ import annotations

import re
import tomllib

import pytest

from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import declarations, table_of
from pneutouch.spec.read import validate
from pneutouch.spec.toml_text import design_template
from pneutouch.spec.values import Quantity

TABLES = [table for table in DesignFile.model_fields if table_of(DesignFile, table)]
FIELDS = [(table, entry) for table in TABLES for entry in declarations(table_of(DesignFile, table))]


@pytest.mark.parametrize(("table", "entry"), FIELDS, ids=[f"{table}.{entry.key}" for table, entry in FIELDS])
def test_every_field_has_help_and_numbers_have_bounds_and_units(table, entry):
    assert entry.help.endswith(".")
    unit = re.search(r"_(mm|kPa|mL)$", entry.key)
    if unit:
        assert entry.unit == unit[1]
        assert entry.low < entry.high


@pytest.mark.parametrize("cast", [False, True])
def test_template_is_a_valid_design_with_every_key_and_every_default(cast):
    text = design_template('my "sensor"', {"mould": {}, "cast_ring": {}, "accepted": {}} if cast else None)
    design = validate(DesignFile, tomllib.loads(text), "template")
    assert design.membrane == DesignFile().membrane
    assert design.pneumatics == DesignFile().pneumatics
    assert design.document.title == 'my "sensor"'
    # Mould and ring stand in the files of cast designs alone.
    assert ("[mould]" in text) == ("[cast_ring]" in text) == cast
    for table, entry in FIELDS:
        if cast or table not in ("mould", "cast_ring", "accepted"):
            assert f"{entry.key} =" in text
            assert f"[{table}]" in text


def test_a_quantity_needs_a_value_or_a_range_and_a_source():
    for content in ({"source": "somewhere"}, {"value": 1.0}, {"low": 2.0, "high": 1.0, "source": "somewhere"}):
        with pytest.raises(ValueError):
            Quantity.model_validate(content)
    ranged = Quantity(low=1.3, high=1.8, source="vendor sheet")
    assert (ranged.nominal, ranged.least, ranged.most) == (pytest.approx(1.55), 1.3, 1.8)
    assert ranged.text() == "1.3 to 1.8"
