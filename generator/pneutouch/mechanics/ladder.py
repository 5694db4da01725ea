"""The ladder of models: what each rung's error is, where it holds, and the cheapest one that is good enough."""

from __future__ import annotations

from dataclasses import dataclass

from pneutouch.errors import InputError
from pneutouch.mechanics.sensor import Sensor

RUNGS = ("membrane", "atlas", "solid")
"""The rungs, cheapest first."""

MODELS = (*RUNGS, "auto")

DEFAULT_TOLERANCE = 0.02

DISCRETISATION = {"sensitivity_discretisation_relative": 0.011, "limit_pressure_relative": 0.002}
"""Greatest relative errors of the solid at its default resolution against a refined mesh (docs/accuracy.md)."""

TABULATION = 0.0075
"""Greatest relative error of the atlas's sensitivity against the solid where `auto` takes it: away from buckling and
tearing (docs/atlas.md); held by `make check-slow`."""

_MEMBRANE = 17.0
"""Greatest relative error of the membrane's sensitivity against the solid (docs/accuracy.md): no bending stiffness."""

NUMERICAL = {
    "membrane": _MEMBRANE,
    "atlas": DISCRETISATION["sensitivity_discretisation_relative"] + TABULATION,
    "solid": DISCRETISATION["sensitivity_discretisation_relative"],
}
"""Stated relative error in sensitivity of each rung as a numerical answer: how far from the exact solution of its
equations, or for the membrane from the solid's. What the equations leave out comes on top, for every rung."""


@dataclass(frozen=True)
class ModelSequence:
    """Rungs to try in order, and why those before them were passed over."""

    rungs: tuple[str, ...]
    passed: tuple[str, ...]


def climb(sensor: Sensor, tolerance: float) -> ModelSequence:
    """The rungs whose stated error meets a tolerance (a fraction), cheapest first.

    Raises InputError for a tolerance that none can state.
    """
    least = min(NUMERICAL.values())
    if not tolerance >= least:
        problem = f"no rung can state so small an error; the best is the solid's {100 * least:g}% in sensitivity"
        raise InputError(problem, key="tolerance", value=f"{100 * tolerance:g}%")
    passed, rungs = [], []
    for rung in RUNGS:
        error = NUMERICAL[rung]
        why = _outside(rung, sensor)
        if error > tolerance:
            passed.append(f"{rung}: its stated error of {error:.1%} is more than {tolerance:.1%}")
        elif why is not None:
            passed.append(f"{rung}: {why}")
        else:
            rungs.append(rung)
    return ModelSequence(tuple(rungs), tuple(passed))


def _outside(rung: str, sensor: Sensor) -> str | None:
    """Why a sensor lies outside a rung's validity, or None."""
    if rung == "atlas":
        from pneutouch.mechanics.atlas_states import outside_atlas

        return outside_atlas(sensor)
    if rung == "membrane" and not (sensor.law is None and sensor.flange is None and sensor.grade is None):
        return "it knows neither other laws, nor a held flange, nor a graded wall"
    return None


def parse_tolerance(text: str) -> float:
    """A tolerance as a fraction from text: ``2%`` or ``0.02``. Raises InputError."""
    number = text.strip().removesuffix("%")
    try:
        value = float(number) / (100.0 if text.strip().endswith("%") else 1.0)
    except ValueError:
        value = float("nan")
    if not 0.0 < value < 100.0:
        raise InputError("it must be a positive share, such as 2% or 0.02", key="tolerance", value=text)
    return value
