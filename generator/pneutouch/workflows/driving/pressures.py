"""Figures of a sensor over the driving pressure, pressures that give a required value, and a measured leak."""

import json
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.coupons import CouponFindings, ReadingSource, leak
from pneutouch.bench.figures import line_figures
from pneutouch.catalogue import DesignSource, Library
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import Evaluation, evaluate
from pneutouch.evaluation.uncertainty import uncertainties
from pneutouch.formats import check_format
from pneutouch.mechanics import SensorPrediction, SensorState, predict
from pneutouch.mechanics.sealed_gas import SealedGas, conductance_of_cap
from pneutouch.parts import Assembly
from pneutouch.results.uncertainty import UncertaintyRecord
from pneutouch.spec.coupon import LeakCap, read_results
from pneutouch.spec.files import read_bytes
from pneutouch.spec.read import Changes
from pneutouch.spec.tasks import TASK_FIGURES
from pneutouch.units import KPA

BUDGET_KEYS = {"force_range_N": "force_at_range_end_N"}
"""For figures whose key in the uncertainty differs from that in a task: the former by the latter."""

_TOP = 0.98
"""Share of the least nominal limit up to which figures are computed: they end at the limit point itself."""

_POINTS = {"atlas": 33, "local": 33, "membrane": 33}
_FEW = 13
"""Numbers of driving pressures: for models that take microseconds, by name, and for models that take a second."""

_BUDGETS = 7
"""Number of driving pressures at which the uncertainty is computed; it varies slowly between them."""

ReachProgress = Callable[[int, int, str], None]


@dataclass
class ReachCurves:
    """A sensor at n driving pressures, rising.

    Attributes:
        evaluation: Evaluation of the design at a driving pressure of 0.
        model: Name of the model of all states.
        states: States at ascending driving pressures; `add` inserts one.
        budgets: Driving pressures (MPa) and the records of the uncertainty there.
        solved: States computed one by one, by driving pressure (MPa)."""

    evaluation: Evaluation
    model: str
    states: list[SensorState]
    budgets: list[tuple[float, UncertaintyRecord]] = field(default_factory=list)
    solved: dict[float, SensorState] = field(default_factory=dict)

    @property
    def pressures(self) -> Array:
        """Driving pressures, MPa (n,)."""
        return np.array([state.driving_pressure for state in self.states])

    def values(self, figure: str) -> Array:
        """A figure by its key at every driving pressure, (n,), in the figure's unit; NaN where a state has none."""
        return np.array([figure_of(state, figure) for state in self.states])

    def widths(self, figure: str) -> Array:
        """Expanded uncertainty (k = 2) of a figure's logarithm at every driving pressure, (n,); NaN if not known.

        That of a calibrated sensor is at the age of its calibration."""
        key = BUDGET_KEYS.get(figure, figure)
        found = ((pressure, entry.known[key]) for pressure, entry in self.budgets if key in entry.known)
        known = [(pressure, record.at_calibration or record) for pressure, record in found]
        if not known:
            return np.full(len(self.states), np.nan)
        at, width = np.array([(pressure, 0.5 * np.log(ends.high / ends.low)) for pressure, ends in known]).T
        return np.asarray(np.interp(self.pressures, at, width))

    @property
    def gas(self) -> SealedGas:
        """Gas in the sensor at every driving pressure."""
        sensor = self.evaluation.sensor
        volumes = np.array([state.cavity_volume for state in self.states])
        return SealedGas(self.pressures, volumes, sensor.gas.dead_volume, sensor.gas.ambient_pressure, volumes[0])

    def predicted(self, pressures: list[float]) -> SensorPrediction:
        """The prediction at ascending driving pressures, MPa; without sway, which changes no figure."""
        options, sensor = self.evaluation.options, self.evaluation.sensor.replace(waves=0)
        return predict(self.evaluation.scene.name, sensor, pressures, model=self.model, closure=options.closure)

    def at(self, pressure: float) -> SensorState:
        """The state at a driving pressure (MPa), computed once."""
        if pressure not in self.solved:
            (self.solved[pressure],) = self.predicted([pressure]).states
        return self.solved[pressure]

    def add(self, pressure: float) -> SensorState:
        """The state at a driving pressure (MPa), computed and inserted if it is missing."""
        k = int(np.searchsorted(self.pressures, pressure))
        if k == len(self.states) or self.states[k].driving_pressure != pressure:
            self.states.insert(k, self.at(pressure))
        return self.states[k]


def figure_of(state: SensorState, figure: str) -> float:
    """A figure by its key in a task, in the figure's unit; NaN if the state has no figures."""
    return float("nan") if state.figures is None else line_figures(state.figures)[figure]


def reach_curves(
    design: str | DesignSource,
    changes: Changes,
    *,
    library: Library | None = None,
    model: str = "auto",
    progress: ReachProgress = lambda done, total, what: None,
    **options: object,
) -> ReachCurves:
    """Evaluate a design from 0 up to nearly its least limit, whatever driving pressures it lists.

    At a local extremum of a figure the pressure at the vertex of a parabola is added, so that the ends of the reachable
    values are met. Raises what `evaluate` does.
    """
    vented = {**changes, "pneumatics.driving_pressures_kPa": [0.0]}
    progress(0, 3, "evaluating the vented sensor")
    evaluation = evaluate(design, vented, library=library, model=model, **options)  # type: ignore[arg-type]
    top = _TOP * evaluation.prediction.limits.lowest
    progress(1, 3, "predicting over the driving pressures")
    chosen, asked = evaluation.prediction.model, evaluation.options
    if asked.model == "auto":
        known = evaluation.scene.name, evaluation.sensor, [0.0, 0.5 * top, top]
        chosen = predict(*known, model="auto", closure=asked.closure, tolerance=asked.tolerance).model
    curves = ReachCurves(evaluation, chosen, [])
    grid = np.linspace(0.0, top, _POINTS.get(chosen, _FEW))
    prediction = curves.predicted(grid.tolist())
    curves.states = list(prediction.states)
    progress(2, 3, "computing the uncertainty")
    some = np.unique(np.linspace(0, len(grid) - 1, _BUDGETS).round().astype(int))
    few = replace(prediction, states=tuple(prediction.states[k] for k in some))
    entries = uncertainties(few, evaluation.sensor, evaluation.scene, lambda: evaluation.resins)
    curves.budgets = [(state.driving_pressure, entry) for state, entry in zip(few.states, entries, strict=True)]
    if 0.0 < evaluation.rating.pressure < top:
        curves.add(evaluation.rating.pressure)
    for figure in TASK_FIGURES.values():
        for pressure in _extrema(curves.pressures, curves.values(figure)):
            curves.add(pressure)
    progress(3, 3, "solving for the driving pressures")
    return curves


def _extrema(pressures: Array, values: Array) -> list[float]:
    """Pressures at the vertices of the parabolas through each interior local extremum and its neighbours."""
    vertices = []
    for k in range(1, len(values) - 1):
        below, at, above = values[k - 1 : k + 2]
        if not (at - below) * (above - at) < 0:
            continue
        left, right = pressures[k] - pressures[k - 1], pressures[k + 1] - pressures[k]
        slope_left, slope_right = (at - below) / left, (above - at) / right
        share = slope_left / (slope_left - slope_right)
        middle = 0.5 * (pressures[k - 1] + pressures[k])
        vertices.append(float(middle + share * 0.5 * (left + right)))
    return vertices


_EXACT = 1e-6
"""Relative distance to the required value below which a solution is accepted."""

_TRIES = 40

_JUMPED = 1e-3
"""Relative distance above which a bracketed crossing is a jump of the figure, not a solution."""


@dataclass(frozen=True)
class PressureBand:
    """Driving pressures (MPa) at which the k = 2 interval of the figure holds the required value.

    ``open_low``, ``open_high``: True if the band ends at 0, or at the highest pressure computed.
    """

    low: float
    high: float
    open_low: bool
    open_high: bool


@dataclass(frozen=True)
class DrivingSolution:
    """State whose figure has the required value; ``band`` is None if the uncertainty is not known."""

    state: SensorState
    band: PressureBand | None


def solutions(curves: ReachCurves, figure: str, value: float) -> list[DrivingSolution]:
    """All driving pressures at which a figure has a value, ascending, solved in every bracket of computed states."""
    pressures, values = curves.pressures, curves.values(figure)
    roots: list[float] = []
    for k in range(len(pressures)):
        if abs(values[k] - value) <= _EXACT * value:
            roots.append(float(pressures[k]))
        elif k + 1 < len(pressures) and (values[k] - value) * (values[k + 1] - value) < 0:
            if abs(values[k + 1] - value) <= _EXACT * value:
                continue
            root = _root(curves, figure, value, (float(pressures[k]), float(pressures[k + 1])))
            roots += [] if root is None else [root]
    states = [curves.add(pressure) for pressure in roots]
    return [DrivingSolution(state, band(curves, figure, value, state.driving_pressure)) for state in states]


def _root(curves: ReachCurves, figure: str, value: float, ends: tuple[float, float]) -> float | None:
    """Pressure between two ends at which the model gives the value (Illinois method); None if the figure jumps."""
    low, high = ends
    off_low, off_high = (figure_of(curves.add(end), figure) / value - 1.0 for end in ends)
    middle = off = np.nan
    for _ in range(_TRIES):
        middle = high - off_high * (high - low) / (off_high - off_low)
        off = figure_of(curves.at(middle), figure) / value - 1.0
        if np.isnan(off) or abs(off) <= _EXACT or abs(high - low) <= _EXACT * high:
            break
        if off * off_high < 0:
            low, off_low = high, off_high
        else:
            off_low *= 0.5
        high, off_high = middle, off
    return float(middle) if abs(off) <= _JUMPED else None


def band(curves: ReachCurves, figure: str, value: float, near: float) -> PressureBand | None:
    """Band about a driving pressure (MPa); None if the uncertainty of the figure is not known.

    With f the predicted figure and w the expanded uncertainty of its logarithm, the band is where \\|ln(f/value)\\| <=
    w.
    """
    pressures, excess = curves.pressures, _excess(curves, figure, value)
    at = int(np.argmin(np.abs(pressures - near)))
    if not excess[at] <= 0.0:
        return None
    low = high = at
    while low > 0 and excess[low - 1] <= 0.0:
        low -= 1
    while high + 1 < len(pressures) and excess[high + 1] <= 0.0:
        high += 1
    ends = (_crossing(pressures, excess, low, low - 1), _crossing(pressures, excess, high, high + 1))
    return PressureBand(ends[0], ends[1], open_low=low == 0, open_high=high == len(pressures) - 1)


def possible(curves: ReachCurves, figure: str, value: float) -> PressureBand | None:
    """Lowest band of driving pressures where the figure may have the value within its uncertainty; else None."""
    inside = np.flatnonzero(_excess(curves, figure, value) <= 0.0)
    return None if inside.size == 0 else band(curves, figure, value, float(curves.pressures[inside[0]]))


def _excess(curves: ReachCurves, figure: str, value: float) -> Array:
    """Distance in ln by which the value lies outside the figure's interval, (n,); NaN if either is not known."""
    return np.asarray(np.abs(np.log(curves.values(figure) / value)) - curves.widths(figure))


def _crossing(pressures: Array, excess: Array, inside: int, outside: int) -> float:
    """Pressure at which the excess is zero between two states; that of ``inside`` if the other has no figure."""
    if not 0 <= outside < len(pressures) or np.isnan(excess[outside]):
        return float(pressures[inside])
    share = excess[inside] / (excess[inside] - excess[outside])
    return float(pressures[inside] + share * (pressures[outside] - pressures[inside]))


_MOST_BYTES = 100_000_000


@dataclass(frozen=True)
class LeakSource:
    """A measured leak: fall of the pressure in kPa/min at a gauge pressure in kPa, and ``where``, its file.

    ``cap``: True behind the leak-test cap, in the gas of connector and tube alone; False on the sensor itself.
    """

    rate_kPa_per_min: float
    pressure_kPa: float
    cap: bool
    where: str

    def conductance(self, gas: SealedGas, assembly: Assembly) -> float:
        """Conductance of the leak, mm3/s; see `mechanics.sealed_gas`."""
        rate = self.rate_kPa_per_min * KPA / 60.0
        if self.cap:
            volume = gas.dead_volume or assembly.internal_volume + assembly.tube_volume
        else:
            volume = float(np.interp(self.pressure_kPa * KPA, gas.pressure, gas.capacity))
        return max(0.0, conductance_of_cap(rate, self.pressure_kPa * KPA, volume, gas.ambient))


def read_leak(path: Path, design: str) -> LeakSource:
    """Leak of a design from a results file of coupons (TOML), or from a folder or figures.json of `characterize`.

    Raises InputError for other files, for another design, and if no leak was measured.
    """
    if path.is_dir():
        path = path / "figures.json"
    return _of_campaign(path, design) if path.suffix.lower() == ".json" else _of_cap(path, design)


def _of_cap(path: Path, design: str) -> LeakSource:
    results = read_results(path)
    cap: LeakCap | None = results.leak_cap.get(design)
    if cap is None:
        known = ", ".join(results.leak_cap)
        remedy = f"it holds leak-cap of {known}" if known else "measure the coupon leak-cap: docs/howto/coupons.md"
        raise InputError("no leak of this design", file=path, key=f"leak-cap.{design}", remedy=remedy)
    findings = CouponFindings()
    try:
        leak(design, cap, 0.0, ReadingSource(str(path), results.lab, results.date), findings)
    except ValueError as error:
        raise InputError(str(error), file=path, key=f"leak-cap.{design}.start_kPa") from None
    if not findings.figures:
        raise InputError("empty", file=path, key=f"leak-cap.{design}.start_kPa", remedy="fill in the readings")
    mean_kPa = float(np.mean(cap.start_kPa + cap.end_kPa))
    if mean_kPa <= 0:
        raise InputError("no pressure to lose", file=path, key=f"leak-cap.{design}.start_kPa", value=cap.start_kPa)
    return LeakSource(findings.figures[0].value, mean_kPa, True, f"leak-cap in {path}")


def _of_campaign(path: Path, design: str) -> LeakSource:
    try:
        content: Any = json.loads(read_bytes(path, _MOST_BYTES, "figures.json"))
        check_format("figures", content, path)
        measured, rows = content["design"], [row for row in content["injections"] if row["unit"] == "kPa/min"]
        rates = [(float(row["value"]), float(row["figure"].split(",")[1].split()[0])) for row in rows]
    except (ValueError, KeyError, TypeError, AttributeError, IndexError, OverflowError, RecursionError):
        raise InputError("not as characterize writes it", file=path, remedy="give a folder of its results") from None
    if measured != design:
        raise InputError(f"measured {measured}, not this design", file=path, key="design", value=measured)
    if not np.isfinite(rates).all():
        raise InputError("a leak that is no finite number", file=path, key="injections", remedy="characterize again")
    rates = [(rate, pressure_kPa) for rate, pressure_kPa in rates if pressure_kPa > 0]
    if not rates:
        raise InputError("holds no leak run above 0 kPa", file=path, remedy="plan one: docs/howto/measuring.md")
    # The conductance is rate over pressure: its mean over the runs at their mean pressure.
    mean_kPa = float(np.mean([pressure_kPa for _, pressure_kPa in rates]))
    share = float(np.mean([rate / pressure_kPa for rate, pressure_kPa in rates]))
    return LeakSource(share * mean_kPa, mean_kPa, False, f"leak runs in {path}")
