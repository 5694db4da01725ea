"""Tables of docs/reference/gauges.md from the files of the gauges, for `stored_pages`."""

from __future__ import annotations

from pathlib import Path

from pneutouch.catalogue import Library
from pneutouch.spec.fields import declaration
from pneutouch.spec.gauge import FIGURES, Gauge

ROOT = Path(__file__).resolve().parents[2]


def gauges() -> dict[str, Gauge]:
    """The shipped gauges by name."""
    return Library((ROOT,)).all("gauges", Gauge)


def table(listed: dict[str, Gauge]) -> str:
    """One row a gauge, unknown figures marked."""
    columns = ("noise_kPa", "resolution_kPa", "rate_Hz", "error_kPa", "inner_volume_mL", "overload_kPa", "supply_V")
    heads = [f"{key.rpartition('_')[0].replace('_', ' ')}, {declaration(Gauge, key).unit}" for key in columns]
    rows = [["name", "part", "reads, kPa", *heads, "output"], ["---"] * (len(columns) + 4)]
    for name, gauge in listed.items():
        reads = f"{gauge.range_kPa.low:g} to {gauge.range_kPa.high:g} {gauge.reference}"
        output = f"{', '.join(gauge.interfaces)}; {gauge.transfer.output}"
        rows.append([f"`{name}`", gauge.title, reads, *(_value(gauge, key) for key in columns), output])
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def _value(gauge: Gauge, key: str) -> str:
    quantity = getattr(gauge, key)
    if quantity is not None:
        return str(quantity.text())
    return "recorder's" if "recorder" in gauge.unknown.get(key, "") else "**unknown**"


def sources(gauge: Gauge) -> str:
    """Every number of a gauge with its source, then what is unknown."""
    lines = [f"### {gauge.title}", "", f"{gauge.maker} {gauge.order_code}. Port: {gauge.port}.", ""]
    lines += ["| figure | value | source |", "| --- | --- | --- |"]
    span = gauge.range_kPa
    lines.append(f"| range, kPa | {span.low:g} to {span.high:g} | {span.source} |")
    ends = "" if gauge.transfer.at_low is None else f": {gauge.transfer.at_low:.10g} to {gauge.transfer.at_high:.10g}"
    lines.append(f"| output at both ends | {gauge.transfer.output}{ends} | {gauge.transfer.source} |")
    for key in FIGURES:
        quantity, unit = getattr(gauge, key), declaration(Gauge, key).unit
        label = f"{key.rpartition('_')[0].replace('_', ' ')}, {unit}"
        value = "**unknown**" if quantity is None else quantity.text()
        lines.append(f"| {label} | {value} | {gauge.unknown.get(key, '') if quantity is None else quantity.source} |")
    return "\n".join(lines)
