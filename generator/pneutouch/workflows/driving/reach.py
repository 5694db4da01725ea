"""The figures of a sensor over the driving pressure, from vented to just below its least limit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.catalogue import DesignSource, Library
from pneutouch.evaluation.evaluate import Evaluation, evaluate
from pneutouch.evaluation.uncertainty import documents
from pneutouch.mechanics import SensorPrediction, SensorState, predict
from pneutouch.mechanics.sealed_gas import SealedGas
from pneutouch.mechanics.uncertainty.record import UncertaintyRecord
from pneutouch.spec.read import Changes
from pneutouch.spec.tasks import TASK_FIGURES

BUDGET_KEYS = {"force_range_N": "force_at_range_end_N"}
"""Keys of the budget whose figures have another key in a task."""

_TOP = 0.98
"""Share of the least nominal limit up to which the figures are computed: at the limit point itself they end."""

_POINTS = {"atlas": 33, "membrane": 33}
_FEW = 13
"""Driving pressures at which the models of microseconds are evaluated, and those of a second."""

_BUDGETS = 7
"""Driving pressures at which the uncertainty is computed; it changes slowly between them."""

ReachProgress = Callable[[int, int, str], None]


@dataclass
class ReachCurves:
    """A sensor at n driving pressures, rising.

    Attributes:
        evaluation: The vented sensor.
        model: The model of all states.
        states: The states in order of driving pressure; `add` inserts one.
        budgets: Driving pressures (MPa) and the documents of the uncertainty there.
    """

    evaluation: Evaluation
    model: str
    states: list[SensorState]
    budgets: list[tuple[float, UncertaintyRecord]] = field(default_factory=list)

    @property
    def pressures(self) -> Array:
        """Driving pressures, MPa (n,)."""
        return np.array([state.driving_pressure for state in self.states])

    def values(self, figure: str) -> Array:
        """A figure by its key at every driving pressure, in its unit (n,); NaN for a missing one."""
        return np.array([figure_of(state, figure) for state in self.states])

    def widths(self, figure: str) -> Array:
        """Expanded uncertainty (k = 2) of the logarithm of a figure at every driving pressure (n,); NaN: not known."""
        key = BUDGET_KEYS.get(figure, figure)
        known = [
            (pressure, 2.0 * entry["figures"][key]["standard_uncertainty_relative"])
            for pressure, entry in self.budgets
            if key in entry.get("figures", {})
        ]
        if not known:
            return np.full(len(self.states), np.nan)
        at, width = np.array(known).T
        return np.asarray(np.interp(self.pressures, at, width))

    @property
    def gas(self) -> SealedGas:
        """The gas at every driving pressure."""
        sensor = self.evaluation.sensor
        volumes = np.array([state.cavity_volume for state in self.states])
        return SealedGas(self.pressures, volumes, sensor.gas.dead_volume, sensor.gas.ambient_pressure, volumes[0])

    def predicted(self, pressures: list[float]) -> SensorPrediction:
        """The prediction at ascending driving pressures, MPa."""
        options, scene = self.evaluation.options, self.evaluation.scene
        return predict(scene.name, self.evaluation.sensor, pressures, model=self.model, closure=options.closure)

    def add(self, pressure: float) -> SensorState:
        """The state at a driving pressure (MPa); it is kept."""
        k = int(np.searchsorted(self.pressures, pressure))
        if k == len(self.states) or self.states[k].driving_pressure != pressure:
            self.states.insert(k, self.predicted([pressure]).states[0])
        return self.states[k]


def figure_of(state: SensorState, figure: str) -> float:
    """A figure of a task by its key, in its unit; NaN if the state has none."""
    if state.figures is None:
        return float("nan")
    return {
        "sensitivity_kPa_per_N": state.figures.sensitivity_kPa_per_N,
        "stiffness_N_per_mm": state.figures.stiffness,
        "force_range_N": state.figures.force_range[1],
    }[figure]


def reach_curves(
    design: str | DesignSource,
    changes: Changes,
    *,
    library: Library | None = None,
    model: str = "auto",
    progress: ReachProgress = lambda done, total, what: None,
    **options: object,
) -> ReachCurves:
    """Evaluate a design over its driving pressures; its own list of them is not read. Raises InputError.

    Where a curve has a local extremum the pressure of its parabola is added, so that the ends of what can be reached
    are met.
    """
    vented = {**changes, "pneumatics.driving_pressures_kPa": [0.0]}
    progress(0, 3, "evaluating the vented sensor")
    evaluation = evaluate(design, vented, library=library, model=model, **options)  # type: ignore[arg-type]
    top = _TOP * evaluation.prediction.limits.lowest
    progress(1, 3, "predicting over the driving pressures")
    probed = predict(
        evaluation.scene.name,
        evaluation.sensor,
        [0.0, 0.5 * top, top],
        model=model,
        closure=evaluation.options.closure,
        tolerance=evaluation.options.tolerance,
    )
    curves = ReachCurves(evaluation, probed.model, [])
    grid = np.linspace(0.0, top, _POINTS.get(probed.model, _FEW))
    prediction = curves.predicted(grid.tolist())
    curves.states = list(prediction.states)
    progress(2, 3, "computing the uncertainty")
    chosen = np.unique(np.linspace(0, len(grid) - 1, _BUDGETS).round().astype(int))
    few = replace(prediction, states=tuple(prediction.states[k] for k in chosen))
    entries = documents(few, evaluation.sensor, evaluation.scene, lambda: evaluation.resins)
    curves.budgets = [(state.driving_pressure, entry) for state, entry in zip(few.states, entries, strict=True)]
    if 0.0 < evaluation.rating.pressure < top:
        curves.add(evaluation.rating.pressure)
    for figure in TASK_FIGURES.values():
        for pressure in _extrema(curves.pressures, curves.values(figure)):
            curves.add(pressure)
    progress(3, 3, "solving for the driving pressures")
    return curves


def _extrema(pressures: Array, values: Array) -> list[float]:
    """Pressures of the vertices of the parabolas through every interior local extremum and its neighbours."""
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
