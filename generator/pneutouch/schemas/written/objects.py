"""Schemas of the records on an object: a built texture specimen, a voxel stack, an exported design."""

from pneutouch.schemas.shape import (
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
    record,
)

_POINT: Schema = {**NUMBERS, "minItems": 3, "maxItems": 3}
_DIGEST: Schema = {"type": "string", "pattern": "^[0-9a-f]{64}$"}
_COLOUR: Schema = {**items({"type": "integer", "minimum": 0, "maximum": 255}), "minItems": 4, "maxItems": 4}
_SHARE: Schema = {"type": "number", "minimum": 0, "maximum": 1}


def stack() -> Schema:
    """Schema of ``stack.json`` of a voxel stack."""
    resin = record("A base resin.", {"rgba": _COLOUR, "voxels": WHOLE, "volume_mm3": NUMBER})
    dither = {"method": TEXT, "seed": WHOLE, "cube_mm": NUMBER, "least_share_of_a_cube": NUMBER}
    keys = {
        "name": TEXT,
        "input_hash": TEXT,
        "printer": TEXT,
        "mode": TEXT,
        "orientation": TEXT,
        "versions": mapping(TEXT),
        "print_frame_offset_mm": _POINT,
        "prefix": TEXT,
        "dpi": PAIR,
        "pixel_um": PAIR,
        "layer_um": NUMBER,
        "pixels": PAIR,
        "layers": described_by("Number of slices.", WHOLE),
        "size_mm": _POINT,
        "first_voxel_mm": _POINT,
        "background_rgba": _COLOUR,
        "resins": described_by("Base resins by name.", mapping(resin)),
        "bodies": described_by("Bodies by name.", mapping(_body())),
        "dither": record("How fractions are spread over voxels.", dither),
        "assumptions": TEXTS,
        "sha256": _DIGEST,
        "slices": described_by("Digest of each slice, from the first on.", items(_DIGEST)),
    }
    return record("A stack of voxel slices.", keys)


def _body() -> Schema:
    mixed: dict[str, Schema] = {
        "made_up_within_mm": NUMBER,
        "stiff_resin": TEXT,
        "skin_voxels": WHOLE,
        **dict.fromkeys(("fraction_requested", "fraction_given", "fraction_realised"), _SHARE),
        "worst_cube": NUMBER,
        "cubes": WHOLE,
    }
    keys = {
        "material": described_by("Label of the material.", TEXT),
        "resins": described_by("Base resins that it is mixed of.", TEXTS),
        "voxels": WHOLE,
        "volume_mm3": NUMBER,
        "exact_volume_mm3": NUMBER,
    }
    return record("A body; what follows its volumes is of a mixed body alone.", {**keys, **mixed}, mixed)


def exported_design() -> Schema:
    """Schema of the file that **Export** on the page saves and **Open** reads."""
    value: Schema = {"type": ["string", "null"]}
    keys = {
        "version": TEXT,
        "base": TEXT,
        "values": described_by("What differs from the base, by TABLE.KEY; null: taken out.", mapping(value)),
    }
    return record("A design that the studio exported.", keys)
