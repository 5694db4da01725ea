"""Jobs: fewest, each of which the printer can hold, in the order that changes least."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.errors import InputError
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer
from pneutouch.spec.read import validate
from pneutouch.workflows.tray.order import changes, jobs

RESINS = ["Tango", "Agilus", "Clear", "White"]


def material(*resins):
    content = {
        "title": "+".join(resins),
        "code": "X",
        "kind": "rigid",
        "base_resins": list(resins),
        "colour": "#AAAAAA",
        "density_g_per_cm3": {"value": 1.1, "source": "assumed here"},
    }
    return validate(Material, content, "lab.toml")


def printer(library, at_once):
    own: Printer = library.load("printers", "j735")
    modes = [mode.model_copy(update={"digital_materials": True, "resins_at_once": None}) for mode in own.mode]
    return own.model_copy(update={"resins": RESINS, "resins_at_once": at_once, "mode": modes})


def loads(groups, parts):
    return [frozenset(r for k in group for m in parts[k] for r in m.base_resins) for group in groups]


def test_what_fits_at_once_is_one_job(library):
    own = library.load("printers", "objet260-connex")
    names = ("TangoPlus", "FLX9940", "FLX9995", "VeroClear")
    assert jobs([(library.load("materials", name),) for name in names], own) == [[0, 1, 2, 3]]


def test_two_pairs_that_share_a_resin_are_two_jobs_with_one_change(library):
    parts = [(material("Tango", "Clear"),), (material("Agilus", "Clear"),), (material("Clear"),), (material("Tango"),)]
    groups = jobs(parts, printer(library, 2))
    assert sorted(map(sorted, groups)) == [[0, 2, 3], [1]] or sorted(map(sorted, groups)) == [[0, 3], [1, 2]]
    assert changes(loads(groups, parts)) == 1


def test_what_is_loaded_anew_counts_not_what_is_taken_out():
    few, many = frozenset({"Tango"}), frozenset({"Tango", "Agilus", "Clear"})
    assert changes([few, many]) == 2
    assert changes([many, few]) == 0
    assert changes([many, few, many]) == 2
    assert changes([few]) == 0


@given(
    parts=st.lists(st.lists(st.sampled_from(RESINS), min_size=1, max_size=2, unique=True), min_size=1, max_size=9),
    at_once=st.integers(2, 4),
)
def test_jobs_hold_each_part_once_and_no_two_could_be_joined(library, parts, at_once):
    own = printer(library, at_once)
    given_ = [(material(*resins),) for resins in parts]
    groups = jobs(given_, own)
    assert sorted(k for group in groups for k in group) == list(range(len(parts)))
    held = loads(groups, given_)
    assert all(len(load) <= at_once for load in held)
    assert all(len(one | other) > at_once for one, other in pairwise(held))
    if len(frozenset().union(*held)) <= at_once:
        assert len(groups) == 1


def test_a_part_that_no_job_can_hold_is_refused(library):
    with pytest.raises(InputError, match="cannot print Tango\\+Clear"):
        jobs([(material("Tango", "Clear", "White"),)], printer(library, 2))
