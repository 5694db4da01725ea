"""Designs side by side: what differs between them, and their figures with intervals."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneutouch.api import show
from pneutouch.api.design import Design, load
from pneutouch.api.fields import keywords, plain
from pneutouch.api.prediction import Prediction
from pneutouch.errors import InputError
from pneutouch.spec.design import DesignFile

if TYPE_CHECKING:
    from pandas import DataFrame


class Comparison(show.Shown):
    """Predictions side by side. ``inputs`` holds the fields that differ, a value a design."""

    def __init__(self, designs: tuple[Design, ...], predictions: tuple[Prediction, ...]) -> None:
        self.designs, self.predictions = designs, predictions
        every = {name: tuple(getattr(design, name) for design in designs) for name in keywords(DesignFile)}
        self.inputs = {name: values for name, values in every.items() if any(v != values[0] for v in values)}

    def to_frame(self) -> DataFrame:
        """A row a figure and driving pressure; per design its value, and ``low`` and ``high`` where they are known."""
        from pandas import concat

        frames = {f"{k + 1}: {p.name}": p.to_frame().T for k, p in enumerate(self.predictions)}
        return concat(frames, axis="columns").swaplevel(axis="columns").sort_index(axis="columns", level=0)

    def to_dict(self) -> dict[str, Any]:
        """The fields that differ, and every prediction."""
        return {"inputs": self.inputs, "predictions": [prediction.to_dict() for prediction in self.predictions]}

    def _rows(self) -> list[Any]:
        states = self.predictions[0].states
        shared_kPa = [
            s.driving_pressure_kPa for s in states if all(_has(p, s.driving_pressure_kPa) for p in self.predictions)
        ]
        figures = [
            (f"sensitivity at {at:g} kPa", *(str(p.at(at).sensitivity or "-") for p in self.predictions))
            for at in shared_kPa
        ]
        return [*((name, *values) for name, values in self.inputs.items()), *figures]

    def _head(self) -> str:
        return f"Comparison of {', '.join(design.name for design in self.designs)}"


def compare(
    *designs: Design | str | Path, driving_pressures_kPa: Iterable[float] | None = None, **options: Any
) -> Comparison:
    """Predict designs and set them side by side; ``options`` are those of `Design.predict`. Raises InputError."""
    if not designs:
        raise InputError("no design to compare", key="designs", remedy="give designs, their names or their paths")
    chosen = tuple(design if isinstance(design, Design) else load(design) for design in designs)
    pressures_kPa = plain(driving_pressures_kPa)
    return Comparison(chosen, tuple(design.predict(pressures_kPa, **options) for design in chosen))


def _has(prediction: Prediction, pressure_kPa: float) -> bool:
    return any(state.driving_pressure_kPa == pressure_kPa for state in prediction.states)
