"""Errors and assumptions that the finite elements, and the atlas made of them, have in common."""

from pneutouch.mechanics.models.accuracy import LIMIT_DISCRETISATION, SENSITIVITY_DISCRETISATION
from pneutouch.mechanics.sensor import IndentationProtocol, Sensor
from pneutouch.results.prediction import ErrorEstimate

BODY = "axisymmetric hyperelastic solid with the wall's full stiffness"
NOT_CHECKED = "sway and lobes of the dome around its axis are not looked for"

_SURFACES = "R0 is the inner radius; heights are those of the inner and the outer surface"
_THROUGH_BASE = (
    "the wall below the base plane, self-contact and contact with the connector are not modelled",
    "the fold of the wall at its clamped corner, which refined meshes find in deep presses, is not resolved by default",
)
_BREAK = (
    "elongation at break is set against the greatest principal stretch on the faces, half a wall away from the clamp"
)
_ON_BASE = (
    "next to its clamp and inside, the wall lies down without friction on the body below it; contact of the rest of "
    "the wall with itself is not modelled"
)


def discretised(
    summary: str,
    sensitivity_relative: float = SENSITIVITY_DISCRETISATION,
    sensitivity_tabulation_relative: float | None = None,
) -> ErrorEstimate:
    """The errors of finite elements; the atlas adds that of its table."""
    return ErrorEstimate(
        sensitivity_relative=None,
        limit_pressure_relative=LIMIT_DISCRETISATION,
        sensitivity_discretisation_relative=sensitivity_relative,
        sensitivity_tabulation_relative=sensitivity_tabulation_relative,
        summary=(summary,),
    )


def solid_assumptions(sensor: Sensor, body: str) -> tuple[str, ...]:
    """Assumptions on a wall of full stiffness; ``body`` says what is solved."""
    largest = sensor.wall.largest_stretch
    fitted = "" if largest is None else f", fitted to tension up to a stretch of {largest:g}"
    law = f"law {sensor.wall.hyperelastic.convention}{fitted}, Poisson ratio {sensor.wall.poisson_ratio:g}"
    lines = (law, body, _SURFACES)
    if sensor.dome.base is None:
        return (*lines, *_THROUGH_BASE, _edge(sensor.protocol), _BREAK)
    return (*lines, _edge(sensor.protocol), _BREAK, _ON_BASE)


def _edge(protocol: IndentationProtocol) -> str:
    """Edge that the solid gives to the pressing object, in words."""
    if protocol.body is not None:
        return "beyond its edge, or flanks of 60 degrees, the object turns up as a parabola; there the range ends"
    if protocol.plate_rim is not None:
        return f"the plate's edge is rounded with {protocol.plate_rim:g} mm, or with a cell of the mesh if that is more"
    return "the plate's edge is rounded with a thirtieth of its radius"
