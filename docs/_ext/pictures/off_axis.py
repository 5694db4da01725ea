"""The chart of docs/background/off-axis.md: the error of the force read under other contacts."""

from __future__ import annotations

from pneutouch.evaluation import evaluate
from pneutouch.evaluation.anywhere import contact_chart
from pneutouch.evaluation.sheet_data import ContactChart, ContactRow
from pneutouch.report.style import ACCENT, FAINT, INK, MARKERS, figure, svg


def errors() -> ContactChart:
    """The table of the paper's sensor in TangoPlus at 0 and 22 kPa."""
    solved = evaluate("paper-dome", {"pneumatics.driving_pressures_kPa": [0, 22]}, model="atlas")
    found = contact_chart(solved.prediction, solved.sensor)
    assert isinstance(found, ContactChart)
    return found


def chart() -> str:
    """One row a contact, one mark a driving pressure."""
    found = errors()
    with figure(150, 84) as drawn:
        ax = drawn.subplots()
        rows = list(reversed(found.rows))
        for k, (pressure_kPa, rises_kPa) in enumerate(zip(found.driving_pressures_kPa, found.rises_kPa, strict=True)):
            values = [row.errors_percent[k][0] for row in rows]
            look = {"color": (INK, ACCENT)[k], "marker": MARKERS[k], "mfc": None if k == 0 else "white"}
            kept = [(value, place) for place, value in enumerate(values) if value is not None]
            driven = f"driven at {pressure_kPa:g} kPa, pressure rise {rises_kPa[0]:.1f} kPa"
            ax.plot(*zip(*kept, strict=True), ls="", ms=5, label=driven, **look)
        ax.set_yticks(range(len(rows)), [label(row) for row in rows])
        ax.axvline(0, color=INK, lw=0.8)
        ax.grid(axis="y", color=FAINT, lw=0.4)
        ax.set(xlabel="error of the force read  (%)", xlim=(-5, None))
        ax.legend(loc="lower right", fontsize=6.5)
        return svg(drawn)


def label(row: ContactRow) -> str:
    """A contact in words."""
    if row.radius is None:
        return f"plate tilted by {row.tilt_deg:g}°"
    place = "across the pole" if row.kind == "edge" else "central"
    if row.offset:
        place = f"{_millimetres(row.offset)} off the axis"
    return f"{row.kind} of {_millimetres(row.radius)}, {place}"


def _millimetres(length: float) -> str:
    """To a hundredth; halves go up, as on the page."""
    return f"{round(length + 1e-9, 2):g} mm"
