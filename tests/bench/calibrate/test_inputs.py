"""Too little, or nothing that can be fitted, is refused in words."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from pneutouch.bench.calibrate.fit import fit
from pneutouch.bench.calibrate.fitted_atlas import TRAVEL, shared_of
from pneutouch.bench.calibrate.observations import Injection, Observations, points_of
from pneutouch.bench.calibrate.parameters import parse_names
from pneutouch.bench.record import MeasuredCurve, MeasuredIndentation
from pneutouch.errors import InputError
from pneutouch.spec.campaign import Rig
from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import declaration, table_of
from pneutouch.units import KPA
from tests.bench.calibrate.sensors import DESIGNED, chosen, curves, exact, run


def one(at, force, rise) -> Observations:
    return Observations((MeasuredCurve(run(22.0), np.array(at), np.array(force), np.array(rise), 0.022),))


@pytest.mark.parametrize(
    ("observations", "words"),
    [
        (Observations(()), "no curves and no injections"),
        (one([0.0], [0.0], [0.0]), "22-1.csv: no point beyond first contact"),
        (one([0.0, 3.0], [0.0, 0.5], [0.0, 1e-3]), "one point is not enough"),
        (one([0.0, 3.0, 4.0], [0.0, np.nan, 1.0], [0.0, 1e-3, 2e-3]), "22-1.csv: force: not a number"),
        (Observations((), (Injection("i", np.zeros(3), np.zeros(3)),)), "i: no injected volume above zero"),
    ],
)
def test_nothing_to_fit_is_refused(library, observations, words):
    with pytest.raises(InputError, match=words):
        fit(observations, DESIGNED, chosen(library, "modulus"))


def test_a_noisy_channel_has_the_noise_in_its_error_and_the_other_has_not():
    """By a hundred and a thousand times its value, in newton and MPa: it grows as the noise itself, not as a power."""
    (plain,) = exact(DESIGNED, (22.0,))
    for channel, unit in ((0, 1.0), (1, KPA)):
        sizes = []
        for times in (0.0, 100.0, 1000.0):
            noise = np.zeros(2)
            noise[channel] = times * unit
            points = points_of(Observations((replace(plain, noise=tuple(noise)),)))
            sizes.append([points.errors[points.channels == each][0] for each in (0, 1)])
        quiet, noisy, noisier = np.array(sizes)
        assert noisier[1 - channel] == quiet[1 - channel]
        assert noisy[channel] == pytest.approx(100.0 * unit, rel=1e-3)
        assert noisier[channel] == pytest.approx(1000.0 * unit, rel=1e-3)


def test_more_parameters_than_values_need_priors(library):
    (whole,) = exact(DESIGNED, (22.0,))
    seen = one(whole.indentation[[0, 6, 9]], whole.force[[0, 6, 9]], whole.rise[[0, 6, 9]])
    with pytest.raises(InputError, match=r"4 values for 4 parameters without priors"):
        fit(seen, DESIGNED, chosen(library, "modulus", "wall", "dead-volume", "offset", priors=False))
    assert np.isfinite(fit(seen, DESIGNED, chosen(library, "modulus", "dead-volume")).half_width).all()


def test_a_fitted_dead_volume_is_one_that_a_design_may_have(library):
    stated = declaration(table_of(DesignFile, "pneumatics"), "dead_volume_mL")
    high_mL = chosen(library, "dead-volume").high[2] / 1e3
    assert high_mL == pytest.approx(stated.high)


def test_a_sensor_outside_the_atlas_is_refused(library):
    thick = DESIGNED.replace(wall_thickness=5.5)
    with pytest.raises(InputError, match=r"the atlas does not cover this sensor: wall 0\.595 R0"):
        fit(Observations(exact(DESIGNED, (0.0,))), thick, chosen(library, "modulus"))


def test_all_at_one_pressure_can_be_fitted(library):
    seen = curves(DESIGNED.replace(shear_modulus=0.2), (12.0,), 4, np.random.default_rng(3))
    result = fit(Observations(seen), DESIGNED, chosen(library, "modulus", priors=False))
    assert abs(result.full[0] - np.log(0.2)) < result.half_width[0] < 0.1


def test_a_dome_that_stood_its_pressure_is_stiffer_than_its_limit_pressure_implies(library):
    """Driven at 60 kPa, beyond the limit point of the design's modulus: the search begins above it."""
    truth = DESIGNED.replace(shear_modulus=0.35)
    result = fit(Observations(exact(truth, (0.0, 60.0))), DESIGNED, chosen(library, "modulus", priors=False))
    assert result.full[0] == pytest.approx(np.log(0.35), abs=1e-4)


@pytest.mark.parametrize(
    ("names", "words"),
    [
        (["moduls"], 'fit = "moduls": no such parameter. Did you mean modulus'),
        (["wall", "wall"], "wall is there twice"),
        ([], "empty"),
    ],
)
def test_names_of_parameters_are_checked(names, words):
    with pytest.raises(InputError, match=words):
        parse_names(names)


def _touched(onset: float, fitted: bool = True) -> MeasuredIndentation:
    return MeasuredIndentation(0.0, (1.0, 5.0), (4.0, 5.0), 6.0, onset, fitted, 1.0, 0.0, 0.0, 0.022, 0.0)


def test_an_uncertain_first_contact_moves_force_and_rise_of_its_run_together(library):
    """A contact that is the middle of three 0.1 mm apart is known to 0.1 mm over root 3, a little worse than their mean."""
    (clean,) = exact(DESIGNED, (22.0,))
    indents = tuple(_touched(0.1 * k) for k in (-1, 0, 1))
    exact_contact = shared_of(points_of(Observations((clean,))))
    points = points_of(Observations((replace(clean, indents=indents), replace(clean, indents=indents))))
    wandering = shared_of(points)
    assert (exact_contact.kind < TRAVEL).all()
    columns = wandering.columns[:, wandering.kind == TRAVEL]
    assert columns.shape[1] == 2
    force, rise = (columns[:, 0].reshape(2, 2, -1)[k, 0] for k in (0, 1))
    for column, values in ((force, clean.force), (rise, clean.rise)):
        slope = np.gradient(values, clean.indentation)[1:]
        assert column == pytest.approx(0.1 / np.sqrt(3) * np.sqrt(0.5 * np.pi) * slope, rel=1e-6)
    assert not columns[points.clusters == 1, 0].any()


def test_a_first_contact_that_was_not_fitted_makes_a_run_no_surer():
    """It equals the median of those that were: counted as one of them it would narrow their spread."""
    (clean,) = exact(DESIGNED, (22.0,))
    fitted = tuple(_touched(0.1 * k) for k in (-1, 0, 1))
    short = tuple(_touched(0.0, fitted=False) for _ in range(4))
    errors = [
        points_of(Observations((replace(clean, indents=indents),))).travel_error
        for indents in (fitted, (*short, *fitted), short)
    ]
    assert errors[1] == pytest.approx(errors[0])
    assert errors[0] > 0.0
    assert errors[2] == 0.0


def test_forces_at_the_end_of_the_sensors_range_are_not_fitted(library):
    """A force sensor that stops at 5 N would make the dome soft; the points before that give the modulus."""
    truth = DESIGNED.replace(shear_modulus=0.2)
    seen = exact(truth, (0.0, 22.0))
    cut = tuple(replace(curve, force=np.minimum(curve.force, 5.0)) for curve in seen)
    observations = Observations(cut, rig=Rig(force_range_N=5.0))
    result = fit(observations, DESIGNED, chosen(library, "modulus", priors=False))
    assert result.full[0] == pytest.approx(np.log(0.2), abs=2e-3)
    assert max(curve.force.max() for curve in seen) > 10.0
