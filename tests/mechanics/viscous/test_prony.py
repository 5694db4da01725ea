"""The Prony series: closed forms against numbers, and what a material file may say."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.viscous.describe import describe
from pneutouch.mechanics.viscous.prony import Prony, prony_series, relaxed, unknown
from pneutouch.spec.material import Material, Relaxation
from tests.mechanics.viscous.closed import after_ramp, loop_energy

A = Prony((0.1450, 0.1534, 0.1084), (0.1139, 2.528, 51.19))

series = st.lists(st.tuples(st.floats(0.01, 0.3), st.floats(0.05, 100.0)), min_size=1, max_size=3).map(
    lambda terms: Prony(tuple(share for share, _ in terms), tuple(time for _, time in terms))
)


@given(series)
def test_it_falls_from_the_instantaneous_to_the_relaxed_modulus(prony):
    found = prony.modulus(np.concatenate([[0.0], np.geomspace(1e-3, 1e3, 50), [1e9]]))
    assert found[0] == pytest.approx(1 / prony.relaxed_share, rel=1e-12)
    assert found[-1] == pytest.approx(1.0, abs=1e-12)
    assert (np.diff(found) <= 0).all()


@given(series, st.floats(0.01, 100.0), st.floats(0.0, 300.0))
def test_after_a_ramp_it_is_the_mean_of_the_modulus_over_the_ages_of_the_strain(prony, ramp, wait):
    nodes, weights = np.polynomial.legendre.leggauss(120)
    ages = wait + 0.5 * ramp * (nodes + 1)
    assert after_ramp(prony, ramp, np.array([wait]))[0] == pytest.approx(0.5 * weights @ prony.modulus(ages), rel=1e-6)
    assert after_ramp(prony, 1e-9, np.array([wait]))[0] == pytest.approx(prony.modulus(np.array([wait]))[0], rel=1e-6)


@given(series, st.floats(0.1, 100.0))
def test_the_energy_of_a_loop_is_the_work_of_the_convolution(prony, ramp):
    """sigma(t) integrated numerically from the modulus itself: int_0^t G(s) ds by its antiderivative's tabulation."""
    t = np.linspace(0.0, 2 * ramp, 40001)
    k = prony.modulus(t)
    rise = np.concatenate([[0.0], np.cumsum(0.5 * (k[1:] + k[:-1])) * t[1]]) / ramp
    stress = np.where(t <= ramp, rise, rise - 2 * np.interp(t - ramp, t, rise))
    work = (np.trapezoid(stress[:20001], t[:20001]) - np.trapezoid(stress[20000:], t[20000:])) / ramp
    assert loop_energy(prony, ramp) == pytest.approx(work, rel=1e-3, abs=1e-6)


def test_slow_and_fast_loops_leave_nothing():
    assert loop_energy(A, 1e6) < 1e-4
    assert loop_energy(A, 1e-6) < 1e-4
    assert loop_energy(A, 5.0) > 0.05


def terms(*pairs):
    return [{"share": share, "time_s": time} for share, time in pairs]


@pytest.mark.parametrize(
    ("bad", "word"),
    [
        (terms((0.5, 1.0), (0.5, 2.0)), "add up to 1"),
        (terms((0.5, 2.0), (0.1, 1.0)), "more than the one before"),
        (terms((0.5, 2.0), (0.1, 2.0)), "more than the one before"),
        (terms((0.0, 1.0)), "greater than 0"),
        (terms((-0.1, 1.0)), "greater than 0"),
        (terms((0.5, 0.0)), "greater than 0"),
        (terms((1.0, 1.0)), "less than 1"),
        ([], "at least 1"),
    ],
)
def test_what_is_no_relaxation_is_refused(bad, word):
    with pytest.raises(ValidationError, match=word):
        Relaxation.model_validate({"terms": bad, "source": "invented for a test"})


def test_relaxation_without_a_word_on_the_modulus_is_refused(library):
    agilus = library.load("materials", "Agilus30").model_dump()
    with pytest.raises(ValidationError, match="shear_modulus_is"):
        Material.model_validate({**agilus, "shear_modulus_is": None})


def test_all_sources_of_agilus_are_kept_and_no_resin_of_the_paper_has_one(library):
    agilus = library.load("materials", "Agilus30")
    first, second, third = prony_series(agilus)
    fall = third.modulus(np.array([1.0, 600.0]))
    assert fall[0] / fall[1] == pytest.approx(4.1, rel=0.02)
    assert first.relaxed_share == pytest.approx(0.5932) and "dogbone" in first.source
    assert second.relaxed_share == pytest.approx(0.19) and "1904.11888" in second.source
    # Its own level agrees with the file's modulus: E0 3.25 MPa relaxed, over three.
    assert 3.25 * second.relaxed_share / 3 == pytest.approx(agilus.shear_modulus_MPa.nominal, rel=0.01)
    others = [m for name, m in library.all("materials", Material).items() if name != "Agilus30"]
    assert not any(m.relaxation for m in others)


def test_an_instantaneous_modulus_is_relaxed_first(library):
    agilus = library.load("materials", "Agilus30")
    sensor = material_sensor(agilus)
    assert relaxed(sensor, agilus, A) == sensor
    quick = agilus.model_copy(update={"shear_modulus_is": "instantaneous"})
    assert relaxed(sensor, quick, A).wall.shear_modulus == pytest.approx(0.206 * (1 - 0.1450 - 0.1534 - 0.1084))


def test_a_series_that_leaves_the_atlas_is_left_out_and_none_at_all_is_told(library):
    """Relaxed to 0.19 of 0.206 MPa the gas is stiffer than the atlas knows; to 0.59 it is not."""
    agilus = library.load("materials", "Agilus30").model_copy(update={"shear_modulus_is": "instantaneous"})
    sensor = material_sensor(agilus)
    assert unknown(sensor, agilus, "solid") is None
    found = describe(sensor, agilus, [0.0], 4.0)
    assert len(found.sources) == 1 and "dogbone" in found.sources[0]
    assert len(found.held[0]) == 1
    only = agilus.model_copy(update={"relaxation": agilus.relaxation[1:]})
    assert "ambient pressure" in unknown(sensor, only, "solid")
