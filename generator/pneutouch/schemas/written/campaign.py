"""Schema of a test plan: its record, with tables that other declarations hold."""

from pneutouch.results.plan import PlannedCampaign
from pneutouch.schemas.models import model_schema
from pneutouch.schemas.shape import TEXT, Schema, or_null, record
from pneutouch.schemas.typed import of_record
from pneutouch.schemas.written.parts import contact
from pneutouch.spec.campaign import Rig


def plan() -> Schema:
    """Schema of ``plan.json`` and of the output of ``pneutouch plan --json``."""
    rig = model_schema(Rig)["properties"]
    rig = {key: {k: v for k, v in field.items() if k != "default"} for key, field in rig.items()}
    instead = {
        "PlannedCampaign.contact": contact(),
        "PlannedCampaign.rig": record("The rig.", {**rig, "file": or_null(TEXT)}),
    }
    return of_record(PlannedCampaign, instead)
