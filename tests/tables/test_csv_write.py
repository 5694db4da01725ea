"""CSV that is written: a spreadsheet finds data in it and no formula, and numbers stay numbers."""

import csv
import io

import pytest

from pneutouch.tables.csv_table import csv_bytes, safe_cell


@pytest.mark.parametrize("text", ["=cmd|' /C calc'!A0", "+1+1", "-2+3", "@SUM(A1)", "\t=1", "\r=1", "  =1", "＝1+1"])
def test_text_that_a_spreadsheet_would_run_is_marked_as_text(text: str):
    assert safe_cell(text) == "'" + text


@pytest.mark.parametrize("value", ["-0.25", "+1e-3", "paper-dome", "a=b", "", -2.5, 3, None])
def test_numbers_and_other_text_stay_as_they_are(value: object):
    assert safe_cell(value) == value


def test_every_cell_and_the_header_is_safe_and_the_file_reads_back():
    content = csv_bytes(["=name", "x_mm"], [["@a", -1.5], ['b, "c"\nd', "-1.5"]])
    read = list(csv.reader(io.StringIO(content.decode(), newline="")))
    assert read == [["'=name", "x_mm"], ["'@a", "-1.5"], ['b, "c"\nd', "-1.5"]]
