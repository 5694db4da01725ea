"""A prediction as an object: figures with interval and unit, curves, tables and drawings of itself."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import pneutouch as pt


@pytest.fixture(scope="module")
def prediction():
    return pt.load("paper-dome").predict([0, 22], model="atlas")


def test_a_state_has_the_figures_and_curves_of_the_document(prediction):
    state, said = prediction.at(22), prediction.to_dict()["states"][1]
    assert state.sensitivity_kPa_per_N == said["sensitivity_kPa_per_N"] == float(state.sensitivity)
    known = said["uncertainty"]["figures"]["sensitivity_kPa_per_N"]
    assert state.sensitivity.interval == (known["low"], known["high"])
    assert (state.sensitivity.unit, state.stiffness.unit, state.range_end.unit) == ("kPa/N", "N/mm", "mm")
    assert state.apex_height_inner.interval is None
    for name in ("indentation_mm", "contact_force_N", "pressure_rise_kPa"):
        assert getattr(state, name).tolist() == said["curve"][name]
    slope = np.polyfit(state.contact_force_N, state.pressure_rise_kPa, 1)[0]
    assert slope == pytest.approx(state.sensitivity_kPa_per_N, rel=0.02)


def test_a_pressure_that_was_not_predicted_is_refused(prediction):
    with pytest.raises(pt.InputError, match="predicted: 0, 22 kPa") as caught:
        prediction.at(10)
    assert (caught.value.key, caught.value.value) == ("pressure_kPa", 10)


@pytest.mark.parametrize("value", [10**400, float("nan"), "22", None])
def test_a_pressure_that_is_no_finite_number_is_refused(prediction, value):
    with pytest.raises(pt.InputError, match=r"pressure_kPa( = .*)?: must be a finite number"):
        prediction.at(value)


def test_a_pressure_may_be_a_scalar_of_numpy(prediction):
    assert prediction.at(np.float32(22)) is prediction.at(np.int64(22)) is prediction.at(22)


def test_frames_hold_every_state_and_every_point(prediction):
    frame = prediction.to_frame()
    assert list(frame.index) == [0, 22] and frame.index.name == "driving_pressure_kPa"
    for pressure_kPa in frame.index:
        row, state = frame.loc[pressure_kPa], prediction.at(pressure_kPa)
        assert row["sensitivity_kPa_per_N"] == state.sensitivity_kPa_per_N
        assert (row["sensitivity_kPa_per_N_low"], row["sensitivity_kPa_per_N_high"]) == state.sensitivity.interval
    curve = prediction.at(0).to_frame()
    assert curve["contact_force_N"].tolist() == prediction.at(0).contact_force_N.tolist()


def test_a_plot_draws_every_state_with_labelled_axes(prediction):
    from matplotlib.figure import Figure

    ax = prediction.plot(Figure().subplots())
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("contact force  (N)", "pressure rise  (kPa)")
    for line, state in zip(ax.get_lines(), prediction.states, strict=True):
        assert line.get_ydata().tolist() == state.pressure_rise_kPa.tolist()
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["0 kPa", "22 kPa"]


def test_the_membrane_has_figures_without_intervals():
    state = pt.load("paper-dome").predict([12], model="membrane").at(12)
    assert state.sensitivity.interval is None and state.limit_pressure is None
    assert str(state.sensitivity).endswith(" kPa/N")


def test_what_a_prediction_is_made_of_shows_itself_in_a_line(prediction):
    evaluation = prediction.evaluation
    parts = (evaluation, evaluation.prediction, evaluation.prediction.states[0], evaluation.assembly, evaluation.scene)
    for part in (*parts, *evaluation.assembly.solids, *evaluation.assembly.bodies):
        assert type(part).__name__ in repr(part)
        assert len(repr(part)) < 120 + len(evaluation.scene.where)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["paper-dome", "graded-dome", "cast-dome"])
def test_a_prediction_passes_between_processes(name):
    found = pt.load(name).predict()
    before = pickle.loads(pickle.dumps(found))
    whole = found.to_dict()
    after = pickle.loads(pickle.dumps(found))
    assert before.to_dict() == after.to_dict() == whole
    assert str(before) == str(found)


@pytest.mark.slow
def test_a_comparison_and_a_checked_design_pass_between_processes():
    design = pt.load("paper-dome")
    compared = pt.compare(design, "soft-pad", model="atlas")
    copy = pickle.loads(pickle.dumps(compared))
    assert copy.to_dict() == compared.to_dict() and copy.labels == compared.labels
    assert [p.to_dict() for p in copy.predictions] == [p.to_dict() for p in compared.predictions]
    checked = design.check()
    again = pickle.loads(pickle.dumps(design))
    assert again == design and again.check().to_dict() == checked.to_dict()


@pytest.mark.slow
@pytest.mark.parametrize("run", [lambda: pt.plan("paper-dome"), lambda: pt.respond("paper-dome", model="atlas")])
def test_a_result_passes_between_processes_and_can_be_saved_there(run, tmp_path):
    found = run()
    copy = pickle.loads(pickle.dumps(found))
    ours, theirs = found.save(tmp_path / "ours"), copy.save(tmp_path / "theirs")
    names = sorted(path.relative_to(ours) for path in ours.rglob("*") if path.is_file())
    assert names == sorted(path.relative_to(theirs) for path in theirs.rglob("*") if path.is_file())
    assert all((ours / name).read_bytes() == (theirs / name).read_bytes() for name in names)
