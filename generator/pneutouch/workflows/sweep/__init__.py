"""Many designs to one dataset: planned, computed in pieces that survive a kill, written whole or not at all."""

from pneutouch.workflows.sweep.plan import Axis, Plan
from pneutouch.workflows.sweep.read import plan_of_file, plan_of_flags
from pneutouch.workflows.sweep.run import Outcome, sweep

__all__ = ["Axis", "Outcome", "Plan", "plan_of_file", "plan_of_flags", "sweep"]
