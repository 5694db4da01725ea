"""The place of a calibration in the user's folder, checked before anything is computed for it."""

import os
from collections.abc import Sequence
from pathlib import Path

from pneutouch.bench.calibrate.parameters import KEYS, NAMES
from pneutouch.catalogue import KINDS
from pneutouch.errors import InputError
from pneutouch.spec.calibration import SensorCalibration
from pneutouch.spec.names import NAME_RULE, plain_name
from pneutouch.spec.read import read_toml

_NO_CALIBRATION = "none"
"""Name of a calibration that leaves the calibration of a design out."""


def check_place(name: str, root: Path) -> Path:
    """The file ``root/calibrations/name.toml`` of a calibration.

    Raises InputError for a bad name, for a place that something other than a file has, and for a folder that cannot be
    written.
    """
    # DESIGN@NAME is a path where it ends with .toml.
    if plain_name(name, key="save") == _NO_CALIBRATION or name.endswith(".toml"):
        remedy = f"{NAME_RULE}; not {_NO_CALIBRATION}, and not ending with .toml"
        raise InputError("cannot be the name of a calibration", key="save", value=name, remedy=remedy)
    path = root / KINDS["calibrations"].folder / f"{name}.toml"
    if path.is_symlink() or (path.exists() and not path.is_file()):
        raise InputError("is no file of its own", file=path, remedy="move it away or give another `save`")
    parent = next(one for one in path.absolute().parents if one.exists())
    if not parent.is_dir():
        raise InputError(f"{parent} is not a folder", file=path, remedy="move it away: it must be a folder")
    if not os.access(parent, os.W_OK | os.X_OK):
        raise InputError(f"{parent} cannot be written", file=path, remedy="take a user's folder you may write to")
    return path


def check_unlike(path: Path, digest: str, names: Sequence[str], hold_out_kPa: Sequence[float]) -> None:
    """Raise InputError where the file is there and cannot be the calibration that is to be made.

    It can be where its campaign has the ``digest``, and ``names`` were fitted and ``hold_out_kPa`` were held out.
    """
    if not path.is_file():
        return
    try:
        there = KINDS["calibrations"].validate(read_toml(path), str(path))
    except InputError:
        raise taken(path) from None
    assert isinstance(there, SensorCalibration)
    held_kPa = [] if there.response is None else there.response.held_out_pressures_kPa
    fitted = {parameter.key for parameter in there.parameters if parameter.fitted}
    requested = {KEYS[NAMES.index(name)] for name in names}
    if there.source.digest != digest or fitted != requested or held_kPa != list(hold_out_kPa):
        raise taken(path)


def taken(path: Path) -> InputError:
    """The error of a name that another calibration has."""
    remedy = "give another `save`, or `replace` to replace it"
    return InputError("there is a calibration of this name, of other content", file=path, remedy=remedy)
