"""The comparison as one HTML page and one PDF from the same content and the same figures."""

from collections.abc import Mapping
from typing import Any

from pneutouch.evaluation.comparison_record import ComparisonRecord, RowRecord
from pneutouch.parts import Assembly
from pneutouch.report import pages
from pneutouch.report.compared import plots, words

_KINDS = {"design": "design, predicted", "build": "build, as predicted when it was built", "measured": "measured"}

_MANY = f"The first {plots.MOST} are drawn."


def comparison_sheet(document: ComparisonRecord, parts: Mapping[str, Assembly]) -> dict[str, bytes]:
    """``comparison.html`` and ``comparison.pdf``; ``parts`` are the assemblies by label. Same input, same bytes."""
    groups = _pictures(document, parts)
    names = {picture: f"figure-{k}" for k, picture in enumerate(p for _, _, drawn in groups for p in drawn.values())}
    content = {
        **_content(document),
        "figures": [
            {
                "title": title,
                "caption": caption,
                "plots": [{"name": names[picture], "title": head} for head, picture in drawn.items()],
            }
            for title, caption, drawn in groups
            if drawn
        ],
    }
    pictures = {name: picture for picture, name in names.items()}
    return {
        "comparison.html": pages.html("compare.html.j2", content, pictures).encode(),
        "comparison.pdf": pages.pdf("compare.typ", content, pictures),
    }


def _content(document: ComparisonRecord) -> dict[str, Any]:
    """The sections of the sheet; every leaf is text."""
    labels = words.labels(document)
    return {
        "title": " and ".join([", ".join(labels[:-1]), labels[-1]]),
        "tool": f"pneutouch {document['pneutouch']}",
        "labels": labels,
        "compared": [[one["label"], _KINDS[one["kind"]], one["source"] or "–"] for one in document["compared"]],
        "marks": words.marks(document),
        "summary": words.summary(document),
        "inputs": words.input_rows(document),
        "groups": [
            {
                "title": words.heading(p),
                "rows": [_row(row) for row in document["figures"] if row["driving_pressure_kPa"] == p],
            }
            for p in words.pressures(document)
        ],
        "criterion": document["criterion"],
        "notes": list(document["notes"]),
    }


def _row(row: RowRecord) -> dict[str, Any]:
    return {
        "name": words.figure_name(row),
        "values": [list(pair) for pair in words.figure_cells(row)],
        "differences": [list(cells) for cells in words.difference_cells(row)],
    }


def _pictures(document: ComparisonRecord, parts: Mapping[str, Assembly]) -> list[tuple[str, str, dict[str, str]]]:
    """Title, caption, and the plots by their own titles."""
    many = f" {_MANY}" if len(document["compared"]) > plots.MOST else ""
    apart, cut = plots.differences(document), plots.sections(document, parts)
    return [
        (
            "Differences",
            f"From {words.labels(document)[0]}, with their intervals (k = 2). Filled: the difference exceeds its "
            f"uncertainty; open: it does not.{many}",
            {} if apart is None else {"": apart},
        ),
        (
            "Response",
            "Pressure rise over contact force up to the range's end, by driving pressure. Lines: predicted, with the "
            f"interval of the sensitivity; markers: measured.{many}",
            plots.responses(document),
        ),
        (
            "Force over indentation",
            "By driving pressure. Lines: predicted, with the interval of the stiffness; markers: measured." + many,
            plots.indentations(document),
        ),
        (
            "Sections",
            f"Through the axis, laid over one another; the dome's base plane is z = 0.{many}",
            {} if cut is None else {"": cut},
        ),
    ]
