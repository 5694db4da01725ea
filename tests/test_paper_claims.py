"""The page that sets the paper's statements beside this program's figures: what is stored is what the code gives today."""

from __future__ import annotations

import re

import numpy as np
import pytest
from benchmarks.store import stored
from paper_claims import Found, figures, judged

KNOWN = stored("claims")


@pytest.fixture(scope="module")
def found() -> Found:
    return Found()


def test_every_verdict_is_the_one_that_the_code_gives(found):
    """Words, verdicts and reasons to the letter, numbers to a hundredth: processors round the last digit differently."""
    number = re.compile(r"-?\d+(?:\.\d+)?")
    assert len(KNOWN["claims"]) > 30
    for now, known in zip(judged(found), KNOWN["claims"], strict=True):
        assert now._replace(ours="")._asdict() == {**known, "ours": ""}
        assert number.sub("#", now.ours) == number.sub("#", known["ours"])
        values = [np.array(number.findall(text), float) for text in (now.ours, known["ours"])]
        np.testing.assert_allclose(*values, rtol=0.01, atol=0.011, err_msg=known["says"])


def test_a_reason_stands_where_a_statement_is_not_confirmed():
    for row in KNOWN["claims"]:
        assert bool(row["why"]) == (row["verdict"] != "agrees"), row["says"]


def test_the_redrawn_curves_are_those_of_the_code(found):
    compare(figures(found), KNOWN["figures"])


def compare(now, known):
    if isinstance(known, dict):
        assert now.keys() == known.keys()
        for key in known:
            compare(now[key], known[key])
    elif known and isinstance(known[0], list):
        assert len(now) == len(known)
        for one, other in zip(now, known, strict=True):
            compare(one, other)
    else:
        np.testing.assert_allclose(np.array(now, float), np.array(known, float), rtol=1e-3, atol=1e-3)
