"""What a datasheet adds for a graded membrane: two pictures, and the constant mixes it is compared with."""

from __future__ import annotations

import numpy as np

from pneutouch.catalogue import ResolvedDesign
from pneutouch.errors import ComputationError
from pneutouch.mechanics import Sensor, SensorPrediction
from pneutouch.report.graded import ComparedMembrane, grade_section, graded_against_constant

CAPTIONS = {
    "grade": "Graded membrane: the stiff resin's share of the wall, laid droplet by droplet; beside it share and modulus along "
    "the arc from the pole to the rim. The mixing curve behind it is assumed, see the sources.",
    "graded": "The graded membrane against constant ones of its size, all by the solid: as stiff throughout as at its softest, "
    "on average and at its stiffest. Left the sensitivity over the driving pressure, right the response at the highest.",
}


def graded_figures(scene: ResolvedDesign, sensor: Sensor, prediction: SensorPrediction) -> dict[str, str]:
    """Figures ``grade`` and ``graded`` as SVG for a graded membrane; nothing for any other."""
    if scene.membrane_material.along is None or sensor.wall.grade is None:
        return {}
    pressures = np.array([state.driving_pressure for state in prediction.states])
    relative = sensor.wall.grade[1]
    found = []
    for label, share in (("softest", min(relative)), ("mean", 1.0), ("stiffest", max(relative))):
        modulus = share * sensor.wall.shear_modulus
        constant = _constant(sensor.replace(shear_modulus=modulus, grade=None), pressures, f"{label} {modulus:.2f} MPa")
        if constant is not None:
            found.append(constant)
    return {
        "grade": grade_section(scene.membrane_material, scene),
        "graded": graded_against_constant(ComparedMembrane("graded", prediction.states), found),
    }


def _constant(sensor: Sensor, pressures: np.ndarray, label: str) -> ComparedMembrane | None:
    """A constant membrane at those pressures that it bears; None where it bears none."""
    from pneutouch.mechanics.solid_states import solid_result

    for count in range(pressures.size, 0, -1):
        try:
            return ComparedMembrane(label, solid_result(sensor, pressures[:count], past_limit=1.0).states)
        except ComputationError:
            continue
    return None
