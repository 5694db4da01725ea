"""The schema of a design that the studio exported."""

from pneutouch.schemas.shape import TEXT, Schema, described_by, mapping, record


def exported_design() -> Schema:
    """Schema of the file that **Export** on the page saves and **Open** reads."""
    value: Schema = {"type": ["string", "null"]}
    keys = {
        "version": TEXT,
        "base": TEXT,
        "values": described_by("What differs from the base, by TABLE.KEY; null: taken out.", mapping(value)),
    }
    return record("A design that the studio exported.", keys)
