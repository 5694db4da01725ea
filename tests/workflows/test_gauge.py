"""The gauge in select, plan and simulate: what it sets there, and which one a selection takes."""

import pytest

from pneutouch.bench.simulate.rig import RigModel
from pneutouch.catalogue import Library, load_scene
from pneutouch.evaluation.gauge import reading_of
from pneutouch.mechanics.gauge_reading import gauge_reading
from pneutouch.spec.gauge import Gauge
from pneutouch.spec.options import SimulationOptions
from pneutouch.spec.read import validate
from pneutouch.spec.target import Target
from pneutouch.units import KPA
from pneutouch.workflows.plan import PAPER, paper_rig
from pneutouch.workflows.select.processes import select
from pneutouch.workflows.simulate import simulate
from tests.refusals import refused

AMBIENT = 101.325 * KPA


def gauge(name: str) -> Gauge:
    return Library.default().load("gauges", name)


def target(gauge: str, **required: float) -> Target:
    return validate(Target, {"target": required, "setting": {"gauge": gauge}}, "a test")


def test_the_simulated_rig_takes_noise_step_and_range_of_the_gauge():
    rig = RigModel().with_gauge(gauge_reading(gauge("bosch-bmp390"), AMBIENT))
    assert (rig.pressure_noise, rig.pressure_step) == pytest.approx((3e-5 * KPA, 1.6e-5 * KPA))
    assert rig.pressure_range == pytest.approx(125 * KPA - AMBIENT)
    assert RigModel().with_gauge(gauge_reading(gauge("smc-pse543"), AMBIENT)) == RigModel()


def test_a_perfect_rig_stays_perfect():
    assert RigModel.perfect().with_gauge(gauge_reading(gauge("bosch-bmp390"), AMBIENT)) == RigModel.perfect()


def test_a_simulation_faster_than_its_gauge_is_refused(tmp_path):
    with refused("rate_Hz", 100.0):
        simulate("paper-dome", tmp_path, {"pneumatics.gauge": "bosch-bmp390"}, SimulationOptions(rate_Hz=100.0))
    assert list(tmp_path.iterdir()) == []


def test_the_plans_rig_reads_as_far_and_as_often_as_the_gauge():
    scene = load_scene("paper-dome", {"pneumatics.gauge": "st-lps33hw"})
    rig = paper_rig(scene)
    assert rig.pressure_range_kPa == pytest.approx(126 - 101.325)
    assert rig.rate_Hz == 75.0 and rig.force_range_N == PAPER.force_range_N
    assert paper_rig(load_scene("paper-dome")) == PAPER
    assert reading_of(scene).title in rig.name


def test_an_unknown_gauge_of_a_target_is_named():
    with refused("setting.gauge", "pse543"):
        select(target("pse543", sensitivity_kPa_per_N=2.0), "select")


def test_any_gauge_and_a_grade_contradict_each_other():
    content = {
        "target": {"sensitivity_kPa_per_N": 2.0, "widest_range": True},
        "given": {"graded": True},
        "setting": {"gauge": "any"},
    }
    with refused("", fields=["given.graded", "setting.gauge"]):
        validate(Target, content, "a test")


@pytest.mark.slow
def test_any_gauge_takes_the_finest_that_covers_the_range():
    run = select(target("any", sensitivity_kPa_per_N=1.2, driving_pressure_kPa=60.0), "select")
    chosen = next(trial for trial in run.gauges if trial.chosen)
    assert {trial.gauge for trial in run.gauges} == set(Library.default().paths("gauges"))
    assert run.base.design.pneumatics.gauge == chosen.gauge
    best = run.answer.designs[0]
    assert best.ends_with != "gauge range"
    assert f"pneumatics.gauge={chosen.gauge}" in run.assignments(best)
    # Gauges that detect less came first and are out for their range.
    finer = run.gauges[: run.gauges.index(chosen)]
    assert finer and all("it reads to" in trial.why for trial in finer)
    read = gauge_reading(gauge(chosen.gauge), AMBIENT)
    slope = float(best.pool.response.lines.sensitivity[0]) * KPA
    assert chosen.smallest_force_N == pytest.approx(read.threshold / slope)
