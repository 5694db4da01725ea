"""Bounds and laws of mixing: their limits, their order, and the numbers of the shipped mixing curve."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from release.tables.mixing_laws import (
    HARDNESS_READ,
    LONG_TERM,
    PLACING,
    SOFT_HARDNESS,
    TENSION_SLOPE,
    THRESHOLD,
    VOXEL_THRESHOLD,
    by_hardness,
    by_mixture_tool,
    by_tension,
    fraction_of,
    hashin_shtrikman_high,
    hashin_shtrikman_low,
    percolation,
    placings,
    reuss,
    stiff_moduli,
    voigt,
)

from pneutouch.catalogue import Library
from pneutouch.catalogue.mixture import mixing
from pneutouch.mechanics.paper_sensor import young_modulus
from pneutouch.workflows.coupons.order import FRACTIONS
from tests.conftest import ROOT

LIBRARY = Library((ROOT,))
SOFT = 0.17
LAWS = (voigt, reuss, hashin_shtrikman_low, hashin_shtrikman_high, percolation)
contrast, share = st.floats(1.01, 1e4), st.floats(0.0, 1.0)


def general_low(f, k1, g1, k2, g2):
    """Hashin and Shtrikman 1963, the lower shear bound for any bulk moduli: the source of the incompressible one."""
    return g1 + f / (1 / (g2 - g1) + 6 * (k1 + 2 * g1) * (1 - f) / (5 * g1 * (3 * k1 + 4 * g1)))


@given(share, contrast)
def test_the_bounds_are_in_order(f, times):
    found = [float(law(np.array(f), 1.0, times)) for law in (reuss, hashin_shtrikman_low, hashin_shtrikman_high, voigt)]
    assert all(b >= a * (1 - 1e-12) for a, b in pairwise(found))


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.__name__)
@given(times=contrast)
def test_a_law_runs_from_the_soft_modulus_to_the_stiff_one_and_rises(law, times):
    found = law(np.linspace(0, 1, 301), SOFT, times * SOFT)
    assert found[[0, -1]] == pytest.approx([SOFT, times * SOFT], rel=1e-9)
    assert (np.diff(found) >= -1e-12 * found[1:]).all()


@given(share, contrast)
def test_the_incompressible_bound_is_the_limit_of_the_general_one(f, times):
    general = general_low(f, 1e9, 1.0, 1e9 * times, times)
    assert float(hashin_shtrikman_low(np.array(f), 1.0, times)) == pytest.approx(general, rel=1e-6)


def test_few_rigid_islands_stiffen_as_einstein_says():
    """1 + 5/2 f for rigid spheres far apart (Einstein 1906; Smallwood 1944 for an elastic matrix)."""
    f = 1e-4
    assert (float(hashin_shtrikman_low(np.array(f), 1.0, 1e9)) - 1) / f == pytest.approx(2.5, rel=1e-3)


def test_droplets_stay_apart_up_to_the_threshold():
    f = np.linspace(0, THRESHOLD, 50)
    assert percolation(f, SOFT, 833.0) == pytest.approx(reuss(f, SOFT, 833.0))
    before, after = percolation(THRESHOLD + np.array([-1e-3, 1e-3]), SOFT, 833.0)
    assert after > 40 * before
    later = percolation(np.array(0.25), SOFT, 833.0, VOXEL_THRESHOLD)
    assert float(later) == pytest.approx(float(reuss(np.array(0.25), SOFT, 833.0)))


def test_the_threshold_is_that_of_spheres_on_a_cubic_lattice():
    assert pytest.approx(math.pi / 6 * VOXEL_THRESHOLD, abs=5e-4) == THRESHOLD


@pytest.mark.parametrize("law", [*LAWS, *PLACING.values()], ids=lambda law: law.__name__)
@given(f=st.floats(0.01, 0.99))
def test_the_fraction_of_a_modulus_undoes_the_law(law, f):
    modulus = float(law(np.array(f), SOFT, 833.0))
    again = fraction_of(law, modulus, SOFT, 833.0)
    # The law may be as good as level (islands at first, droplets below the threshold) or a step.
    assert again <= f + 1e-12
    assert float(law(np.array(again), SOFT, 833.0)) == pytest.approx(modulus, rel=1e-9)


def test_the_series_goes_through_its_points():
    f, mu = np.array(LONG_TERM[:-1]).T
    assert by_mixture_tool(f, SOFT, 833.0) == pytest.approx(SOFT * mu / mu[0])


def test_the_tensile_line_is_a_power_of_ten_and_the_hardness_goes_through_its_readings():
    assert float(by_tension(np.array(1 / TENSION_SLOPE), SOFT, 833.0)) == pytest.approx(10 * SOFT)
    for name, f in HARDNESS_READ.items():
        modulus = LIBRARY.load("materials", name).shear_modulus_MPa.nominal
        assert float(by_hardness(np.array(f), SOFT, 833.0)) == pytest.approx(modulus, rel=1e-12)


def test_hardness_and_tension_of_the_same_mixes_rise_alike():
    """What the choice of the curve in use rests on: two properties, one slope over the soft resin of those mixes."""
    base = young_modulus(SOFT_HARDNESS)
    for name, f in HARDNESS_READ.items():
        shore = LIBRARY.load("materials", name).shore_a.nominal
        assert math.log10(young_modulus(shore) / base) / f == pytest.approx(TENSION_SLOPE, rel=0.1)


# What the file printprofiles/mixing/TangoPlus+VeroClear.toml says, computed again.

LAW = mixing("TangoPlus", "VeroClear", LIBRARY)
ENDS = stiff_moduli(LIBRARY.load("materials", "VeroClear"))


def test_the_stiff_resin_is_a_third_of_its_youngs_modulus():
    assert pytest.approx((2000 / 3, 3000 / 3)) == ENDS


@pytest.mark.parametrize("k", range(7))
def test_fractions_of_the_shipped_curves_are_what_their_laws_give(k):
    point, placed = LAW.curve.points[k], placings(float(LAW.modulus[k]), SOFT)
    for key, side in (("fraction", "fraction"), ("fraction_low", "low"), ("fraction_high", "high")):
        assert getattr(point, side) == pytest.approx(placed[key], abs=5.1e-4)


def test_every_curve_covers_the_catalogue_within_what_its_source_states():
    assert LAW.fraction[-1] < 0.4
    assert LAW.curve.points[-1].low < LAW.fraction[-1] < LAW.curve.points[-1].high


def test_the_curve_lies_between_the_bounds():
    f = np.linspace(0, float(LAW.fraction[-1]), 400)[1:]
    curve = LAW.modulus_at(f)
    assert (curve > hashin_shtrikman_low(f, SOFT, ENDS[1])).all()
    assert (curve < hashin_shtrikman_high(f, SOFT, ENDS[0])).all()
    assert (curve > reuss(f, SOFT, ENDS[1])).all()
    assert (curve < voigt(f, SOFT, ENDS[0])).all()


def test_every_curve_is_stiffer_than_separate_droplets():
    for name in LAW.curve.curves.by_name:
        law = mixing("TangoPlus", "VeroClear", LIBRARY, curve=name)
        f = np.linspace(0, float(law.fraction[-1]), 200)[1:]
        assert (law.modulus_at(f) > hashin_shtrikman_low(f, SOFT, ENDS[1])).all()


def test_a_coupon_set_steps_evenly_by_every_curve():
    for name in LAW.curve.curves.by_name:
        law = mixing("TangoPlus", "VeroClear", LIBRARY, curve=name)
        inside = [f for f in FRACTIONS if f <= law.fraction[-1]]
        modulus = law.modulus_at(np.array([*inside, min(FRACTIONS[-1], float(law.fraction[-1]))]))
        assert (modulus[1:] / modulus[:-1]).max() < 2.5
    assert FRACTIONS[-1] <= LAW.fraction[-1]
    assert len(FRACTIONS) == 8
