"""Folders of the files: the user's, and the shipped one."""

import os
from pathlib import Path

HOME = "PNEUTOUCH_HOME"
"""Environment variable that names the user's folder."""

IN_CHECKOUT = "user"
"""The user's folder inside a checkout of the program, whose own ``designs`` are the shipped ones; git ignores it."""

PACKAGE = Path(__file__).resolve().parents[1]
_CHECKOUT = PACKAGE.parents[1]


def shipped_root() -> Path:
    """The folder of the shipped files, ``designs`` and ``printprofiles``: the installed data, else the checkout."""
    installed = PACKAGE / "data"
    return installed if installed.is_dir() else _CHECKOUT


def user_folder() -> Path:
    """The folder that holds the user's ``designs``, ``calibrations`` and ``printprofiles``.

    It is ``$PNEUTOUCH_HOME``, else the working folder; in a checkout of the program, whose folders of these names are
    shipped, it is ``user/``. Relative where it is found from the working folder, so that messages stay short.
    """
    named = os.environ.get(HOME)
    if named:
        return Path(named).expanduser()
    return Path(IN_CHECKOUT) if _is_checkout(Path()) else Path()


def _is_checkout(folder: Path) -> bool:
    """True if a folder is a checkout of the program: this one, or another one if the program is installed."""
    return (folder / "generator/pneutouch/catalogue" / Path(__file__).name).is_file()
