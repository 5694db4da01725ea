"""Ageing as an optional shift: Gent's ratio of the hardnesses, and how little of the measured change it explains."""

from __future__ import annotations

import pytest

from pneutouch.catalogue import Library
from pneutouch.catalogue.library import elastomers
from pneutouch.errors import InputError
from pneutouch.mechanics.paper_sensor import logarithmic_change, material_sensor
from pneutouch.mechanics.viscous.describe import ageing_ratio, ageing_shift, ageing_unknown
from pneutouch.spec.material import HyperelasticLaw
from pneutouch.units import KPA
from tests.conftest import ROOT
from tests.mechanics.viscous.tables import PAPER_RESINS, ageing_shift_as_measured, ageing_table, resin

MEASURED = {"TangoPlus": 0.148, "FLX9950": 0.170, "FLX9970": 0.349}
HARDNESS = {
    "TangoPlus": (27.6, 29.5),
    "FLX9940": (38.5, 42.4),
    "FLX9950": (50.4, 51.1),
    "FLX9960": (59.9, 60.5),
    "FLX9970": (68.9, 68.2),
    "FLX9985": (80.4, 76.0),
    "FLX9995": (91.3, 87.0),
}


def gent(shore: float) -> float:
    """The relation as it is printed, up to a factor."""
    return (56 + 7.62336 * shore) / (254 - 2.54 * shore)


@pytest.mark.parametrize("name", PAPER_RESINS)
def test_the_ratio_is_gents_of_the_papers_hardnesses(name, library):
    fresh, aged = HARDNESS[name]
    assert ageing_ratio(resin(library, name)) == pytest.approx(gent(aged) / gent(fresh), rel=1e-9)
    assert (ageing_ratio(resin(library, name)) > 1) == (logarithmic_change(fresh, aged) > 0) == (aged > fresh)


def test_a_resin_without_its_hardness_after_a_year_is_refused_by_name(library):
    with pytest.raises(InputError, match=r"Agilus30 after a year is not known; give shore_a and shore_a_one_year"):
        ageing_ratio(resin(library, "Agilus30"))
    law = HyperelasticLaw(name="yeoh", constants=[0.1], source="invented for a test")
    with pytest.raises(InputError, match="law of its own"):
        ageing_ratio(resin(library, "TangoPlus").model_copy(update={"law": law}))


def test_of_the_papers_resins_none_lacks_its_ageing(library):
    lacking = {name for name, resin in elastomers(library).items() if ageing_unknown(resin)}
    assert {"Agilus30"} < lacking and not {name for name in lacking if name.startswith(("FLX", "Tango"))}


def test_the_shift_follows_the_modulus_and_the_sensors_elasticity(library):
    """A stiff dome carries the load by its wall: a softer wall reads more."""
    hard = resin(library, "FLX9985")
    ratio, shift = ageing_shift(material_sensor(hard), hard, [0.0])
    assert ratio < 1 < 1 + shift[0]
    assert shift[0] == pytest.approx(ratio**-0.85 - 1, rel=0.1)
    soft = resin(library, "TangoPlus")
    ratio, shift = ageing_shift(material_sensor(soft), soft, [0.0, 22 * KPA])
    assert ratio > 1.05
    assert abs(shift[0]) < 0.01 and 0 < shift[1] < 0.03


@pytest.mark.parametrize("name", MEASURED)
def test_hardness_explains_less_than_a_tenth_of_what_was_measured(name, library):
    material = resin(library, name)
    _, size = ageing_shift_as_measured(material, ageing_ratio(material))
    assert 0 < size < 0.1 * MEASURED[name]
    own = material.measured.sensitivity_change_one_year_percent.nominal
    assert own == pytest.approx(100 * MEASURED[name], abs=0.05)


def test_the_page_has_the_table_of_today():
    page = (ROOT / "docs" / "background" / "ageing.md").read_text(encoding="utf-8")
    assert "\n".join(ageing_table(Library((ROOT,)))) in page
