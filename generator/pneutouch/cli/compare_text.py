"""Output of ``compare`` for people."""

from pneutouch.cli.terminal import table_text
from pneutouch.report import comparison_words
from pneutouch.results.comparison import ColumnRecord, ComparisonRecord, RowRecord


def comparison_text(comparison: ComparisonRecord) -> str:
    """Differences, every figure with its interval, those that exceed their uncertainty, and the assumptions."""
    labels = comparison_words.labels(comparison)
    lines = [f"{one.label}: {one.kind}{_from(one)}" for one in comparison.compared]
    lines += comparison_words.marks(comparison)
    inputs = comparison_words.input_rows(comparison)
    if inputs:
        lines += ["", table_text(["inputs that differ", *labels], inputs)]
    for pressure_kPa in comparison_words.pressures(comparison):
        rows = [_row(row) for row in comparison.figures if row.driving_pressure_kPa == pressure_kPa]
        head = [comparison_words.heading(pressure_kPa), *labels, *_difference_heads(labels)]
        lines += ["", table_text(head, rows)]
    lines += ["", *comparison_words.summary(comparison), ""]
    return "\n".join([*lines, comparison.criterion, *comparison.notes])


def _difference_heads(labels: list[str]) -> list[str]:
    return ["difference"] if len(labels) == 2 else [f"{label}, difference" for label in labels[1:]]


def _from(one: ColumnRecord) -> str:
    return f", {one.source}" if one.source not in ("", one.label) else ""


def _row(row: RowRecord) -> list[str]:
    values = [f"{value} ({interval})" if interval else value for value, interval in comparison_words.figure_cells(row)]
    differences = [
        f"{percent} ({interval}): {word}" if interval else f"{percent}: {word}" if percent != word else word
        for percent, interval, word in comparison_words.difference_cells(row)
    ]
    return [comparison_words.figure_name(row), *values, *differences]
