"""A design's sensor as a model of a simulator."""

from pneutouch.workflows.simulator.run import SIMULATORS, SimulatorResult, make_simulator, write_simulator

__all__ = ["SIMULATORS", "SimulatorResult", "make_simulator", "write_simulator"]
