"""Charts of what the code gives today, in some seconds: theory, uncertainty, relaxation, ageing, grades, the line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.dynamics import states

from pictures import contact, off_axis
from pneutouch.arrays import Array, hermite
from pneutouch.catalogue import Library
from pneutouch.evaluation.evaluate import Evaluation, evaluate
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.line.transient import gain_at
from pneutouch.mechanics.membrane import LIMIT_HEIGHT, LIMIT_PRESSURE, RISING_BRANCH, relative_pressure
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.uncertainty import budget, document, model_errors
from pneutouch.mechanics.viscous.describe import LOOP_SPEEDS, RAMP_SPEED
from pneutouch.mechanics.viscous.prony import prony_series
from pneutouch.mechanics.viscous.runs import loop, relaxation
from pneutouch.report.chart import Chart, drawn_svg
from pneutouch.report.fit_charts import GainCurve, gain_panel
from pneutouch.report.style import ACCENT, FAINT, INK, LINES, MARKERS, MUTED, figure, legend_above, plain_ticks, svg
from pneutouch.spec.material import Material
from pneutouch.units import KPA

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ROOT = Path(__file__).resolve().parents[3]
DOCS = ROOT / "docs" / "background"

DRIVEN_kPa, PRESSED_mm = 22.0, 4.0
"""The states of the section in theory.md."""

GRADES = {
    "graded, 4.39 to 21.6 % VeroClear": {"from": "TangoPlus", "to": "VeroClear", "fraction": [0.0439, 0.216]},
    "19 % VeroClear": {"from": "TangoPlus", "to": "VeroClear", "fraction": 0.19},
    "TangoPlus": "TangoPlus",
}
"""The first selection of graded.md, the nearest constant mix and the soft resin, on a wall of 1.2 mm."""

SHARED = {
    "sensitivity_kPa_per_N": ("sensitivity", "kPa/N"),
    "stiffness_N_per_mm": ("stiffness", "N/mm"),
    "force_at_range_end_N": ("force at the end of the range", "N"),
    "limit_pressure_kPa": ("limit pressure", "kPa"),
}
NUMERICAL = {"sensitivity_kPa_per_N": 0.011, "limit_pressure_kPa": 0.002}
"""Numerical errors of the example in uncertainty.md."""

_LEAST_SHARE = 0.015
"""Smaller shares of a variance are drawn as one."""


def theory() -> str:
    """The wall unloaded, inflated and pressed; inflation pressure over apex height by three models."""
    changes = {"pneumatics.driving_pressures_kPa": [DRIVEN_kPa], "indentation.depth_mm": PRESSED_mm}
    solved = evaluate("paper-dome", changes, model="solid")
    with figure(180, 78) as drawn:
        left, right = drawn.subplots(1, 2, width_ratios=(1.3, 1.0))
        _sections(left, solved)
        _inflations(right, solved)
        return svg(drawn)


def _sections(ax: Axes, solved: Evaluation) -> None:
    """Half sections in the states 0, I and II, one next to the other."""
    dome, walls = solved.sensor.dome, solved.prediction.states[0].walls
    angle = np.linspace(0.0, 0.5 * np.pi, 60)
    rest = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    faces = (
        ("0", dome.inner_radius * rest, (dome.inner_radius + dome.wall_thickness) * rest, FAINT),
        ("I", walls.inner[0], walls.outer[0], "white"),
        ("II", walls.inner[-1], walls.outer[-1], "#8FB6CD"),
    )
    for k, (name, inner, outer, fill) in enumerate(faces):
        shift = 16.0 * k
        line = np.concatenate([inner, outer[::-1]])
        ax.fill(line[:, 0] + shift, line[:, 1], fc=fill, ec=INK, lw=0.8)
        ax.plot([shift, shift], [-1.0, 14.5], color=MUTED, lw=0.5, ls=LINES[3])
        ax.plot([shift, shift + 13.0], [0.0, 0.0], color=INK, lw=0.6)
        ax.text(shift + 6.0, -2.6, f"state {name}", ha="center", fontsize=7)
    top = float(walls.outer[-1][:, 1].max())
    ax.plot([32.0, 45.0], [top, top], color=INK, lw=1.8)
    ax.text(39.0, top + 0.5, "plate", ha="center", fontsize=6.5)
    ax.set(aspect="equal", xlim=(-1, 46), ylim=(-3.5, 15))
    ax.set_axis_off()


def _inflations(ax: Axes, solved: Evaluation) -> None:
    """Dimensionless pressure over the height of the inner apex: the cap, the exact membrane and the solid."""
    dome, curve, limit = solved.sensor.dome, solved.prediction.inflation, solved.prediction.limit_point
    scale = dome.inner_radius / (solved.sensor.wall.shear_modulus * dome.wall_thickness)
    x = np.linspace(1.0, 2.2, 200)
    exact = RISING_BRANCH[:, ::-1]
    lines = (
        ("membrane model", x, relative_pressure(x), (LIMIT_HEIGHT, LIMIT_PRESSURE), MUTED),
        ("exact membrane", *_smooth(exact), tuple(exact[-1]), INK),
        (
            f"solid, t0/R0 = {dome.wall_thickness / dome.inner_radius:.3f}",
            curve.apex_inner / dome.inner_radius,
            curve.pressure * scale,
            (limit.apex_inner / dome.inner_radius, limit.driving_pressure * scale),
            ACCENT,
        ),
    )
    for k, (label, height, pressure, top, colour) in enumerate(lines):
        ax.plot(height, pressure, color=colour, ls=LINES[(1, 4, 0)[k]], lw=(1.0, 1.2, 1.6)[k], label=label)
        ax.plot(*top, MARKERS[k], color=colour, ms=4)
    ax.set(xlabel="height of the inner apex / R0  (-)", ylabel="p R0/(μ t0)  (-)", xlim=(1.0, 2.2), ylim=(0.0, 1.7))
    ax.legend(loc="lower right")


def _smooth(points: Array) -> tuple[Array, Array]:
    """A fine curve through points (n, 2) in order of x, by differences of second order."""
    x, y = points.T
    fine = np.linspace(x[0], x[-1], 100)
    return fine, hermite(fine, x, y, np.gradient(y, x, edge_order=2))


def shares() -> dict[str, tuple[dict[str, float], float, float]]:
    """By figure: shares of the variance by source, lower and upper end; the paper's sensor in TangoPlus at 0 kPa."""
    library = Library((ROOT,))
    tango: Material = library.load("materials", "TangoPlus")
    errors = model_errors(tango, library.all("materials", Material).values())
    printer: Any = library.load("printers", "objet260-connex")
    batch = batch_of(material_sensor(tango), [0.0])
    figures = document(budget(batch, tango, printer, near_paper=True, errors=errors, numerical=NUMERICAL), 0).known
    return {key: (dict(figures[key].shares), figures[key].low, figures[key].high) for key in SHARED}


def uncertainty() -> str:
    """Stacked shares of the variance, one bar a figure, with the interval of each at its end."""
    known = shares()
    names = [name for parts, _, _ in known.values() for name, share in parts.items() if share >= _LEAST_SHARE]
    order = [*dict.fromkeys(names), "all others"]
    fills = (ACCENT, "#8FB6CD", "white", FAINT, MUTED, "#3D8FBF", "#E4E9ED", INK)
    hatches = ("", "", "///", "", "", "...", "", "")
    with figure(180, 66) as drawn:
        ax = drawn.add_subplot()
        for row, (parts, low, high) in enumerate(known.values()):
            left = 0.0
            for k, name in enumerate(order):
                share = 100 * parts.get(name, 0.0) if parts.get(name, 0.0) >= _LEAST_SHARE else 0.0
                share = 100.0 - left if name == order[-1] else share
                look = {"color": fills[k % len(fills)], "hatch": hatches[k % len(hatches)], "ec": INK, "lw": 0.5}
                ax.barh(row, share, 0.62, left=left, label=name if row == 0 else None, **look)
                left += share
            unit = list(SHARED.values())[row][1]
            ax.text(101.5, row, f"{low:.3g} to {high:.3g} {unit}", va="center", fontsize=6.5)
        ax.set_yticks(range(len(known)), [title for title, _ in SHARED.values()])
        ax.invert_yaxis()
        ax.grid(False)
        ax.set(xlabel="share of the variance  (%)", xlim=(0, 122), xticks=range(0, 101, 20))
        legend_above(ax)
        return svg(drawn)


def viscous() -> str:
    """Force and pressure rise of a held press, and a cycle, of the paper's dome in Agilus30 by all sources."""
    material: Material = Library((ROOT,)).load("materials", "Agilus30")
    sensor, series = material_sensor(material), prony_series(material)
    depth, driven = 0.5 * sensor.dome.inner_radius, [DRIVEN_kPa * KPA]
    held = relaxation(sensor, series, driven, depth, RAMP_SPEED)[0]
    cycles = loop(sensor, series, driven, depth, LOOP_SPEEDS[-1])[0]
    with figure(180, 78) as drawn:
        left, right = drawn.subplots(1, 2)
        for k, (run, cycle) in enumerate(zip(held, cycles, strict=True)):
            look = {"color": (ACCENT, INK, MUTED)[k], "lw": 1.4}
            at = int(np.argmin(np.abs(run.times - 1.0)))
            left.plot(run.times, 100 * run.force / run.force[at], label=f"data {'ABC'[k]}", **look)
            left.plot(run.times, 100 * run.rise / run.rise[at], ls=LINES[1], **look)
            right.plot(cycle.force_in, cycle.rise_in / KPA, **look)
            right.plot(cycle.force_out, cycle.rise_out / KPA, ls=LINES[1], **look)
        left.set(
            xlabel="time since the press  (s)", ylabel="share of the value at 1 s  (%)", xscale="log", ylim=(0, None)
        )
        left.set_xlim(0.01, 600.0)
        plain_ticks(left.xaxis)
        right.set(xlabel="contact force  (N)", ylabel="pressure rise  (kPa)", xlim=(0, None), ylim=(0, None))
        legend_above(left)
        return svg(drawn)


def ageing() -> str:
    """Change of the sensitivity in a year from the hardness and as measured, as the table of the page has them."""
    page = (DOCS / "ageing.md").read_text(encoding="utf-8")
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in page.splitlines() if line[:1] == "|"]
    changes = {row[0]: [float(row[k].strip(" %")) for k in (4, 5)] for row in rows[2:]}
    with figure(120, 66) as drawn:
        ax = drawn.add_subplot()
        for place, pair in enumerate(changes.values()):
            for k, value in enumerate(pair):
                look = {"color": (ACCENT, "white")[k], "ec": INK, "lw": 0.8}
                label = ("from the hardness", "measured")[k] if place == 0 else None
                ax.bar(place + 0.4 * (k - 0.5), value, 0.36, label=label, **look)
                ax.text(place + 0.4 * (k - 0.5), value + 0.6, f"{value:.1f} %", ha="center", fontsize=6.5)
        ax.set_xticks(range(len(changes)), list(changes))
        ax.grid(False, axis="x")
        ax.set(ylabel="change of the sensitivity in a year  (%)", ylim=(0, 40))
        legend_above(ax)
        return svg(drawn)


def graded() -> str:
    """Sensitivity over driving pressure of a graded wall, of the nearest constant mix and of the soft resin."""
    pressures_kPa = [0.0, 5.5, 11.0, 16.5, 22.0]
    with figure(120, 76) as drawn:
        ax = drawn.add_subplot()
        for k, (label, material) in enumerate(GRADES.items()):
            changes = {
                "membrane.wall_thickness_mm": 1.2,
                "membrane.material": material,
                "print.profile": "j735",
                "pneumatics.driving_pressures_kPa": pressures_kPa,
            }
            states = evaluate("paper-dome", changes, model="solid").prediction.states
            values = [state.figures.sensitivity for state in states]
            ax.plot(
                pressures_kPa, values, color=(ACCENT, INK, MUTED)[k], ls=LINES[k], marker=MARKERS[k], ms=4, label=label
            )
        ax.set(xlabel="driving pressure  (kPa)", ylabel="sensitivity  (kPa/N)", xlim=(0, 22.5), ylim=(1.5, 2.55))
        legend_above(ax)
        return svg(drawn)


def dynamics() -> str:
    """The gain over frequency for three lengths of the tube."""
    frequency = np.geomspace(0.1, 2000.0, 600)
    known = states().items()
    gains = [GainCurve(f"{length:g} mm", frequency, gain_at(s.dynamics, frequency)) for length, s in known]
    return drawn_svg(Chart((gain_panel(gains),), (150.0, 80.0)))


CHARTS: dict[str, Callable[[], str]] = {
    "theory": theory,
    "uncertainty": uncertainty,
    "viscous": viscous,
    "ageing": ageing,
    "graded": graded,
    "dynamics": dynamics,
    "contact": contact.chart,
    "off-axis": off_axis.chart,
}
