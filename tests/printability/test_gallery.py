"""Each rule fires on the parts made to break it and on no other; good parts break none."""

from __future__ import annotations

from functools import cache

import pytest

from pneutouch.printability import Joint, PrintSubject, check
from pneutouch.printability.rulebook import RULES
from pneutouch.printability.rules.bodies import check_contact_faces, check_matte
from pneutouch.printability.rules.cleaning import check_cleaning
from pneutouch.printability.view import PrintView
from tests.printability.gallery import BAD, GOOD, ball, box, item, one, rod, taper, two
from tests.printability.working import WORKING


@cache
def findings(name):
    """What the rules say of a bad part, checked once."""
    return tuple(check(BAD[name].make()))


def cases(names):
    """Bad parts as parameters; a long channel that folds back, which costs most, in the long run."""
    return [pytest.param(name, marks=pytest.mark.slow) if name == "meander" else name for name in names]


@pytest.mark.parametrize("name", cases(BAD))
def test_a_bad_part_breaks_the_rules_it_was_made_for_and_no_other(name):
    found = findings(name)
    assert {finding.rule: finding.severity for finding in reversed(found)} == BAD[name].breaks, found


@pytest.mark.parametrize("name", GOOD)
def test_a_good_part_breaks_no_rule(name):
    assert check(GOOD[name]()) == []


def pin(width):
    return one(box(8, 8, 3) + rod(width / 2, 7, (4.0, 4.0, 2.0)))


def hole(width):
    return one(box(8, 8, 1.7) - rod(width / 2, 4, (4.0, 4.0, -1.0)))


def bore(widths):
    return one(box(8, 8, 2.2 * widths) - rod(1.1, 2.2 * widths + 2, (4.0, 4.0, -1.0)))


def bottle(share):
    """A ball of a hollow and its neck, as wide as a share of the hollow."""
    return one(box(14, 14, 14) - ball(5, (7.0, 7.0, 7.0)) - rod(5 * share, 8, (7.0, 7.0, 7.0)))


@pytest.mark.parametrize(
    ("rule", "make", "sizes", "expected"),
    [
        ("walls", lambda t: one(box(12, 12, t)), (0.59, 0.61, 0.99, 1.01), ("error", "warning", "warning", None)),
        ("pins", pin, (0.49, 0.52, 0.98, 1.02), ("error", "warning", "warning", None)),
        ("holes", hole, (0.58, 0.62, 0.98, 1.02), ("error", "warning", "warning", None)),
        ("gaps", lambda t: two(t, "tray"), (0.19, 0.21, 0.39, 0.41), ("error", "warning", "warning", None)),
        ("edges", lambda angle: one(taper(angle, 0.0)), (29, 31), ("warning", None)),
        ("cleaning", bore, (10.3, 9.7), ("warning", None)),
        # The neck is measured by cubes of 0.25 mm.
        pytest.param(
            *("cleaning", bottle, (0.46, 0.54, 0.66, 0.74), ("error", "warning", "warning", None)),
            marks=pytest.mark.slow,
        ),
    ],
    ids=["walls", "pins", "holes", "gaps", "edges", "bores", "necks"],
)
def test_a_rule_turns_at_its_limit(rule, make, sizes, expected):
    """Limits of the printer's profile (walls, pins, holes and gaps in mm), a knife's angle, and shares of a width."""
    found = [{(finding.rule, finding.severity) for finding in check(make(size))} for size in sizes]
    assert found == [set() if severity is None else {(rule, severity)} for severity in expected]


def bend(length):
    """A shaft of 2 mm from above, and a side room of that length at its bottom."""
    return one(box(12, 8, 10) - box(2, 2, 7, (3, 3, 4)) - box(length + 1, 2, 2, (4, 3, 4)))


def roofed(share):
    """A sensing face of 100 mm of length, and a roof over a share of it."""
    face = item(box(100, 10, 10), "face", job="tray", sensing=lambda points: points[:, 2] > 9.999)
    return PrintSubject((face, item(box(100 * share, 12, 1, (50, -1, 12)), "roof", job="tray")))


def joined(share):
    """Two blocks that share 100 mm2, a share of their joint."""
    return PrintSubject(two(0.0).items, (Joint("one", "other", 100 / share, (5.0, 5.0, 10.0)),))


@pytest.mark.parametrize(
    ("rule", "make", "kept", "broken"),
    [
        (check_cleaning, bend, 0.5, 1.5),
        (check_matte, roofed, 0.008, 0.012),
        (check_contact_faces, joined, 0.9995, 0.995),
    ],
    ids=["hidden", "matte", "joint"],
)
def test_a_rule_by_itself_turns_at_its_limit(rule, make, kept, broken):
    """2 mm3 out of sight, 1 % of a sensing face, and 99.9 % of a joint."""
    assert rule(PrintView(make(kept))) == []
    assert len(rule(PrintView(make(broken)))) == 1


def test_every_rule_has_an_exhibit():
    assert {rule for exhibit in BAD.values() for rule in exhibit.breaks} | set(WORKING) == set(RULES)


@pytest.mark.parametrize(
    "name", cases(name for name in BAD if name not in ("fine", "coarse", "open mesh", "inside out"))
)
def test_a_finding_says_how_far_off_where_and_why(name):
    for finding in findings(name):
        assert finding.message
        assert len(finding.source) >= 8
        assert finding.fix
        if finding.excess is not None:
            assert finding.stated.excess.measured != finding.stated.excess.limit
        if finding.rule not in ("envelope", "resins"):
            assert finding.where_mm is not None
