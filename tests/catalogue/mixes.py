"""Mixes by the shipped curve of TangoPlus and VeroClear, or by another."""

from __future__ import annotations

from pneutouch.catalogue import Library
from pneutouch.catalogue.mixture import mixed_material, mixing
from pneutouch.spec.grade import Grade
from tests.conftest import ROOT

LIBRARY = Library((ROOT,))
LAW = mixing("TangoPlus", "VeroClear", LIBRARY)


def mixed(fraction, at=None, library=LIBRARY):
    content = {"from": "TangoPlus", "to": "VeroClear", "fraction": fraction, **({} if at is None else {"at": at})}
    return mixed_material(Grade.model_validate(content), library, file="here")
