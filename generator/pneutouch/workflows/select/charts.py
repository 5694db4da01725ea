"""Charts of a selection: the trade-off at its target, and the range over which the chosen design can be tuned."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from pneutouch.catalogue import Library
from pneutouch.evaluation.charts import curve, interval
from pneutouch.evaluation.sheet_data import ChartPoint, SensitivityCurve, TradeOff, TuningChart
from pneutouch.output.files import CHARTS_MANIFEST, check_own, replace_own
from pneutouch.report.chart import Chart, drawn_svg
from pneutouch.report.prose import front_error
from pneutouch.report.tradeoff import tradeoff_panel, tuning_panel
from pneutouch.selection import Candidate
from pneutouch.selection.front import TradeOffFront, contact_front, front
from pneutouch.selection.problem import SelectionProblem
from pneutouch.spec.material import Material
from pneutouch.units import KPA
from pneutouch.workflows.select.checks import CandidateSolver, contact_text
from pneutouch.workflows.select.select import SelectionRun

_SIZE = (130.0, 90.0)
"""Width and height of a chart, mm."""

_SOLVED, _LEAST = 9, 2
"""Number of driving pressures of a tuning curve by the solid, and least number of them with figures."""

_DESIGNS = 5
"""Greatest number of designs on the trade-off, and of resins on the tuning chart."""


TRADE_OFF, TUNING = "trade-off.svg", "tuning.svg"


def check_charts(folder: Path) -> None:
    """Raise InputError if a chart in ``folder`` is not as it was written."""
    check_own((folder / TRADE_OFF, folder / TUNING), folder / CHARTS_MANIFEST, "charts")


def write_charts(
    selection: SelectionRun, folder: Path, chosen: Candidate | None = None, library: Library | None = None
) -> list[Path]:
    """Write ``trade-off.svg``, and ``tuning.svg`` for ``chosen`` (None: the best design), if there is a design.

    Returns the paths of the files.

    Raises InputError if the folder cannot be written, or if a chart there is not as it was written."""
    library = library or Library.default()
    charts = {TRADE_OFF: drawn_svg(Chart((tradeoff_panel(tradeoff(selection, library)),), _SIZE))}
    chart = tuning(selection, library, chosen)
    if chart is not None:
        charts[TUNING] = drawn_svg(Chart((tuning_panel(chart),), _SIZE))
    files = {folder / name: text.encode() for name, text in charts.items()}
    replace_own(files, folder / CHARTS_MANIFEST, "charts")
    return list(files)


def tradeoff(selection: SelectionRun, library: Library | None = None) -> TradeOff:
    """Trade-off at the target's driving pressure, else at the best design's: fronts, the target's window, designs in
    it.

    Under a contact that the atlas does not cover the fronts are the atlas's, corrected by the solid along them."""
    problem, designs = selection.problem, _best(selection)
    pressure = problem.driving_pressure
    if pressure is None:
        pressure = float(designs[0].pool.pressure[0]) if designs else 0.0
    target_kPa_per_N = problem.sensitivity
    # Of a mix the fronts of the designs' own fractions: those of all that were tried lie side by side.
    mixed = any(resin.grade is not None for resin in problem.resins)
    resins = tuple(choice.resin for choice in designs) if mixed and designs else problem.resins
    problem = replace(problem, driving_pressure=pressure, resins=resins)
    fronts, errors, caption = _fronts(selection, problem, library or Library.default())
    return TradeOff(
        tuple(fronts),
        pressure / KPA,
        (problem.gauge_limit - pressure) / KPA,
        tuple(_spot(rank, choice) for rank, choice in enumerate(designs, start=1)),
        None
        if target_kPa_per_N is None
        else (target_kPa_per_N * (1 - problem.tolerance), target_kPa_per_N * (1 + problem.tolerance)),
        problem.force_range,
        caption,
        errors,
    )


def _fronts(
    selection: SelectionRun, problem: SelectionProblem, library: Library
) -> tuple[list[TradeOffFront], tuple[float, float] | None, str]:
    """Fronts, their median and greatest error (None by the atlas), and a caption; corrected where the solid
    searched."""
    if selection.by_solid is None:
        return front(problem), None, ""
    drawn = contact_front(problem, CandidateSolver(selection.base, selection.assignments, library))
    errors = drawn.median_error, drawn.greatest_error
    stated = f"curves: atlas corrected by the solid, {front_error(errors)}"
    return drawn.fronts, errors, f"{contact_text(selection.base)}; points: solid\n{stated}"


def tuning(selection: SelectionRun, library: Library, chosen: Candidate | None = None) -> TuningChart | None:
    """Sensitivity over driving pressure, to the rated one, of ``chosen`` (None: the best) and other resins; or None."""
    designs = _best(selection)
    if not designs:
        return None
    chosen = chosen or designs[0]
    if chosen.contact is not None:
        return _tuned_by_solid(selection, library, chosen)
    material = chosen.resin.material
    drawn = curve(selection.sensor_of(chosen), chosen.rated, material.title)
    if drawn is None:
        return None
    low, high = interval(
        selection.sensor_of(chosen),
        drawn,
        material,
        list(library.all("materials", Material).values()),
        selection.base.printer,
        "atlas",
    )
    others = (
        curve(selection.sensor_of(choice), min(choice.rated, chosen.rated), choice.resin.material.title)
        for choice in designs
        if choice.resin.name != chosen.resin.name
    )
    return TuningChart(drawn, low, high, _working(chosen), tuple(other for other in others if other is not None))


def _tuned_by_solid(selection: SelectionRun, library: Library, chosen: Candidate) -> TuningChart | None:
    """Curve of a design under a contact that the atlas does not cover, its interval if known; or None."""
    solve = CandidateSolver(selection.base, selection.assignments, library)
    pressures = np.unique([*np.linspace(0.0, chosen.rated, _SOLVED), float(chosen.pool.pressure[0])])
    states = [state for state in solve(chosen.resin, chosen.pool, pressures.tolist()).states if state.figures]
    if len(states) < _LEAST:
        return None
    at_kPa = np.array([state.driving_pressure for state in states]) / KPA
    solved_kPa_per_N = np.array([state.figures.sensitivity for state in states if state.figures])
    drawn = SensitivityCurve(at_kPa, solved_kPa_per_N, "solid", chosen.resin.material.title)
    caption = f"{contact_text(selection.base)}: by the solid"
    low, high = solve.interval(chosen.resin, chosen.pool, drawn, states) or (None, None)
    return TuningChart(drawn, low, high, _working(chosen), caption=caption)


def _working(chosen: Candidate) -> dict[float, float]:
    """Driving pressure (kPa) that a design is for, and its sensitivity there (kPa/N), as a dictionary."""
    return {float(chosen.pool.pressure[0]) / KPA: chosen.pool.figures.sensitivity}


def _best(selection: SelectionRun) -> list[Candidate]:
    """Best design of each resin, the best resin first, `_DESIGNS` at most."""
    first: dict[str, Candidate] = {}
    for choice in selection.answer.designs:
        first.setdefault(choice.resin.name, choice)
    return list(first.values())[:_DESIGNS]


def _spot(rank: int, choice: Candidate) -> ChartPoint:
    title, figures = choice.resin.material.title, choice.pool.figures
    return ChartPoint(title, f"{rank}  {title}, {figures.reach:.3g} N", figures)
