"""Measurements of coupons, as text for people."""

from typing import Any

from pneutouch.cli.table import table_text


def results_text(document: dict[str, Any]) -> str:
    """The figures, what each profile changes, the files written, and remarks."""
    figures = [
        [
            f["about"],
            f["name"],
            f"{f['value']:.4g}",
            "" if f["spread"] is None else f"± {f['spread']:.2g}",
            _count(f["count"]),
        ]
        for f in document["figures"]
    ]
    changes = [
        [change["key"], _shown(change["before"]), "->", _shown(change["after"])] for change in document["changes"]
    ]
    parts = [
        table_text([], figures),
        table_text([], changes),
        "\n".join(f"written: {path}" for path in document["written"]),
        "\n".join(f"note: {note}" for note in document["notes"]),
    ]
    return "\n\n".join(part for part in parts if part)


def _count(count: int | None) -> str:
    return "" if count is None else f"n = {count}"


def _shown(quantity: dict[str, Any] | None) -> str:
    """The number of a quantity, or the least size of a feature."""
    if quantity is None:
        return "not known"
    if "recommended" in quantity:
        return f"{quantity['least']:g}" if "least" in quantity else "not known"
    if "value" in quantity:
        return f"{quantity['value']:g}"
    return f"{quantity['low']:g} to {quantity['high']:g}"
