"""The trade-off, tuning and share charts: data as the atlas and the budget have them, the window where the target says."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from pneutouch.evaluation.charts import tradeoff, tuning
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.report.certainty import OTHERS, ends, ranked, share_bars, shares
from pneutouch.report.curves import resin_sensitivities
from pneutouch.report.tradeoff import tradeoff_panel, tuning_panel
from pneutouch.results.record import SENSITIVITY_KEY
from pneutouch.results.record import plain as data
from pneutouch.spec.target import Target
from pneutouch.units import KPA
from pneutouch.workflows.select.charts import check_charts, write_charts
from pneutouch.workflows.select.charts import tradeoff as selected_tradeoff
from pneutouch.workflows.select.charts import tuning as selected_tuning
from pneutouch.workflows.select.select import select
from tests.refusals import refused

TARGET = {
    "target": {"sensitivity_kPa_per_N": 1.5, "tolerance_percent": 5, "driving_pressure_kPa": 20, "force_range_N": 20},
    "given": {"materials": ["TangoPlus", "FLX9960"]},
    "setting": {"base": "paper-dome"},
}


@pytest.fixture(scope="module")
def selection(library):
    return select(Target.model_validate(TARGET), "test", library)


@pytest.fixture
def axes(monkeypatch):
    """The axes of every figure saved."""
    seen = []
    original = Figure.savefig

    def record(self, *words, **options):
        seen.extend(self.axes)
        return original(self, *words, **options)

    monkeypatch.setattr(Figure, "savefig", record)
    return seen


@pytest.mark.slow
def test_the_window_stands_where_the_target_says(selection):
    panel = tradeoff_panel(selected_tradeoff(selection))
    (window,) = [line for line in panel.lines if line.high is not None]
    assert window.x == pytest.approx((1.5 * 0.95, 1.5 * 1.05))
    assert window.low == pytest.approx((20, 20))
    assert window.high == pytest.approx((panel.ylim[1], panel.ylim[1]))


def test_fronts_are_respond_s_and_the_designs_lie_on_or_below_them(selection):
    found = selected_tradeoff(selection)
    assert found.driving_pressure_kPa == pytest.approx(20)
    assert [front.resin.name for front in found.known] == ["TangoPlus", "FLX9960"]
    for number, front in enumerate(found.known):
        # A batch closes in on the ends of its ranges together, so that a sensor's range depends on it a little.
        ones = np.ones_like(front.radius)
        batch = selection.problem.batch(number * ones, front.radius, front.wall, 0.02 * ones)
        own = respond(batch, selection.problem.steps).lines
        np.testing.assert_allclose(own.sensitivity, front.sensitivity, rtol=1e-3)
        np.testing.assert_allclose(own.reach, front.force, rtol=1e-3)
    by_title = {front.resin.material.title: front for front in found.known}
    for spot in found.spots:
        front = by_title[spot.resin]
        assert spot.figures.reach <= 1.03 * np.interp(spot.figures.sensitivity, front.sensitivity, front.force)
        assert spot.figures.sensitivity == pytest.approx(1.5, rel=0.05)


def test_the_band_at_the_working_pressure_is_the_choice_s_own(selection, library):
    found, best = selected_tuning(selection, library), selection.answer.designs[0]
    (pressure, value), *rest = found.working_kPa_per_N.items()
    assert not rest
    assert pressure == pytest.approx(20)
    assert np.interp(pressure, found.chosen.driving_pressure_kPa, found.chosen.sensitivity) == pytest.approx(
        value, rel=1e-3
    )
    width = (
        np.interp(pressure, found.chosen.driving_pressure_kPa, np.log(found.high_kPa_per_N / found.low_kPa_per_N)) / 2
    )
    assert width == pytest.approx(best.expanded, rel=0.03)
    assert found.chosen.driving_pressure_kPa[-1] == pytest.approx(best.rated / KPA, rel=1e-3)


def test_tuning_curves_are_respond_s(selection, library):
    found, best = selected_tuning(selection, library), selection.answer.designs[0]
    sensor = selection.sensor_of(best)
    own = respond(
        batch_of(sensor, (found.chosen.driving_pressure_kPa * KPA).tolist()), sensor.protocol.steps
    ).lines.sensitivity
    np.testing.assert_allclose(found.chosen.sensitivity, own, rtol=1e-3)
    assert {other.label for other in found.others} == {"TangoPlus", "FLX9960-DM"} - {found.chosen.label}


@pytest.mark.slow
def test_charts_of_a_selection_are_written_whole_and_repeat(selection, library, tmp_path):
    for folder in ("a", "b"):
        paths = write_charts(selection, tmp_path / folder, library=library)
        assert [path.name for path in paths] == ["trade-off.svg", "tuning.svg"]
        names = sorted(path.name for path in (tmp_path / folder).iterdir())
        assert names == ["charts-manifest.json", "trade-off.svg", "tuning.svg"]
    for name in ("trade-off.svg", "tuning.svg"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()
    (tmp_path / "file").write_text("x")
    with refused("charts"):
        write_charts(selection, tmp_path / "file", library=library)
    # Its own charts are replaced, those of others are not.
    write_charts(selection, tmp_path / "a", library=library)
    (tmp_path / "a" / "tuning.svg").write_text("mine")
    with refused(None, file=tmp_path / "a" / "tuning.svg", remedy="charts"):
        check_charts(tmp_path / "a")
    with refused(None, file=tmp_path / "a" / "tuning.svg", remedy="charts"):
        write_charts(selection, tmp_path / "a", library=library)
    assert (tmp_path / "a" / "tuning.svg").read_text() == "mine"


@pytest.mark.slow
def test_a_target_out_of_reach_still_shows_the_fronts_and_the_window(library, tmp_path, axes):
    far = {**TARGET, "target": {**TARGET["target"], "sensitivity_kPa_per_N": 500}}
    selection = select(Target.model_validate(far), "test", library)
    assert not selection.answer.designs
    assert [path.name for path in write_charts(selection, tmp_path, library=library)] == ["trade-off.svg"]
    assert axes[0].get_xlim()[1] > 500


@pytest.fixture(scope="module")
def drawn(evaluated):
    """A design's trade-off."""
    return tradeoff(evaluated("paper-dome", model="atlas"))


def test_a_design_s_charts_mark_the_design_at_its_own_figures(evaluated, drawn):
    evaluation = evaluated("paper-dome", model="atlas")
    last = evaluation.prediction.states[-1]
    (spot,) = drawn.spots
    assert spot.figures == last.figures and spot.figures.reach == last.figures.force_high
    runs = {front.resin.name for front in drawn.fronts}
    assert "Agilus30" not in runs
    assert {"TangoPlus", "FLX9995"} <= runs
    found = tuning(evaluation, 0.0356)
    assert list(found.working_kPa_per_N) == pytest.approx([0, 5, 12, 22])
    for (pressure, value), said in zip(found.working_kPa_per_N.items(), evaluation.uncertainty, strict=True):
        assert np.interp(pressure, found.chosen.driving_pressure_kPa, found.chosen.sensitivity) == pytest.approx(
            value, rel=1e-3
        )
        own = data(said)["figures"][SENSITIVITY_KEY]
        assert np.interp(pressure, found.chosen.driving_pressure_kPa, found.low_kPa_per_N) == pytest.approx(
            own["low"], rel=0.01
        )
        assert np.interp(pressure, found.chosen.driving_pressure_kPa, found.high_kPa_per_N) == pytest.approx(
            own["high"], rel=0.01
        )


def test_axes_of_the_charts_carry_quantities_and_units(evaluated, drawn):
    evaluation = evaluated("paper-dome", model="atlas")
    tuned = tuning_panel(replace(tuning(evaluation, 0.03), published_kPa_per_N=((0.0, 2.547),)))
    # A resin stands in a row, so its axis has names.
    assert tradeoff_panel(drawn).y == "" and tradeoff_panel(drawn).rows
    for panel in (tuned, tradeoff_panel(replace(drawn, gauge_kPa=300.0)), replace(tradeoff_panel(drawn), y="f  (N)")):
        assert all(re.search(r"\w+  \((kPa|N|kPa/N)\)$", label.split("\n")[0]) for label in (panel.x, panel.y))


def test_fronts_that_the_gauge_ends_stand_in_rows(drawn):
    """All on the line force times sensitivity = range of the gauge: rows show them apart, thin where less is reached."""
    panel, (spot,) = tradeoff_panel(drawn), drawn.spots
    assert sorted(panel.rows) == sorted(front.resin.material.title for front in drawn.known)
    bars = {line.y[-1]: line for line in panel.lines if line.width == 0.7 and len(line.x)}
    thick = {float(np.nanmax(line.y)): line for line in panel.lines if line.width > 3}
    for front in drawn.known:
        row = panel.rows.index(front.resin.material.title)
        np.testing.assert_array_equal(bars[row].x, front.sensitivity)
        by_gauge = front.force * front.sensitivity > 0.93 * drawn.gauge_kPa
        np.testing.assert_array_equal(np.isfinite(thick[row].y), by_gauge)
        ends = [note.text for note in panel.notes if note.at in [(float(s), row) for s in front.sensitivity[[0, -1]]]]
        assert ends == [f"{front.force[0]:.3g} N", f"{front.force[-1]:.3g} N"]
    (own,) = [front for front in drawn.known if front.resin.material.title == spot.resin]
    (label,) = [note.text for note in panel.notes if note.bold]
    assert f"{spot.figures.reach:.3g} N" in label
    # The axis tells the greatest range between the ends: that of the gauge over the sensitivity.
    best = np.interp(spot.figures.sensitivity, own.sensitivity, own.force)
    assert best == pytest.approx(drawn.gauge_kPa / spot.figures.sensitivity, rel=0.07)
    (mark,) = [line for line in panel.lines if line.marker]
    assert mark.x == (spot.figures.sensitivity,) and panel.rows[int(mark.y[0])] == spot.resin
    assert [line.label for line in panel.lines if not len(line.x)] == ["thin: less, another limit ends the range"]


def test_share_bars_add_up_and_are_as_long_as_the_shares(evaluated, axes):
    evaluation = evaluated("paper-dome", model="atlas")
    found = shares(ends(evaluation.prediction, evaluation.uncertainty))
    assert list(found) == ["0 kPa", "22 kPa"]
    rows = ranked(list(found.values()))
    assert next(iter(rows)) == "ageing"
    assert OTHERS in rows
    np.testing.assert_allclose(np.sum(list(rows.values()), axis=0), 1.0, atol=1e-4)
    share_bars(found)
    lengths = [bar.get_width() for bar in axes[0].patches]
    np.testing.assert_allclose(lengths, 100 * np.concatenate(list(rows.values())))


def test_a_single_state_at_0_kPa_without_resin_curves_is_drawn():
    changes = {"pneumatics.driving_pressures_kPa": [0.0]}
    prediction = evaluate("paper-dome", changes, model="atlas").prediction
    assert resin_sensitivities({}, prediction, "TangoPlus", {}).xlim == (0, 1.0)
