"""Sweep: many designs into one dataset, computed in parts that survive an abort, written whole or not at all."""

from pneutouch.workflows.sweep.execute import SweepResult, sweep
from pneutouch.workflows.sweep.grid import SweepAxis, SweepPlan, plan_of_file, plan_of_flags, plan_of_grid

__all__ = ["SweepAxis", "SweepPlan", "SweepResult", "plan_of_file", "plan_of_flags", "plan_of_grid", "sweep"]
