"""The uncertainty of a prediction: stated sources, their shares, expanded uncertainties with k = 2 (JCGM 100)."""

from pneutouch.mechanics.uncertainty.document import budget, document, text
from pneutouch.mechanics.uncertainty.sources.model_error import model_errors

__all__ = ["budget", "document", "model_errors", "text"]
