"""The schema of the truth of a simulated campaign."""

from pneutouch.bench.simulate.scatter import ParameterRecord
from pneutouch.schemas.shape import (
    FLAG,
    NUMBER,
    TEXT,
    TEXTS,
    WHOLE,
    Schema,
    described_by,
    items,
    mapping,
    or_null,
    record,
)
from pneutouch.schemas.typed import typed

_MAYBE = or_null(NUMBER)


def truth() -> Schema:
    """Schema of ``truth.json`` of ``pneutouch simulate``."""
    figures = mapping({"type": ["number", "string", "null"]})
    specimen = {
        "resin": TEXT,
        "age_days": NUMBER,
        "shear_modulus_MPa": NUMBER,
        "pressures": described_by("Figures without noise, by driving pressure in kPa.", mapping(figures)),
        "wall_thickness_mm": NUMBER,
        "dead_volume_mL": NUMBER,
        "model": TEXT,
    }
    population = {
        "resin": TEXT,
        "age_days": NUMBER,
        "driving_pressure_kPa": NUMBER,
        "figures": described_by("Mean figures over specimens.", mapping(_MAYBE)),
        "spread": described_by("Standard deviation of each figure over specimens.", mapping(NUMBER)),
        "count": WHOLE,
        "basis": TEXT,
    }
    keys = {
        "simulated": FLAG,
        "design": TEXT,
        "model": TEXT,
        "seed": WHOLE,
        "rate_Hz": NUMBER,
        "rest_s": NUMBER,
        "parameters": mapping(mapping(mapping(typed(ParameterRecord, {})))),
        "specimens": described_by("Specimens by name.", mapping(record("A simulated specimen.", specimen))),
        "populations": items(record("Sensors of one resin, age and driving pressure.", population)),
        "notes": TEXTS,
    }
    return record("True values of the simulated specimens, without noise.", keys)
