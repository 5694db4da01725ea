"""Numerical errors of the models (docs/background/accuracy.md), and assumptions of the finite elements."""

from typing import Any

from pneutouch.mechanics.sensor import IndentationProtocol, Sensor
from pneutouch.results.prediction import ErrorEstimate
from pneutouch.wording import data_of

HARMONICS_SETTLED = 0.01
"""Greatest relative change of sensitivity, force and pressure by the last increase of the harmonics' order."""

SENSITIVITY_DISCRETISATION = 0.011
LIMIT_DISCRETISATION = 0.002
"""Greatest relative errors of the solid at its default resolution against a refined mesh."""

SHALLOW_DISCRETISATION = 0.012, 0.02
"""As `SENSITIVITY_DISCRETISATION`, of domes that rise by less than their radius, with a dead volume of at most 5 R0^3
and of more, to 13 R0^3: against 256 cells along the arc, where the range ends at the depth (60 random designs); up to
7 % where a fold next to the clamp ends it on one mesh and not on the other."""

FLAT_LIMIT_DISCRETISATION = 0.01
"""As `LIMIT_DISCRETISATION`, of flat walls, which turn by nearly a right angle at their clamp: 0.1 to 0.8 % against
256 x 8 cells for walls of 0.1 and 0.15 R0."""

OBJECT_DISCRETISATION = 0.02
"""Greatest relative error of the solid's sensitivity under an object that is not a plate, at the resolution used for
it, against a refined mesh (docs/background/contact.md): 0.002 where the range ends at the depth, more where an event
ends it."""

SOFT = 0.03
"""Greatest relative error of the solid's force and pressure under a soft object within its range, against CalculiX with
the object as a second body (docs/background/contact.md)."""

TABULATION = 0.0075
"""Greatest relative error of the atlas's sensitivity against the solid where `auto` uses the atlas: not near buckling
or tearing, and not for ranges below 0.2 R0 (docs/background/atlas.md); checked by `make check-slow`."""

NUMERICAL = {
    "membrane": 17.0,
    "atlas": SENSITIVITY_DISCRETISATION + TABULATION,
    "local": SENSITIVITY_DISCRETISATION + TABULATION,
    "solid": SENSITIVITY_DISCRETISATION,
    "harmonic": OBJECT_DISCRETISATION,
}
"""Relative numerical error in sensitivity of each model: its distance from the exact solution of its own equations, or,
for the membrane, which has no bending stiffness, from the solid's. Effects that they leave out are additional."""

_SHALLOW = 0.999
"""Rise over R0 below which a dome counts as shallow."""

BODY = "axisymmetric hyperelastic solid with the wall's full stiffness"
NOT_CHECKED = "sway and lobes of the dome around its axis are not looked for"

_WORDS: dict[str, Any] = data_of(__file__)

TREND: str = _WORDS["trend"].format(off=1 + NUMERICAL["membrane"])
"""Why no interval is given of the membrane's figures."""


def sensitivity_discretisation(sensor: Sensor) -> float:
    """Greatest relative error of the mesh in the sensitivity of a sensor, by shape, object and gas."""
    shape = sensor.dome.shape
    if sensor.protocol.soft is not None:
        return SOFT
    if sensor.protocol.body is not None:
        return OBJECT_DISCRETISATION
    if not shape.domed or shape.inner_height >= _SHALLOW * shape.inner_radius:
        return SENSITIVITY_DISCRETISATION
    return SHALLOW_DISCRETISATION[sensor.gas.dead_volume > 5.0 * shape.inner_radius**3]


def limit_discretisation(sensor: Sensor) -> float:
    """Greatest relative error of the mesh in the limit pressure of a sensor."""
    return LIMIT_DISCRETISATION if sensor.dome.shape.domed else FLAT_LIMIT_DISCRETISATION


def discretised(
    summary: str,
    sensitivity_relative: float = SENSITIVITY_DISCRETISATION,
    sensitivity_tabulation_relative: float | None = None,
    limit_relative: float = LIMIT_DISCRETISATION,
) -> ErrorEstimate:
    """Error estimate of the finite elements; ``sensitivity_tabulation_relative`` is the error of the atlas's table."""
    return ErrorEstimate(
        sensitivity_relative=None,
        limit_pressure_relative=limit_relative,
        sensitivity_discretisation_relative=sensitivity_relative,
        sensitivity_tabulation_relative=sensitivity_tabulation_relative,
        summary=(summary,),
    )


def solid_assumptions(sensor: Sensor, body: str) -> tuple[str, ...]:
    """Assumptions of the finite elements for a sensor; ``body`` describes the body and what is checked, in words."""
    largest = sensor.wall.largest_stretch
    fitted = "" if largest is None else f", fitted to tension up to a stretch of {largest:g}"
    law = f"law {sensor.wall.hyperelastic.convention}{fitted}, Poisson ratio {sensor.wall.poisson_ratio:g}"
    lines = (law, body, _WORDS["surfaces"])
    if sensor.dome.base is None:
        return (*lines, *_WORDS["through_base"], _edge(sensor.protocol), _WORDS["break"])
    return (*lines, _edge(sensor.protocol), _WORDS["break"], _WORDS["on_base"])


def _edge(protocol: IndentationProtocol) -> str:
    """Edge that the solid gives to the plate or other object, in words."""
    if protocol.soft is not None:
        return (
            "the object is linear elastic, isotropic, wider than the contact and without friction; the range ends "
            "where its surface has moved by half the contact's radius, or half its thickness"
        )
    if protocol.body is not None:
        return "beyond its edge, or flanks of 60 degrees, the object turns up as a parabola; there the range ends"
    if protocol.plate_rim is not None:
        return f"the plate's edge is rounded with {protocol.plate_rim:g} mm, or with a cell of the mesh if that is more"
    return "the plate's edge is rounded with a thirtieth of its radius"
