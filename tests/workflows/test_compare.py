"""Designs, builds and measurements side by side, from what other commands wrote."""

from __future__ import annotations

import json
import shutil
from dataclasses import asdict

import pypdfium2
import pytest

from pneutouch.catalogue import DesignSource, Library
from pneutouch.cli.compare import comparison_text
from pneutouch.errors import InputError
from pneutouch.report import comparison_words
from pneutouch.results.comparison import ColumnRecord, ComparisonRecord
from pneutouch.spec.options import SimulationOptions
from pneutouch.spec.toml_text import toml_text
from pneutouch.workflows.characterize.campaign import characterize
from pneutouch.workflows.characterize.campaign import write as write_measured
from pneutouch.workflows.compare import compare, write
from pneutouch.workflows.simulate import simulate
from tests.mechanics.test_rating import calibrated
from tests.refusals import refused

RIG = SimulationOptions(
    specimens=2, driving_pressures_kPa=[0.0, 22.0], runs=1, kinds=["steps"], model="atlas", rest_s=5.0
)
THICK = DesignSource("thick", {"membrane": {"wall_thickness_mm": 2.0}, "pneumatics": {"dead_volume_mL": 0.0}}, "thick")


@pytest.fixture(scope="module")
def results(tmp_path_factory, library):
    folder = tmp_path_factory.mktemp("compare")
    campaign = simulate("paper-dome", folder, None, RIG, library)
    return write_measured(characterize(campaign, model="atlas", library=library), folder, "none")


def rows(result, key):
    return {row.driving_pressure_kPa: row for row in result.record.figures if row.figure == key}


def test_designs_are_compared_with_what_differs_and_at_every_pressure(library):
    result = compare(["paper-dome", THICK], library=library, model="atlas")
    assert result.record.inputs["membrane.wall_thickness_mm"] == (1.5, 2.0)
    found = rows(result, "sensitivity_kPa_per_N")
    for evaluation, k in zip(result.evaluations, (0, 1), strict=True):
        for state in evaluation.prediction.states:
            row = found[1e3 * state.driving_pressure]
            assert row.values[k].value == pytest.approx(state.figures.sensitivity, rel=1e-5)
    limit = rows(result, "limit_pressure_kPa")[None].differences[0]
    assert limit.exceeds is True and limit.percent > 20


def test_a_build_is_the_design_that_it_was_built_from(built, library):
    """The recorded prediction and a new one: no input differs, and no figure beyond the digits written."""
    result = compare([str(built("paper-dome")), "paper-dome"], library=library)
    assert result.record.inputs == {}
    assert "No input differs." in result.record.notes
    assert len(rows(result, "sensitivity_kPa_per_N")) == 4
    for row in result.record.figures:
        assert row.differences[0].percent == pytest.approx(0, abs=1e-4), row.figure
    again = compare(
        [str(built("paper-dome")), THICK], {"membrane.inner_radius_mm": 9.0}, library=library, model="atlas"
    )
    assert "membrane.inner_radius_mm" not in again.record.inputs
    assert any("predicted again" in note for note in again.record.notes)


def test_a_design_is_compared_with_its_calibrated_self(library, tmp_path):
    """One specimen of known modulus: narrower than any print; its fitted parameters do not cancel between two states."""
    (tmp_path / "calibrations").mkdir()
    calibration = calibrated(0.03, 0.02, 0.0).model_dump(mode="json", exclude_none=True)
    (tmp_path / "calibrations/A1.toml").write_text(toml_text(calibration))
    place = Library((tmp_path, *library.folders))
    other = DesignSource("other", {"calibration": "A1", "pneumatics": {"dead_volume_mL": 0.5}}, "other")
    result = compare(["paper-dome", "paper-dome@A1", other], library=place, model="atlas")
    labels = [one.label for one in result.record.compared]
    assert labels == ["paper-dome", "paper-dome@A1", "other@A1"]
    assert result.name == "compare-paper-dome-A1-other-A1"
    marked = calibration["source"]["simulated"]
    assert [one.simulated for one in result.record.compared] == [False, marked, marked]
    inputs = result.record.inputs
    assert inputs["calibration"] == (None, "A1", "A1")
    # The calibrated wall is the designed one, which the design alone names otherwise.
    assert "prediction.wall_thickness_mm" not in inputs
    limit = rows(result, "limit_pressure_kPa")[None]
    drawn, specimen, same = limit.values
    assert specimen.low > drawn.low and specimen.high < drawn.high and same == specimen
    together, apart = compare(["paper-dome@A1", other], library=place, model="atlas"), limit.differences[0]
    (alike,) = rows(together, "limit_pressure_kPa")[None].differences
    assert alike.exceeds is False
    own = 100 * (specimen.high / specimen.value - 1)
    assert own < alike.high_percent < 1.5 * own < apart.high_percent


@pytest.mark.slow
def test_results_alone_are_their_measurement_and_their_prediction(results, library):
    figures = json.loads((results / "figures.json").read_text())
    result = compare([str(results)], library=library)
    assert [one.kind for one in result.record.compared] == ["design", "measured"]
    found = rows(result, "sensitivity_kPa_per_N")
    for group in figures["groups"]:
        stated = group["figures"]["sensitivity_kPa_per_N"]
        predicted, measured = found[group["driving_pressure_kPa"]].values
        assert measured.value == pytest.approx(stated["value"], rel=1e-5)
        assert measured.high == pytest.approx(stated["high"], rel=1e-5)
        assert predicted.value == pytest.approx(stated["predicted"]["value"], rel=1e-5)


@pytest.mark.slow
def test_a_prediction_is_read_at_the_depths_of_the_measurement(results, library):
    """What compare makes of design and results is what characterize made of them."""
    alone = compare([str(results)], library=library)
    beside = compare(["paper-dome", str(results)], library=library, model="atlas")
    for key in ("sensitivity_kPa_per_N", "stiffness_N_per_mm", "force_at_range_end_N"):
        for pressure, row in rows(alone, key).items():
            theirs = rows(beside, key)[pressure]
            assert asdict(theirs.values[0]) == pytest.approx(asdict(row.values[0]), rel=1e-4)
            assert theirs.values[1] == row.values[1]
            assert theirs.differences[0].exceeds == row.differences[0].exceeds
    assert beside.record.driving_pressures_kPa == (0.0, 22.0)
    assert any("not all have them: 5, 12 kPa" in note for note in beside.record.notes)
    measured = [curve for curve in beside.record.curves if curve.measured]
    assert len(measured) == 4 and all(len(curve.contact_force_N) > 5 for curve in measured)


@pytest.mark.slow
def test_the_sheet_is_written_whole_and_the_same_twice(tmp_path, results, library):
    result = compare(["paper-dome", THICK, str(results)], library=library, model="atlas")
    folder = write(result, tmp_path / "one")
    assert folder.name == "compare-paper-dome-thick-campaign-measured"
    again = write(compare(["paper-dome", THICK, str(results)], library=library, model="atlas"), tmp_path / "two")
    names = ["comparison.html", "comparison.json", "comparison.pdf", "manifest.json"]
    assert sorted(path.name for path in folder.iterdir()) == names
    assert all((folder / name).read_bytes() == (again / name).read_bytes() for name in names)
    page = (folder / "comparison.html").read_text()
    assert page.count("<svg") == 6
    assert not any(word in page for word in ('src="http', 'href="http', "url(http", "<script"))
    pdf = pypdfium2.PdfDocument(folder / "comparison.pdf")
    text = " ".join(page.get_textpage().get_text_range() for page in pdf)
    # Both are marked, as every sheet of simulated data; the note among the assumptions would be read last.
    mark = "SIMULATED DATA: paper-dome-campaign-measured: a program made these runs"
    assert comparison_words.marks(result.record) == [f"{mark}; no sensor was measured."]
    assert mark in page and mark in text.replace("\r\n", " ")
    assert comparison_text(result.record).splitlines()[3].startswith(mark)
    for word in ("paper-dome", "thick", "membrane.wall_thickness_mm", "exceeds", "sensitivity, kPa/N"):
        assert word in page and word in text, word


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda folder: (folder / "figures.json").write_text("{}"), "was changed after it was written"),
        (lambda folder: (folder / "manifest.json").unlink(), "neither a build nor a characterization"),
        (lambda folder: (folder / "manifest.json").write_text("[]"), "damaged or not ours"),
        (lambda folder: (folder / "points.csv").unlink(), r"holds no points\.csv"),
    ],
)
def test_a_folder_that_is_not_whole_is_refused(results, tmp_path, library, spoil, message):
    folder = shutil.copytree(results, tmp_path / "spoilt")
    spoil(folder)
    with pytest.raises(InputError, match=message) as caught:
        compare(["paper-dome", str(folder)], library=library, model="membrane")
    assert str(folder) in str(caught.value)


def test_what_cannot_be_compared_is_refused(built, library):
    with pytest.raises(InputError, match="paper-dome is given twice"):
        compare(["paper-dome", "paper-dome"], library=library)
    with pytest.raises(InputError, match="one thing alone"):
        compare(["paper-dome"], library=library, model="membrane")
    with refused("design", "nothing"):
        compare(["paper-dome", "nothing"], library=library, model="membrane")


@pytest.mark.parametrize(("kind", "how"), [("measured", "a program made"), ("design", "calibrated on simulated runs")])
def test_what_rests_on_simulated_runs_is_marked(kind, how):
    first, second = (
        ColumnRecord(label=label, name=label, kind=kind, source="", simulated=label == "A", driving_pressures_kPa=())
        for label in "AB"
    )
    record = ComparisonRecord(
        pneutouch="",
        compared=(first, second),
        inputs={},
        driving_pressures_kPa=(),
        coverage_factor=2.0,
        criterion="",
        figures=(),
        notes=(),
        curves=(),
    )
    (mark,) = comparison_words.marks(record)
    assert mark.startswith(f"SIMULATED DATA: A: {how}")
