"""A design evaluated: prediction, uncertainty, limits, and the comparison with published figures."""

from pneutouch.evaluation.evaluate import Evaluation, evaluate

__all__ = ["Evaluation", "evaluate"]
