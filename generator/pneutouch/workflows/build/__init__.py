"""A design to its output folder."""

from pneutouch.workflows.build.run import STEPS, build, input_hash, inputs

__all__ = ["STEPS", "build", "input_hash", "inputs"]
