"""Draw a design, check it and read its print files back, without a prediction."""

from __future__ import annotations

import itertools

import numpy as np

from pneutouch.body import Body
from pneutouch.catalogue import Library, load_scene
from pneutouch.catalogue.library import elastomers
from pneutouch.errors import InputError
from pneutouch.evaluation.subject import subject_of
from pneutouch.export.threemf import threemf
from pneutouch.parts import Assembly, assemble
from pneutouch.printability import Finding, check
from pneutouch.spec.read import parse_changes
from tests.conftest import ROOT
from tests.parts.overlap import overlap_volume

LIBRARY = Library((ROOT,))
RESINS = list(elastomers(LIBRARY))


def outcome(base: str, chosen: list[str]) -> tuple[str, list[Finding] | str]:
    """``refused`` with the reason, ``broken`` or ``built`` with what the rules found."""
    try:
        assembly = assemble(load_scene(base, parse_changes(chosen), LIBRARY))
    except InputError as error:
        return "refused", str(error)
    sound(assembly)
    found = check(subject_of(assembly))
    return ("broken" if any(f.severity == "error" for f in found) else "built"), found


def sound(assembly: Assembly) -> None:
    """Closed by index and as float32 STL, nothing collapsed, nothing overlapping."""
    for body in assembly.bodies:
        assert body.is_closed(), body.name
        read = body.moved(assembly.print_offset).welded()
        assert read.is_closed(), f"{body.name} opens as STL"
        assert len(set(map(tuple, np.sort(read.triangles, axis=1).tolist()))) == len(read.triangles), body.name
        assert all(len(set(corner)) == 3 for corner in read.triangles.tolist()), f"{body.name} has a collapsed triangle"
    for one, other in itertools.combinations(assembly.bodies, 2):
        assert overlap_volume(one, other) < 1e-9, (one.name, other.name)


def strict_warnings(name: str, bodies: tuple[Body, ...]) -> int:
    """Warnings of a strict reading of the 3MF; raises where it is refused."""
    import lib3mf

    model = lib3mf.get_wrapper().CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromBuffer(threemf(name, bodies, {"Title": name}))
    return int(reader.GetWarningCount())
