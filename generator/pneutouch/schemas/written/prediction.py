"""The schema of a prediction, from the records that declare it."""

from pneutouch.results.prediction import PredictionRecord
from pneutouch.schemas.shape import Schema
from pneutouch.schemas.typed import of_record
from pneutouch.schemas.written.parts import contact


def prediction() -> Schema:
    """Schema of the output of ``pneutouch predict --json``, part of which ``prediction.json`` holds."""
    return of_record(PredictionRecord, {"PredictionRecord.contact": contact()})
