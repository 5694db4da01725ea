"""The measured sheet: every figure beside its prediction, what went wrong said, the same bytes, and few runs as well as many."""

from __future__ import annotations

import html as markup
import re
from dataclasses import replace

import numpy as np
import pypdfium2
import pytest

from pneutouch.bench.figures import FIGURES
from pneutouch.bench.record import SuspectInterval
from pneutouch.report.measured import tables
from pneutouch.report.measured.head import MINUS, between, difference, number, signed, tiles, verdict
from pneutouch.report.measured.panels import panels_of
from pneutouch.report.measured.plots import responses
from pneutouch.report.measured.sheet import measured_datasheet
from pneutouch.report.measured.tables import MOST, failures, loops, resin_table, specimens
from pneutouch.results.measured import Verdict

from .campaign import INJECTIONS, RESINS, VERDICTS, measured_of

PLOTS = ("Sensitivity over driving pressure", "Response", "Force over indentation", "Hysteresis", "Relaxation")
FAILURE = ("runs/FLX9940-2-steps.csv", 'row 20418: force_N = "nan.": not a number; must be one')
QUESTION = ("runs/TangoPlus-1.csv", "driving pressure reads 12.1 kPa where the campaign says 0: swapped files?")


def text_of(pdf):
    """The PDF's words with single blanks: lines break anywhere, and pdfium marks a hyphen at a line's end."""
    pages = "\n".join(page.get_textpage().get_text_range() for page in pypdfium2.PdfDocument(pdf))
    return " ".join(re.sub(r"[-\x02\ufffe]\s*\n", "-", pages).replace("\x02", "-").replace("\ufffe", "-").split())


def words_of(page):
    """The words of a page without its figures and style."""
    bare = re.sub(r"<style>.*?</style>|<svg.*?</svg>|<[^>]+>", " ", page.decode(), flags=re.DOTALL)
    return " ".join(markup.unescape(bare).split())


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
def said(files):
    """What page and PDF say."""
    return words_of(files["measured-datasheet.html"]), text_of(files["measured-datasheet.pdf"])


@pytest.fixture(scope="module")
def least(library):
    """One resin, one pressure, one specimen, one run, really measured."""
    return measured_of(
        library, resins=("TangoPlus",), pressures=(0.0,), specimens=1, runs=1, kinds=("steps",), simulated=False
    )


def test_page_and_pdf_have_every_section_resin_and_plot(said):
    sections = ("Leak and dead volume", "Failures", "Questions", "Warnings", "Specimens", "Conditions", "Definitions")
    for text in said:
        for word in (*PLOTS, *sections, *(f"Figures of {resin}" for resin in RESINS)):
            assert word in text


def test_every_figure_stands_on_the_sheet_with_its_meaning(said):
    for text in said:
        for figure in FIGURES:
            assert figure.name in text
            assert tables.LINES_OF[figure.key] in text


def test_figures_are_those_of_the_groups_with_interval_and_difference(campaign, said):
    page, _ = said
    for beside in campaign.comparisons:
        found, predicted = beside.group.figures["sensitivity_kPa_per_N"], beside.predicted["sensitivity_kPa_per_N"]
        row = (
            f"{number(found.value, 4)} {between((found.value, found.low, found.high), 4)} 3 / 9 "
            f"{number(predicted[0], 4)} {between(predicted, 4)} {signed(100 * (found.value / predicted[0] - 1))} yes"
        )
        for text in said:
            assert row in text
    assert page.count(" 3 / 9 ") >= 6 * len(campaign.comparisons)


def test_simulated_data_says_so_on_every_page_and_measured_data_does_not(files, least):
    pages = list(pypdfium2.PdfDocument(files["measured-datasheet.pdf"]))
    assert all("SIMULATED DATA" in page.get_textpage().get_text_range() for page in pages)
    assert b"SIMULATED DATA" in files["measured-datasheet.html"]
    real = measured_datasheet(least)
    assert b"SIMULATED" not in real["measured-datasheet.html"]
    assert "SIMULATED" not in text_of(real["measured-datasheet.pdf"])


def test_failures_questions_doubts_and_leaks_are_listed(said):
    for text in said:
        assert FAILURE[1] in text
        assert QUESTION[1] in text
        assert f"doubt number {MOST - 1} in a row" in text
        assert f"doubt number {MOST} in a row" not in text
        assert "and 7 more: see figures.json" in text
        assert f"{MOST + 7} parts of the records are doubtful" in text
        assert "Not used: 1 of 252 runs" in text
        assert "0.02130 0.0031 kPa/min" in text


def test_verdict_is_failed_before_undecided_before_passed(campaign):
    passed, undecided, failed = VERDICTS
    for verdicts, word in (
        ((passed, undecided, failed), "Target failed"),
        ((passed, undecided), "Target not decided"),
        ((passed,), "Target passed"),
        ((), "No target given"),
    ):
        assert verdict(replace(campaign, verdicts=verdicts)).word == word


def test_head_counts_specimens_runs_and_resins(said):
    for text in said:
        for word in ("21 specimens, 252 runs, 7 resins", "Test bench 3", "2026-03-02", "0123456789ab", "paper-dome"):
            assert word in text


def test_page_is_self_contained_and_draws_every_plot_once(files):
    page = files["measured-datasheet.html"].decode()
    assert re.findall(r"""(?:src|href)=["']?(https?://[^"'>]+)""", page) == []
    assert page.count("<svg") == len(PLOTS)
    assert "url(data:font/otf;base64," in page


def test_same_campaign_same_bytes(least):
    assert measured_datasheet(least) == measured_datasheet(least)


def test_one_run_is_shown_without_interval_and_without_empty_headings(least):
    files = measured_datasheet(least)
    for text in (words_of(files["measured-datasheet.html"]), text_of(files["measured-datasheet.pdf"])):
        assert "1 specimen, 1 run, 1 resin" in text
        assert "The run was read." in text
        assert "one value, no interval" in text
        assert (
            "Not measured: Repeatability of the sensitivity; Part to part, of the sensitivity; Saturation force;"
            in text
        )
        for word in ("Failures", "Questions", "Warnings parts", "Ageing", "Figures of FLX9940", "Leak and dead"):
            assert word not in text
    assert files["measured-datasheet.html"].decode().count("<svg") == 3


def test_ageing_stands_beside_the_papers(library):
    aged = measured_of(library, resins=("TangoPlus",), runs=1, kinds=("steps",), ages=(0.0, 365.0))
    files = measured_datasheet(aged)
    for text in (words_of(files["measured-datasheet.html"]), text_of(files["measured-datasheet.pdf"])):
        assert "Ageing" in text
        assert f"12 months {MINUS}9.1 {MINUS}15.0 to {MINUS}3.2 ± 14.8" in text
        assert "Ages fresh and 12 months" in text
    assert files["measured-datasheet.html"].decode().count("<svg") == 4


def test_without_a_prediction_the_sheet_says_why_and_invents_none(library):
    found = measured_of(library, resins=("TangoPlus",), pressures=(0.0,), kinds=("steps",), predicted=False)
    table = resin_table(panels_of(found.comparisons)[0])
    assert table.why == ["No prediction at 0 kPa: beyond the limit point of this resin"]
    assert all(row[5:] == ["", "", "", ""] for figure in table.figures for row in figure.rows)
    files = measured_datasheet(found)
    assert "Thin lines join" in files["measured-datasheet.html"].decode()
    assert "predicted, 95 %" not in text_of(files["measured-datasheet.pdf"])


def test_a_campaign_of_which_nothing_could_be_read_still_gives_a_sheet(least):
    files = measured_datasheet(replace(least, comparisons=(), curves=(), failures=(FAILURE,)))
    text = text_of(files["measured-datasheet.pdf"])
    assert "Not used: 1 of 1 run" in text
    assert FAILURE[1] in text
    assert b"<svg" not in files["measured-datasheet.html"]


def test_what_a_user_writes_stays_text(least):
    title = "<b>50 % & $x_1$ #pagebreak() {{ sheet }}"
    files = measured_datasheet(
        replace(
            least, campaign=least.campaign.model_copy(update={"title": title}), failures=(("a_$b$.csv", "*no* <i>"),)
        )
    )
    for text in (words_of(files["measured-datasheet.html"]), text_of(files["measured-datasheet.pdf"])):
        assert title in text
        assert "a_$b$.csv" in text
        assert "*no* <i>" in text


def test_a_resin_of_any_title_can_be_drawn(least):
    beside = replace(least.comparisons[0], label="Resin $5 _a")
    other = replace(
        least.comparisons[0], label="$", group=replace(beside.group, key=replace(beside.group.key, resin="other"))
    )
    files = measured_datasheet(replace(least, comparisons=(beside, other)))
    assert "Figures of Resin $5 _a" in words_of(files["measured-datasheet.html"])


def test_specimen_rows_are_means_over_runs(campaign):
    listed = specimens(panels_of(campaign.comparisons))
    assert listed.more == ""
    rows = listed.rows
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
    by_name = {tile[0]: tile for tile in tiles(campaign)}
    gaps = {
        (b.label, b.group.key.driving_pressure_kPa): difference(
            b.group.figures["sensitivity_kPa_per_N"].value, b.predicted["sensitivity_kPa_per_N"][0]
        )
        for b in campaign.comparisons
    }
    (label, pressure), gap = max(gaps.items(), key=lambda item: abs(item[1]))
    assert by_name["Off the predicted sensitivity"][3] == f"median; most {signed(gap)} % at {label}, {pressure:g} kPa"
    assert by_name["In the predicted band"][1] == "14 of 14"
    assert len(by_name) == 6


def test_docs_define_every_figure_with_its_key(root):
    text = (root / "docs" / "howto" / "measuring.md").read_text(encoding="utf-8")
    section = text[text.index("## Definitions") :]
    assert set(tables.LINES_OF) == {figure.key for figure in FIGURES}
    for figure in FIGURES:
        row = next(line for line in section.splitlines() if f"`{figure.key}`" in line)
        cells = re.split(r"(?<!\\)\|", row)[1:-1]
        assert cells[0].strip().startswith(figure.name)
        assert cells[1].strip() == (figure.unit or "-")
        assert all(cell.strip() for cell in cells)


def test_a_verdict_of_its_own_words_is_printed(least):
    wish = Verdict("stiffness at 0 kPa", "at most 5 N/mm", "4.7 N/mm", True)
    text = text_of(measured_datasheet(replace(least, verdicts=(wish,)))["measured-datasheet.pdf"])
    assert "stiffness at 0 kPa at most 5 N/mm 4.7 N/mm passed" in text


def test_a_plot_of_one_resin_among_several_is_narrow_and_named(campaign):
    without = tuple(
        beside if beside.label == "TangoPlus" else replace(beside, group=_only(beside.group, "steps"))
        for beside in campaign.comparisons
    )
    panels = panels_of(without)
    loop, response = loops(panels), responses(panels)
    assert not loop.wide
    assert response.wide
    width = [float(re.search(r'width="([\d.]+)pt"', plot.svg)[1]) for plot in (loop, response)]
    assert width == pytest.approx([86 / 25.4 * 72, 180 / 25.4 * 72], rel=1e-3)
    assert not any(panel.alone for panel in panels)


def _only(group, kind):
    kept = [k for k, curve in enumerate(group.curves) if curve.run.kind == kind]
    return replace(group, curves=tuple(group.curves[k] for k in kept), each=tuple(group.each[k] for k in kept))


def test_a_failure_does_not_say_its_file_twice(campaign):
    listed = failures(replace(campaign, failures=(("runs/a.csv", "/home/lab/campaign/runs/a.csv: no such file"),)))
    assert listed.rows == [["runs/a.csv", "no such file"]]
