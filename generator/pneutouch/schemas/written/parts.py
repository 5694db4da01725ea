"""Parts that several documents have."""

from pneutouch.schemas.shape import NUMBER, NUMBERS, TEXT, TEXTS, Schema, any_of, choice, record
from pneutouch.spec.contact import SIZES, ContactTable


def contact(notes: bool = False) -> Schema:
    """Schema of the pressing object, given if that is no frictionless plate."""
    sizes = {key: NUMBER for keys in SIZES.values() for key in keys}
    corners = {"type": "array", "items": NUMBERS}
    more: dict[str, Schema] = {"notes": TEXTS, "rounds": NUMBER, "solves": NUMBER} if notes else {}
    keys: dict[str, Schema] = {
        "object": choice(*SIZES),
        "label": TEXT,
        "plate_diameter_mm": NUMBER,
        "plate_rim_mm": NUMBER,
        **{**sizes, "profile_mm": corners},
        "friction": any_of(NUMBER, {"const": "inf"}),
        "offset_mm": NUMBER,
        "tilt_deg": NUMBER,
        "shear_mm": NUMBER,
        **more,
    }
    helped = {key: schema | _help(key) for key, schema in keys.items()}
    return record("What presses the sensor, where that is no frictionless plate.", helped, set(keys) - {"label"})


def _help(key: str) -> Schema:
    """The help of the design file's key."""
    field = ContactTable.model_fields.get(key)
    return {} if field is None else {"description": field.description}
