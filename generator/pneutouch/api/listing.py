"""Names of the designs, calibrations, materials, printers and gauges that a user can give."""

from typing import Any

from pneutouch.api import show
from pneutouch.catalogue.listing import listing


class Listing(show.Shown, dict[str, str]):
    """Titles by name."""

    def _head(self) -> str:
        return f"{len(self)} names"

    def _rows(self) -> list[Any]:
        return list(self.items())


def designs() -> Listing:
    """The designs: the user's and the shipped ones."""
    return _listed("designs")


def materials() -> Listing:
    """The cured materials."""
    return _listed("materials")


def calibrations() -> Listing:
    """The calibrations of sensors, which ``design.replace(calibration=NAME)`` takes."""
    return _listed("calibrations")


def printers() -> Listing:
    """The printers."""
    return _listed("printers")


def gauges() -> Listing:
    """The pressure gauges, which ``design.replace(gauge=NAME)`` takes."""
    return _listed("gauges")


def _listed(kind: str) -> Listing:
    """Titles by name; for a file that cannot be read its error in place of the title."""
    listed = Listing()
    for entry in listing(kind)[kind]:
        listed[entry["name"]] = f"cannot be read: {entry['error']}" if "error" in entry else entry["title"]
    return listed
