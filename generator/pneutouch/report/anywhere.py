"""The datasheet's section on contact that is not central: charts, table and notes."""

from dataclasses import replace

import numpy as np

from pneutouch.evaluation.sheet_data import ContactChart, ContactRow, ErrorCurves
from pneutouch.report.blocks import Items, Plot, Plots, SheetBlock, SheetTable, Text, section
from pneutouch.report.chart import Chart, Note, Panel, PlotLine, drawn_svg
from pneutouch.report.numbers import DASH
from pneutouch.report.style import ACCENT, INK, LINES, MARKERS

_SIZE = (57.0, 58.0)
"""Width and height of a chart in mm: a third of the width of the text on A4."""

_LOOKS = (PlotLine(tone=INK, dashes=LINES[0], width=1.6), PlotLine(tone=ACCENT, dashes=LINES[1], width=1.6))
"""Line styles of the lowest and the highest driving pressure."""

_MARKED = 5
"""A marker is drawn at one in this many points of a curve."""


def contact_line(chart: ContactChart | str | None, rated_kPa: float) -> str:
    """Text for the first page: error of the reading under a central ball, and the uncertainty that an unknown contact
    adds, at driving pressures within the rated one; if ``chart`` is None or a reason, "Not stated" with the reason."""
    if chart is None or isinstance(chart, str):
        return f"Not stated: {chart or ''}."
    # Where no pressure is within the rating, the first stands for the design, as in the tiles.
    count = max(sum(pressure_kPa <= rated_kPa for pressure_kPa in chart.driving_pressures_kPa), 1)
    central = (row for row in chart.rows if row.kind == "ball" and not row.offset)
    balls = [row for row in central if row.errors_percent[count - 1][0] is not None]
    shares = " and ".join(f"±{100 * share:.0f} %" for share in chart.standard_uncertainties[:count])
    pressures = " and ".join(f"{pressure_kPa:g}" for pressure_kPa in chart.driving_pressures_kPa[:count])
    unknown = f"unknown place and object: {shares} (k = 1) at {pressures} kPa"
    if not balls:
        return f"{unknown[:1].upper()}{unknown[1:]}."
    ball, at = balls[len(balls) // 2], f"{chart.driving_pressures_kPa[count - 1]:g} kPa"
    return (
        f"Calibrated under a central plate. A central ball of {ball.radius:.3g} mm radius reads "
        f"{ball.errors_percent[count - 1][0]:+.0f} % at {at}; {unknown}. See the annex."
    )


def contact_section(chart: ContactChart | str | None) -> list[SheetBlock]:
    """Section with charts, table and notes; with the reason alone if ``chart`` is a reason or None."""
    title = "Contact that is not central"
    if chart is None or isinstance(chart, str):
        return section(title, Text(f"Not stated: {chart or ''}."))
    head = ["Contact"]
    for pressure_kPa, rises_kPa in zip(chart.driving_pressures_kPa, chart.rises_kPa, strict=True):
        head += [f"{pressure_kPa:g} kPa,\nrise {rise_kPa:.3g} kPa" for rise_kPa in rises_kPa]
    rows = [[_label(row), *(_cell(error) for state in row.errors_percent for error in state)] for row in chart.rows]
    plots = [Plot(drawn_svg(Chart((panel,), _SIZE, keys=1))) for panel in contact_panels(chart)]
    return section(
        title,
        Plots(plots, (1, 1, 1), _caption(chart)),
        SheetTable(rows, head, numeric=range(1, len(head))),
        Items(_notes(chart)),
    )


def contact_panels(chart: ContactChart) -> list[Panel]:
    """Three panels, equal in height, of the error of the force read: over radius, over offset, over tilt."""
    charts = (
        (chart.by_radius, chart.edges_by_radius, "radius, contact central  (mm)", "x"),
        (chart.by_offset, chart.edges_by_offset, "offset from the axis  (mm)", ""),
        (chart.by_tilt, None, "tilt of a plate  (degrees)", ""),
    )
    every = [curves for *both, _, _ in charts for curves in both if curves is not None]
    errors = np.concatenate([np.ravel(curves.errors_percent) for curves in every])
    low, high = (float(f(errors, initial=0.0, where=np.isfinite(errors))) for f in (np.min, np.max))
    margin = 0.05 * (high - low)
    words = [
        f"driven at {pressure_kPa:g} kPa, pressure rise {rises_kPa[0]:.3g} kPa"
        for pressure_kPa, rises_kPa in zip(chart.driving_pressures_kPa, chart.rises_kPa, strict=True)
    ]
    return [
        Panel(
            across,
            "error of the force read  (%)",
            (*_curves(curves, words), *(() if edges is None else _curves(edges))),
            () if edges is None else (*_named(curves, "ball"), *_named(edges, "edge")),
            xlim=(float(curves.along[0]), float(curves.along[-1])),
            ylim=(low - margin, high + margin),
            log=log,
            zero="y",
        )
        for curves, edges, across, log in charts
    ]


def _curves(curves: ErrorCurves, words: list[str] | None = None) -> list[PlotLine]:
    """One line for each driving pressure, labelled by ``words``; without them (edges of bars) thin with markers."""
    lines = [replace(look, x=curves.along, y=y) for y, look in zip(curves.errors_percent, _LOOKS, strict=False)]
    if words is None:
        return [replace(line, width=0.9, marker=MARKERS[0], every=_MARKED) for line in lines]
    return [replace(line, label=label) for line, label in zip(lines, words, strict=False)]


def _named(curves: ErrorCurves, name: str) -> list[Note]:
    """A note with the object's name at its curve for the lowest driving pressure; none if the curve is all NaN."""
    errors_percent = curves.errors_percent[0]
    known = np.flatnonzero(np.isfinite(errors_percent))
    if not known.size:
        return []
    at = known[known.size // 3]
    return [Note(name, (float(curves.along[at]), float(errors_percent[at])), (0.5, 1.0))]


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
