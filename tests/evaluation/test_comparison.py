"""Differences between figures: their uncertainty against samples of the same sources, and what counts as one."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from pneutouch.errors import InputError
from pneutouch.evaluation.comparison import (
    ComparedFigure,
    ComparedSensor,
    ComparedState,
    SourceEffect,
    comparison,
    effects_of,
    labelled,
    variance_of_ratio,
)
from pneutouch.evaluation.uncertainty import spread
from pneutouch.mechanics.atlas.figures import DEAD, FIGURES, INPUTS, log_figures, moved
from pneutouch.mechanics.uncertainty.source import FIGURE
from pneutouch.mechanics.uncertainty.sources.model_error import MODEL_CORRELATION, table_s1_errors
from pneutouch.results.record import plain as data
from pneutouch.spec.material import Material

WALLS = "membrane.wall_thickness_mm=1.5", "membrane.wall_thickness_mm=1.9"
AT = "pneumatics.driving_pressures_kPa=[12]"


def test_the_model_errors_correlate_in_one_resin_and_not_between_resins(library):
    """The constant, computed again from Table S1: the resins that the model's error is pooled from."""
    materials = [m for m in library.all("materials", Material).values() if m.measured]
    errors = np.log1p([e for e in table_s1_errors(materials) if np.abs(np.log1p(e)).min() < math.log(1.5)])
    assert errors.shape == (6, 2)
    square = (errors**2).mean()
    assert 1 - ((errors[:, 1] - errors[:, 0]) ** 2).mean() / (2 * square) == pytest.approx(MODEL_CORRELATION, abs=2e-3)
    products = [(errors[i] * errors[k]).mean() for i in range(6) for k in range(i)]
    assert abs(np.mean(products)) < 0.1 * square


@pytest.fixture(scope="module")
def pair(evaluated):
    return [evaluated("paper-dome", wall, AT, model="atlas") for wall in WALLS]


def test_effects_add_up_to_the_uncertainty_of_the_figure(pair):
    document = data(pair[0].uncertainty[0])
    for figure, entry in document["figures"].items():
        total = sum(effect.size**2 for effect in effects_of(document, figure))
        assert total == pytest.approx(entry["standard_uncertainty_relative"] ** 2, rel=1e-5, abs=1e-15)


@pytest.mark.parametrize(
    "figure",
    [
        "sensitivity_kPa_per_N",
        "limit_pressure_kPa",
        pytest.param("stiffness_N_per_mm", marks=pytest.mark.slow),
        pytest.param("apex_height_outer_mm", marks=pytest.mark.slow),
    ],
)
def test_the_uncertainty_of_a_difference_is_that_of_samples_with_shared_sources(pair, figure):
    """Two walls of one resin: the resin's sources drawn once for both, the model's errors drawn correlated."""
    logs = [_sampled(evaluation, side, FIGURES.index(figure)) for side, evaluation in enumerate(pair)]
    one, other = (effects_of(data(evaluation.uncertainty[0]), figure) for evaluation in pair)
    stated = math.sqrt(variance_of_ratio(one, other, same_resin=True))
    assert stated == pytest.approx(float(np.nanstd(logs[1] - logs[0])), rel=0.12)
    assert math.sqrt(variance_of_ratio(one, other, same_resin=False)) > 1.3 * stated


def _sampled(evaluation, side, figure, count=1500):
    """Logarithms of a figure (count,); what is shared has the same numbers on both sides."""
    scene, state = evaluation.scene, evaluation.prediction.states[0]
    resins = list(evaluation.resins.values())
    pressures = [state.driving_pressure]
    estimate = spread(evaluation.sensor, pressures, scene.membrane_material, resins, scene.printer, "atlas").combined()
    batch, on_figure = estimate.batch.take(np.zeros(count, int)), np.zeros(count)
    for number, source in enumerate(estimate.budget.sources):
        shared = source.name in ("published modulus", "ageing of the modulus", "ageing")
        own = source.sample(0, count, np.random.default_rng([number, 0 if shared else 1 + side]))
        if source.name == "model":
            common, apart = (np.random.default_rng([number, k]).standard_normal(count) for k in (0, 1 + side))
            mixed = math.sqrt(MODEL_CORRELATION) * common + math.sqrt(1 - MODEL_CORRELATION) * apart
            own = np.exp(source.standard[0] * mixed)
        if not source.counts[figure, 0]:
            continue
        if source.acts_on == FIGURE:
            on_figure += np.log(own)
        else:
            batch = moved(batch, source.acts_on, own if source.acts_on == INPUTS[DEAD] else np.log(own))
    ratio = np.round(batch.wall_ratio, 3)
    return log_figures(replace(batch, wall_thickness=ratio * batch.inner_radius))[figure] + on_figure


def test_what_is_shared_cancels_and_what_is_not_adds_up():
    shared = SourceEffect("published modulus", "a", 0.3), SourceEffect("inner radius", "b", 0.1)
    assert variance_of_ratio(shared, shared, same_resin=True) == pytest.approx(2 * 0.1**2)
    assert variance_of_ratio(shared, shared, same_resin=False) == pytest.approx(2 * (0.3**2 + 0.1**2))
    against = (SourceEffect("published modulus", "a", -0.3),)
    assert variance_of_ratio(shared[:1], against, same_resin=True) == pytest.approx(0.6**2)
    other_pool = SourceEffect("model", "seven cells", 0.1), SourceEffect("model", "two cells", 0.1)
    assert variance_of_ratio(other_pool[:1], other_pool[1:], same_resin=True) == pytest.approx(0.02)


def test_states_of_one_calibration_are_never_surer_of_their_difference_than_its_covariance_is():
    """Two unknowns that two states weigh differently: as one unknown they would cancel, and the difference be exact."""
    loads = np.array([[0.03, 0.0], [0.0, 0.03]])
    first, second = (SourceEffect("calibrated parameters", "sensor A", float(np.linalg.norm(row))) for row in loads)
    true = float(((loads[1] - loads[0]) ** 2).sum())
    assert variance_of_ratio((first,), (second,), same_resin=True) == pytest.approx(true)
    alike = float(((loads[0] - 0.5 * loads[0]) ** 2).sum())
    half = (SourceEffect("calibrated parameters", "sensor A", 0.015),)
    assert variance_of_ratio((first,), half, same_resin=True) > alike


def _sensor(name, value, low, high, pressures=(0.0,), source=""):
    figure = ComparedFigure(value, low, high)
    states = tuple(ComparedState(p, {"sensitivity_kPa_per_N": figure}, ()) for p in pressures)
    return ComparedSensor(name, "measured", source, {}, None, states, label=name)


@pytest.mark.parametrize(("value", "exceeds"), [(2.0 * math.exp(0.279), False), (2.0 * math.exp(0.287), True)])
def test_a_difference_exceeds_two_combined_standard_uncertainties(value, exceeds):
    """Two intervals of +-20 % (logarithm): their difference is uncertain by sqrt(2) times that, 0.283."""
    ends = [(v, v * math.exp(-0.2), v * math.exp(0.2)) for v in (2.0, value)]
    document = comparison([_sensor("a", *ends[0]), _sensor("b", *ends[1])])
    (difference,) = document.figures[0].differences
    assert difference.exceeds is exceeds
    assert difference.percent == pytest.approx(100 * (value / 2 - 1), rel=1e-4)
    width = math.log((1 + difference.high_percent / 100) / (1 + difference.low_percent / 100)) / 2
    assert width == pytest.approx(0.2 * math.sqrt(2), rel=1e-4)


def test_without_an_interval_nothing_is_claimed():
    document = comparison([_sensor("a", 2.0, 1.9, 2.1), _sensor("b", 4.0, None, None)])
    (difference,) = document.figures[0].differences
    assert difference.percent == pytest.approx(100)
    assert difference.exceeds is None and difference.low_percent is None


def test_pressures_that_not_all_have_are_named_and_none_in_common_is_an_error():
    some = [_sensor("a", 2.0, 1.9, 2.1, (0.0, 5.0)), _sensor("b", 2.0, 1.9, 2.1, (5.0, 9.0))]
    document = comparison(some)
    assert document.driving_pressures_kPa == (5.0,)
    assert "Not compared, because not all have them: 0, 9 kPa." in document.notes
    with pytest.raises(InputError, match=r"a: 0 kPa; b: 9 kPa.*driving_pressures_kPa=\[9\]"):
        comparison([_sensor("a", 2.0, 1.9, 2.1), _sensor("b", 2.0, 1.9, 2.1, (9.0,))])


def test_every_column_has_a_name_of_its_own():
    def names(*given):
        return labelled([_sensor(name, 1, 1, 1, source=source) for name, source in given])

    assert names(("a", "x"), ("b", "x")) == ("a", "b")
    assert names(("a", "a"), ("a", "outputs/a")) == ("a", "outputs/a")
    assert names(("design", ""), ("design", "")) == ("design (1)", "design (2)")
