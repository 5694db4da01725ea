"""The datasheet's section on contact that is not central: charts, table and captions."""

from __future__ import annotations

from typing import Any

import numpy as np

from pneutouch.evaluation.sheet_data import ContactChart, ContactRow, ErrorCurves
from pneutouch.report.style import ACCENT, INK, LINES, MARKERS, figure, legend_above, note, plain_ticks, svg

SIZE = (57.0, 58.0)
"""Width and height of a chart in mm: a third of the width of the text on A4."""

DASH = "–"

_LOGARITHMIC = "contact-radius"

_LOOKS: tuple[dict[str, Any], ...] = ({"color": INK, "ls": LINES[0]}, {"color": ACCENT, "ls": LINES[1]})
"""Line styles of the lowest and the highest driving pressure."""

_MARKED = 5
"""Points of a curve to one mark."""


def contact_figures(chart: ContactChart) -> dict[str, str]:
    """Error of the force read over the radius of a ball or an edge, their offset, and the tilt of a plate, as SVG by
    name; their vertical axes are the same."""
    charts = {
        "contact-radius": (chart.by_radius, chart.edges_by_radius, "radius, contact central  (mm)"),
        "contact-offset": (chart.by_offset, chart.edges_by_offset, "offset from the axis  (mm)"),
        "contact-tilt": (chart.by_tilt, None, "tilt of a plate  (degrees)"),
    }
    drawn = [curves for *both, _ in charts.values() for curves in both if curves is not None]
    errors = np.concatenate([np.ravel(curves.errors_percent) for curves in drawn])
    low, high = (float(f(errors, initial=0.0, where=np.isfinite(errors))) for f in (np.min, np.max))
    margin = 0.05 * (high - low)
    return {
        name: _chart(
            curves, edges, chart, xlabel=across, ylim=(low - margin, high + margin), logarithmic=name == _LOGARITHMIC
        )
        for name, (curves, edges, across) in charts.items()
    }


def _chart(
    curves: ErrorCurves,
    edges: ErrorCurves | None,
    chart: ContactChart,
    *,
    xlabel: str,
    ylim: tuple[float, float],
    logarithmic: bool,
) -> str:
    with figure(*SIZE) as drawn:
        ax = drawn.subplots()
        _curves(ax, curves, chart)
        if edges is not None:
            _edges(ax, edges)
            _named(ax, curves, "ball")
            _named(ax, edges, "edge")
        ax.set(
            xlabel=xlabel, ylabel="error of the force read  (%)", xlim=(curves.along[0], curves.along[-1]), ylim=ylim
        )
        if logarithmic:
            ax.set_xscale("log")
            plain_ticks(ax.xaxis)
        legend_above(ax, columns=1)
        return svg(drawn)


def _curves(ax: Any, curves: ErrorCurves, chart: ContactChart) -> None:
    """One curve a driving pressure, and the line of no error."""
    ax.axhline(0.0, color=INK, lw=0.6, zorder=1)
    states = zip(chart.driving_pressures_kPa, chart.rises_kPa, curves.errors_percent, _LOOKS, strict=False)
    for pressure_kPa, rises_kPa, errors_percent, look in states:
        label = f"driven at {pressure_kPa:g} kPa, pressure rise {rises_kPa[0]:.3g} kPa"
        ax.plot(curves.along, errors_percent, lw=1.6, label=label, **look)


def _edges(ax: Any, curves: ErrorCurves) -> None:
    """Draw the curves of edges, marked."""
    for errors_percent, look in zip(curves.errors_percent, _LOOKS, strict=False):
        marks: dict[str, Any] = {"marker": MARKERS[0], "ms": 3.2, "mfc": "white", "mew": 0.8, "markevery": _MARKED}
        ax.plot(curves.along, errors_percent, lw=0.9, **marks, **look)


def _named(ax: Any, curves: ErrorCurves, name: str) -> None:
    """Write the name of the pressing object next to the curve of the lowest driving pressure."""
    errors_percent = curves.errors_percent[0]
    known = np.flatnonzero(np.isfinite(errors_percent))
    if known.size:
        at = known[known.size // 3]
        note(ax, name, (float(curves.along[at]), float(errors_percent[at])), (0.5, 1.0))


def contact_section(chart: ContactChart | str | None) -> dict[str, Any]:
    """The section as plain data; ``why`` stands alone where the table does not cover the sensor."""
    if chart is None or isinstance(chart, str):
        return {"known": False, "why": chart or ""}
    head = ["Contact"]
    for pressure_kPa, rises_kPa in zip(chart.driving_pressures_kPa, chart.rises_kPa, strict=True):
        head += [f"{pressure_kPa:g} kPa,\nrise {rise_kPa:.3g} kPa" for rise_kPa in rises_kPa]
    rows = [[_label(row), *(_cell(error) for state in row.errors_percent for error in state)] for row in chart.rows]
    return {"known": True, "head": head, "rows": rows, "caption": _caption(chart), "notes": _notes(chart)}


def _label(row: ContactRow) -> str:
    if row.radius is None:
        return f"plate, tilted by {row.tilt_deg:g}°"
    middle = "across the pole" if row.kind == "edge" else "central"
    place = f"{row.offset:.3g} mm off the axis" if row.offset else middle
    return f"{row.kind} of {row.radius:.3g} mm radius, {place}"


def _cell(error_percent: float | None) -> str:
    return DASH if error_percent is None else f"{error_percent:+.0f} %"


def _caption(chart: ContactChart) -> str:
    return (
        "Error of the force that is read from the pressure rise by the curve of the central plate, without friction: "
        "positive where the reading states more than the true force. The charts are at the first pressure rise of the "
        f"table; with marks: the edge of a bar rounded to the radius; middle chart: radius {chart.ball_radius:.3g} mm. "
        f"{DASH}: within 0.75 R0 of travel, or before an event, the object does not reach that reading."
    )


def _notes(chart: ContactChart) -> list[str]:
    shares = " and ".join(
        f"{u:.0%} at {pressure_kPa:g} kPa"
        for u, pressure_kPa in zip(chart.standard_uncertainties, chart.driving_pressures_kPa, strict=True)
    )
    return [
        f"Where object and place of contact are not known they add a standard uncertainty of {shares} to the "
        "sensitivity. It is part of the interval only where the design states contact.anywhere.",
        "Assumed for it: a ball of 0.3 R0 radius or more (curvature even), its axis anywhere in the disc of 0.6 R0; a "
        "plate tilted by up to 20°. Edges are off by less.",
        f"A level plate may stand {chart.free_offset:.1f} mm off the axis without effect: the contact stays inside its "
        "edge.",
    ]
