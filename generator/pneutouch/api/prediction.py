"""A prediction as an object: figures with interval and unit, curves as arrays, tables and pictures of itself."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.api import show
from pneutouch.api.fields import numbers_of
from pneutouch.arrays import Array
from pneutouch.errors import InputError, shown
from pneutouch.evaluation.result import predicted, predicted_in_full
from pneutouch.results.prediction import StateRecord
from pneutouch.results.record import plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from pandas import DataFrame

    from pneutouch.evaluation.evaluate import Evaluation
    from pneutouch.mechanics.rating import Rating
    from pneutouch.parts import Assembly

_UNIT = re.compile(r"(.+?)_((?:mm|N|kPa|mL)(?:_per_(?:mm|N))?)$")

_CLOSE = 1e-6
"""Driving pressures that differ by less than this, kPa, are taken as the same."""


@dataclass(frozen=True)
class FigureValue:
    """A figure in its ``unit``; ``interval`` is its expanded uncertainty interval (k = 2), None if unknown."""

    name: str
    value: float
    unit: str
    interval: tuple[float, float] | None = None

    def __float__(self) -> float:
        return self.value

    def __str__(self) -> str:
        known = "" if self.interval is None else f" ({self._ends()})"
        return f"{self.value:.4g}{known} {self.unit}".rstrip()

    def _ends(self) -> str:
        return "-" if self.interval is None else f"{self.interval[0]:.4g} to {self.interval[1]:.4g}"

    def _repr_html_(self) -> str:
        return show.html(
            self.name, [(f"{self.value:.4g}", self._ends(), self.unit)], ("value", "interval (k = 2)", "unit"), None
        )


def axes_of(ax: Axes | None) -> Axes:
    """The axes given, else new ones."""
    if ax is not None:
        return ax
    from matplotlib import pyplot

    made: Axes = pyplot.subplots()[1]
    return made


class PredictedState(show.Shown):
    """A sensor at one driving pressure: figures, and curves over the indentation as arrays of one length.

    A figure without a unit in its name has value, interval and unit; it is None if it could not be computed.
    """

    driving_pressure_kPa: float
    indentation_mm: Array
    contact_force_N: Array
    pressure_rise_kPa: Array
    sensitivity: FigureValue | None
    sensitivity_kPa_per_N: float | None
    stiffness: FigureValue | None
    stiffness_N_per_mm: float | None
    force_at_range_end: FigureValue | None
    range_end: FigureValue
    range_end_mm: float
    apex_height_inner: FigureValue
    apex_height_inner_mm: float
    apex_height_outer: FigureValue
    apex_height_outer_mm: float
    limit_pressure: FigureValue | None
    r_squared: float | None
    events: list[dict[str, Any]]
    curve: dict[str, Array]
    uncertainty: dict[str, Any]

    def __init__(self, state: StateRecord) -> None:
        self.record, self.figures = state, dict[str, FigureValue]()
        assert state.uncertainty is not None
        known, content = state.uncertainty.known, plain(state)
        curve = {name: np.array(values) for name, values in content["curve"].items()}
        vars(self).update({**content, **curve, "curve": curve, "limit_pressure": None, "force_at_range_end": None})
        for key, value in {**{name: entry.value for name, entry in known.items()}, **content}.items():
            split = _UNIT.match(key)
            given = key == "driving_pressure_kPa" and key not in known
            if split is None or given or not isinstance(value, float | None):
                continue
            name, unit = split[1], split[2].replace("_per_", "/")
            setattr(self, name, None)
            if value is not None:
                interval = (known[key].low, known[key].high) if key in known else None
                self.figures[key] = FigureValue(name, value, unit, interval)
                vars(self)[name] = self.figures[key]

    def to_frame(self) -> DataFrame:
        """The curves as a table: a row for each point, a column for each curve."""
        from pandas import DataFrame

        return DataFrame(self.curve)

    def _head(self) -> str:
        return f"Prediction at {self.driving_pressure_kPa:g} kPa"

    def _rows(self) -> list[Any]:
        return [(figure.name, str(figure)) for figure in self.figures.values()]


class Prediction(show.Documented):
    """Prediction of a design by one model at its driving pressures."""

    def __init__(self, evaluation: Evaluation) -> None:
        self.evaluation = evaluation
        self.name, self.model = evaluation.scene.name, evaluation.prediction.model

    @cached_property
    def states(self) -> tuple[PredictedState, ...]:
        """The states in order of driving pressure."""
        return tuple(PredictedState(state) for state in predicted(self.evaluation).states)

    @cached_property
    def filled(self) -> tuple[PredictedState, ...]:
        """States given by ``pneumatics.injected_volumes_mL`` or ``apex_heights_mm``, also beyond the limit point."""
        return tuple(PredictedState(state) for state in predicted(self.evaluation).filled)

    def __iter__(self) -> Iterator[PredictedState]:
        return iter(self.states)

    def __len__(self) -> int:
        return len(self.states)

    def __getitem__(self, place: int) -> PredictedState:
        return self.states[place]

    @property
    def rating(self) -> Rating:
        """The rated pressure, its basis and advice that would raise it."""
        return self.evaluation.rating

    def at(self, pressure_kPa: float) -> PredictedState:
        """The state at a driving pressure. Raises InputError if it was not predicted."""
        (required_kPa,) = numbers_of([pressure_kPa], "pressure_kPa")
        for state in self.states:
            if abs(state.driving_pressure_kPa - required_kPa) < _CLOSE:
                return state
        known = ", ".join(f"{state.driving_pressure_kPa:g}" for state in self.states)
        remedy = f"predicted: {known} kPa; give `driving_pressures_kPa` to predict others"
        raise InputError("not predicted", key="pressure_kPa", value=pressure_kPa, remedy=remedy)

    def _document(self) -> Any:
        return predicted_in_full(self.evaluation)

    def to_frame(self) -> DataFrame:
        """Table with a row for each driving pressure and a column for each figure, ``_low`` and ``_high`` if known."""
        from pandas import DataFrame, Index

        rows = []
        for state in self.states:
            row: dict[str, float] = {}
            for key, figure in state.figures.items():
                low_high = dict(zip((f"{key}_low", f"{key}_high"), figure.interval or (), strict=False))
                row |= {key: figure.value, **low_high}
            rows.append(row)
        return DataFrame(rows, Index([s.driving_pressure_kPa for s in self.states], name="driving_pressure_kPa"))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw pressure rise over contact force, a line for each state, into ``ax`` (None: new); returns it."""
        from pneutouch.report.chart import draw_panel
        from pneutouch.report.curves import Press, rises, state_look

        ax = axes_of(ax)
        presses = [
            Press(s.indentation_mm, s.contact_force_N, s.pressure_rise_kPa, state_look(k, s.driving_pressure_kPa))
            for k, s in enumerate(self.states)
        ]
        draw_panel(ax, rises(presses))
        ax.set_title(self.name)
        ax.legend(title="driving pressure")
        return ax

    _columns = ("driving pressure", "sensitivity", "stiffness", "range end")

    def _head(self) -> str:
        return f"Prediction of {shown(self.name)} by model {self.model}: sensitivity, stiffness, range"

    def _rows(self) -> list[Any]:
        return [
            (
                f"{s.driving_pressure_kPa:g} kPa",
                *(str(each or "-") for each in (s.sensitivity, s.stiffness, s.range_end)),
            )
            for s in self.states
        ]

    def _picture(self) -> Assembly:
        return self.evaluation.assembly
