"""How little is known of an assumed mix is in its budget, beside what is known of its resins."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.catalogue import Library
from pneutouch.catalogue.mixture import mixed_material
from pneutouch.mechanics.atlas.figures import FIGURES
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.uncertainty.document import budget
from pneutouch.mechanics.uncertainty.sources.model_error import model_errors
from pneutouch.mechanics.uncertainty.sources.modulus import modulus_sources
from pneutouch.spec.grade import Grade
from pneutouch.spec.material import Material
from pneutouch.units import KPA
from tests.conftest import ROOT

LIBRARY = Library((ROOT,))
AWAY = np.array([False])
POINTS = {point.material: point.fraction for point in LIBRARY.load("mixing", "TangoPlus+VeroClear").points}


def mixed(fraction):
    grade = Grade.model_validate({"from": "TangoPlus", "to": "VeroClear", "fraction": fraction})
    return mixed_material(grade, LIBRARY, file="here")


def standard(material):
    """Combined standard uncertainty of the logarithm of the modulus."""
    return float(np.sqrt(sum(source.standard[0] ** 2 for source in modulus_sources(material, AWAY))))


def budget_of(material):
    every = [m for m in LIBRARY.all("materials", Material).values() if m.kind == "elastomer"]
    batch = batch_of(material_sensor(material), [0.0, 12 * KPA])
    return budget(
        batch,
        material,
        LIBRARY.load("printers", "objet260-connex"),
        near_paper=True,
        errors=model_errors(material, every),
        numerical={},
    )


@pytest.mark.parametrize("fraction", [0.048, 0.1, 0.2, 0.3, [0.0, 0.25]])
def test_the_source_is_the_band_as_a_rectangle_of_logarithms(fraction):
    material = mixed(fraction)
    source = next(s for s in modulus_sources(material, AWAY) if s.name == "mixing fraction")
    mu = material.shear_modulus_MPa
    assert source.standard[0] == pytest.approx(np.log(mu.high / mu.low) / np.sqrt(12))
    assert source.acts_on == "shear_modulus"
    assert source.counts.all()
    assert not source.known


@pytest.mark.parametrize(("name", "fraction"), POINTS.items(), ids=POINTS)
def test_a_mix_is_never_surer_than_the_catalogue_resin_at_its_fraction(name, fraction):
    resin = LIBRARY.load("materials", name)
    # The hardness of a mix was not read, so its scatter between prints is an assumption for all mixes alike.
    ours, theirs = ({s.name: s.standard[0] for s in modulus_sources(m, AWAY)} for m in (mixed(fraction), resin))
    assert ours["published modulus"] >= theirs["published modulus"] * (1 - 1e-9)
    assert np.hypot(ours["published modulus"], ours["mixing fraction"]) >= theirs["published modulus"] * (1 - 1e-9)
    if fraction:
        assert standard(mixed(fraction)) > standard(resin)


@pytest.mark.parametrize("name", ["FLX9950", "FLX9970"])
def test_the_sensitivity_of_a_mix_is_less_sure_than_the_resins(name):
    row = FIGURES.index("sensitivity_kPa_per_N")
    mix, resin = budget_of(mixed(POINTS[name])), budget_of(LIBRARY.load("materials", name))
    assert (mix.expanded[row] > resin.expanded[row]).all()
    names = [source.name for source in mix.sources]
    assert mix.shares[names.index("mixing fraction"), FIGURES.index("limit_pressure_kPa")].min() > 0.2


def test_a_measured_curve_counts_its_spread_alone():
    material = mixed(0.2)
    quantity = {"value": 0.8, "spread": 0.08, "source": material.shear_modulus_MPa.source}
    content = {**material.model_dump(exclude_none=True), "shear_modulus_MPa": quantity}
    (source,) = modulus_sources(Material.model_validate(content), AWAY)
    assert source.name == "modulus as measured"
    assert source.standard[0] == pytest.approx(0.1)
