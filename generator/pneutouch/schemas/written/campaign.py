"""Schemas of what campaigns write: the plan, and the figures of the measured runs."""

from pneutouch.results.prediction import RatingRecord
from pneutouch.schemas.models import model_schema
from pneutouch.schemas.shape import (
    FLAG,
    NUMBER,
    NUMBERS,
    TEXT,
    WHOLE,
    Schema,
    described_by,
    items,
    mapping,
    or_null,
    record,
)
from pneutouch.schemas.typed import of_record, typed
from pneutouch.schemas.written.parts import contact
from pneutouch.spec.campaign import Rig, RunKind
from pneutouch.workflows.plan import StepRecord

_KIND: Schema = {"enum": list(RunKind.__args__)}  # type: ignore[attr-defined]


def plan() -> Schema:
    """Schema of ``plan.json`` and of the output of ``pneutouch plan --json``."""
    rig = model_schema(Rig)["properties"]
    rig = {key: {k: v for k, v in field.items() if k != "default"} for key, field in rig.items()}
    warning = {
        "rule": TEXT,
        "resin": or_null(TEXT),
        "driving_pressure_kPa": or_null(NUMBER),
        "depth_mm": or_null(NUMBER),
        "message": TEXT,
    }
    text_keys = {"name": TEXT, "design": TEXT, "title": TEXT, "dead_volume_note": TEXT, "folder": TEXT}
    number_keys = (
        "inner_radius_mm",
        "wall_thickness_mm",
        "ambient_pressure_kPa",
        "dead_volume_mL",
        "clearance_mm",
        "plate_diameter_mm",
        "total_s",
    )
    keys = {
        **text_keys,
        **dict.fromkeys(number_keys, NUMBER),
        "driving_pressures_kPa": NUMBERS,
        "contact": contact(),
        "rig": record("The rig.", {**rig, "file": or_null(TEXT)}),
        "sensors": items(record("A specimen.", {"sensor": TEXT, "resin": TEXT})),
        "resins": items(_expected()),
        "tests": mapping(_test()),
        "runs": items(_planned_run()),
        "warnings": items(record("Where the rig cannot follow.", warning)),
    }
    return record("A measurement campaign, run by run.", keys, ("dead_volume_note", "contact", "folder"))


def _points() -> Schema:
    values = ("force_N", "pressure_rise_kPa", "cavity_pressure_kPa")
    return items(record("A depth.", {"depth_mm": NUMBER, **dict.fromkeys(values, or_null(NUMBER))}))


def _expected() -> Schema:
    injected = ("volume_mL", "pressure_kPa", "without_dead_volume_kPa", "with_more_dead_volume_kPa")
    volumes = (
        "cavity_volume_mL",
        "dead_volume_mL",
        "line_pressure_kPa",
        "line_volume_mL",
        "more_dead_volume_mL",
        "sensor_volume_mL",
    )
    rows = items(record("A volume.", dict.fromkeys(injected, or_null(NUMBER))))
    injection = {**dict.fromkeys(volumes, or_null(NUMBER)), "sensor": rows}
    state = {
        "driving_pressure_kPa": NUMBER,
        "points": _points(),
        "range_end_mm": NUMBER,
        "range_ends_by": or_null(TEXT),
    }
    keys = {
        "resin": TEXT,
        "model": TEXT,
        "states": items(record("One driving pressure.", state)),
        "injection": record("Air to inject, and the expected readings.", injection),
        "limit_kPa": NUMBER,
        "limit_by": TEXT,
        "rating": of_record(RatingRecord),
        "leak_limit_kPa_per_min": or_null(NUMBER),
    }
    return record("Expected readings of one resin.", keys)


def _test() -> Schema:
    numbers = ("hold_s", "rest_s", "speed_mm_per_s", "duration_s")
    keys = {
        "depths_mm": NUMBERS,
        **dict.fromkeys(numbers, NUMBER),
        "reset": FLAG,
        "driving_pressures_kPa": NUMBERS,
        "runs": described_by("How often it is done.", WHOLE),
    }
    return record("A kind of run.", keys)


def _planned_run() -> Schema:
    keys = {
        "number": WHOLE,
        "kind": _KIND,
        "sensor": TEXT,
        "resin": TEXT,
        "driving_pressure_kPa": NUMBER,
        "run": WHOLE,
        "file": TEXT,
        "steps": items(typed(StepRecord, {})),
        "expected": _points(),
        "duration_s": NUMBER,
    }
    return record("A run.", keys)
