"""Relaxation, hysteresis and ageing of a predicted sensor, as a datasheet shows them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from pneutouch.evaluation.sheet_data import AgeingData, LoadingLoop, RelaxationCurve, ViscousData, ViscousRow
from pneutouch.mechanics import Sensor, SensorPrediction
from pneutouch.mechanics.viscous.prony import ageing_ratio, ageing_unknown, unknown
from pneutouch.spec.material import Material

if TYPE_CHECKING:
    from pneutouch.mechanics.viscous.describe import ViscousRuns
    from pneutouch.mechanics.viscous.runs import LoopRun, RelaxationRun

# The runs are followed on the atlas or by the solid, which a prediction by the membrane model must not load.


def viscous_runs(prediction: SensorPrediction, material: Material, sensor: Sensor) -> ViscousRuns | str:
    """The runs of every state of a prediction, or why there are none."""
    why = unknown(sensor, material, prediction.model)
    if why is not None:
        return why
    from pneutouch.mechanics.viscous.describe import chosen_depth, describe

    depth = chosen_depth(sensor, [state.range_end for state in prediction.states])
    if not depth > 0:
        return "a state has no range"
    return describe(sensor, material, [state.driving_pressure for state in prediction.states], depth)


def viscous_data(runs: ViscousRuns | str) -> ViscousData | str:
    """The figures and curves of all runs, or why there are none."""
    if isinstance(runs, str):
        return runs
    from pneutouch.mechanics.viscous.describe import RAMP_SPEED

    rows = tuple(
        _row(pressure, j, runs.held[i][j], {speed: of[i][j] for speed, of in runs.loops.items()})
        for i, pressure in enumerate(runs.driving_pressures)
        for j in range(len(runs.sources))
    )
    quick = list(runs.loops.values())[-1]
    held, loops = tuple(map(_curve, runs.held[-1])), tuple(map(_loop, quick[-1]))
    return ViscousData(runs.depth, RAMP_SPEED, runs.sources, runs.basis, rows, held, loops)


def _row(pressure: float, j: int, held: RelaxationRun, loops: dict[float, LoopRun]) -> ViscousRow:
    losses = None
    if held.ended is None:
        (force, _), (rise, decade) = held.drop(held.force), held.drop(held.rise)
        losses = force, rise, decade
    measures = {speed: run.hysteresis() for speed, run in loops.items()}
    ended: dict[float | str, str] = {speed: run.ended for speed, run in loops.items() if run.ended}
    return ViscousRow(
        pressure,
        j,
        losses,
        {speed: None if measure is None else measure[0] for speed, measure in measures.items()},
        ended | ({"held": held.ended} if held.ended else {}),
        tuple(run.contact_lost for run in loops.values() if run.contact_lost is not None),
    )


def _curve(run: RelaxationRun) -> RelaxationCurve | None:
    late = run.times >= 1.0 - 1e-9
    if late.sum() < 2:
        return None
    force, rise = (100 * values / values[late][0] for values in (run.force, run.rise))
    return RelaxationCurve(run.times, force, rise)


def _loop(run: LoopRun) -> LoadingLoop | None:
    return None if run.force_out.size < 2 else LoadingLoop(run.force_in, run.rise_in, run.force_out, run.rise_out)


def ageing_data(prediction: SensorPrediction, material: Material, sensor: Sensor) -> AgeingData | str:
    """Modulus after a year and the change of sensitivity at the lowest and highest pressure, or why it is unknown.

    Outside the atlas there is no change of sensitivity.
    """
    why = ageing_unknown(material)
    if why is not None:
        return why
    from pneutouch.mechanics.atlas_states import outside_atlas
    from pneutouch.mechanics.viscous.describe import ageing_shift

    changes: tuple[tuple[float, float], ...] = ()
    if outside_atlas(sensor) is None:
        ends = [prediction.states[k].driving_pressure for k in (0, -1)]
        shift = ageing_shift(sensor, material, ends)[1]
        if np.isfinite(shift).all():
            changes = tuple(zip(ends, shift.tolist(), strict=True))
    return AgeingData(ageing_ratio(material), changes)
