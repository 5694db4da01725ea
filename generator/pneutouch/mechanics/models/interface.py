"""The interface of a model: the sensors it covers, its error, its answers, and its assumptions."""

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
    """Reason why `auto` must not use an answer; ``fatal`` if it is none at all, ``beyond_error`` if the stated error
    does not hold for it."""

    why: str
    fatal: bool
    beyond_error: bool = False


class ModelAnswer(NamedTuple):
    """The result of a model for one sensor, and its limitation, or None."""

    result: ModelResult
    limitation: Limitation | None = None


Answered = ModelAnswer | PneutouchError
"""An answer, or the error of a sensor that has none."""


class SensorModel(ABC):
    """A model of the sensor.

    ``correctable``: a calibration's factors on force and rise, found against finite elements, hold for its answers.
    ``holds_flange``: it clamps a flange as the connector does; the others clamp the base plane.
    """

    name: ClassVar[str]
    correctable: ClassVar[bool] = True
    holds_flange: ClassVar[bool] = False

    @abstractmethod
    def covers(self, sensor: Sensor) -> str | None:
        """Reason why the model has no answer for a sensor, or None if it covers it."""

    @abstractmethod
    def answer(self, sensors: Sequence[Sensor], driving_pressures: Sequence[Array]) -> list[Answered]:
        """Answers for sensors that the model covers, each at driving pressures of its own (MPa, ascending).

        A sensor that has none, for instance beyond its limit point, gets its error and stops no other.
        """

    @abstractmethod
    def errors(self, sensor: Sensor, driving_pressures: Array) -> ErrorEstimate:
        """The numerical errors of its answers."""

    @abstractmethod
    def assumptions(self, sensor: Sensor) -> tuple[str, ...]:
        """The assumptions that the model makes of its own, in words."""

    def stated_error(self, sensor: Sensor) -> float:
        """Relative numerical error in sensitivity."""
        return NUMERICAL[self.name]

    def answer_one(self, sensor: Sensor, driving_pressures: Array) -> ModelAnswer:
        """The answer for one sensor. Raises its error."""
        (answer,) = self.answer([sensor], [driving_pressures])
        if isinstance(answer, PneutouchError):
            raise answer
        return answer

    def closed(self, closure: str) -> SensorModel:
        """The model with a closure of the membrane's contact; no other model has one."""
        return self


def one_by_one(
    answer: Callable[[Sensor, Array], ModelAnswer], sensors: Sequence[Sensor], driving_pressures: Sequence[Array]
) -> list[Answered]:
    """Answers of a model that takes one sensor at a time."""

    def tried(sensor: Sensor, pressures: Array) -> Answered:
        try:
            return answer(sensor, pressures)
        except PneutouchError as error:
            return error

    return [tried(sensor, pressures) for sensor, pressures in zip(sensors, driving_pressures, strict=True)]
