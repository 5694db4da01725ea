"""The paper's statements beside what this program computes: ``python docs/_ext/paper_claims.py`` (20 s).

Writes docs/background/claims.json, from which ``make pages charts`` makes docs/background/paper.md and its figures. A
verdict is computed, never written: the statement holds for the figures here ("agrees"), does not ("differs"), or is of
something that no model here has ("not modelled"). The reasons are words.
"""

from __future__ import annotations

import json
import statistics
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.catalogue import Library
from pneutouch.evaluation.charts import air
from pneutouch.evaluation.evaluate import Evaluation, evaluate
from pneutouch.evaluation.result import predicted
from pneutouch.evaluation.table_s1 import measured
from pneutouch.mechanics import Sensor, SensorPrediction, SensorState, predict
from pneutouch.mechanics.membrane import LIMIT_HEIGHT, pressure, relative_height, thickness_stretch
from pneutouch.mechanics.models.membrane import cap_volume
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.response import tangent_stiffness
from pneutouch.mechanics.sensor import Filling
from pneutouch.spec.material import Material
from pneutouch.units import KPA, ML

BACKGROUND = Path(__file__).resolve().parents[1] / "background"
ROOT = BACKGROUND.parents[1]
PRESSURES_kPa = (0.0, 5.0, 12.0, 22.0)
HEIGHTS = tuple(np.linspace(10.75, 26.0, 32).tolist())
"""Apex heights outside, mm, of the states through the limit point of TangoPlus."""
SHALLOW = (1.0, 3.0)
"""Depths, mm, at which a tangent stiffness is read."""
SOFT, FLAT, HARD = ("TangoPlus", "FLX9940-DM", "FLX9950-DM", "FLX9960-DM"), "FLX9970-DM", ("FLX9985-DM", "FLX9995-DM")
RADII = (5.0, 9.25, 15.0, 25.0)
CLOSE = 0.05
"""Relative difference up to which a number of the paper's theory counts as met."""

PRINTED = ("modulus between prints", "wall thickness", "inner radius")
"""Sources of the uncertainty that differ between prints of one design."""
AGED = {"TangoPlus": 0.1476, "FLX9950-DM": 0.1698, "FLX9970-DM": 0.349}
"""Mean change of the sensitivity in a year (Supplement E)."""


def tangent(state: SensorState, depth: float) -> float:
    """Tangent stiffness dF/d(depth), N/mm, at a depth in mm."""
    return float(np.interp(depth, state.indentation, tangent_stiffness(state.indentation, state.force)))


def sensitivity(state: SensorState) -> float:
    """Sensitivity of a state, kPa/N; NaN without a line."""
    return state.figures.sensitivity if state.figures else float("nan")


class Found:
    """What this program computes for the paper's sensor, each thing once."""

    @cached_property
    def resins(self) -> dict[str, Material]:
        """The seven resins of Table S1 by title, softest first."""
        library = Library((ROOT,))
        known = [m for m in library.all("materials", Material).values() if measured(m)]
        known.sort(key=lambda m: m.shear_modulus_MPa.nominal if m.shear_modulus_MPa else 0.0)
        return {m.title: m for m in known}

    @cached_property
    def sensors(self) -> dict[str, Sensor]:
        """The paper's sensor in each resin."""
        return {title: material_sensor(material) for title, material in self.resins.items()}

    @cache  # noqa: B019 (one object lives as long as the program)
    def states(self, model: str, closure: str = "variational") -> dict[str, tuple[SensorState, ...]]:
        """States at `PRESSURES_kPa` by resin."""
        return {title: self.prediction(title, model, closure).states for title in self.sensors}

    @cache  # noqa: B019
    def prediction(self, title: str, model: str, closure: str = "variational") -> SensorPrediction:
        """Prediction of the sensor in a resin."""
        return predict("", self.sensors[title], [p * KPA for p in PRESSURES_kPa], model=model, closure=closure)

    @cache  # noqa: B019
    def beyond(self, closure: str) -> tuple[SensorState, ...]:
        """States of the membrane in TangoPlus at `HEIGHTS`, through the limit point."""
        heights = [Filling("apex", height) for height in HEIGHTS]
        return predict("", self.sensors["TangoPlus"], [0.0], model="membrane", closure=closure, fillings=heights).filled

    @cached_property
    def solid_beyond(self) -> tuple[SensorState, ...]:
        """States of the solid in TangoPlus by injected gas, up to where the resin tears."""
        gas = [Filling("injected", v * ML) for v in (0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 5.23, 6.0, 7.0, 8.0, 9.0)]
        return predict("", self.sensors["TangoPlus"], [0.0], fillings=gas).filled

    @cached_property
    def paper_dome(self) -> Evaluation:
        """The shipped design of the paper's sensor."""
        pressures = {"pneumatics.driving_pressures_kPa": [0.0, 22.0]}
        return evaluate("paper-dome", pressures, library=Library((ROOT,)))

    def ratio(self, title: str, model: str = "solid") -> float:
        """Sensitivity at 22 kPa over that at 0."""
        states = self.states(model)[title]
        return sensitivity(states[-1]) / sensitivity(states[0])

    def published(self, title: str) -> tuple[float, float]:
        """Table S1: sensitivities at 0 and 22 kPa."""
        cells = measured(self.resins[title])
        assert cells is not None
        return cells

    @cached_property
    def by_print(self) -> dict[str, float]:
        """Standard deviation of the sensitivity between prints at 0 kPa, kPa/N, for the resins of Supplement E."""
        spread = {}
        for name in ("TangoPlus", "FLX9950", "FLX9970"):
            changes = {"membrane.material": name, "pneumatics.driving_pressures_kPa": [0.0]}
            (state,) = predicted(evaluate("paper-dome", changes, library=Library((ROOT,)))).states
            assert state.uncertainty is not None and state.uncertainty.elasticities is not None
            slopes = state.uncertainty.elasticities["sensitivity_kPa_per_N"]
            moves = {source.name: source for source in state.uncertainty.sources or ()}
            parts = [slopes[moves[s].acts_on] * moves[s].standard_uncertainty for s in PRINTED if s in moves]
            spread[name] = float(np.hypot.reduce(parts)) * (state.sensitivity_kPa_per_N or 0.0)
        return spread

    @cached_property
    def year(self) -> dict[str, float]:
        """Mean relative change of the sensitivity in a year by the hardness, 0 to 22 kPa."""
        names = {"TangoPlus": "TangoPlus", "FLX9950-DM": "FLX9950", "FLX9970-DM": "FLX9970"}
        changes = {}
        for title, name in names.items():
            new, old = (
                evaluate("paper-dome", {"membrane.material": name}, aged=aged, library=Library((ROOT,))).prediction
                for aged in (False, True)
            )
            pairs = zip(new.states, old.states, strict=True)
            changes[title] = statistics.mean(abs(sensitivity(a) / sensitivity(b) - 1) for a, b in pairs)
        return changes


Answer = tuple[str, bool | None]


@dataclass(frozen=True)
class Claim:
    """A statement: the part of this page, its place in the paper, what it says, our figures with the verdict (None: not
    modelled), and the reason where it differs or is not modelled."""

    part: str
    place: str
    says: str
    answer: Callable[[Found], Answer]
    why: str = ""


class Verdict(NamedTuple):
    """A claim with its figures, as the page shows it."""

    part: str
    place: str
    says: str
    ours: str
    verdict: str
    why: str


def judged(found: Found) -> list[Verdict]:
    """Every claim with its verdict."""
    from paper_statements import CLAIMS

    words = {True: "agrees", False: "differs", None: "not modelled"}
    rows = []
    for claim in CLAIMS:
        ours, holds = claim.answer(found)
        why = claim.why if holds is not True else ""
        rows.append(Verdict(claim.part, claim.place, claim.says, ours, words[holds], why))
    return rows


def figures(found: Found) -> dict[str, Any]:
    """The curves of the paper's figures, as lists."""
    height = np.linspace(1.0, 3.0, 81)
    domes = {
        title: (s.dome.inner_radius, s.dome.wall_thickness, s.wall.shear_modulus) for title, s in found.sensors.items()
    }
    solid = found.states("solid")
    return {
        "3a": {
            t: _pairs(height * d[0] + thickness_stretch(height) * d[1], pressure(height, *d) / KPA)
            for t, d in domes.items()
        },
        "3c": _pairs(np.array(RADII), LIMIT_HEIGHT * np.array(RADII)),
        "5a": {c: _beyond(found.beyond(c), lambda s: tangent(s, SHALLOW[1])) for c in ("variational", "printed")},
        "6": {t: [_pairs(s.force, s.pressure_rise / KPA) for s in solid[t]] for t in (*SOFT[:2], SOFT[3])},
        "6g": {
            t: _pairs(np.array(PRESSURES_kPa), np.array([sensitivity(s) for s in states]))
            for t, states in solid.items()
        },
        "measured": {t: found.published(t) for t in found.sensors},
        "7a": {c: _beyond(found.beyond(c), sensitivity) for c in ("variational", "printed")},
        "7a solid": _beyond(found.solid_beyond, sensitivity),
        "5a solid": _beyond(found.solid_beyond, lambda s: tangent(s, SHALLOW[1])),
    }


def _beyond(states: tuple[SensorState, ...], read: Callable[[SensorState], float]) -> list[list[float]]:
    """Pressure, kPa, height outside, mm, and a figure of states in order of volume."""
    rows = [[state.driving_pressure / KPA, state.apex_outer, read(state)] for state in states]
    return [[float(f"{x:.6g}") for x in row] for row in rows]


def _pairs(x: Array, y: Array) -> list[list[float]]:
    return [[float(f"{a:.6g}") for a in values] for values in (x, y)]


def volumes(found: Found, at_kPa: float) -> dict[str, float]:
    """Cavity volume of the membrane at a pressure over that at rest, by resin."""
    ratios = {}
    for title, sensor in found.sensors.items():
        dome = sensor.dome
        x = relative_height(np.array(at_kPa * KPA), dome.inner_radius, dome.wall_thickness, sensor.wall.shear_modulus)
        ratios[title] = float(cap_volume(x, 1.0) / cap_volume(np.array(1.0), 1.0))
    return ratios


def by_temperature(found: Found) -> Array:
    """Change of the sealed pressure with temperature, kPa/K, at 0 and 22 kPa."""
    return np.asarray(air(found.paper_dome).by_temperature_kPa_per_K)


def main() -> None:
    """Compute and store."""
    found = Found()
    content = {"claims": [verdict._asdict() for verdict in judged(found)], "figures": figures(found)}
    (BACKGROUND / "claims.json").write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
