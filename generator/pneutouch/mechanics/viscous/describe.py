"""Figures of a press, a hold and a loop of every state."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.batches import batch_of
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.atlas_states import outside_atlas
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.viscous.by_solid import loop_by_solid, relaxation_by_solid
from pneutouch.mechanics.viscous.known import ageing_ratio
from pneutouch.mechanics.viscous.prony import prony_series, relaxed
from pneutouch.mechanics.viscous.runs import LoopRun, RelaxationRun, loop, relaxation
from pneutouch.spec.material import Material
from pneutouch.units import KPA

RAMP_SPEED = 5.0
"""mm/s, of the press before the hold: our choice, the paper gives none."""

LOOP_SPEEDS = (0.5, 5.0)
"""mm/s: our choice, a slow and a quick hand."""

DEPTH_SHARE = 0.5
"""Depth over R0: our choice, the paper's relaxation test gives none. Deeper, stiff resins pressed fast buckle."""

_KERNEL = "one relaxation for all stresses of the resin, that of small strain; no temperature dependence"

BASIS = (
    "quasi-linear viscoelasticity on the atlas, gas isothermal and sealed; the inflated dome has relaxed before "
    "contact",
    _KERNEL,
)

SOLID_BASIS = (
    "quasi-linear viscoelasticity on the solid with its contact along the whole run, friction with its history; gas "
    "isothermal and sealed; the inflated dome has relaxed before contact",
    _KERNEL,
)
"""Under a contact that the atlas does not cover."""


@dataclass(frozen=True)
class ViscousRuns:
    """Runs of one sensor: ``held[i][j]``, ``loops[speed][i][j]`` of state i in series j; MPa, depth in mm.

    ``basis`` states the model, `BASIS` or `SOLID_BASIS`.
    """

    sources: tuple[str, ...]
    driving_pressures: tuple[float, ...]
    depth: float
    held: list[list[RelaxationRun]]
    loops: dict[float, list[list[LoopRun]]]
    basis: tuple[str, ...] = BASIS

    def document(self) -> dict[str, Any]:
        """The figures as data: one entry a state, one a source in it."""
        return {
            "depth_mm": self.depth,
            "ramp_speed_mm_per_s": RAMP_SPEED,
            "sources": list(self.sources),
            "basis": list(self.basis),
            "states": [
                {
                    "driving_pressure_kPa": pressure / KPA,
                    "by_source": [self._of_source(i, j) for j in range(len(self.sources))],
                }
                for i, pressure in enumerate(self.driving_pressures)
            ],
        }

    def _of_source(self, i: int, j: int) -> dict[str, Any]:
        loops = [{"speed_mm_per_s": speed, **_looped(runs[i][j])} for speed, runs in self.loops.items()]
        return {"relaxation": _held(self.held[i][j]), "hysteresis": loops}


def describe(sensor: Sensor, material: Material, driving_pressures: Sequence[float], depth: float) -> ViscousRuns:
    """Press a sensor at driving pressures (MPa) to a depth (mm) in every series of its resin.

    The sensor and its resin must be such that `known.unknown` returns None. A series whose relaxed modulus leaves the
    atlas, where the file gives the instantaneous one, is left out. The solid follows a contact that is not the atlas's.
    """
    kept, held, loops = [], [], []
    by_solid = sensor.protocol.other_contact is not None
    hold, cycle = (relaxation_by_solid, loop_by_solid) if by_solid else (relaxation, loop)
    for series in prony_series(material):
        relaxed_sensor = relaxed(sensor, material, series)
        if not by_solid and outside_atlas(relaxed_sensor) is not None:
            continue
        kept.append(series.source)
        held.append(hold(relaxed_sensor, [series], driving_pressures, depth, RAMP_SPEED))
        loops.append({v: cycle(relaxed_sensor, [series], driving_pressures, depth, v) for v in LOOP_SPEEDS})
    states = range(len(driving_pressures))
    return ViscousRuns(
        tuple(kept),
        tuple(driving_pressures),
        depth,
        [[one[i][0] for one in held] for i in states],
        {v: [[one[v][i][0] for one in loops] for i in states] for v in LOOP_SPEEDS},
        SOLID_BASIS if by_solid else BASIS,
    )


def chosen_depth(sensor: Sensor, range_ends: Sequence[float]) -> float:
    """Depth of the runs in mm: a share of R0, within the range of every state."""
    return float(min(DEPTH_SHARE * sensor.dome.inner_radius, sensor.protocol.depth, *range_ends))


def ageing_shift(sensor: Sensor, material: Material, driving_pressures: Sequence[float]) -> tuple[float, Array]:
    """Ratio of the modulus after a year by hardness, and the relative change of the sensitivity from it, (n,).

    Raises InputError if the resin's hardness after a year is not known.
    """
    ratio = ageing_ratio(material)
    old = sensor.replace(shear_modulus=ratio * sensor.wall.shear_modulus)
    before_kPa_per_N, after_kPa_per_N = (
        respond(batch_of(one, driving_pressures), one.protocol.steps).lines.sensitivity_kPa_per_N
        for one in (sensor, old)
    )
    return ratio, after_kPa_per_N / before_kPa_per_N - 1.0


def _held(run: RelaxationRun) -> dict[str, Any]:
    if run.ended is not None:
        return {"ended": run.ended}
    (force, force_decade), (rise, rise_decade) = run.drop(run.force), run.drop(run.rise)
    return {
        "force_loss_percent": 100 * force,
        "force_loss_percent_per_decade": 100 * force_decade,
        "pressure_rise_loss_percent": 100 * rise,
        "pressure_rise_loss_percent_per_decade": 100 * rise_decade,
        "from_s": 1.0,
        "to_s": float(np.round(run.times[-1], 9)),
    }


def _looped(run: LoopRun) -> dict[str, Any]:
    hysteresis, ended = run.hysteresis(), {} if run.ended is None else {"ended": run.ended}
    if hysteresis is None:
        return ended
    return {
        "width_percent": 100 * hysteresis[0],
        "area_percent": 100 * hysteresis[1],
        "contact_lost_at_mm": run.contact_lost,
        **ended,
    }
