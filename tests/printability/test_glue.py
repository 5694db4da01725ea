"""Glues by pair of surfaces, and the rule that refuses a flange glued with a wrong one."""

from __future__ import annotations

import typing
from dataclasses import replace

import pytest

from pneutouch.catalogue import load_scene
from pneutouch.errors import InputError
from pneutouch.evaluation.subject import glued_seat
from pneutouch.parts.glue import GLUES, GlueSurface, glue_of, glues_for, surface_of
from pneutouch.printability.rules import working
from pneutouch.printability.view import GluedSeat, PrintView
from pneutouch.spec.design import Connector, DesignFile
from tests.printability.working import dome
from tests.refusals import refused

SURFACES = typing.get_args(GlueSurface)
GLUED = {"connector.seat": "glued-flange"}


def findings(name, one, other):
    subject, context = dome([0])
    return working.check_glue(PrintView(subject, replace(context, glued=GluedSeat(name, one, other))))


def test_silicone_takes_its_own_glue_alone_and_every_pair_has_one():
    for surface in SURFACES:
        assert glues_for("silicone", surface) == ["silicone-adhesive"]
    assert all(glues_for(one, other) for one in SURFACES for other in SURFACES)
    assert not GLUES["silicone-adhesive"].bond("silicone", "silicone").weak


@pytest.mark.parametrize("name", GLUES)
def test_a_glue_that_does_not_bond_is_an_error_and_the_remedy_bonds(name):
    for one in SURFACES:
        for other in SURFACES:
            bond = GLUES[name].bond(one, other)
            found = [one.severity for one in findings(name, one, other)]
            assert found == ([] if bond and not bond.weak else ["warning" if bond else "error"])
            if bond is None:
                (finding,) = findings(name, one, other)
                assert all(better in finding.fix for better in glues_for(one, other))


def test_the_glue_of_a_cast_flange_is_silicones_and_of_a_printed_one_the_makers_choice():
    cast, printed = load_scene("cast-dome", GLUED), load_scene("paper-dome")
    assert (glue_of(cast), glue_of(printed), glued_seat(printed)) == ("silicone-adhesive", None, None)
    assert glued_seat(cast) == ("silicone-adhesive", "silicone", "thermoplastic")
    assert surface_of(printed.printer) == "photopolymer"
    assert glued_seat(load_scene("cast-dome")) is None


def test_a_cast_ring_is_glued_rigid_on_rigid():
    ring = load_scene("cast-dome", {"connector.seat": "cast-ring"})
    assert glued_seat(ring) == ("epoxy", "thermoplastic", "thermoplastic")
    assert glue_of(load_scene("cast-dome", {"connector.seat": "cast-ring", "connector.glue": "cyanoacrylate"})) == (
        "cyanoacrylate"
    )
    assert [one.severity for one in findings(*glued_seat(ring))] == []
    assert [one.severity for one in findings("silicone-adhesive", "thermoplastic", "thermoplastic")] == ["error"]


def test_a_seat_without_glue_refuses_one_and_a_design_without_one_reads_as_before():
    with refused("connector.glue", "epoxy"):
        load_scene("cast-dome", {"connector.glue": "epoxy"})
    with pytest.raises(InputError, match=r"connector\.glue"):
        load_scene("paper-dome", {"connector.glue": "honey"})
    assert "glue" not in DesignFile().model_dump()["connector"]
    assert Connector(glue="epoxy").model_dump()["glue"] == "epoxy"
