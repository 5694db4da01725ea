"""Too little, or nothing that can be fitted, is refused in words."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from pneutouch.bench.calibrate import Injection, Observations, fit
from pneutouch.bench.calibrate.parameters import parse_names
from pneutouch.bench.record import Curve
from pneutouch.errors import InputError
from tests.bench.calibrate.sensors import DESIGNED, chosen, curves, exact, run


def one(at, force, rise) -> Observations:
    return Observations((Curve(run(22.0), np.array(at), np.array(force), np.array(rise), 0.022),))


@pytest.mark.parametrize(("observations", "words"), [
    (Observations(()), "no curves and no injections"),
    (one([0.0], [0.0], [0.0]), "22-1.csv: no point beyond first contact"),
    (one([0.0, 3.0], [0.0, 0.5], [0.0, 1e-3]), "one point is not enough"),
    (one([0.0, 3.0, 4.0], [0.0, np.nan, 1.0], [0.0, 1e-3, 2e-3]), "22-1.csv: force: not a number"),
    (Observations((), (Injection("i", np.zeros(3), np.zeros(3)),)), "i: no injected volume above zero"),
])  # fmt: skip
def test_nothing_to_fit_is_refused(library, observations, words):
    with pytest.raises(InputError, match=words):
        fit(observations, DESIGNED, chosen(library, "modulus"))


def test_more_parameters_than_values_need_priors(library):
    (whole,) = exact(DESIGNED, (22.0,))
    seen = one(whole.indentation[[0, 6, 9]], whole.force[[0, 6, 9]], whole.rise[[0, 6, 9]])
    with pytest.raises(InputError, match=r"4 values for 4 parameters without priors"):
        fit(seen, DESIGNED, chosen(library, "modulus", "wall", "dead-volume", "offset", priors=False))
    assert np.isfinite(fit(seen, DESIGNED, chosen(library, "modulus", "dead-volume")).half_width).all()


def test_a_sensor_outside_the_atlas_is_refused(library):
    thick = replace(DESIGNED, wall_thickness=4.0)
    with pytest.raises(InputError, match=r"the atlas does not speak for this sensor: wall 0\.432 R0"):
        fit(Observations(exact(DESIGNED, (0.0,))), thick, chosen(library, "modulus"))


def test_all_at_one_pressure_can_be_fitted(library):
    seen = curves(replace(DESIGNED, shear_modulus=0.2), (12.0,), 4, np.random.default_rng(3))
    found = fit(Observations(seen), DESIGNED, chosen(library, "modulus", priors=False))
    assert abs(found.full[0] - np.log(0.2)) < found.half_width[0] < 0.1


def test_a_dome_that_stood_its_pressure_is_stiffer_than_the_limit_says(library):
    """Driven at 60 kPa, beyond the limit point of the design's modulus: the search begins above it."""
    truth = replace(DESIGNED, shear_modulus=0.35)
    found = fit(Observations(exact(truth, (0.0, 60.0))), DESIGNED, chosen(library, "modulus", priors=False))
    assert found.full[0] == pytest.approx(np.log(0.35), abs=1e-4)


@pytest.mark.parametrize(("names", "words"), [
    (["moduls"], "--fit moduls: no such parameter. Did you mean modulus"), (["wall", "wall"], "wall is there twice"), ([], "empty"),
])  # fmt: skip
def test_names_of_parameters_are_checked(names, words):
    with pytest.raises(InputError, match=words):
        parse_names(names)


def test_a_first_contact_that_is_not_sure_weighs_steep_points_less(library):
    """A contact that is the middle of three 0.1 mm apart is known to 0.1 mm over root 3, times the stiffness in force."""
    from pneutouch.bench.calibrate.observations import points_of
    from pneutouch.bench.record import Indent

    (clean,) = exact(DESIGNED, (22.0,))
    indents = tuple(Indent(0.0, (1.0, 5.0), (4.0, 5.0), 6.0, 0.1 * k, 1.0, 0.0, 0.0, 0.022, 0.0) for k in (-1, 0, 1))
    sure = points_of(Observations((clean,)))
    wandering = points_of(Observations((replace(clean, indents=indents),)))
    added = np.sqrt(wandering.force_error**2 - sure.force_error**2)[0]
    stiffness = np.gradient(clean.force[1:], clean.indentation[1:])
    assert added == pytest.approx(0.1 / np.sqrt(3) * stiffness, rel=0.01)
