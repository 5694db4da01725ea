"""The table of models, cheapest first, and the choice of the cheapest model that is accurate enough."""

from dataclasses import dataclass
from importlib import import_module
from typing import TypedDict, cast

from pneutouch.errors import InputError, nearest
from pneutouch.mechanics.models.interface import SensorModel
from pneutouch.mechanics.sensor import Sensor
from pneutouch.shape.hemisphere import no_hemisphere
from pneutouch.spec.values import plain_number
from pneutouch.wording import data_of

MODELS: dict[str, str] = data_of(__file__)
"""Modules of the models by name, cheapest first. Each holds its model as ``MODEL`` and is imported on first use."""

MODEL_CHOICES = (*MODELS, "auto")

CLOSURES = ("variational", "printed")
"""Closures of the contact in the membrane model."""

USUAL = "usual"
"""Name for the default model of a sensor (`usual_model`)."""

DEFAULT_TOLERANCE = 0.02


@dataclass(frozen=True)
class ModelSequence:
    """Names of the models to try, cheapest first, texts that say why others were passed over, and the tolerance that
    they meet: the one asked for, or the best model's error where that is more than the default."""

    models: tuple[str, ...]
    passed: tuple[str, ...]
    tolerance: float


def model_named(name: str) -> SensorModel:
    """The model of a name in `MODELS`. Raises InputError for an unknown name."""
    if name not in MODELS:
        raise InputError(f"unknown model.{nearest(name, MODEL_CHOICES)}", key="model", value=name)
    return cast(SensorModel, import_module(MODELS[name]).MODEL)


def outside(name: str, sensor: Sensor) -> str | None:
    """Reason why the model of a name in `MODELS` does not cover a sensor, or None if it does."""
    return model_named(name).covers(sensor)


def stated_error(name: str, sensor: Sensor) -> float:
    """Relative numerical error in sensitivity that a model states for a sensor."""
    return model_named(name).stated_error(sensor)


def usual_model(sensor: Sensor) -> str:
    """Name of the default model: ``harmonic`` for contact off the axis, else ``solid``."""
    return "solid" if sensor.protocol.off_axis is None else "harmonic"


def models_for(sensor: Sensor, tolerance: float) -> ModelSequence:
    """The models, cheapest first up to the usual one, that cover a sensor and meet a tolerance (a fraction).

    Raises InputError if the tolerance is below the usual model's stated error, or if no model covers the sensor.
    """
    best = usual_model(sensor)
    least = stated_error(best, sensor)
    if tolerance == DEFAULT_TOLERANCE:
        # The default must not refuse a sensor for which no model states so small an error.
        tolerance = max(tolerance, least)
    if not tolerance >= least:
        problem = f"no model can state so small an error; the best is the {best}'s {100 * least:g}% in sensitivity"
        enough = f"give at least {100 * least:g}%"
        raise InputError(problem, key="tolerance", value=f"{100 * tolerance:g}%", remedy=enough)
    names = list(MODELS)
    passed, models = [], []
    for name in names[: names.index(best) + 1]:
        if name == "local" and no_hemisphere(sensor.dome.shape) is None:
            continue
        error = stated_error(name, sensor)
        if error > tolerance:
            passed.append(f"{name}: its stated error of {error:.1%} is more than {tolerance:.1%}")
        elif (why := outside(name, sensor)) is not None:
            passed.append(f"{name}: {why}")
        else:
            models.append(name)
    if not models:
        problem = f"no model covers the sensor: {'; '.join(passed)}"
        raise InputError(problem, key="model", value="auto", remedy=remedy(sensor))
    return ModelSequence(tuple(models), tuple(passed), tolerance)


def remedy(sensor: Sensor) -> str:
    """Advice, in words, if a model cannot predict a sensor: another model, or a setting that a model covers."""
    usual = usual_model(sensor)
    return (
        f"take `model` auto or {usual}" if outside(usual, sensor) is None else "take `clamp` base, or central contact"
    )


class ModelOptions(TypedDict):
    """Name of the model for a prediction, and the numerical error (a fraction) that it must meet if that is auto."""

    model: str
    tolerance: float


def model_options(model: str | None, tolerance: float | str | None) -> ModelOptions:
    """Options from a model's name (None: usual) and a tolerance, with which only auto is accepted (else InputError)."""
    if tolerance is None:
        return {"model": model or USUAL, "tolerance": DEFAULT_TOLERANCE}
    if model not in (None, "auto"):
        problem = f"with `model` {model}: a tolerance is for `model` auto"
        raise InputError(problem, key="tolerance", value=str(tolerance), remedy="give one of both")
    return {"model": "auto", "tolerance": parse_tolerance(str(tolerance))}


def parse_tolerance(text: str) -> float:
    """Tolerance as a fraction, above 0 and at most 1, from a text such as ``2%`` or ``0.02``. Raises InputError."""
    number = text.strip().removesuffix("%")
    try:
        value = plain_number(number) / (100.0 if text.strip().endswith("%") else 1.0)
    except ValueError:
        value = float("nan")
    if not 0.0 < value <= 1.0:
        problem = "it must be a positive share of at most 1, such as 2% or 0.02"
        raise InputError(problem, key="tolerance", value=text)
    return value
