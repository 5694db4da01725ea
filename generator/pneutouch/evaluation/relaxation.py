"""Relaxation, hysteresis and ageing of a predicted sensor, as a datasheet shows them."""

from typing import TYPE_CHECKING

import numpy as np

from pneutouch.mechanics import Sensor, SensorPrediction
from pneutouch.mechanics.viscous.prony import unknown
from pneutouch.results.behaviour import BySource, Hold, Loop, Viscous, ViscousState, WholeLoop
from pneutouch.spec.material import Material
from pneutouch.units import KPA
from pneutouch.wording import rounded

if TYPE_CHECKING:
    from pneutouch.mechanics.viscous.describe import ViscousRuns
    from pneutouch.mechanics.viscous.runs import LoopRun, RelaxationRun

_DIGITS = 6

# The runs are followed on the atlas or by the solid, which a prediction by the membrane model must not load.


def viscous_runs(prediction: SensorPrediction, material: Material, sensor: Sensor) -> "ViscousRuns | str":
    """The runs of every state of a prediction, or the reason why there are none."""
    why = unknown(sensor, material, prediction.model)
    if why is not None:
        return why
    if prediction.states[0].driving_pressure < 0.0:
        return "a driving pressure is below ambient"
    from pneutouch.mechanics.viscous.describe import chosen_depth, describe

    depth = chosen_depth(sensor, [state.range_end for state in prediction.states])
    if not depth > 0:
        return "a state has no range"
    return describe(sensor, material, [state.driving_pressure for state in prediction.states], depth)


def viscous(runs: "ViscousRuns | str") -> Viscous:
    """Record of relaxation and hysteresis of every state by every source of data, or of why there is none."""
    if isinstance(runs, str):
        return Viscous(unknown=runs)
    from pneutouch.mechanics.viscous.describe import RAMP_SPEED

    states = tuple(
        ViscousState(pressure / KPA, tuple(_by_source(runs, i, j) for j in range(len(runs.sources))))
        for i, pressure in enumerate(runs.driving_pressures)
    )
    record = Viscous(
        depth_mm=runs.depth, ramp_speed_mm_per_s=RAMP_SPEED, sources=runs.sources, basis=runs.basis, states=states
    )
    return rounded(record, _DIGITS)


def _by_source(runs: "ViscousRuns", i: int, j: int) -> BySource:
    return BySource(_hold(runs.held[i][j]), tuple(_pressed(speed, of[i][j]) for speed, of in runs.loops.items()))


def _hold(run: "RelaxationRun") -> Hold:
    if run.ended is not None:
        return Hold(ended=run.ended)
    (force, force_decade), (rise, rise_decade) = run.drop(run.force), run.drop(run.rise)
    return Hold(100 * force, 100 * force_decade, 100 * rise, 100 * rise_decade, 1.0, float(np.round(run.times[-1], 9)))


def _pressed(speed: float, run: "LoopRun") -> Loop:
    hysteresis = run.hysteresis()
    if hysteresis is None:
        return Loop(speed_mm_per_s=speed, ended=run.ended)
    width, area = hysteresis
    return WholeLoop(
        speed_mm_per_s=speed,
        width_percent=100 * width,
        area_percent=100 * area,
        contact_lost_at_mm=run.contact_lost,
        ended=run.ended,
    )
