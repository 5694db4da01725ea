"""The design that a campaign names, which must be there."""

from pathlib import Path

from pneutouch.catalogue.library import Library
from pneutouch.catalogue.scene import DesignSource
from pneutouch.errors import InputError
from pneutouch.spec.campaign import CAMPAIGN, Campaign, design_of


def known_design(campaign: Campaign, folder: Path, library: Library) -> str | None:
    """The design that a campaign names, as a command takes it; None if it names none.

    Raises InputError for one that is not there, with the campaign's file and key.
    """
    name = design_of(campaign, folder)
    if name is not None:
        try:
            DesignSource.of(name, library)
        except InputError as error:
            # An error on what is in the design's file names that file.
            if error.file is None:
                error.file, error.key, error.value = str(folder / CAMPAIGN), "design", campaign.design
            raise
    return name
