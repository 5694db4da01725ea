"""Schemas of what single commands find: a fitted law, a simulated signal, a scan, the truth of a simulated campaign."""

from pneutouch.bench.simulate.scatter import ParameterRecord
from pneutouch.schemas.shape import (
    FLAG,
    NUMBER,
    NUMBERS,
    TEXT,
    TEXTS,
    WHOLE,
    Schema,
    choice,
    described_by,
    items,
    mapping,
    or_null,
    record,
)
from pneutouch.schemas.typed import typed

_MAYBE = or_null(NUMBER)


def fit() -> Schema:
    """Schema of ``fit.json`` and of the output of ``pneutouch fit-material --json``."""
    specimen = {
        "data": TEXT,
        "points": described_by("Number of points.", WHOLE),
        "slack_percent": NUMBER,
        "shear_modulus_MPa": NUMBER,
    }
    keys = {
        "material": described_by("Name of the fitted material.", TEXT),
        "file": TEXT,
        "test": choice("tension", "puck"),
        "largest_stretch": NUMBER,
        "law": _law(),
        "shear_modulus_small_strain_MPa": NUMBER,
        "shear_modulus_MPa": NUMBER,
        "shear_modulus_uncertainty_MPa": _MAYBE,
        "specimens": described_by("Measured specimens.", items(record("A measured specimen.", specimen))),
        "fits": items(_law(refused=or_null(TEXT))),
        "profile": or_null(TEXT),
        "notes": TEXTS,
        "folder": TEXT,
    }
    return record("A material law fitted to a lab's own test.", keys, ["folder"])


def _law(**more: Schema) -> Schema:
    keys = {
        "name": described_by("Name of the law.", TEXT),
        "label": TEXT,
        "constants": described_by("Constants of the law: MPa, exponents without unit.", NUMBERS),
        "uncertainties": items(_MAYBE),
        "misfit_percent": NUMBER,
        "misfit_of_points_percent": NUMBER,
    }
    return record("A fitted law.", {**keys, **more})


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
