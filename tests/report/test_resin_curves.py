"""The datasheet's curves of other resins: which model draws them, and where they end."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.report.sheet_charts import drawn_by


def test_a_resin_that_cannot_be_solved_does_not_stop_the_sheet(evaluated, library, monkeypatch):
    from pneutouch.errors import ComputationError
    from pneutouch.evaluation import charts
    from pneutouch.spec.material import Material

    def fail(*words, **options):
        raise ComputationError("no equilibrium")

    monkeypatch.setattr(charts, "predict", fail)
    materials = library.all("materials", Material)
    outside = evaluated("paper-dome").sensor.replace(flange=(3.0, 1.5))
    assert charts.resin_curves(outside, materials, 0.02, "solid", None) == {}


def test_resins_are_compared_by_the_atlas_as_respond_has_them(evaluated):
    from pneutouch.evaluation.charts import in_resin, resin_curves
    from pneutouch.mechanics.atlas.press import batch_of
    from pneutouch.mechanics.atlas.respond import respond

    dome = evaluated("paper-dome")
    sensor, elastic = dome.sensor, dome.alike
    assert len(elastic) == 7
    found = resin_curves(sensor, elastic, 0.022, "solid", None)
    assert set(found) == {m.title for m in elastic.values()}
    assert drawn_by(found) == "drawn by the atlas"
    for material in elastic.values():
        pressure, sensitivity, model, _ = found[material.title]
        assert model == "atlas"
        assert pressure[0] == 0
        assert pressure[-1] == pytest.approx(22)
        own = respond(batch_of(in_resin(sensor, material), (1e-3 * pressure).tolist()), sensor.protocol.steps)
        np.testing.assert_allclose(sensitivity, own.lines.sensitivity, rtol=1e-3)


@pytest.mark.slow
def test_a_resin_outside_the_atlas_is_drawn_by_the_solid_and_the_caption_says_so(evaluated, library):
    from pneutouch.evaluation.charts import resin_curves
    from pneutouch.spec.material import Material

    tango, hard = (library.load("materials", name) for name in ("TangoPlus", "FLX9960"))
    assert isinstance(tango, Material)
    odd = hard.model_copy(update={"poisson_ratio": hard.poisson_ratio.model_copy(update={"value": 0.48})})
    sensor = evaluated("paper-dome").sensor
    found = resin_curves(sensor, {"a": tango, "b": odd}, 0.02, "solid", None)
    assert [curve.model for curve in found.values()] == ["atlas", "solid"]
    assert drawn_by(found) == "drawn by the atlas, FLX9960-DM by the solid"
    same = resin_curves(sensor, {"b": hard}, 0.02, "solid", None)["FLX9960-DM"]
    near = np.interp(found["FLX9960-DM"].driving_pressure_kPa, same.driving_pressure_kPa, same.sensitivity)
    np.testing.assert_allclose(found["FLX9960-DM"].sensitivity, near, rtol=0.02)


def test_seven_resins_are_compared_and_stop_at_their_own_limits(evaluated, library):
    from pneutouch.evaluation.charts import resin_curves
    from pneutouch.mechanics.membrane import limits
    from pneutouch.spec.material import Material

    sensor = evaluated("paper-dome").sensor
    materials = library.all("materials", Material)
    found = resin_curves(sensor, materials, 0.060, "membrane", "variational")
    assert set(found) == {m.title for m in materials.values() if m.kind == "elastomer"}
    assert found["TangoPlus"][0][-1] <= 1e3 * limits(sensor).limit_point
    assert found["FLX9970-DM"][0][-1] == pytest.approx(60.0)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("resin", "model"),
    [("FLX9940", "atlas corrected by the solid"), ("FLX9985", "solid")],
    ids=["to depth", "to event"],
)
def test_curves_under_friction_are_the_solids_within_a_percent(resin, model, evaluated, library):
    """Between the pressures at which they were solved; the hard resin's ranges end by an event."""
    from pneutouch.evaluation.charts import in_resin, resin_curves
    from pneutouch.mechanics.models.solid import solid_states

    material = library.load("materials", resin)
    sensor = evaluated("paper-dome").sensor.replace(friction=0.6)
    found = resin_curves(sensor, {resin: material}, 0.022, "solid", None)
    (curve,) = found.values()
    assert curve.model == model and drawn_by(found) == f"drawn by the {model}"
    at = np.array([5.5, 16.5])
    states = solid_states(in_resin(sensor, material).replace(waves=0), 1e-3 * at)
    solid = [state.figures.sensitivity for state in states]
    shown = np.interp(at, curve.driving_pressure_kPa, curve.sensitivity)
    np.testing.assert_allclose(shown, solid, rtol=0.01)


def test_a_chart_without_curves_names_no_model():
    assert drawn_by({}) == "no curve of a resin was computed"
