"""Each rule fires on the parts made to break it and on no other; good parts break none."""

from __future__ import annotations

from functools import cache

import pytest

from pneutouch.printability import check
from pneutouch.printability.check import RULES
from tests.printability.gallery import BAD, GOOD
from tests.printability.working import WORKING


@cache
def findings(name):
    """What the rules say of a bad part, checked once."""
    return tuple(check(BAD[name].make()))


@pytest.mark.parametrize("name", BAD)
def test_a_bad_part_breaks_the_rules_it_was_made_for_and_no_other(name):
    found = findings(name)
    assert {finding.rule: finding.severity for finding in reversed(found)} == BAD[name].breaks, found


@pytest.mark.parametrize("name", GOOD)
def test_a_good_part_breaks_no_rule(name):
    assert check(GOOD[name]()) == []


def test_every_rule_has_an_exhibit():
    assert {rule for exhibit in BAD.values() for rule in exhibit.breaks} | set(WORKING) == set(RULES)


@pytest.mark.parametrize("name", [name for name in BAD if name not in ("fine", "coarse", "open mesh", "inside out")])
def test_a_finding_says_how_far_off_where_and_why(name):
    for finding in findings(name):
        document = finding.document()
        assert document["message"]
        assert len(document["source"]) >= 8
        assert document["fix"]
        if finding.excess is not None:
            assert document["excess"]["measured"] != document["excess"]["limit"]
        if finding.rule not in ("envelope", "resins"):
            assert document["where_mm"] is not None
