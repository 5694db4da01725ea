"""Pads of tests: cells tabulated by coarse presses, in a quarter of the time, and once for all files of a run."""

from __future__ import annotations

import hashlib
from contextlib import contextmanager

import numpy as np
import pytest

from pneutouch.mechanics.touch import cell as cells
from pneutouch.mechanics.touch.cell import CellTable

_NAMES, _COARSE, _COARSEST = ("_ORDER", "_CELLS", "_STEPS"), (4, 8, 6), (2, 4, 4)
"""What a table is made of; a home's is for what a pad does with it, and on the flange takes a third of the time."""


@contextmanager
def coarse_presses(values=_COARSE, **variables):
    """Coarse presses, with variables of the environment set."""
    with pytest.MonkeyPatch.context() as patch:
        for name, value in variables.items():
            patch.setenv(name, str(value))
        for name, value in zip(_NAMES, values, strict=True):
            patch.setattr(cells, name, value)
        yield


@contextmanager
def coarse_home(tmp_path_factory):
    """An empty home of a user, whose tables are coarse and shared by all files of a run."""
    home = tmp_path_factory.mktemp("pads")
    with coarse_presses(_COARSEST, PNEUTOUCH_HOME=home, XDG_CACHE_HOME=_shared(tmp_path_factory)):
        yield home


def coarse_table(sensor, pressure, tmp_path_factory):
    """The table of a cell by coarse presses at a driving pressure, MPa."""
    key = hashlib.sha256(repr((sensor, pressure)).encode()).hexdigest()[:16]
    path = _shared(tmp_path_factory) / f"coarse-{key}.npz"
    if not path.is_file():
        with coarse_presses():
            made = cells.cell_table(sensor, pressure)
        part = tmp_path_factory.mktemp("table") / "table.npz"
        np.savez(part, **made.arrays())
        path.parent.mkdir(exist_ok=True)
        part.replace(path)
    with np.load(path) as file:
        return CellTable.of({name: file[name] for name in file.files})


def _shared(tmp_path_factory):
    """A folder that all processes of a run have, as each has a folder of its own in it."""
    base = tmp_path_factory.getbasetemp()
    return (base.parent if base.name.startswith("popen-") else base) / "coarse"
