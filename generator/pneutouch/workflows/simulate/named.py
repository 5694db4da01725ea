"""The design of a campaign: by its name, or as a file in the campaign's folder, which holds all that its file names."""

from pneutouch.catalogue import DesignSource, Library
from pneutouch.catalogue.scene import split_calibration
from pneutouch.spec.campaign_file import CAMPAIGN
from pneutouch.spec.files import read_bytes


def named_design(design: str | DesignSource, library: Library) -> tuple[str, dict[str, bytes]]:
    """Name of the design in a campaign; for a design that was given by a path also its copy for the campaign's
    folder."""
    if isinstance(design, DesignSource):
        return design.name, {}
    plain, calibration = split_calibration(design, library)
    if plain in library.paths("designs"):
        return design, {}
    path = library.design_file(plain)
    named = path.suffix == ".toml" and path.name != CAMPAIGN
    name = path.name if named else f"{path.stem}-design.toml"
    return name if calibration is None else f"{name}@{calibration}", {name: read_bytes(path)}
