"""The models, cheapest first: the error of each, its validity, and the choice of the cheapest one that is good
enough."""

from dataclasses import dataclass
from typing import TypedDict

from pneutouch.errors import InputError
from pneutouch.mechanics.sensor import Sensor
from pneutouch.spec.values import plain_number

MODELS = ("membrane", "atlas", "solid")
"""The models of central contact, cheapest first; contact off the axis has one, harmonic."""

MODEL_CHOICES = (*MODELS, "harmonic", "auto")

USUAL = "usual"
"""The model if none is named: harmonic for contact off the axis, else the solid."""

DEFAULT_TOLERANCE = 0.02

HARMONICS_SETTLED = 0.01
"""The last raise of the harmonics changes sensitivity, force and pressure by less than this share."""

SENSITIVITY_DISCRETISATION = 0.011
LIMIT_DISCRETISATION = 0.002
"""Greatest relative errors of the solid at its default resolution against a refined mesh
(docs/background/accuracy.md)."""

OBJECT_DISCRETISATION = 0.02
"""Greatest relative error of the solid's sensitivity under an object that is no plate, at the resolution it takes,
against a refined mesh (docs/background/contact.md): 0.002 where the range ends at the depth, more where an
event ends it."""

TABULATION = 0.0075
"""Greatest relative error of the atlas's sensitivity against the solid where `auto` takes it: away from buckling and
tearing (docs/background/atlas.md); held by `make check-slow`."""

_MEMBRANE = 17.0
"""Greatest relative error of the membrane's sensitivity against the solid: no bending stiffness
(docs/background/accuracy.md)."""

NUMERICAL = {
    "membrane": _MEMBRANE,
    "atlas": SENSITIVITY_DISCRETISATION + TABULATION,
    "solid": SENSITIVITY_DISCRETISATION,
}
"""Relative error in sensitivity of each model as a numerical answer: its distance from the exact solution of its
equations, or for the membrane from the solid's. Effects that the equations leave out come on top, for every model."""


@dataclass(frozen=True)
class ModelSequence:
    """Models to try, cheapest first, and why others were passed over."""

    models: tuple[str, ...]
    passed: tuple[str, ...]


def stated_error(model: str, sensor: Sensor) -> float:
    """`NUMERICAL` of a model on a sensor: larger for the solid under an object that is no plate, and for harmonic under
    any."""
    if model == "harmonic":
        return OBJECT_DISCRETISATION
    return OBJECT_DISCRETISATION if model == "solid" and sensor.protocol.body is not None else NUMERICAL[model]


def models_for(sensor: Sensor, tolerance: float) -> ModelSequence:
    """The models whose stated error meets a tolerance (a fraction), cheapest first.

    Raises InputError for a tolerance that none can state.
    """
    best = "solid" if sensor.protocol.off_axis is None else "harmonic"
    least = stated_error(best, sensor)
    if not tolerance >= least:
        problem = f"no model can state so small an error; the best is the {best}'s {100 * least:g}% in sensitivity"
        raise InputError(problem, key="tolerance", value=f"{100 * tolerance:g}%")
    passed, models = [], []
    for model in MODELS if best == "solid" else (*MODELS, best):
        error = stated_error(model, sensor)
        why = _outside(model, sensor)
        if error > tolerance:
            passed.append(f"{model}: its stated error of {error:.1%} is more than {tolerance:.1%}")
        elif why is not None:
            passed.append(f"{model}: {why}")
        else:
            models.append(model)
    return ModelSequence(tuple(models), tuple(passed))


def _outside(model: str, sensor: Sensor) -> str | None:
    """Reason why a sensor lies outside a model's validity, or None."""
    if model == "atlas":
        from pneutouch.mechanics.atlas_states import outside_atlas

        return outside_atlas(sensor)
    if model == "solid":
        return sensor.protocol.off_axis
    if model == "harmonic":
        return outside_harmonic(sensor)
    if model == "membrane" and sensor.protocol.other_contact is not None:
        return sensor.protocol.other_contact
    if model == "membrane" and not (
        sensor.wall.law is None and sensor.dome.flange is None and sensor.wall.grade is None
    ):
        return "it covers neither other laws, nor a clamped flange, nor a graded wall"
    return None


def usual_model(sensor: Sensor) -> str:
    """The model of a sensor if none is named."""
    return "solid" if sensor.protocol.off_axis is None else "harmonic"


def outside_harmonic(sensor: Sensor) -> str | None:
    """Reason why the model with harmonics does not cover a sensor, or None if it does."""
    if sensor.dome.flange is not None:
        return "the flange is held as printed, and the wall's contact with its top is axisymmetric"
    return None


class ModelOptions(TypedDict):
    """The model of a prediction and, where it is auto, the numerical error as a fraction that it must meet."""

    model: str
    tolerance: float


def model_options(model: str | None, tolerance: float | str | None) -> ModelOptions:
    """The model and the tolerance of a prediction; a tolerance alone requires the cheapest model that meets it."""
    if tolerance is None:
        return {"model": model or USUAL, "tolerance": DEFAULT_TOLERANCE}
    if model not in (None, "auto"):
        problem = f"with `model` {model}: a tolerance is for `model` auto"
        raise InputError(problem, key="tolerance", value=str(tolerance), remedy="give one of both")
    return {"model": "auto", "tolerance": parse_tolerance(str(tolerance))}


def parse_tolerance(text: str) -> float:
    """A tolerance as a fraction from text: ``2%`` or ``0.02``. Raises InputError."""
    number = text.strip().removesuffix("%")
    try:
        value = plain_number(number) / (100.0 if text.strip().endswith("%") else 1.0)
    except ValueError:
        value = float("nan")
    if not 0.0 < value <= 1.0:
        problem = "it must be a positive share of at most 1, such as 2% or 0.02"
        raise InputError(problem, key="tolerance", value=text)
    return value
