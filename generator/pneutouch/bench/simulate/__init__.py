"""Simulator: records of known sensors, like those of a rig, always labelled as simulated."""

from pneutouch.bench.simulate.curve import ModelDeviation, PressCurve, press_curves
from pneutouch.bench.simulate.rig import RigModel, ScatterModel, SimulatedSpecimens, WallMemory
from pneutouch.bench.simulate.runs import (
    Population,
    RecordSamples,
    SimulationTruth,
    population,
    simulate_leak,
    simulate_run,
    specimen_figures,
)

__all__ = [
    "ModelDeviation",
    "Population",
    "PressCurve",
    "RecordSamples",
    "RigModel",
    "ScatterModel",
    "SimulatedSpecimens",
    "SimulationTruth",
    "WallMemory",
    "population",
    "press_curves",
    "simulate_leak",
    "simulate_run",
    "specimen_figures",
]
