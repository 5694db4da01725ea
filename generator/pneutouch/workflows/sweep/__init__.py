"""Many designs to one dataset: planned, computed in pieces that survive a kill, written whole or not at all."""

from pneutouch.workflows.sweep.plan import SweepAxis, SweepPlan
from pneutouch.workflows.sweep.read import plan_of_file, plan_of_flags, plan_of_grid
from pneutouch.workflows.sweep.run import SweepResult, sweep

__all__ = ["SweepAxis", "SweepPlan", "SweepResult", "plan_of_file", "plan_of_flags", "plan_of_grid", "sweep"]
