"""The interface of a model: the sensors it covers, its errors, its answers and its assumptions."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import ClassVar, NamedTuple

from pneutouch.arrays import Array
from pneutouch.errors import PneutouchError
from pneutouch.mechanics.models.accuracy import NUMERICAL
from pneutouch.mechanics.prediction import ModelResult
from pneutouch.mechanics.sensor import Sensor
from pneutouch.results.prediction import ErrorEstimate


class Limitation(NamedTuple):
    """Reason why `auto` must not use an answer; ``fatal`` if nothing may use it, ``beyond_error`` if the stated error
    does not hold for it."""

    why: str
    fatal: bool
    beyond_error: bool = False


class ModelAnswer(NamedTuple):
    """Result of a model for one sensor, and its limitation or None."""

    result: ModelResult
    limitation: Limitation | None = None


Answered = ModelAnswer | PneutouchError
"""An answer, or the error raised for a sensor without an answer."""


class SensorModel(ABC):
    """A model of the sensor.

    ``correctable``: True if the factors of a calibration, found against finite elements, apply to its force and rise.
    ``holds_flange``: True if it clamps a flange as the connector does; other models clamp the base plane.
    """

    name: ClassVar[str]
    correctable: ClassVar[bool] = True
    holds_flange: ClassVar[bool] = False

    @abstractmethod
    def covers(self, sensor: Sensor) -> str | None:
        """Reason why the model has no answer for a sensor, or None if the model covers it."""

    @abstractmethod
    def answer(self, sensors: Sequence[Sensor], driving_pressures: Sequence[Array]) -> list[Answered]:
        """Answers for sensors that the model covers, each at its own driving pressures (MPa, ascending).

        A sensor without an answer, for instance beyond its limit point, gets an error instead; the others do not stop.
        """

    @abstractmethod
    def errors(self, sensor: Sensor, driving_pressures: Array) -> ErrorEstimate:
        """Numerical errors of the model's answers."""

    @abstractmethod
    def assumptions(self, sensor: Sensor) -> tuple[str, ...]:
        """Assumptions specific to the model, in words."""

    def stated_error(self, sensor: Sensor) -> float:
        """Relative numerical error in sensitivity that the model states."""
        return NUMERICAL[self.name]

    def answer_one(self, sensor: Sensor, driving_pressures: Array) -> ModelAnswer:
        """Answer for one sensor. Raises the error of a sensor without an answer."""
        (answer,) = self.answer([sensor], [driving_pressures])
        if isinstance(answer, PneutouchError):
            raise answer
        return answer

    def closed(self, closure: str) -> SensorModel:
        """The model with a closure of the membrane's contact; the same model if it is not the membrane."""
        return self


def one_by_one(
    answer: Callable[[Sensor, Array], ModelAnswer], sensors: Sequence[Sensor], driving_pressures: Sequence[Array]
) -> list[Answered]:
    """Answers of a model that takes one sensor at a time; errors are returned in place of answers."""

    def tried(sensor: Sensor, pressures: Array) -> Answered:
        try:
            return answer(sensor, pressures)
        except PneutouchError as error:
            return error

    return [tried(sensor, pressures) for sensor, pressures in zip(sensors, driving_pressures, strict=True)]
