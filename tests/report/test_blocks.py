"""Every kind of block stands on the page and in the PDF, and what somebody wrote stays text in both."""

from __future__ import annotations

import json

import numpy as np
import pytest

from pneutouch.report import blocks, pages
from pneutouch.report.chart import Panel, PlotLine, drawn_svg
from pneutouch.report.pictures import png

from .words import page_words, pdf_words, sheet_texts

ODD = '<b>50 % & $x_1$ #pagebreak() {{ sheet }} "said" \\n *no* [_a_]'


@pytest.fixture(scope="module")
def sheet():
    svg = drawn_svg(Panel("force  (N)", "rise  (kPa)", (PlotLine((0, 1), (0, 2)),)))
    rows = [
        ["alpha", "one", blocks.Cell("1.5", "1.2 to 1.8", strong=True)],
        ["alpha", "two", "2.5"],
        ["beta", "one", ODD],
    ]
    return blocks.Sheet(
        title=f"Title {ODD}",
        subtitle="Kind of sheet",
        name="A sheet",
        facts=(("Made by", "the test"),),
        tool="pneutouch",
        foot="at the foot",
        mark="MARKED",
        mark_note="for a reason",
        blocks=(
            blocks.Text(ODD, "status"),
            blocks.FramedBlocks("Framed", [blocks.Text("inside the frame", "strong")]),
            blocks.Heading("A section"),
            blocks.Text("words", "muted"),
            blocks.Items(["first", ODD], numbered=True),
            blocks.SheetTable(rows, ("Name", "Part", "Value\nkPa"), numeric=(2,), strong=(2,), merged=1),
            blocks.SheetTable([["fact", "a value", "and what it rests on"]]),
            blocks.Plots(
                [blocks.Plot(svg, "caption of one", "title of one", full=True), blocks.Plot(svg)], caption="both"
            ),
            blocks.View("view", json.dumps({"bodies": []}), png(np.ones((4, 4, 3))), "a body", "turns", svg),
            blocks.Tiles([blocks.Tile("Sensitivity", "2.3", "kPa/N", "at rest")]),
            blocks.Columns(([blocks.Text("left")], [blocks.Text("right")]), (2, 1)),
        ),
    )


def test_page_and_pdf_hold_every_text(sheet):
    page, pdf = page_words(pages.html(sheet).encode()), pdf_words(pages.pdf(sheet)).replace(" ", "")
    for text in sheet_texts(sheet):
        assert " ".join(text.split()) in page, text
        assert "".join(text.split()) in pdf, text
    assert "at the foot".replace(" ", "") in pdf


def test_page_and_pdf_hold_every_figure(sheet):
    assert pages.html(sheet).count("<svg") == 3
    files = pages.source(sheet)
    assert sorted(name.rpartition(".")[2] for name in files) == ["png", "svg", "svg", "svg", "typ"]
    assert all(name.encode() in files["sheet.typ"] for name in files if name != "sheet.typ")


def test_cells_that_repeat_are_merged_in_groups(sheet):
    table = next(block for block in sheet.blocks if isinstance(block, blocks.SheetTable))
    assert [len(group) for group in table.groups] == [2, 1]
    assert table.names == ["Name", "Part", "Value, kPa"]
    assert b"rowspan: 2" in pages.source(sheet)["sheet.typ"]


def test_an_empty_section_is_left_out():
    assert blocks.section("Nothing", blocks.SheetTable([]), blocks.Items([]), blocks.Text("")) == []


def test_the_same_sheet_gives_the_same_bytes(sheet):
    assert pages.set_sheet(sheet, "a") == pages.set_sheet(sheet, "a")
