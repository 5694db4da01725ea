"""A rig that is none: records as a laboratory would get them, from known sensors. Always labelled as simulated."""

from pneutouch.bench.simulate.curve import PressCurve, press_curves
from pneutouch.bench.simulate.rig import RigModel
from pneutouch.bench.simulate.run import Samples, simulate_leak, simulate_run
from pneutouch.bench.simulate.scatter import Scatter, Specimens
from pneutouch.bench.simulate.truth import Population, Truth, population, specimen_figures
from pneutouch.bench.simulate.wall import Wall

__all__ = [
    "Population", "PressCurve", "RigModel", "Samples", "Scatter", "Specimens", "Truth", "Wall", "population", "press_curves",
    "simulate_leak", "simulate_run", "specimen_figures",
]  # fmt: skip
