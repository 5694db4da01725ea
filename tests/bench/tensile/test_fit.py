"""Laws fitted to tension: what was put in comes out, and the law of the solid is the law that is fitted."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pneutouch.bench.tensile.choose import FORMS, MISFIT, choose_law, instability, reached_stretch
from pneutouch.bench.tensile.law_fit import RATIOS, LawForm, TensionCurve, fit_law, tension
from pneutouch.errors import InputError
from pneutouch.mechanics.laws import hyperelastic
from pneutouch.mechanics.laws.hyperelastic import first_invariant, same_invariant
from pneutouch.mechanics.laws.strain import VALUE, Strain

STRETCH = np.linspace(1.02, 3.0, 100)

LAWS = {
    "neo-hookean": (0.17,),
    "mooney-rivlin": (0.06, 0.02),
    "yeoh": (0.06, 0.009, -0.0004),
    "ogden": (0.1, 2.6, 0.02, -1.5),
}


def curve(name="yeoh", constants=(0.06, 0.009), slack=0.0, noise=0.0):
    stress = tension(name, constants, STRETCH)
    wobble = 1 + noise * np.sin(37 * STRETCH)
    return TensionCurve(STRETCH * (1 + slack), stress * wobble)


@pytest.mark.parametrize("name", LAWS)
def test_the_stress_is_the_slope_of_the_energy_that_the_solid_has(name):
    law, step = hyperelastic(name, LAWS[name], 0.49), 1e-4

    def energy(stretch):
        across = stretch**-0.5
        return law.energy(Strain(stretch**2 + across**2, stretch * across, across)).data[VALUE]

    slope = (energy(STRETCH + step) - energy(STRETCH - step)) / (2 * step)
    assert tension(name, LAWS[name], STRETCH) == pytest.approx(slope, rel=1e-6)


@pytest.mark.parametrize("form", FORMS, ids=lambda form: form.label)
def test_constants_come_back(form):
    constants = {1: (0.17,), 2: (0.06, 0.009), 3: (0.06, 0.009, 0.0004), 4: (0.1, 1.8, 0.004, 6.0)}[form.parameters]
    if form.name == "ogden" and form.parameters == 2:
        constants = (0.12, 3.2)
    fit = fit_law(form, [curve(form.name, constants)])
    assert fit.stress(STRETCH) == pytest.approx(tension(form.name, constants, STRETCH), rel=1e-4)
    if form.parameters < 4:
        assert fit.constants == pytest.approx(constants, rel=1e-4)


@settings(max_examples=6, deadline=None)
@given(st.floats(0.005, 5.0), st.floats(-0.02, 0.4))
def test_the_law_taken_is_within_five_percent_of_what_made_the_data(modulus, stiffening):
    made = curve("yeoh", (0.5 * modulus, 0.5 * modulus * stiffening))
    choice = choose_law([made], largest=2.5, slack=0.0)
    assert choice.law.misfit <= MISFIT
    inside = STRETCH[(STRETCH >= 1.1) & (STRETCH <= 2.5)]
    assert choice.law.stress(inside) == pytest.approx(
        tension("yeoh", (0.5 * modulus, 0.5 * modulus * stiffening), inside), rel=1.6 * MISFIT
    )


def test_the_fewest_constants_are_taken():
    assert choose_law([curve("neo-hookean", (0.17,))]).law.form == LawForm("neo-hookean", 1)
    assert choose_law([curve("yeoh", (0.06, 0.02))]).law.form == LawForm("yeoh", 2)


@pytest.mark.parametrize("slack", [0.0, 0.015, 0.04])
def test_slack_is_found_and_taken_off(slack):
    choice = choose_law([curve(slack=slack)], largest=2.5)
    assert choice.curves[0].slack == pytest.approx(slack, abs=2e-3)
    assert choice.law.constants[0] == pytest.approx(0.06, rel=0.02)


def test_slack_left_in_would_soften_the_law():
    dragged = fit_law(LawForm("yeoh", 2), [curve(slack=0.04).up_to(2.5)])
    assert dragged.constants[0] < 0.95 * 0.06


def test_noise_of_the_load_cell_is_not_the_laws():
    fit = fit_law(LawForm("yeoh", 2), [curve(noise=0.06)])
    assert fit.worst > 0.045
    assert fit.misfit < 0.75 * fit.worst


def test_a_law_whose_stress_falls_is_refused():
    assert "uniaxial" in str(instability("yeoh", (0.06, -0.02, 0.0), 3.0))
    assert instability("yeoh", (0.06, 0.009), 3.0) is None
    assert instability("mooney-rivlin", (0.06, 0.01), 3.0) is None


def test_data_that_no_law_can_follow_are_refused():
    with pytest.raises(InputError, match="no law fits"):
        choose_law([TensionCurve(STRETCH, -0.1 * (STRETCH - 1))], largest=2.5, slack=0.0)


@given(st.floats(1.0, 8.0))
def test_the_tension_of_an_invariant(stretch):
    assert float(same_invariant(first_invariant(stretch))) == pytest.approx(stretch, rel=1e-6)


def kind_curve(kind, constants=(0.06, 0.02), name="mooney-rivlin", most=2.2, count=40):
    stretch = np.linspace(1.02, most, count)
    return TensionCurve(stretch, tension(name, constants, stretch, RATIOS[kind]), kind=kind)


@pytest.mark.parametrize("kind", RATIOS)
@pytest.mark.parametrize("name", LAWS)
def test_the_stress_of_every_kind_is_the_slope_of_the_energy(name, kind):
    law, step, ratio = hyperelastic(name, LAWS[name], 0.49), 1e-5, RATIOS[kind]

    def energy(first, second):
        return law.energy(Strain(first**2 + second**2, first * second, 1 / (first * second))).data[VALUE]

    first, second = STRETCH, STRETCH**ratio
    slope = (energy(first + step, second) - energy(first - step, second)) / (2 * step)
    assert tension(name, LAWS[name], STRETCH, ratio) == pytest.approx(slope, rel=1e-5)


@pytest.mark.parametrize("second", ["equibiaxial", "planar"])
def test_two_kinds_of_test_determine_the_part_of_the_second_invariant(second):
    # Few points of one kind must count as much as many of the other.
    choice = choose_law([kind_curve("tension", count=200), kind_curve(second, most=1.6, count=12)], slack=0.0)
    assert choice.law.form.name == "mooney-rivlin"
    assert choice.law.constants == pytest.approx((0.06, 0.02), rel=0.01)
    assert choice.kinds == ("tension", second)


def test_tension_alone_predicts_too_little_equibiaxial_stress():
    choice = choose_law([kind_curve("tension")], slack=0.0)
    other = kind_curve("equibiaxial", most=1.6)
    far = other.stretch > 1.2
    assert (choice.law.stress(other.stretch, "equibiaxial")[far] < 0.9 * other.stress[far]).all()


def test_a_law_of_the_first_invariant_is_taken_where_the_second_has_no_part():
    kinds = [kind_curve(kind, (0.08,), "neo-hookean", most=1.5) for kind in ("tension", "equibiaxial")]
    assert choose_law(kinds, slack=0.0).law.form == LawForm("neo-hookean", 1)


def test_a_negative_exponent_of_two_kinds_comes_back():
    kinds = [kind_curve(kind, (0.1, 3.5, 0.03, -2.5), "ogden", most=1.8) for kind in RATIOS]
    choice = choose_law(kinds, slack=0.0)
    assert choice.law.misfit <= MISFIT
    assert choice.law.form.name == "ogden"


@pytest.mark.parametrize("count", [8, 9])
def test_few_points_in_the_range_are_refused_with_a_range_that_works(count):
    coarse = kind_curve("tension", most=4.5, count=count)
    with pytest.raises(InputError) as caught:
        choose_law([replace(coarse, file="coarse.csv")], slack=0.0)
    assert caught.value.file == "coarse.csv"
    further = float(str(caught.value.remedy).rpartition(" ")[2])
    assert choose_law([coarse], further, slack=0.0).curves[0].stretch.size == 4


def test_a_law_with_too_few_points_for_its_constants_is_refused():
    coarse = kind_curve("tension", (0.1, 0.03, 0.004), "yeoh", most=2.0, count=4)
    choice = choose_law([coarse], slack=0.0)
    assert all(fit.form.parameters <= 2 or k in choice.refused for k, fit in enumerate(choice.fits))


def test_the_range_follows_the_modulus():
    assert reached_stretch(0.17) == 2.0
    assert reached_stretch(0.02) == 2.5
    assert choose_law([curve("yeoh", (0.06, 0.009))]).largest == 2.0
    assert choose_law([curve("yeoh", (0.01, 0.0015))]).largest == 2.5


def test_each_specimen_has_a_modulus():
    choice = choose_law([curve("neo-hookean", (mu,)) for mu in (0.1, 0.12)], largest=2.0)
    assert choice.each == pytest.approx((0.1, 0.12), rel=0.01)
    assert 0.1 < choice.neo_hookean.constants[0] < 0.12
