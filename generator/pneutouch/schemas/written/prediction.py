"""The schema of a prediction, from the typed dictionaries that declare it."""

from pneutouch.evaluation.document import PredictionRecord
from pneutouch.mechanics.rating import RatingRecord
from pneutouch.mechanics.uncertainty.record import UncertaintyRecord
from pneutouch.schemas.shape import FLAG, NUMBER, NUMBERS, TEXT, TEXTS, WHOLE, Schema, choice, items, or_null, record
from pneutouch.schemas.typed import typed
from pneutouch.schemas.written.parts import contact
from pneutouch.spec.calibration import CalibrationSource

_KNOWN = {"RatingRecord": RatingRecord, "UncertaintyRecord": UncertaintyRecord}
"""Names that the module of the record imports for a type checker alone."""


def prediction() -> Schema:
    """Schema of the output of ``pneutouch predict --json``; ``prediction.json`` holds a part of it."""
    points = ("driving_pressure_kPa", "apex_height_inner_mm", "apex_height_outer_mm", "cavity_volume_mL")
    limit_keys = ("driving_pressure_kPa", "apex_height_inner_mm", "apex_height_outer_mm")
    instead: dict[str, Schema] = {
        "contact": contact(),
        "contact_anywhere": _anywhere(),
        "gauge": _gauge(),
        "viscous": _viscous(),
        "dynamics": _dynamics(),
        "calibration": _calibration(),
        "mixing_curves": items(_by_curve()),
        "limit_point": or_null(
            record(
                "The limit point.",
                dict.fromkeys((*limit_keys, "membrane_stretch", "thickness_stretch"), NUMBER),
                ("membrane_stretch", "thickness_stretch"),
            )
        ),
        "inflation": record("Lists of one length.", dict.fromkeys(points, NUMBERS)),
    }
    return typed(PredictionRecord, instead, _KNOWN)


def _anywhere() -> Schema:
    row = {"object": TEXT, "radius_mm": or_null(NUMBER), "offset_mm": NUMBER, "tilt_deg": NUMBER}
    state = {
        "driving_pressure_kPa": NUMBER,
        "pressure_rise_kPa": NUMBERS,
        "contact_force_N": NUMBERS,
        "force_error_percent": items(items(or_null(NUMBER))),
        "standard_uncertainty_relative": or_null(NUMBER),
    }
    keys = {
        "unknown": TEXT,
        "contacts": items(record("One contact.", row)),
        "states": items(record("One driving pressure.", state)),
        "plate_offset_without_effect_mm": or_null(NUMBER),
        "table_error_relative": NUMBER,
    }
    return record("Errors of the force read where object and place of contact are unknown.", keys, keys)


def _gauge() -> Schema:
    state = (
        "smallest_force_N",
        "smallest_force_at_first_contact_N",
        "zero_drift_kPa_per_K",
        "zero_drift_N_per_K",
        "warming_that_reads_as_smallest_force_K",
    )
    numbers = ("noise_kPa", "step_kPa", "threshold_kPa", "rate_Hz", "bandwidth_Hz", "reads_from_kPa", "reads_to_kPa")
    states = {"driving_pressure_kPa": NUMBER, **dict.fromkeys(state, or_null(NUMBER))}
    keys = {
        "name": or_null(TEXT),
        "title": TEXT,
        "reference": choice("gauge", "absolute"),
        **dict.fromkeys(numbers, or_null(NUMBER)),
        "criterion": TEXT,
        "limited_by": or_null(TEXT),
        "inner_volume_counted_mL": or_null(NUMBER),
        "states": items(record("One driving pressure.", states)),
    }
    return record("The pressure gauge and the smallest force that is detected.", keys)


def _viscous() -> Schema:
    losses = ("force_loss", "pressure_rise_loss")
    held: dict[str, Schema] = {f"{each}_percent{more}": NUMBER for each in losses for more in ("", "_per_decade")}
    held |= {"ended": TEXT, "from_s": NUMBER, "to_s": NUMBER}
    looped: dict[str, Schema] = {
        "speed_mm_per_s": NUMBER,
        "width_percent": NUMBER,
        "area_percent": NUMBER,
        "contact_lost_at_mm": or_null(NUMBER),
        "ended": TEXT,
    }
    source = {
        "relaxation": record("After the plate has stopped.", held, held),
        "hysteresis": items(record("One speed.", looped, set(looped) - {"speed_mm_per_s"})),
    }
    state = {"driving_pressure_kPa": NUMBER, "by_source": items(record("One source.", source))}
    keys = {
        "unknown": TEXT,
        "depth_mm": NUMBER,
        "ramp_speed_mm_per_s": NUMBER,
        "sources": TEXTS,
        "basis": TEXTS,
        "states": items(record("One driving pressure.", state)),
    }
    return record("Relaxation and hysteresis; or `unknown` alone, the reason why there are none.", keys, keys)


def _dynamics() -> Schema:
    known = ("resonance_gain", "delay_ms", "rise_time_ms", "overshoot_percent", "fast_gas_over_slow")
    state = {
        "driving_pressure_kPa": NUMBER,
        "relaxation_source": or_null(TEXT),
        "first_resonance_Hz": or_null(NUMBER),
        "bandwidth_3_dB_Hz": or_null(NUMBER),
        "bandwidth_limited_by": or_null(TEXT),
        "within_5_percent_Hz": or_null(NUMBER),
        "within_5_percent_limited_by": or_null(TEXT),
        **dict.fromkeys((*known, "fast_wall_over_slow"), or_null(NUMBER)),
    }
    piece = {"part": TEXT, **dict.fromkeys(("length_mm", "inner_diameter_mm", "volume_mL"), NUMBER)}
    keys = {
        "basis": TEXTS,
        "line": items(record("One piece of the line.", piece)),
        "end_volume_mL": NUMBER,
        "gauge_rate_Hz": or_null(NUMBER),
        "note": TEXT,
        "states": items(record("One driving pressure.", state)),
    }
    return record("How fast the sensor reads.", keys, ("note",))


def _calibration() -> Schema:
    kinds: dict[object, Schema] = {bool: FLAG, int: WHOLE, str: TEXT, float: NUMBER}
    keys: dict[str, Schema] = {"name": TEXT, "title": TEXT}
    for key, field in CalibrationSource.model_fields.items():
        made = kinds.get(field.annotation) or (NUMBERS if "list" in str(field.annotation) else None)
        made = made or or_null(NUMBER if "float" in str(field.annotation) else TEXT)
        keys[key] = {**made, "description": field.description}
    return record("The calibration that the prediction is of.", keys)


def _by_curve() -> Schema:
    state = {
        "driving_pressure_kPa": NUMBER,
        "sensitivity_kPa_per_N": or_null(NUMBER),
        "force_range_end_N": or_null(NUMBER),
    }
    keys = {
        "curve": TEXT,
        "place": choice("softer", "in use", "stiffer"),
        "shear_modulus_MPa": NUMBER,
        "beyond_last_point": FLAG,
        "rated_pressure_kPa": or_null(NUMBER),
        "states": items(record("One driving pressure.", state)),
    }
    return record("The sensor by one mixing curve.", keys)
