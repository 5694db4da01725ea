"""The front of the datasheet, and what its annex must not hide or say twice."""

from __future__ import annotations

import re

import numpy as np
import pytest

from pneutouch.evaluation.sheet import sheet_data
from pneutouch.report import sheet_tables
from pneutouch.report.blocks import SheetTable, found
from pneutouch.report.certainty import share_bars, uncertainty_section
from pneutouch.report.datasheet import described
from pneutouch.results.record import SENSITIVITY_KEY


@pytest.fixture(scope="module")
def paper(evaluated):
    return sheet_data(evaluated("paper-dome"), "0")


@pytest.fixture(scope="module")
def cast(evaluated):
    return sheet_data(evaluated("cast-dome"), "0")


def test_the_front_has_no_figure_at_a_driving_pressure_above_the_rated_one(paper):
    """The paper drives to 22 kPa; the rated pressure is 19.7 kPa, so 12 kPa is the highest on the front."""
    first, last, force = sheet_tables.key_figures(paper)[:3]
    states = {round(state.driving_pressure * 1e3): state.figures for state in paper.prediction.states}
    assert (first.value, last.value) == tuple(f"{states[p].sensitivity:.2f}" for p in (0, 12))
    assert force.value.split()[-1] == f"{states[12].force_range[1]:.1f}"
    (driving,) = [row[1] for row in sheet_tables.connections(paper) if row[0] == "Driving"]
    assert [float(number) for number in re.findall(r"[\d.]+\d|\d", driving)] == [0, 5, 12, 19.7]
    marked = [row[0] for row in sheet_tables.performance(paper).rows if row[0].endswith("*")]
    assert marked == ["22 *"]


@pytest.mark.parametrize("name", ["paper", "cast"])
def test_each_figure_on_the_front_stands_with_that_of_the_gas_as_drawn(name, request):
    sheet = request.getfixturevalue(name)
    assert sheet.as_drawn.model == ("atlas" if name == "paper" else "solid")
    assert sheet.as_drawn.dead_volume == pytest.approx(sheet.assembly.drawn_volume)
    tiles = sheet_tables.key_figures(sheet)[:3]
    drawn = sheet.as_drawn.states[0].figures, sheet.as_drawn.states[2 if name == "paper" else -1].figures
    assert tiles[0].condition.endswith(f"{drawn[0].sensitivity:.2f}")
    assert tiles[1].condition.endswith(f"{drawn[1].sensitivity:.2f}")
    assert tiles[2].condition.endswith(f"{drawn[1].force_range[1]:.1f}")


def test_a_cast_sheet_has_one_drift_and_one_word_on_fast_contact(cast):
    """The atlas's neo-Hookean wall gave a second drift and a ratio for fast contact beside "not known"."""
    assert cast.gas is None
    notes = [note for one in cast.uncertainty for note in one.notes or ()]
    assert not [note for note in notes if "kPa/K" in note or "adiabatic" in note]


def test_events_within_the_range_that_do_not_end_it_are_listed_with_their_force(paper):
    quiet = {(event.kind) for state in paper.prediction.states for event in state.events if not event.ends_range}
    lines = sheet_tables.quiet_events(paper)
    assert {"creasing", "wall on its base"} <= quiet and len(lines) == len(quiet)
    state = paper.prediction.states[0]
    (crease,) = [event for event in state.events if event.kind == "creasing"]
    force = np.interp(crease.indentation, state.indentation, state.force)
    (line,) = [line for line in lines if "creasing" in line]
    assert [float(number) for number in re.findall(r"\d+\.\d+", line)][:2] == [
        round(crease.indentation, 2),
        round(force, 1),
    ]


def test_the_sources_are_in_the_order_of_the_chart_s_shares(paper):
    tables = found(uncertainty_section(paper, ()), SheetTable)
    (rows,) = [table.rows for table in tables if table.head and table.head[0] == "Source"]
    shares = paper.uncertainty[-1].known[SENSITIVITY_KEY].shares
    ranked = [name for name in dict.fromkeys(row[0] for row in rows) if name in shares]
    assert ranked == sorted(shares, key=lambda name: -shares[name])
    assert rows[0][3] == f"{100 * max(shares.values()):.0f} %"
    assert rows[0][3] in share_bars({"22 kPa": dict(shares)})


def test_findings_name_their_body(cast):
    (table,) = [one for one in found(described(cast).blocks, SheetTable) if one.head and one.head[0] == "Severity"]
    assert [row[2] for row in table.rows] == [finding.body for finding in cast.findings]
