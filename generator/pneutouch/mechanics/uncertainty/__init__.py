"""The uncertainty of a prediction: its sources, their shares of the variance, and intervals with k = 2 (JCGM 100)."""

from pneutouch.mechanics.uncertainty.document import budget, document, text
from pneutouch.mechanics.uncertainty.sources.model_error import model_errors

__all__ = ["budget", "document", "model_errors", "text"]
