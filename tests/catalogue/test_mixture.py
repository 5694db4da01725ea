"""Mixes of two resins: the curve, its band, and that a mix equal to a catalogue resin is that resin."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import PchipInterpolator

from pneutouch.catalogue import Library
from pneutouch.catalogue.along import ArcProfile
from pneutouch.catalogue.mixture import mixed_material, mixing
from pneutouch.errors import InputError
from pneutouch.mechanics import predict
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.spec.grade import Grade
from pneutouch.spec.read import read_toml
from pneutouch.spec.toml_text import toml_text
from pneutouch.units import KPA
from tests.conftest import ROOT

LIBRARY = Library((ROOT,))
LAW = mixing("TangoPlus", "VeroClear", LIBRARY)
POINTS = {point.material: point.fraction for point in LAW.curve.points}


def mixed(fraction, at=None, library=LIBRARY):
    content = {"from": "TangoPlus", "to": "VeroClear", "fraction": fraction, **({} if at is None else {"at": at})}
    return mixed_material(Grade.model_validate(content), library, file="here")


knots = st.lists(st.floats(0.01, 0.99), max_size=6, unique_by=lambda x: round(x, 2)).map(
    lambda inner: (0.0, *sorted(round(x, 2) for x in inner), 1.0)
)
values = st.floats(-3.0, 3.0).map(lambda x: round(x, 3))


@st.composite
def curves(draw):
    at = draw(knots)
    return ArcProfile(at, tuple(draw(st.lists(values, min_size=len(at), max_size=len(at)))))


@given(curves())
def test_between_knots_it_is_scipys_monotone_cubic(line):
    """PchipInterpolator has the same inner slopes (Fritsch and Butland) and end slopes."""
    x = np.linspace(0, 1, 203)
    assert line(x) == pytest.approx(PchipInterpolator(line.knots, line.values)(x), abs=1e-10)


@given(curves())
def test_between_two_knots_it_stays_between_their_values(line):
    for a, b, low, high in zip(line.knots, line.knots[1:], line.values, line.values[1:], strict=False):
        found = line(np.linspace(a, b, 41))
        assert (np.sign(high - low) * np.diff(found) >= -1e-12).all()
        assert found.min() >= min(low, high) - 1e-12
        assert found.max() <= max(low, high) + 1e-12


def test_one_value_is_a_constant_and_beyond_the_ends_it_is_the_ends():
    assert (ArcProfile((0.0,), (0.3,))(np.linspace(0, 1, 5)) == 0.3).all()
    line = ArcProfile((0.0, 0.4, 1.0), (1.0, 2.0, 1.5))
    assert line(np.array([-1.0, 2.0])) == pytest.approx([1.0, 1.5])


@given(st.floats(0, 0.668), st.floats(0, 0.668))
def test_more_stiff_resin_is_stiffer_and_the_band_holds_the_curve(one, other):
    low, high = sorted((one, other))
    moduli = LAW.modulus_at(np.array([low, high]))
    assert moduli[1] >= moduli[0] * (1 - 1e-12)
    ends = LAW.band_at(np.array([low, high]))
    for end in ends:
        assert end[1] >= end[0] * (1 - 1e-12)
    assert (ends[0] <= moduli).all()
    assert (ends[1] >= moduli).all()
    assert (ends[0] >= 0.17 * (1 - 1e-12)).all()


@pytest.mark.parametrize(("name", "fraction"), POINTS.items(), ids=POINTS)
def test_a_constant_mix_equal_to_a_catalogue_resin_has_its_figures(name, fraction):
    """The driven sensor too: all figures of the atlas, to half a percent and in truth to rounding."""
    resin = LIBRARY.load("materials", name)
    pressures = [0.0, 12 * KPA, 22 * KPA]
    # Without the break strain: that of a mix is read between resins, and the limits are no figure of the sensor.
    ours, theirs = (
        predict("x", material_sensor(m).replace(break_stretch=None), pressures, model="atlas").document()
        for m in (mixed(fraction), resin)
    )
    for one, other in zip(ours["states"], theirs["states"], strict=True):
        for key in ("sensitivity_kPa_per_N", "stiffness_N_per_mm", "apex_height_outer_mm", "range_end_mm", "r_squared"):
            assert one[key] == pytest.approx(other[key], rel=1e-9)
    assert ours["limit_point"] == pytest.approx(theirs["limit_point"], rel=1e-9)
    assert mixed(fraction).elongation_at_break_percent.value == resin.elongation_at_break_percent.least


def test_the_mean_of_a_grade_is_that_over_the_domes_area():
    """Fraction linear in the arc: its mean over a hemisphere is the mean of 2 theta/pi, weight sin theta, that is 2/pi."""
    material = mixed([0.0, 0.4])
    weight = np.sin(0.5 * np.pi * np.array(material.along.arc))
    mean = np.average(material.along.stiff_fraction, weights=weight)
    assert mean == pytest.approx(0.4 * 2 / np.pi, abs=2e-3)
    modulus = np.average(material.along.shear_modulus_MPa, weights=weight)
    assert material.shear_modulus_MPa.value == pytest.approx(modulus)
    assert material.shear_modulus_MPa.low < material.shear_modulus_MPa.value < material.shear_modulus_MPa.high
    assert material.mix is None


def test_stored_stations_follow_the_curve():
    """Straight between the 65 stations the modulus of the shipped design is within a thousandth of its curve."""
    material = mixed([0.0, 0.08, 0.25], [0, 0.5, 1])
    arc = np.linspace(0, 1, 1001)
    exact = LAW.modulus_at(ArcProfile((0, 0.5, 1), (0.0, 0.08, 0.25))(arc))
    assert np.interp(arc, material.along.arc, material.along.shear_modulus_MPa) == pytest.approx(exact, rel=1e-3)


def test_elongation_is_the_least_along_the_arc():
    stiff = mixed(0.325).elongation_at_break_percent.value
    assert mixed([0.0, 0.325, 0.0]).elongation_at_break_percent.value == pytest.approx(stiff)


def changed(tmp_path, name="TangoPlus+VeroClear", **top):
    content = read_toml(ROOT / "printprofiles/mixing/TangoPlus+VeroClear.toml")
    content.update(top)
    folder = tmp_path / "printprofiles/mixing"
    folder.mkdir(parents=True)
    (folder / f"{name}.toml").write_text(toml_text(content))
    return Library((tmp_path, ROOT))


def point(fraction, **more):
    return {"fraction": fraction, "source": "a source of its own", **more}


ZERO = point(0.0, material="TangoPlus")
BAD = [
    (
        {"points": [ZERO, point(0.2, shear_modulus_MPa=0.5), point(0.1, shear_modulus_MPa=0.9)]},
        "fraction 0.1 after 0.2",
    ),
    ({"points": [ZERO, point(0.2, shear_modulus_MPa=0.5), point(0.2, shear_modulus_MPa=0.9)]}, "they must rise"),
    (
        {"points": [ZERO, point(0.1, shear_modulus_MPa=0.5), point(0.2, shear_modulus_MPa=0.4)]},
        "0.4 MPa at fraction 0.2 after 0.5 MPa",
    ),
    ({"points": [point(0.1, material="TangoPlus"), point(0.2, material="FLX9960")]}, "must be 0, the soft resin alone"),
    ({"points": [ZERO, point(0.2)]}, "either material or shear_modulus_MPa"),
    ({"points": [ZERO, point(0.2, material="FLX9960", shear_modulus_MPa=1.0)]}, "either material or shear_modulus_MPa"),
    (
        {"points": [ZERO, point(0.2, material="FLX9960", shear_modulus_spread_MPa=1.0)]},
        "a spread needs its shear_modulus_MPa",
    ),
    ({"points": [ZERO, point(0.2, material="FLX9960", fraction_low=0.3)]}, "must lie between fraction_low = 0.3"),
    (
        {"points": [ZERO, point(0.1, material="FLX9950", fraction_high=0.4), point(0.2, material="FLX9960")]},
        "it must not fall",
    ),
    ({"points": [ZERO, point(0.2, material="FLX9961")]}, "no such name among the materials"),
    ({"points": [ZERO, point(0.2, material="Agilus30")]}, "has Agilus30 in it"),
    ({"points": [ZERO, point(0.2, material="VeroClear")]}, "has no shear_modulus_MPa"),
    ({"points": [ZERO, point(0.2, shear_modulus_MPa=-1.0)]}, "shear_modulus_MPa"),
    ({"soft": "Agilus30"}, 'must be "TangoPlus" and "VeroClear"'),
    ({"stiff": "TangoPlus"}, "another resin than soft"),
]


@pytest.mark.parametrize(("top", "said"), BAD, ids=[said[:40] for _, said in BAD])
def test_a_wrong_curve_names_its_file_and_what_would_be_right(tmp_path, top, said):
    library = changed(tmp_path, **top)
    with pytest.raises(InputError) as error:
        mixed(0.1, library=library)
    assert said in str(error.value)
    assert "TangoPlus+VeroClear.toml" in str(error.value)


def test_a_measured_curve_has_no_band_but_a_spread(tmp_path):
    measured = [
        point(f, shear_modulus_MPa=mu, shear_modulus_spread_MPa=0.1 * mu)
        for f, mu in ((0.0, 0.2), (0.2, 0.9), (0.4, 4.0))
    ]
    found = mixed(0.3, library=changed(tmp_path, points=measured)).shear_modulus_MPa
    assert found.low is found.high is None
    assert found.spread == pytest.approx(0.1 * found.value)
    assert 0.9 < found.value < 4.0
