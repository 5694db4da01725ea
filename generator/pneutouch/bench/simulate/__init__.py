"""The simulator: records like those of a rig, from known sensors. They are always labelled as simulated."""

from pneutouch.bench.simulate.curve import ModelDeviation, PressCurve, press_curves
from pneutouch.bench.simulate.rig import RigModel
from pneutouch.bench.simulate.runs import RecordSamples, simulate_leak, simulate_run
from pneutouch.bench.simulate.scatter import ScatterModel, SimulatedSpecimens, WallMemory
from pneutouch.bench.simulate.truth import Population, SimulationTruth, population, specimen_figures

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
