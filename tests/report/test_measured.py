"""The measured sheet: every figure beside its prediction, the same bytes, and few runs as well as many."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pypdfium2
import pytest

from pneutouch.bench.figures import FIGURES, run_figures
from pneutouch.bench.record import SuspectInterval
from pneutouch.report.blocks import FramedBlocks, Heading, Plot, SheetTable, found
from pneutouch.report.measured.plots import loops, opened, responses
from pneutouch.report.measured.sheet import described, measured_datasheet, tiles, whole_verdict
from pneutouch.report.measured.tables import MOST, groups_of, lists, resin_section, specimen_section
from pneutouch.report.numbers import MINUS, between, difference, number, signed
from pneutouch.report.pages import html
from pneutouch.report.prose import WORDS
from pneutouch.results.measured import Verdict

from .campaign import INJECTIONS, RESINS, VERDICTS, measured_of
from .words import page_words, pdf_words, sheet_texts

PLOTS = ("Sensitivity over driving pressure", "Response", "Force over indentation", "Hysteresis", "Relaxation")
FAILURE = ("runs/FLX9940-2-steps.csv", 'row 20418: force_N = "nan.": not a number; must be one')
QUESTION = ("runs/TangoPlus-1.csv", "driving pressure reads 12.1 kPa where the campaign says 0: swapped files?")


def headings(sheet):
    return [heading.text for heading in found(sheet.blocks, Heading)]


def table_under(sheet, title):
    """The table below a heading."""
    place = next(k for k, block in enumerate(sheet.blocks) if isinstance(block, Heading) and block.text == title)
    return next(block for block in sheet.blocks[place:] if isinstance(block, SheetTable))


@pytest.fixture(scope="module")
def campaign(library):
    """Seven resins, with everything that a sheet may have to say."""
    found = measured_of(library)
    doubts = tuple(
        SuspectInterval(10.0 + k, 10.5 + k, f"doubt number {k} in a row", bool(k % 2)) for k in range(MOST + 7)
    )
    return replace(
        found,
        curves=(replace(found.curves[0], warnings=doubts), *found.curves[1:]),
        verdicts=VERDICTS,
        injections=INJECTIONS,
        failures=(FAILURE,),
        questions=(QUESTION,),
    )


@pytest.fixture(scope="module")
def files(campaign):
    return measured_datasheet(campaign)


@pytest.fixture(scope="module")
def sheet(campaign):
    return described(campaign)


@pytest.fixture(scope="module")
def least(library):
    """One resin, one pressure, one specimen, one run, really measured."""
    return measured_of(
        library, resins=("TangoPlus",), pressures=(0.0,), specimens=1, runs=1, kinds=("steps",), simulated=False
    )


@pytest.mark.slow
def test_page_and_pdf_have_every_text_of_the_sheet(sheet, files):
    page = page_words(files["measured-datasheet.html"])
    pdf = pdf_words(files["measured-datasheet.pdf"]).replace(" ", "")
    for text in sheet_texts(sheet):
        assert " ".join(text.split()) in page, text
        assert "".join(text.split()) in pdf, text


def test_there_is_every_section_resin_and_plot(sheet):
    sections = ("Leak and dead volume", "Failures", "Questions", "Warnings", "Specimens", "Conditions", "Definitions")
    assert set(headings(sheet)) >= {*sections, *(f"Figures of {resin}" for resin in RESINS)}
    assert {plot.title for plot in found(sheet.blocks, Plot)} == set(PLOTS)


def test_every_figure_stands_on_the_sheet_with_its_meaning(sheet):
    rows = table_under(sheet, "Definitions").rows
    for figure in FIGURES:
        assert any(
            row[0].startswith(figure.name) and row[1] == WORDS["measured"]["definitions"][figure.key] for row in rows
        )


def test_figures_are_those_of_the_groups_with_interval_and_difference(campaign, sheet):
    for beside in campaign.comparisons:
        mean, predicted = beside.group.figures["sensitivity_kPa_per_N"], beside.predicted["sensitivity_kPa_per_N"]
        row = [
            number(mean.value, 4),
            between((mean.value, mean.low, mean.high), 4),
            "3 / 9",
            number(predicted[0], 4),
            between(predicted, 4),
            signed(100 * (mean.value / predicted[0] - 1)),
            "yes",
        ]
        rows = table_under(sheet, f"Figures of {beside.label}").rows
        assert row in [list(map(str, cells[4:])) for cells in rows]
    assert sum("3 / 9" in row for table in found(sheet.blocks, SheetTable) for row in table.rows) >= 12


@pytest.mark.slow
def test_simulated_data_says_so_on_every_page_and_measured_data_does_not(files, least):
    pages = list(pypdfium2.PdfDocument(files["measured-datasheet.pdf"]))
    assert all("SIMULATED DATA" in page.get_textpage().get_text_range() for page in pages)
    assert b"SIMULATED DATA" in files["measured-datasheet.html"]
    real = measured_datasheet(least)
    assert b"SIMULATED" not in real["measured-datasheet.html"]
    assert "SIMULATED" not in pdf_words(real["measured-datasheet.pdf"])


def test_failures_questions_doubts_and_leaks_are_listed(sheet):
    assert list(FAILURE) in table_under(sheet, "Failures").rows
    assert list(QUESTION) in [list(row) for row in table_under(sheet, "Questions").rows]
    warnings = table_under(sheet, "Warnings").rows
    assert [row[0] for row in warnings] == [f"doubt number {k} in a row" for k in range(MOST)]
    assert sum(int(row[2]) for row in warnings) == MOST
    leaks = table_under(sheet, "Leak and dead volume").rows
    assert ["TangoPlus-1", "leak", "0.02130", "–", "0.0031", "kPa/min"] in leaks
    assert ["TangoPlus-1", "dead volume", "0.5120", "0.480", "0.012", "mL"] in leaks
    (box,) = found(sheet.blocks, FramedBlocks)
    left = (MOST + 7 + 1) // 2
    assert f"{left} doubtful" in box.blocks[-1].text and f"{MOST + 7 - left} noted" in box.blocks[-1].text
    assert "1 of 252 runs" in box.blocks[-1].text


def test_verdict_is_failed_before_undecided_before_passed():
    passed, undecided, failed = VERDICTS
    for verdicts, word in (
        ((passed, undecided, failed), "failed"),
        ((passed, undecided), "not decided"),
        ((passed,), "passed"),
    ):
        assert whole_verdict(verdicts).endswith(word)
    assert whole_verdict(()) == "No target given"


def test_head_counts_specimens_runs_and_resins(sheet):
    facts = dict(sheet.facts)
    assert facts["Contains"] == "21 specimens, 252 runs, 7 resins"
    assert (facts["Laboratory"], facts["Measured"], facts["Input"]) == ("Test bench 3", "2026-03-02", "0123456789ab")
    assert facts["Design"].startswith("paper-dome")


def test_page_is_self_contained_and_draws_every_plot_once(sheet):
    page = html(sheet)
    assert re.findall(r"""(?:src|href)=["']?(https?://[^"'>]+)""", page) == []
    assert page.count("<svg") == len(PLOTS)
    assert "url(data:font/otf;base64," in page


def test_same_campaign_same_bytes(least):
    assert measured_datasheet(least) == measured_datasheet(least)


def test_one_run_is_shown_with_the_intervals_of_its_samples_alone_and_without_empty_headings(least):
    sheet = described(least)
    assert dict(sheet.facts)["Contains"] == "1 specimen, 1 run, 1 resin"
    assert set(headings(sheet)) == {
        "Measured and predicted",
        "Figures of TangoPlus",
        "Specimens",
        "Conditions",
        "Definitions",
    }
    rows = table_under(sheet, "Figures of TangoPlus").rows
    known = [row for row in rows if row[5] != "–"]
    assert rows[0][5] == "–" and len(known) <= 2
    assert len(found(sheet.blocks, Plot)) == 3


def test_ageing_stands_beside_the_papers(library):
    aged = measured_of(library, resins=("TangoPlus",), runs=1, kinds=("steps",), ages=(0.0, 365.0))
    sheet = described(aged)
    (table,) = [
        table for table in found(sheet.blocks, SheetTable) if table.head[:1] == ["Resin"] and len(table.head) == 6
    ]
    assert table.rows[0][2:] == ["12 months", f"{MINUS}9.1", f"{MINUS}15.0 to {MINUS}3.2", "± 14.8"]
    assert ["Ages", "fresh and 12 months"] in table_under(sheet, "Conditions").rows
    assert len(found(sheet.blocks, Plot)) == 4


def test_without_a_prediction_the_sheet_says_why_and_invents_none(library):
    campaign = measured_of(library, resins=("TangoPlus",), pressures=(0.0,), kinds=("steps",), predicted=False)
    _, table, *notes = resin_section(groups_of(campaign.comparisons)[0])
    assert notes[-1].text.endswith("beyond the limit point of this resin")
    assert all(row[7:] == ["", "", "", ""] for row in table.rows)
    assert all("predicted, 95 %" not in plot.svg for plot in found(described(campaign).blocks, Plot))


def test_a_campaign_of_which_nothing_could_be_read_still_gives_a_sheet(least):
    sheet = described(replace(least, comparisons=(), curves=(), failures=(FAILURE,)))
    assert list(FAILURE) in table_under(sheet, "Failures").rows
    assert found(sheet.blocks, Plot) == []
    assert measured_datasheet(replace(least, comparisons=(), curves=(), failures=(FAILURE,)))


def test_a_resin_of_any_title_can_be_drawn(least):
    beside = replace(least.comparisons[0], label="Resin $5 _a")
    other = replace(
        least.comparisons[0], label="$", group=replace(beside.group, key=replace(beside.group.key, resin="other"))
    )
    files = measured_datasheet(replace(least, comparisons=(beside, other)))
    assert "Figures of Resin $5 _a" in page_words(files["measured-datasheet.html"])


def test_specimen_rows_are_means_over_runs(campaign):
    (table,) = found(specimen_section(groups_of(campaign.comparisons)), SheetTable)
    rows = table.rows
    assert len(rows) == 7 * 3 * 2
    beside = campaign.comparisons[0]
    name = beside.group.sensors[0]
    own = [
        found["sensitivity_kPa_per_N"]
        for curve, found in zip(beside.group.curves, beside.group.each, strict=True)
        if curve.run.sensor == name and "sensitivity_kPa_per_N" in found
    ]
    assert rows[0][1:3] == [name, "1, circle"]
    assert rows[0][6:8] == [number(float(np.mean(own)), 4), number(float(np.std(own, ddof=1)), 2)]


def test_tiles_name_the_worst_group(campaign):
    by_name = {tile.name: tile for tile in tiles(campaign)}
    gaps = {
        (b.label, b.group.key.driving_pressure_kPa): difference(
            b.group.figures["sensitivity_kPa_per_N"].value, b.predicted["sensitivity_kPa_per_N"][0]
        )
        for b in campaign.comparisons
    }
    (label, pressure), gap = max(gaps.items(), key=lambda item: abs(item[1]))
    assert f"{signed(gap)} % at {label}, {pressure:g} kPa" in by_name["Off the predicted sensitivity"].condition
    assert by_name["In the predicted band"].value == "14 of 14"
    assert len(by_name) == 6


def test_docs_define_every_figure_with_its_key(root):
    text = (root / "docs" / "howto" / "measuring.md").read_text(encoding="utf-8")
    section = text[text.index("## Definitions") :]
    assert set(WORDS["measured"]["definitions"]) == {figure.key for figure in FIGURES}
    for figure in FIGURES:
        row = next(line for line in section.splitlines() if f"`{figure.key}`" in line)
        cells = re.split(r"(?<!\\)\|", row)[1:-1]
        assert cells[0].strip().startswith(figure.name)
        assert cells[1].strip() == (figure.unit or "-")
        assert all(cell.strip() for cell in cells)


def test_a_verdict_of_its_own_words_is_printed(least):
    wish = Verdict("stiffness at 0 kPa", "at most 5 N/mm", "4.7 N/mm", True)
    (table,) = found(found(described(replace(least, verdicts=(wish,))).blocks, FramedBlocks), SheetTable)
    assert list(map(str, table.rows[0])) == [wish.what, wish.required, wish.measured, "passed"]


def test_a_plot_of_one_resin_among_several_is_narrow_and_named(campaign):
    without = tuple(
        beside if beside.label == "TangoPlus" else replace(beside, group=_only(beside.group, "steps"))
        for beside in campaign.comparisons
    )
    groups = groups_of(without)
    loop, response = loops(groups), responses(groups)
    assert not loop.full
    assert response.full
    width = [float(re.search(r'width="([\d.]+)pt"', plot.svg)[1]) for plot in (loop, response)]
    assert width == pytest.approx([86 / 25.4 * 72, 180 / 25.4 * 72], rel=1e-3)
    assert not any(group.alone for group in groups)


def test_the_loop_that_is_drawn_is_as_wide_as_the_figure_says(campaign):
    """Drawn as rise over force, a loop of 0.3 % of full scale is one line."""
    runs = [curve for one in campaign.comparisons for curve in one.group.curves if curve.loop]
    assert runs
    for run in runs:
        ((force, opening),) = opened(run)
        width = run_figures(run)["hysteresis_width_percent"]
        assert 2 * np.abs(opening).max() == pytest.approx(width, rel=0.02)
        assert opening[-1] == pytest.approx(0, abs=1e-9) and force[-1] == pytest.approx(
            max(cycle[0].max() for cycle in run.loop), rel=0.01
        )


def _only(group, kind):
    kept = [k for k, curve in enumerate(group.curves) if curve.run.kind == kind]
    return replace(group, curves=tuple(group.curves[k] for k in kept), each=tuple(group.each[k] for k in kept))


def test_a_failure_does_not_say_its_file_twice(campaign):
    listed = lists(replace(campaign, failures=(("runs/a.csv", "/home/lab/campaign/runs/a.csv: no such file"),)))
    assert ["runs/a.csv", "no such file"] in found(listed, SheetTable)[1].rows
