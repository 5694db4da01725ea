"""The simulator: records like those of a rig, from known sensors. They are always labelled as simulated."""

from pneutouch.bench.simulate.curve import PressCurve, press_curves
from pneutouch.bench.simulate.deviation import ModelDeviation
from pneutouch.bench.simulate.rig import RigModel
from pneutouch.bench.simulate.run import RecordSamples, simulate_leak, simulate_run
from pneutouch.bench.simulate.scatter import ScatterModel, SimulatedSpecimens
from pneutouch.bench.simulate.truth import Population, SimulationTruth, population, specimen_figures
from pneutouch.bench.simulate.wall import WallMemory

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
