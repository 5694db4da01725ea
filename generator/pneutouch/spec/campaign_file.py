"""The file of a campaign: which runs its folder holds, and the design that it names."""

from pathlib import Path

from pneutouch.errors import InputError
from pneutouch.spec.campaign import Campaign
from pneutouch.spec.files import design_inside, inside
from pneutouch.spec.read import read_toml, validate

CAMPAIGN = "campaign.toml"


def campaign_of(data: Path) -> tuple[Campaign, Path]:
    """The campaign of a folder or of its campaign file, whose runs lie in that folder. Raises InputError."""
    path = data / CAMPAIGN if data.is_dir() else data
    if data.is_dir() and not path.is_file():
        raise InputError(f"holds no {CAMPAIGN}", file=data, remedy="`pneutouch plan` writes one to be filled in")
    campaign = validate(Campaign, read_toml(path), str(path))
    for place, run in enumerate(campaign.runs):
        inside(path.parent, run.file, file=path, key=f"runs[{place}].file")
    return campaign, path.parent


def design_of(campaign: Campaign, folder: Path) -> str | None:
    """The design that a campaign names, as a command takes it; None if it names none. Raises InputError."""
    if campaign.design is None:
        return None
    return design_inside(folder, campaign.design, file=folder / CAMPAIGN, key="design")
