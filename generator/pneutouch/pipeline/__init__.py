"""A design to its output folder: the only part that writes files."""

from pneutouch.pipeline.build import build
from pneutouch.pipeline.evaluate import Evaluation, evaluate

__all__ = ["Evaluation", "build", "evaluate"]
