"""The datasheet's section on contact that is not central: charts, table and captions."""

from __future__ import annotations

from typing import Any

import numpy as np

from pneutouch.evaluation.chart_data import ContactChart, ContactRow, ErrorCurves
from pneutouch.report.style import ACCENT, INK, LINES, figure, legend_above, plain_ticks, svg

SIZE = (57.0, 58.0)
"""Width and height of a chart in mm: a third of the width of the text on A4."""

DASH = "–"

_LOGARITHMIC = "contact-radius"


def contact_figures(chart: ContactChart) -> dict[str, str]:
    """Error of the force read over the radius of a ball, its offset, and the tilt of a plate, as SVG by name; their
    vertical axes are the same."""
    charts = {
        "contact-radius": (chart.by_radius, "radius of a central ball  (mm)"),
        "contact-offset": (chart.by_offset, "offset of a ball from the axis  (mm)"),
        "contact-tilt": (chart.by_tilt, "tilt of a plate  (degrees)"),
    }
    errors = np.concatenate([np.ravel(curves.errors_percent) for curves, _ in charts.values()])
    low, high = (float(f(errors, initial=0.0, where=np.isfinite(errors))) for f in (np.min, np.max))
    margin = 0.05 * (high - low)
    return {
        name: _chart(curves, chart, xlabel=across, ylim=(low - margin, high + margin), logarithmic=name == _LOGARITHMIC)
        for name, (curves, across) in charts.items()
    }


def _chart(
    curves: ErrorCurves, chart: ContactChart, *, xlabel: str, ylim: tuple[float, float], logarithmic: bool
) -> str:
    with figure(*SIZE) as drawn:
        ax = drawn.subplots()
        _curves(ax, curves, chart)
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
    looks: tuple[dict[str, Any], ...] = ({"color": INK, "ls": LINES[0]}, {"color": ACCENT, "ls": LINES[1]})
    states = zip(chart.driving_pressures_kPa, chart.rises_kPa, curves.errors_percent, looks, strict=False)
    for pressure_kPa, rises_kPa, errors_percent, look in states:
        label = f"driven at {pressure_kPa:g} kPa, pressure rise {rises_kPa[0]:.3g} kPa"
        ax.plot(curves.along, errors_percent, lw=1.6, label=label, **look)


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
    place = f"{row.offset:.3g} mm off the axis" if row.offset else "central"
    return f"ball of {row.radius:.3g} mm radius, {place}"


def _cell(error_percent: float | None) -> str:
    return DASH if error_percent is None else f"{error_percent:+.0f} %"


def _caption(chart: ContactChart) -> str:
    return (
        "Error of the force that is read from the pressure rise by the curve of the central plate, without friction: "
        "positive where the reading states more than the true force. The charts are at the first pressure rise of the "
        f"table, the middle one for a ball of {chart.ball_radius:.3g} mm radius. {DASH}: within 0.75 R0 of travel, or "
        "before an event, the object does not reach that reading."
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
        "plate tilted by up to 20°.",
        f"A level plate may stand {chart.free_offset:.1f} mm off the axis without effect: the contact stays inside its "
        "edge.",
    ]
