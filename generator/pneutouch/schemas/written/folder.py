"""The schema of a manifest: every output folder has one, and each command adds its own measurements."""

from pneutouch.schemas.shape import NUMBER, NUMBERS, TEXT, TEXTS, WHOLE, Schema, described_by, items, mapping, record
from pneutouch.schemas.written.parts import finding

_DIGEST = {"type": "string", "pattern": "^[0-9a-f]{64}$"}
_ANYTHING: Schema = {"type": "object"}


def manifest() -> Schema:
    """Schema of ``manifest.json``."""
    listed = record("A file.", {"sha256": _DIGEST, "bytes": WHOLE})
    body: dict[str, Schema] = {
        "tolerance_mm": NUMBER,
        "measured_deviation_mm": NUMBER,
        "triangles": WHOLE,
        "volume_mm3": NUMBER,
        "exact_volume_mm3": NUMBER,
    }
    required = ("name", "versions", "files")
    keys: dict[str, Schema] = {
        "name": TEXT,
        "versions": mapping(TEXT),
        "files": mapping(listed),
        "inputs": _ANYTHING,
        "input_hash": {"type": "string", "pattern": "^[0-9a-f]{12,64}$"},
        "mesh": mapping(record("A body's mesh.", body, set(body) - {"triangles"})),
        "print_frame_offset_mm": {**NUMBERS, "minItems": 3, "maxItems": 3},
        "left_out": {"anyOf": [mapping(TEXT), TEXTS, items(_ANYTHING)]},
        "mould": _ANYTHING,
        "estimates": items(_ANYTHING),
        "glue_mL": NUMBER,
        "findings": items({"anyOf": [finding(), finding("labels")]}),
        "jobs": items(_ANYTHING),
        "resin_changes": {"type": ["string", "null"]},
        "coupons": described_by("Coupons by name.", {"type": ["object", "array"]}),
    }
    return record("Inputs of a folder, and the digest of every file in it.", keys, set(keys) - set(required))
