"""Mixes of two resins: the curve, its band, and that a mix equal to a catalogue resin is that resin."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import PchipInterpolator

from pneutouch.catalogue.mixture import ArcProfile, at_temperature, mixed_material, mixing
from pneutouch.catalogue.scene import load_scene
from pneutouch.errors import InputError
from pneutouch.evaluation.result import by_model
from pneutouch.mechanics import predict
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.results.record import plain as data
from pneutouch.spec.grade import Grade
from pneutouch.spec.read import parse_changes
from pneutouch.units import KPA
from tests.catalogue.mixes import LAW, LIBRARY, mixed

POINTS = {point.material: point.fraction for point in LAW.curve.points}

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


@given(st.floats(0, 0.356), st.floats(0, 0.356))
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
        data(by_model(predict("x", material_sensor(m).replace(break_stretch=None), pressures, model="atlas")))
        for m in (mixed(fraction), resin)
    )
    for one, other in zip(ours["states"], theirs["states"], strict=True):
        for key in ("sensitivity_kPa_per_N", "stiffness_N_per_mm", "apex_height_outer_mm", "range_end_mm", "r_squared"):
            assert one[key] == pytest.approx(other[key], rel=1e-9)
    assert ours["limit_point"] == pytest.approx(theirs["limit_point"], rel=1e-9)
    assert mixed(fraction).elongation_at_break_percent.value == resin.elongation_at_break_percent.least


def test_the_mean_of_a_grade_is_that_over_the_domes_area():
    """Fraction linear in the arc: its mean over a hemisphere is the mean of 2 theta/pi, weight sin theta, that is 2/pi."""
    material = mixed([0.0, 0.3])
    weight = np.sin(0.5 * np.pi * np.array(material.along.arc))
    mean = np.average(material.along.stiff_fraction, weights=weight)
    assert mean == pytest.approx(0.3 * 2 / np.pi, abs=2e-3)
    modulus = np.average(material.along.shear_modulus_MPa, weights=weight)
    assert material.shear_modulus_MPa.value == pytest.approx(modulus)
    assert material.shear_modulus_MPa.low < material.shear_modulus_MPa.value < material.shear_modulus_MPa.high
    assert material.mix is None


def test_stored_stations_follow_the_curve():
    """Straight between the 65 stations the modulus of the shipped design is within a thousandth of its curve."""
    material = mixed([0.0, 0.06, 0.19], [0, 0.5, 1])
    arc = np.linspace(0, 1, 1001)
    exact = LAW.modulus_at(ArcProfile((0, 0.5, 1), (0.0, 0.06, 0.19))(arc))
    assert np.interp(arc, material.along.arc, material.along.shear_modulus_MPa) == pytest.approx(exact, rel=1e-3)


def test_elongation_is_the_least_along_the_arc():
    stiff = mixed(0.234).elongation_at_break_percent.value
    assert mixed([0.0, 0.234, 0.0]).elongation_at_break_percent.value == pytest.approx(stiff)


NAMED = {"mixture-tool": "high", "j750-tension": "fraction", "j750-hardness": "low"}


@pytest.mark.parametrize(("name", "side"), NAMED.items(), ids=NAMED)
def test_a_named_curve_goes_through_the_points_at_its_own_fractions(name, side):
    law = mixing("TangoPlus", "VeroClear", LIBRARY, curve=name)
    at = np.array([getattr(point, side) for point in LAW.curve.points])
    assert law.modulus_at(at) == pytest.approx(LAW.modulus)
    # The band does not depend on the curve chosen: which one is true is as unknown as before.
    f = np.linspace(0, 0.2, 50)
    assert (law.band_at(f)[0] <= LAW.band_at(f)[0] * (1 + 1e-12)).all()
    assert (law.band_at(f)[1] >= LAW.band_at(f)[1] * (1 - 1e-12)).all()


@given(st.floats(0.001, 0.216))
def test_the_curves_are_in_the_order_of_their_names_and_bound_the_band(f):
    curves = [mixing("TangoPlus", "VeroClear", LIBRARY, curve=name) for name in NAMED]
    soft, used, stiff = (float(law.modulus_at(f)) for law in curves)
    assert soft < used < stiff
    low, high = (float(end) for end in LAW.band_at(f))
    # The band is straight between the points, the curves are monotone cubics through them.
    assert low == pytest.approx(soft, rel=0.06)
    assert high == pytest.approx(stiff, rel=0.12)


@pytest.mark.parametrize("fraction", [0.1, [0.0, 0.06, 0.19]])
def test_a_mix_knows_itself_by_every_curve(fraction):
    material = mixed(fraction)
    assert [(one.curve, one.place) for one in material.curves] == list(
        zip(NAMED, ("softer", "in use", "stiffer"), strict=True)
    )
    for one in material.curves:
        named = mixed_material(
            Grade.model_validate({"from": "TangoPlus", "to": "VeroClear", "fraction": fraction, "curve": one.curve}),
            LIBRARY,
            file="here",
        )
        assert not one.beyond
        there = material.by_curve(one)
        for key in ("shear_modulus_MPa", "elongation_at_break_percent", "along"):
            assert getattr(there, key) == getattr(named, key)


def test_beyond_a_curves_last_point_its_stiffest_modulus_is_taken_and_that_is_told():
    soft, used, stiff = mixed(0.3).curves
    assert (soft.beyond, used.beyond, stiff.beyond) == (False, False, True)
    assert stiff.shear_modulus_MPa.value == pytest.approx(5.33)


@pytest.mark.parametrize(
    ("grade", "said"),
    [
        ({"fraction": 0.1, "curve": "tension"}, "known: j750-tension, j750-hardness, mixture-tool"),
        ({"fraction": 0.25, "curve": "j750-hardness"}, "no modulus is known beyond 0.216"),
    ],
)
def test_a_curve_that_there_is_not_and_a_fraction_beyond_it_are_refused(grade, said):
    content = Grade.model_validate({"from": "TangoPlus", "to": "VeroClear", **grade})
    with pytest.raises(InputError) as error:
        mixed_material(content, LIBRARY, file="here")
    assert said in str(error.value)


def test_a_resin_that_is_no_mix_reads_as_before():
    """What a result follows from is hashed, so a resin's content has no new key."""
    assert "curves" not in LIBRARY.load("materials", "FLX9950").model_dump(mode="json")


def test_a_material_at_another_temperature_follows_its_master_curve(library):
    found = library.load("materials", "Agilus30")

    def modulus(material, time):
        (terms,) = [series.terms for series in material.relaxation if series.shift]
        left = 1 - sum(term.share for term in terms)
        return left + sum(term.share * np.exp(-time / term.time_s) for term in terms), left

    at = {celsius: at_temperature(found, celsius, "x.toml") for celsius in (10.0, 20.0, 30.0)}
    assert at[20.0] == found
    for celsius, factor in ((10.0, 32.3), (30.0, 0.061)):
        ratio = at[celsius].shear_modulus_MPa.value / found.shear_modulus_MPa.value
        # What is left after 600 s there is what the master curve has at 600 s over the factor.
        assert ratio == pytest.approx(modulus(found, 600 / factor)[0] / modulus(found, 600)[0], rel=0.05)
        # The same instantaneous modulus: shares of it, whose sum less that of the relaxed part is 1.
        early, relaxed = modulus(at[celsius], 0.5)
        assert ratio * early / relaxed == pytest.approx(
            modulus(found, 0.5 / factor)[0] / modulus(found, 0.5)[1], rel=0.05
        )
    with pytest.raises(InputError) as caught:
        at_temperature(found, 5.0, "x.toml")
    assert (caught.value.key, caught.value.value) == ("environment.temperature_C", 5.0)


def test_a_temperature_without_data_is_refused_with_the_one_that_works(library):
    with pytest.raises(InputError) as caught:
        load_scene("paper-dome", parse_changes(["environment.temperature_C=25"]), library)
    assert caught.value.key == "environment.temperature_C"
    good = float(str(caught.value.remedy).split()[1].rstrip(","))
    plain = load_scene("paper-dome", parse_changes([f"environment.temperature_C={good:g}"]), library)
    assert plain.membrane_material == load_scene("paper-dome", library=library).membrane_material
    warm = load_scene("agilus-dome", parse_changes(["environment.temperature_C=30"]), library).membrane_material
    assert warm.shear_modulus_MPa.value < 0.206


def test_the_relaxation_of_agilus_has_the_published_ratio(library):
    (terms,) = [series.terms for series in library.load("materials", "Agilus30").relaxation if series.shift]
    early, late = (1 - sum(term.share * (1 - np.exp(-time / term.time_s)) for term in terms) for time in (1.0, 600.0))
    assert early / late == pytest.approx(4.1, rel=0.02)
