"""Every elastomer in the paper's dome by its own law: ``python -m benchmarks.materials`` (a minute of processor time).

Writes docs/background/materials.json; ``--reach`` prints how far the wall of the shipped domes is stretched instead (`pneutouch.bench.tensile.choose`).
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np

from benchmarks.store import LIBRARY, store
from pneutouch.bench.tensile.law_fit import LawForm
from pneutouch.errors import BeyondLimitError
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.mechanics.models.solid import press_settings, solid_probe, solid_result
from pneutouch.mechanics.paper_sensor import material_sensor, young_modulus
from pneutouch.mechanics.prediction import Limits
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.solid.indent import indent
from pneutouch.mechanics.solid.inflate import inflate, state_at
from pneutouch.spec.material import Material
from pneutouch.units import KPA

PRESSURES_KPA = (0.0, 22.0)


def materials() -> dict[str, Material]:
    """The shipped elastomers by name, printed ones first, soft ones first."""
    every = LIBRARY.all("materials", Material)
    soft = {name: one for name, one in every.items() if one.shear_modulus_MPa is not None and one.kind == "elastomer"}
    return dict(sorted(soft.items(), key=lambda item: (item[1].is_cast, item[1].shear_modulus_MPa.nominal)))


def sensitivity(sensor: Sensor, pressure_kPa: float) -> str:
    """S at a driving pressure, kPa/N, or why there is none."""
    try:
        result = solid_result(sensor.replace(waves=0), np.array([pressure_kPa * KPA]), past_limit=1.0)
    except BeyondLimitError:
        name, limit = min(limits(sensor).named(), key=lambda known: known[1])
        return f"beyond the {name}, {limit / KPA:.1f} kPa"
    figures, left = result.states[0].figures, result.limits.law_range
    if figures is None:
        return "no range"
    mark = "" if left is None or pressure_kPa * KPA <= left else f" (beyond the law range, {left / KPA:.1f} kPa)"
    return f"{figures.sensitivity:.2f}{mark}"


def limits(sensor: Sensor) -> Limits:
    """The limits of the driving pressure."""
    return solid_result(sensor.replace(waves=0), np.array([0.0]), past_limit=1.0).limits


def law_words(material: Material) -> tuple[str, str, str]:
    """Law, misfit and range of a material as cells."""
    if material.law is None:
        return "neo-Hookean", "not fitted", ""
    law = material.law
    label = LawForm(law.name, len(law.constants)).label
    constants = ", ".join(f"{constant:.4g}" for constant in law.constants)
    misfit = "" if law.misfit_percent is None else f"{law.misfit_percent:.1f} %"
    return f"{label}: {constants}", misfit, "" if law.largest_stretch is None else f"1 to {law.largest_stretch:g}"


def row(name: str, material: Material) -> dict[str, Any]:
    """A material, its law, and its sensitivities."""
    sensor, modulus = material_sensor(material), material.shear_modulus_MPa
    law, misfit, stretch = law_words(material)
    below = "silicones, below" if material.is_cast else "filaments, below"
    return {
        "material": name,
        "kind": material.kind_shown,
        "modulus_MPa": modulus.nominal,
        "law": law,
        "misfit": misfit,
        "stretch": stretch,
        "sensitivity": [sensitivity(sensor, pressure) for pressure in PRESSURES_KPA],
        "source": modulus.source.split(":")[0].split(";")[0] if material.law is None else below,
    }


def by_law(name: str, sensor: Sensor) -> dict[str, Any]:
    """Sensitivity (kPa/N) and limits (kPa) by the fitted law and by the neo-Hookean one."""
    other = sensor.replace(law=None, largest_stretch=None)
    fitted, plain = (solid_result(one.replace(waves=0), np.array([0.0]), past_limit=1.0) for one in (sensor, other))
    kpa = {key: value / KPA for key, value in fitted.limits.named() if key in ("law range", "limit point")}
    return {
        "material": name,
        "law_kPa_per_N": fitted.states[0].figures.sensitivity,
        "neo_hookean_kPa_per_N": plain.states[0].figures.sensitivity,
        "law_limits_kPa": kpa,
        "neo_hookean_limit_kPa": plain.limits.limit_point / KPA,
    }


def hardness() -> list[dict[str, Any]]:
    """Young's modulus at small strain (MPa) and over Gent's, of materials with a Shore A hardness and a law or a note."""
    found = []
    for name, material in materials().items():
        if material.shore_a is not None and (material.is_cast or name == "TangoPlus"):
            shore, young = material.shore_a.nominal, 3.0 * material_sensor(material).wall.hyperelastic.mu
            found.append(
                {"material": name, "shore_a": shore, "young_MPa": young, "over_gent": young / young_modulus(shore)}
            )
    return found


def measure() -> dict[str, Any]:
    """All numbers of the page."""
    sensors = {name: material_sensor(material) for name, material in materials().items()}
    return {
        "materials": [row(name, material) for name, material in materials().items()],
        "laws": [by_law(name, sensor) for name, sensor in sensors.items() if sensor.wall.law is not None],
        "hardness": hardness(),
    }


def reach() -> list[str]:
    """The largest stretch of tension by the first invariant on the shipped domes, by modulus and driving pressure."""
    lines = []
    for name in ("paper-dome", "fingertip-dome", "soft-pad"):
        given = evaluate(name, {"pneumatics.driving_pressures_kPa": [0.0]}, model="membrane").sensor.replace(waves=0)
        for modulus in (0.012, 0.025, 0.05, 0.08, 0.2, 0.35, 0.6):
            sensor = given.replace(shear_modulus=modulus)
            probe = solid_probe(sensor)
            run = inflate(probe.solid, past_limit=1.0)
            for share in (0.0, 0.5, 0.8):
                free = state_at(probe.solid, share * run.limit.pressure, run)
                pressed = indent(probe.solid, free, press_settings(sensor), probe)
                most = max(probe.greatest_tension(one.positions / probe.solid.length) for one in pressed.path)
                lines.append(f"{name} {modulus:g} MPa, {share:g} of the limit point: {most:.2f}")
    return lines


if __name__ == "__main__":
    if "--reach" in sys.argv:
        sys.stdout.write("\n".join(reach()) + "\n")
    else:
        store("materials", measure())
