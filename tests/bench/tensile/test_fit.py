"""Laws fitted to tension: what was put in comes out, and the law of the solid is the law that is fitted."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pneutouch.bench.tensile.choose import FORMS, MISFIT, choose_law, instability, reached_stretch
from pneutouch.bench.tensile.law_fit import LawForm, TensionCurve, fit_law, tension
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


def test_the_range_follows_the_modulus():
    assert reached_stretch(0.17) == 2.0
    assert reached_stretch(0.02) == 2.5
    assert choose_law([curve("yeoh", (0.06, 0.009))]).largest == 2.0
    assert choose_law([curve("yeoh", (0.01, 0.0015))]).largest == 2.5


def test_each_specimen_has_a_modulus():
    choice = choose_law([curve("neo-hookean", (mu,)) for mu in (0.1, 0.12)], largest=2.0)
    assert choice.each == pytest.approx((0.1, 0.12), rel=0.01)
    assert 0.1 < choice.neo_hookean.constants[0] < 0.12
