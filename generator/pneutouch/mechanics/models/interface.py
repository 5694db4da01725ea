"""The interface of a model: the sensors it covers, its errors, its answers and its assumptions."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import ClassVar, NamedTuple

from pneutouch.arrays import Array
from pneutouch.errors import PneutouchError
from pneutouch.mechanics.models.accuracy import NUMERICAL
from pneutouch.mechanics.prediction import ModelResult, SensorState
from pneutouch.mechanics.sensor import Filling, Sensor
from pneutouch.results.prediction import ErrorEstimate


class Limitation(NamedTuple):
    """Reason why the model choice `auto` may not use an answer; ``fatal``: it may not be used at all; ``beyond_error``:
    the stated error does not hold for it."""

    why: str
    fatal: bool
    beyond_error: bool = False


class ModelAnswer(NamedTuple):
    """Result of a model for one sensor, and its limitation; None: it has none."""

    result: ModelResult
    limitation: Limitation | None = None


Answered = ModelAnswer | PneutouchError
"""The answer for a sensor, or the error that stands for one."""


class SensorModel(ABC):
    """A model of the sensor.

    ``correctable``: True if the factors of a calibration, found with finite elements, apply to its force and rise.
    ``holds_flange``: True if it clamps a flange as the connector does; other models clamp the base plane.
    """

    name: ClassVar[str]
    correctable: ClassVar[bool] = True
    holds_flange: ClassVar[bool] = False

    @abstractmethod
    def covers(self, sensor: Sensor) -> str | None:
        """Reason why the model does not cover a sensor, or None if it does."""

    @abstractmethod
    def answer(self, sensors: Sequence[Sensor], driving_pressures: Sequence[Array]) -> list[Answered]:
        """Answers for sensors that the model covers, each at its own driving pressures (MPa, ascending).

        For a sensor without an answer, for instance beyond its limit point, the list has an error; no error is raised.
        """

    @abstractmethod
    def errors(self, sensor: Sensor, driving_pressures: Array) -> ErrorEstimate:
        """Numerical errors of the model's answer for a sensor at driving pressures (MPa)."""

    @abstractmethod
    def assumptions(self, sensor: Sensor) -> tuple[str, ...]:
        """Assumptions specific to the model, in words."""

    def filled(self, sensor: Sensor, fillings: Sequence[Filling]) -> tuple[SensorState, ...] | None:
        """States given by their fillings, also beyond the limit point; None: the model has none, the usual one does."""
        return None

    def stated_error(self, sensor: Sensor) -> float:
        """Relative numerical error in sensitivity that the model states for a sensor."""
        return NUMERICAL[self.name]

    def answer_one(self, sensor: Sensor, driving_pressures: Array) -> ModelAnswer:
        """Answer for one sensor at driving pressures (MPa, ascending). Raises the error if there is no answer."""
        (answer,) = self.answer([sensor], [driving_pressures])
        if isinstance(answer, PneutouchError):
            raise answer
        return answer

    def closed(self, closure: str) -> "SensorModel":
        """The membrane model with the named closure of its contact; any other model is returned unchanged."""
        return self


def one_by_one(
    answer: Callable[[Sensor, Array], ModelAnswer], sensors: Sequence[Sensor], driving_pressures: Sequence[Array]
) -> list[Answered]:
    """Answers by ``answer``, a function for one sensor and its driving pressures; its errors stand for answers."""

    def tried(sensor: Sensor, pressures: Array) -> Answered:
        try:
            return answer(sensor, pressures)
        except PneutouchError as error:
            return error

    return [tried(sensor, pressures) for sensor, pressures in zip(sensors, driving_pressures, strict=True)]
