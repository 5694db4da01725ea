"""The schema of a selection: designs for a target, a grade for one, or the designs of several processes."""

from pneutouch.schemas.models import model_schema
from pneutouch.schemas.shape import (
    FLAG,
    NUMBER,
    NUMBERS,
    PAIR,
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
from pneutouch.schemas.written.parts import contact

_OPEN: Schema = {"type": "object"}
_NUMBERS_OR_NULL = items(or_null(NUMBER))


def selection() -> Schema:
    """Schema of the output of ``pneutouch select --json``."""
    plain = _answer({})
    by_process = {key: one for key, one in plain["properties"].items() if key != "written"}
    processes = {
        "met": FLAG,
        "processes": mapping(
            {
                **plain,
                "properties": {**by_process, "profile": described_by("The printer profile.", TEXT)},
                "required": [*plain["required"], "profile"],
            }
        ),
        "left_out": {"type": ["object", "array"]},
        "written": or_null(TEXT),
    }
    several = record("The designs of several processes.", processes, ("written",))
    return {"anyOf": [plain, _graded(), several], "description": "Designs for a target."}


def _target() -> Schema:
    """The target with every key, null where it requires nothing."""
    from pneutouch.spec.target import Target

    tables = model_schema(Target)["$defs"]
    helps = {key: tables[field.annotation.__name__]["description"] for key, field in Target.model_fields.items()}  # type: ignore[union-attr]
    keys = {key: described_by(f"{help} Every key is there; null: free.", _OPEN) for key, help in helps.items()}
    return record("The target, as a target file has it.", keys)


def _answer(more: dict[str, Schema]) -> Schema:
    missed = {**_choice(), "misses_percent": {}}
    rejected = {"rule": TEXT, "reason": TEXT, "design": record("The design.", *_candidate())}
    dropped = {"requirement": TEXT, "attainable": TEXT, "design": record("The best design.", *_candidate())}
    ranked = {"rank": WHOLE, "runner_up": FLAG, "passes_check": or_null(FLAG), **_choice()}
    gauge = {"gauge": TEXT, "title": TEXT, "chosen": FLAG, "why": or_null(TEXT), "smallest_force_N": or_null(NUMBER)}
    keys: dict[str, Schema] = {
        "target": _target(),
        "base": TEXT,
        "dead_volume_note": TEXT,
        "contact": contact(notes=True),
        "met": FLAG,
        "candidates": WHOLE,
        "designs": items(record("A design.", ranked, _OPTIONAL)),
        "nearest": or_null(record("The design that misses least.", missed, _OPTIONAL)),
        "dropped_requirements": items(record("A requirement left out.", dropped)),
        "rejected": items(record("A design that breaks a rule.", rejected)),
        "left_out": {"type": ["object", "array"]},
        "gauges": items(record("A gauge that was tried.", gauge)),
        "written": or_null(TEXT),
        **more,
    }
    return record("Ranked designs.", keys, ("dead_volume_note", "contact", "gauges", "written"))


_OPTIONAL = ("place_uncertainty_relative", "plate_sensitivity_kPa_per_N", "rounds")


def _candidate() -> tuple[dict[str, Schema], tuple[str, ...]]:
    return _choice(), _OPTIONAL


def _choice() -> dict[str, Schema]:
    numbers = (
        "inner_radius_mm",
        "wall_thickness_mm",
        "driving_pressure_kPa",
        "outer_diameter_mm",
        "footprint_mm",
        "dead_volume_mL",
        "sensitivity_kPa_per_N",
        "coverage_factor",
        "place_uncertainty_relative",
        "r_squared",
        "range_end_mm",
        "stiffness_N_per_mm",
        "limit_point_kPa",
        "rated_pressure_kPa",
        "plate_sensitivity_kPa_per_N",
    )
    solid = {"sensitivity_kPa_per_N": or_null(NUMBER), "within_expanded_uncertainty": or_null(FLAG)}
    return {
        "material": TEXT,
        "mix": or_null(_OPEN),
        **dict.fromkeys(numbers, NUMBER),
        "expanded_uncertainty_kPa_per_N": or_null(NUMBER),
        "expanded_uncertainty_relative": or_null(NUMBER),
        "force_range_N": PAIR,
        "range_ends_with": TEXT,
        "above_rated_pressure": FLAG,
        "sensitivity_at_0kPa_and_rated_kPa_per_N": _NUMBERS_OR_NULL,
        "margins": mapping(or_null(NUMBER)),
        "binding": TEXT,
        "model": TEXT,
        "rounds": WHOLE,
        "solid": or_null(record("The solid's figures of the design.", solid)),
        "set": TEXTS,
    }


def _graded() -> Schema:
    figures = {
        "driving_pressures_kPa": NUMBERS,
        "sensitivity_kPa_per_N": _NUMBERS_OR_NULL,
        "difference_percent": or_null(NUMBER),
        "force_range_end_N": _NUMBERS_OR_NULL,
        "range_ends_with": TEXTS,
        "rated_pressure_kPa": or_null(NUMBER),
        "above_rated_pressure": FLAG,
        "meets": FLAG,
        "reason": or_null(TEXT),
    }
    design = {
        "material": _OPEN,
        **dict.fromkeys(("inner_radius_mm", "wall_thickness_mm", "dead_volume_mL"), NUMBER),
        **figures,
        "share_used": mapping(or_null(NUMBER)),
        "passes_check": or_null(FLAG),
        "set": TEXTS,
    }
    keys: dict[str, Schema] = {
        "target": _target(),
        "base": TEXT,
        "contact": contact(),
        "met": FLAG,
        "design": record("The grade.", design),
        "rejected": {"type": ["object", "array", "string", "null"]},
        "constant": items(record("A constant mix.", {"name": TEXT, "fraction": or_null(NUMBER), **figures})),
        "nearest_constant_mix": TEXT,
        "cost": record("Work done.", {"solid_solves": WHOLE, "grades_tried": WHOLE}),
        "model": TEXT,
        "left_out": {"type": ["object", "array"]},
        "written": or_null(TEXT),
    }
    return record("A graded membrane.", keys, ("contact", "written"))
