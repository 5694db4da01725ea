"""States whose figures would mislead: a curve that is no line, and a filling above the rated pressure."""

from __future__ import annotations

import pytest

from pneutouch.evaluation.evaluate import evaluate
from pneutouch.evaluation.result import predicted
from pneutouch.evaluation.sheet import sheet_data
from pneutouch.evaluation.sheet_data import ContactChart
from pneutouch.mechanics.events import NO_LINE
from pneutouch.report import conditions, curves, sheet_tables

PRESSURES, VOLUMES = "pneumatics.driving_pressures_kPa", "pneumatics.injected_volumes_mL"


@pytest.fixture(scope="module")
def emptied():
    """Falling at -15.5 kPa, no line at -12 kPa, a line at 0 and 12 kPa."""
    return evaluate("paper-dome", {PRESSURES: [-15.5, -12, 0, 12]})


def test_a_curve_that_falls_or_is_no_line_has_no_figures_but_an_event(emptied):
    record = predicted(emptied)
    assert [state.sensitivity_kPa_per_N is None for state in record.states] == [True, True, False, False]
    assert [state.sensitivity_kPa_per_N is None for state in record.as_drawn] == [True, True, False, False]
    kinds = [[event.kind for event in state.events if event.kind == NO_LINE] for state in record.states]
    assert kinds == [[NO_LINE], [NO_LINE], [], []]


def test_check_and_the_sheet_warn_of_it(emptied):
    found = [finding for finding in emptied.findings_alone if finding.rule == "driving"]
    # The vacuum beyond the rated one, and each of the two curves that give no line.
    assert [finding.severity for finding in found] == ["warning", "warning", "warning"]
    sheet = sheet_data(emptied, "0")
    assert len(sheet_tables.warnings(sheet)) == 4
    assert [row[3] == sheet_tables.DASH for row in sheet_tables.performance(sheet).rows] == [True, True, False, False]


def test_a_filling_above_the_rated_pressure_is_warned_of_and_marked():
    filled = evaluate("paper-dome", {PRESSURES: [0, 12], VOLUMES: [0.5, 1.5]})
    low, high = (state.driving_pressure for state in filled.prediction.filled)
    assert low < filled.rating.pressure < high
    rating = predicted(filled).rating
    assert rating is not None and [finding.severity for finding in rating.findings] == ["warning"]
    assert rating.findings[0].driving_pressure_kPa == pytest.approx(1e3 * high, rel=1e-5)
    (finding,) = [one for one in filled.findings_alone if one.rule == "driving"]
    assert finding.excess is not None and finding.excess.measured == pytest.approx(1e3 * high, rel=1e-5)
    sheet = sheet_data(filled, "0")
    assert len(sheet_tables.warnings(sheet)) == 1
    table = sheet_tables.filled(sheet)[-1]
    assert ["*" in str(row[1]) for row in table.rows] == [False, True]


def test_a_press_that_is_lost_at_first_contact_has_a_record():
    lost = predicted(evaluate("graded-dome", {PRESSURES: [-21]})).states[0]
    assert lost.curve.indentation_mm == (0.0,) and lost.curve.tangent_stiffness_N_per_mm == ()
    assert lost.sensitivity_kPa_per_N is None and any(event.ends_range for event in lost.events)


def test_the_chart_of_inflation_holds_a_vacuum_and_its_sheet_the_table_off_the_centre(emptied):
    sheet = sheet_data(emptied, "0")
    panel = curves.inflation(emptied.prediction)
    assert panel.ylim[0] < -15.5 and panel.ylim[1] > 39.0
    assert isinstance(sheet.contact, ContactChart) and sheet.contact.driving_pressures_kPa == (0.0, 12.0)
    # A vacuum has intervals, too, and no cell of the rest is empty.
    assert sheet_tables.unknown_intervals(sheet) == []
    assert [row[1] for row in conditions.environment(sheet)[:3] if "–" in row[1]] == []
    assert all(tile.value != "–" for tile in sheet_tables.key_figures(sheet))


def test_the_chart_of_tuning_joins_its_fillings_in_order_of_their_gas():
    typed = evaluate("paper-dome", {PRESSURES: [0, 12], VOLUMES: [5, 1, 3]})
    chart = sheet_data(typed, "0").tuning
    assert chart is not None
    drawn = [value for _, value in chart.filled_kPa_per_N]
    assert drawn == sorted(drawn, reverse=True)
